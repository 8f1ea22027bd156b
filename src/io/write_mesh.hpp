#pragma once

#include <burnish/mesh.hpp>
#include <filesystem>

namespace burnish {

/// save_mesh of files.hpp: ".ply" (binary, little endian) or ".obj". Reading the file back gives
/// the same positions, normals and uvs, bit for bit. Throws Error{bad_option} for another
/// extension, Error{bad_input} if Mesh would refuse `mesh`.
void write_mesh_file(const MeshData& mesh, const std::filesystem::path& path);

}  // namespace burnish
