#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace burnish {

/// Per-corner tangent frames for normal mapping, by the MikkTSpace rules.
///
/// Corner i of triangle k is element 3 k + i of each span; the spans have the same length, a
/// multiple of three. Corners that agree in position, normal and uv (bit for bit; -0 equals 0)
/// share a vertex.
/// @return one frame per corner: xyz = unit tangent, perpendicular to the corner's normal; w = 1 or
///         -1: the bitangent is w * cross(n, t).
/// Around a vertex, triangles that meet in an edge and have uv of the same orientation form a
/// group; the group's tangent is the angle-weighted sum of its triangles' tangents, projected into
/// the plane of the normal. Mirrored uv therefore splits. Triangles without uv area take the
/// orientation of the nearest ones across edges and join their groups. A corner with nothing to go
/// by gets an arbitrary unit tangent, never NaN.
/// The order of triangles, and the corner at which each begins, change no more than rounding.
/// Throws Error{limit} above 2^28 triangles.
/// Method: M. S. Mikkelsen, "Simulation of Wrinkled Surfaces Revisited", 2008.
std::vector<glm::vec4> corner_tangents(std::span<const glm::vec3> positions,
                                       std::span<const glm::vec3> normals,
                                       std::span<const glm::vec2> uvs);

}  // namespace burnish
