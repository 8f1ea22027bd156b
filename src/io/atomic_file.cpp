#include "io/atomic_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <burnish/error.hpp>
#include <cerrno>
#include <cstring>
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

[[noreturn]] void fail(const std::string& name, int error) {
    throw Error(ErrorCode::io,
                fmt::format("{}: cannot be written: {}", name, std::strerror(error)));
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

void AtomicFile::write(std::span<const std::byte> bytes) {
    const int descriptor =
        open(m_temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (descriptor < 0) fail(m_target.string(), errno);
    try {
        write_all(descriptor, bytes, m_target.string());
    } catch (...) {
        close(descriptor);
        throw;
    }
    // Some file systems report a full disk only here.
    if (close(descriptor) != 0) fail(m_target.string(), errno);
}

void AtomicFile::commit() {
    std::error_code failure;
    std::filesystem::rename(m_temporary, m_target, failure);
    if (failure) fail(m_target.string(), failure.value());
    m_committed = true;
}

void write_text_file(std::string_view text, const std::filesystem::path& path) {
    AtomicFile file(path);
    file.write(std::as_bytes(std::span(text)));
    file.commit();
}

void write_all(int descriptor, std::span<const std::byte> bytes, const std::string& name) {
    while (!bytes.empty()) {
        const ssize_t count = ::write(descriptor, bytes.data(), bytes.size());
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) fail(name, errno);
        bytes = bytes.subspan(static_cast<std::size_t>(count));
    }
}

}  // namespace burnish
