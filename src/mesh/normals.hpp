#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace burnish {

/// Normals made up for a mesh that has none.
struct CornerNormals {
    std::vector<glm::vec3> normals;               ///< unit length
    std::vector<std::uint32_t> normal_of_corner;  ///< index into `normals`
};

/// At each vertex, the faces that meet in edges blunter than 50 degrees (the angle between their
/// normals) share the sum of their normals, weighted by their angles at the vertex; sharper edges,
/// edges with one triangle and edges with more than two stay sharp.
/// @param positions     distinct places
/// @param indices       place of each corner, three per triangle
/// @param face_normals  per triangle: unit length, or zero where it has no area: such a triangle
///                      stays alone and gets (0, 0, 1)
CornerNormals corner_normals(std::span<const glm::vec3> positions,
                             std::span<const std::uint32_t> indices,
                             std::span<const glm::vec3> face_normals);

}  // namespace burnish
