#include "io/atomic_file.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <burnish/error.hpp>
#include <string>
#include <system_error>
#include <utility>

namespace burnish {
namespace {

/// A name that no other process and no other thread of this one uses at the same time.
std::filesystem::path temporary_name(const std::filesystem::path& target) {
    static std::atomic<unsigned> counter{0};
    const std::string name = fmt::format(".{}.part{}-{}{}", target.stem().string(), getpid(),
                                         counter++, target.extension().string());
    return target.parent_path() / name;
}

}  // namespace

AtomicFile::AtomicFile(std::filesystem::path target)
    : m_target(std::move(target)), m_temporary(temporary_name(m_target)) {
    std::error_code ignored;
    const std::filesystem::path parent = m_target.parent_path();
    if (!parent.empty() && !std::filesystem::is_directory(parent, ignored))
        throw Error(ErrorCode::io, m_target.string() + ": there is no such directory to write to");
    if (std::filesystem::is_directory(m_target, ignored))
        throw Error(ErrorCode::io,
                    m_target.string() + ": is a directory, expected a file to write");
}

AtomicFile::~AtomicFile() {
    std::error_code ignored;
    if (!m_committed) std::filesystem::remove(m_temporary, ignored);
}

void AtomicFile::commit() {
    std::error_code failure;
    std::filesystem::rename(m_temporary, m_target, failure);
    if (failure)
        throw Error(ErrorCode::io, m_target.string() + ": cannot be written: " + failure.message());
    m_committed = true;
}

}  // namespace burnish
