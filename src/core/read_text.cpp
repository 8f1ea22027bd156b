#include "core/read_text.hpp"

#include <fmt/format.h>

#include <array>
#include <burnish/error.hpp>
#include <fstream>

#include "core/near_file.hpp"

namespace burnish {

std::string read_text(const std::filesystem::path& path) {
    constexpr std::size_t kLargest = 16 << 20;
    std::ifstream stream(path, std::ios::binary);
    if (!stream)
        throw Error(ErrorCode::io, fmt::format("{}: cannot be opened for reading{}", path.string(),
                                               near_file(path)));
    std::string text;
    std::array<char, 1 << 16> chunk;
    do {
        stream.read(chunk.data(), chunk.size());
        text.append(chunk.data(), static_cast<std::size_t>(stream.gcount()));
    } while (stream && text.size() <= kLargest);
    if (stream.bad()) throw Error(ErrorCode::io, fmt::format("{}: cannot be read", path.string()));
    if (text.size() > kLargest)
        throw Error(ErrorCode::limit, fmt::format("{}: more than {} MB, expected a program",
                                                  path.string(), kLargest >> 20));
    return text;
}

}  // namespace burnish
