#pragma once

#include <burnish/files.hpp>

#include "io/mesh_soup.hpp"

namespace burnish {

/// Everything between a file's polygons and a mesh to draw: places, topology, triangles, normals
/// and uvs where they are missing, tangents. Fills `report`. Throws Error{bad_input}, naming the
/// file, if no triangle is left.
MeshData build_mesh(const MeshText& file, MeshSoup soup, MeshReport& report);

}  // namespace burnish
