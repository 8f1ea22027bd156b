#pragma once

#include <burnish/files.hpp>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "io/mesh_soup.hpp"

namespace burnish {

struct SoupTriangles {
    std::vector<SoupCorner> corners;      ///< three per triangle
    std::vector<glm::vec3> face_normals;  ///< per triangle: its polygon's, unit length
    std::vector<std::uint32_t> polygons;  ///< those that were kept, ascending
};

/// Cuts the polygons of `soup` into triangles; corners keep their uv and normal.
///
/// A convex polygon becomes the fan of its first corner; one that is not, and has at most 1024
/// corners, is cut by clipping ears in the plane of its normal (larger ones become fans too).
/// Polygons with a non-finite position, with fewer than 3 distinct positions, or without area are
/// left out and counted in `report`. Triangles without area inside a polygon stay: they close the
/// crack to a neighbour that has an additional corner there.
/// Positions must be distinct places: those at equal coordinates have one index.
SoupTriangles triangulate(const MeshSoup& soup, MeshReport& report);

}  // namespace burnish
