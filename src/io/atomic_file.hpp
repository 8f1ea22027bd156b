#pragma once

#include <filesystem>

namespace burnish {

/// A file that appears whole or not at all: write to `temporary()`, then `commit()`.
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

    /// Puts the temporary in the target's place. Throws Error{io} if that cannot be done.
    void commit();

  private:
    std::filesystem::path m_target;
    std::filesystem::path m_temporary;
    bool m_committed = false;
};

}  // namespace burnish
