#include "io/write_mesh.hpp"

#include <fmt/format.h>

#include <bit>
#include <burnish/error.hpp>
#include <cstdint>
#include <fstream>
#include <string>
#include <string_view>

#include "io/atomic_file.hpp"

namespace burnish {
namespace {

static_assert(std::endian::native == std::endian::little, "binary PLY is written as it lies");

template <class T>
void append_bytes(std::string& out, const T& value) {
    out.append(reinterpret_cast<const char*>(&value), sizeof(value));
}

std::string ply_text(const MeshData& mesh) {
    const std::size_t triangles = mesh.indices.size() / 3;
    std::string out = "ply\nformat binary_little_endian 1.0\n";
    out += fmt::format("element vertex {}\n", mesh.positions.size());
    for (const std::string_view name : {"x", "y", "z", "nx", "ny", "nz", "u", "v"})
        out += fmt::format("property float {}\n", name);
    out += fmt::format("element face {}\nproperty list uchar int vertex_indices\nend_header\n",
                       triangles);
    constexpr std::size_t kVertexBytes = 32, kFaceBytes = 13;
    out.reserve(out.size() + kVertexBytes * mesh.positions.size() + kFaceBytes * triangles);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        append_bytes(out, mesh.positions[i]);
        append_bytes(out, mesh.normals[i]);
        append_bytes(out, mesh.uvs[i]);
    }
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        out += '\3';
        for (std::size_t k = i; k < i + 3; ++k) append_bytes(out, mesh.indices[k]);
    }
    return out;
}

/// fmt prints the shortest text that reads back as the same float.
std::string obj_text(const MeshData& mesh) {
    fmt::memory_buffer out;
    const auto to = std::back_inserter(out);
    for (const glm::vec3& p : mesh.positions) fmt::format_to(to, "v {} {} {}\n", p.x, p.y, p.z);
    for (const glm::vec2& uv : mesh.uvs) fmt::format_to(to, "vt {} {}\n", uv.x, uv.y);
    for (const glm::vec3& n : mesh.normals) fmt::format_to(to, "vn {} {} {}\n", n.x, n.y, n.z);
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        out.push_back('f');
        for (std::size_t k = i; k < i + 3; ++k) {
            const std::uint64_t index = std::uint64_t{mesh.indices[k]} + 1;
            fmt::format_to(to, " {}/{}/{}", index, index, index);
        }
        out.push_back('\n');
    }
    return fmt::to_string(out);
}

}  // namespace

void write_mesh_file(const MeshData& mesh, const std::filesystem::path& path) {
    const std::string extension = path.extension().string();
    if (extension != ".ply" && extension != ".obj")
        throw Error(ErrorCode::bad_option,
                    fmt::format("{}: cannot write the format '{}', expected .ply or .obj",
                                path.string(), extension));
    const Mesh checked(mesh);  // throws what the contract says
    const std::string text = extension == ".ply" ? ply_text(mesh) : obj_text(mesh);
    AtomicFile file(path);
    std::ofstream stream(file.temporary(), std::ios::binary);
    stream.write(text.data(), static_cast<std::streamsize>(text.size()));
    stream.close();
    if (!stream) throw Error(ErrorCode::io, fmt::format("{}: cannot be written", path.string()));
    file.commit();
}

}  // namespace burnish
