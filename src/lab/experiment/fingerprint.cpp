#include "lab/experiment/fingerprint.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <array>
#include <burnish/error.hpp>
#include <burnish/machine.hpp>
#include <fstream>

namespace burnish::lab {
namespace {

void add_file(Fingerprint& to, const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    std::array<char, 1U << 16U> block;
    while (stream) {
        stream.read(block.data(), block.size());
        to.add({block.data(), static_cast<std::size_t>(stream.gcount())});
    }
    if (!stream.eof()) throw Error(ErrorCode::io, fmt::format("{}: cannot be read", file.string()));
}

/// The shared library that has the renderer; empty if it is part of the program.
std::filesystem::path library_file() {
    Dl_info info{};
    const auto* function = reinterpret_cast<const void*>(&machine_profile);
    if (dladdr(function, &info) == 0 || info.dli_fname == nullptr) return {};
    return info.dli_fname;
}

std::string fingerprint_build() {
    Fingerprint result;
    add_file(result, "/proc/self/exe");
    if (const std::filesystem::path library = library_file(); !library.empty())
        add_file(result, library);
    return result.text();
}

}  // namespace

std::string Fingerprint::text() const {
    return fmt::format("{:016x}", m_value);
}

std::string fingerprint(std::string_view bytes) {
    Fingerprint result;
    result.add(bytes);
    return result.text();
}

std::string file_fingerprint(const std::filesystem::path& file) {
    Fingerprint result;
    add_file(result, file);
    return result.text();
}

const std::string& build_fingerprint() {
    static const std::string result = fingerprint_build();
    return result;
}

}  // namespace burnish::lab
