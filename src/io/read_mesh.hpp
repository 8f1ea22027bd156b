#pragma once

#include <burnish/files.hpp>
#include <filesystem>

namespace burnish {

/// load_mesh of files.hpp. PLY, OFF and "solid" STL are known by their first word, OBJ and binary
/// STL by extension. Polygons are cut into triangles as at triangulate(); vertices without normals
/// get those of corner_normals(), polygons without uvs those of chart_uvs(); all get tangents as at
/// corner_tangents(). Time and memory are in proportion to the file's size, whatever it says.
LoadedMesh read_mesh_file(const std::filesystem::path& path);

}  // namespace burnish
