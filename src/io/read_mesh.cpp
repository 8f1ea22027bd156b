#include "io/read_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <fstream>

#include "core/near_file.hpp"
#include "core/within_memory.hpp"
#include "io/mesh_build.hpp"
#include "io/mesh_soup.hpp"
#include "io/mesh_text.hpp"

namespace burnish {
namespace {

namespace fs = std::filesystem;

/// Corner numbers fit 32 bits below this size, since no format has more than one in a byte.
constexpr std::uintmax_t kMaxFileBytes = 0xffffffffU;

std::string read_bytes(const fs::path& path) {
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (!fs::exists(status))
        throw Error(ErrorCode::io,
                    fmt::format("{}: no such file{}", path.string(), near_file(path)));
    if (!fs::is_regular_file(status))
        throw Error(ErrorCode::io, fmt::format("{}: not a regular file", path.string()));
    const std::uintmax_t size = fs::file_size(path, error);
    if (!error && size > kMaxFileBytes)
        throw Error(ErrorCode::limit, fmt::format("{}: {} bytes, expected at most {}",
                                                  path.string(), size, kMaxFileBytes));
    std::ifstream stream(path, std::ios::binary);
    if (error || !stream)
        throw Error(ErrorCode::io, fmt::format("{}: cannot be opened", path.string()));
    std::string bytes(size, '\0');
    stream.read(bytes.data(), static_cast<std::streamsize>(size));
    if (static_cast<std::uintmax_t>(stream.gcount()) != size)
        throw Error(ErrorCode::io, fmt::format("{}: cannot be read", path.string()));
    return bytes;
}

using Parser = MeshSoup (*)(const MeshText&);

std::string lower_extension(const fs::path& path) {
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return extension;
}

Parser choose_parser(const MeshText& file, const fs::path& path) {
    const std::string extension = lower_extension(path);
    const std::string_view first =
        LineWords(file, file.bytes.substr(0, file.bytes.find('\n')), 1).word();
    if (first == "ply") return parse_ply;
    if (is_off_keyword(first)) return parse_off;
    if (extension == ".obj") return parse_obj;
    if (extension == ".stl" || first == "solid") return parse_stl;
    if (extension == ".off") return parse_off;
    if (extension == ".ply") return parse_ply;
    mesh_error(file, 0,
               fmt::format("unknown mesh format, expected OBJ, PLY, OFF or STL (extension {})",
                           in_quotes(extension)));
}

}  // namespace

LoadedMesh read_mesh_file(const fs::path& path) {
    const auto shortage = [&] { return path.string() + ": too large for the memory"; };
    return within_memory(shortage, [&] {
        const std::string bytes = read_bytes(path);
        const MeshText file{path.string(), bytes};
        MeshReport report;
        const MeshData data = build_mesh(file, choose_parser(file, path)(file), report);
        return LoadedMesh{Mesh(data), report};
    });
}

}  // namespace burnish
