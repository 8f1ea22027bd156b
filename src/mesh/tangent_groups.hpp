#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace burnish {

/// Triangles over vertices that are distinct in position, normal and uv together.
struct WeldedTriangles {
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;
    std::vector<glm::vec2> uvs;
    std::vector<std::uint32_t> indices;  ///< three per triangle; every vertex is used
};

/// The corners of a mesh divided by tangent. Each group belongs to one vertex; groups are numbered
/// by vertex, so that they can serve as the vertices of the mesh that is drawn.
struct TangentGroups {
    std::vector<std::uint32_t> group_of_corner;
    std::vector<std::uint32_t> vertex_of_group;
    std::vector<glm::vec4> tangent_of_group;  ///< as returned by corner_tangents
};

/// Throws Error{limit} above 2^28 triangles.
void check_tangent_limit(std::size_t corner_count);

/// Groups and tangents by the rules at corner_tangents. Throws as check_tangent_limit.
TangentGroups tangent_groups(const WeldedTriangles& mesh);

/// How a triangle's uv lies on it.
enum class UvSide : std::uint8_t {
    mirrored,   ///< uv runs clockwise
    preserved,  ///< uv runs counter-clockwise, as the triangle does
    none,       ///< no uv area: its tangent is whatever its neighbours' is
    excluded,   ///< not a triangle: two corners in one place, or a place that is not finite
};

/// Replaces every `none` by a side: that of the nearest triangles across edges that have one,
/// `preserved` if those differ or if there are none. Does not depend on the triangles' order.
void spread_sides(std::span<const std::uint32_t> indices, std::span<UvSide> sides);

}  // namespace burnish
