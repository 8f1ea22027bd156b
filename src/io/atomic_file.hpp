#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace burnish {

/// A file that appears whole or not at all: write it, by `write()` or under the name `temporary()`,
/// then `commit()`.
///
/// The temporary lies in the same directory, so that the rename is one step, and keeps the
/// extension, by which writers choose the format. It is removed unless committed.
class AtomicFile {
  public:
    explicit AtomicFile(std::filesystem::path target);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    [[nodiscard]] const std::filesystem::path& temporary() const noexcept { return m_temporary; }

    /// Writes the whole temporary. Throws Error{io} if not every byte arrives.
    void write(std::span<const std::byte> bytes);

    /// Puts the temporary in the target's place. Throws Error{io} if that cannot be done.
    void commit();

  private:
    std::filesystem::path m_target;
    std::filesystem::path m_temporary;
    bool m_committed = false;
};

/// Writes a whole file, as save_text promises.
void write_text_file(std::string_view text, const std::filesystem::path& path);

/// Writes every byte to a file descriptor. Throws Error{io} that calls the file `name`.
void write_all(int descriptor, std::span<const std::byte> bytes, const std::string& name);

}  // namespace burnish
