#include "mesh/chart.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace burnish {
namespace {

/// Above this |y| of the normal a face is an end, not a side. The least |component| along the
/// direction of projection is then sqrt((1 - 0.9^2) / 2) = 0.308, the inverse of the most stretch.
constexpr float kEndNormal = 0.9F;

/// The box in which uv runs from 0 to 1.
struct Cube {
    glm::dvec3 low;
    glm::dvec3 high;
    double size;
};

Cube bounding_cube(std::span<const glm::vec3> positions) {
    if (positions.empty()) return {glm::dvec3(0.0), glm::dvec3(0.0), 1.0};
    glm::vec3 low = positions[0], high = positions[0];
    for (const glm::vec3& p : positions) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    const glm::dvec3 extent = glm::dvec3(high) - glm::dvec3(low);
    const double longest = std::max({extent.x, extent.y, extent.z});
    return {glm::dvec3(low), glm::dvec3(high), longest > 0.0 ? longest : 1.0};
}

glm::dvec2 project(const glm::dvec3& p, const glm::vec3& normal, const Cube& cube) {
    const glm::dvec3 up = p - cube.low, down = cube.high - p;
    if (std::abs(normal.y) > kEndNormal)
        return normal.y > 0.0F ? glm::dvec2(up.x, down.z) : glm::dvec2(up.x, up.z);
    if (std::abs(normal.x) > std::abs(normal.z))
        return normal.x > 0.0F ? glm::dvec2(down.z, up.y) : glm::dvec2(up.z, up.y);
    return normal.z >= 0.0F ? glm::dvec2(up.x, up.y) : glm::dvec2(down.x, up.y);
}

}  // namespace

std::vector<glm::vec2> chart_uvs(std::span<const glm::vec3> positions,
                                 std::span<const std::uint32_t> indices,
                                 std::span<const glm::vec3> face_normals) {
    const Cube cube = bounding_cube(positions);
    std::vector<glm::vec2> uvs;
    uvs.reserve(indices.size());
    for (std::size_t c = 0; c < indices.size(); ++c)
        uvs.emplace_back(project(glm::dvec3(positions[indices[c]]), face_normals[c / 3], cube) /
                         cube.size);
    return uvs;
}

}  // namespace burnish
