#pragma once

#include <filesystem>
#include <vector>

namespace burnish::view {

/// Notices that files were written. Files are looked at, not subscribed to: that works on every
/// file system, and a few dozen of them cost microseconds.
class FileWatch {
  public:
    /// From now on these.
    void watch(const std::vector<std::filesystem::path>& files);
    /// A scene or mesh and the files that it names; of one that cannot be read itself alone.
    void watch_input(const std::filesystem::path& input);
    /// Whether one was written, came or went since the last call, or since `watch`. A file that is
    /// being written counts once it has kept its time from one call to the next.
    bool changed();

  private:
    using Time = std::filesystem::file_time_type;
    struct Watched {
        std::filesystem::path file;
        Time reported;  ///< when it was written, as far as the caller knows
        Time seen;      ///< at the last call
    };
    std::vector<Watched> m_files;
};

}  // namespace burnish::view
