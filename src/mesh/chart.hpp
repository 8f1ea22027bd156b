#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace burnish {

/// Uvs made up for a mesh that has none, for any mesh: each triangle is projected along one of the
/// six axis directions, so neighbours with different directions have a seam between them.
///
/// Guarantees: finite, within [0, 1], same winding as the triangle (no mirrored uv); one period
/// spans the longest side of the bounding box, so texels are square; no direction on the surface is
/// stretched more than 3.3 times. On the sides u is level and v is the height y, whichever of the
/// four side directions is taken: brush marks along u run on across those seams, and tangents are
/// continuous. Only faces within 26 degrees of straight up or down lie in the two end charts.
///
/// @param positions     finite
/// @param indices       three per triangle
/// @param face_normals  per triangle: unit length, or zero without area
/// @return              uv of each corner; corners of one vertex in one chart have the same bits
std::vector<glm::vec2> chart_uvs(std::span<const glm::vec3> positions,
                                 std::span<const std::uint32_t> indices,
                                 std::span<const glm::vec3> face_normals);

}  // namespace burnish
