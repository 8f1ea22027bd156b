#include "mesh/normals.hpp"

#include <cmath>

#include "core/dmath.hpp"
#include "mesh/fans.hpp"

namespace burnish {
namespace {

/// Keeps the edges of a hexagonal prism (60 degrees) and smooths those of an icosahedron (42).
constexpr double kCosSharp = 0.6427876096865393;  // 50 degrees

struct BluntEdges {
    const glm::vec3* face_normals;
    static constexpr bool kJoinsMany = false;
    [[nodiscard]] static std::uint32_t side(std::uint32_t) { return 0; }
    [[nodiscard]] bool joins(std::uint32_t a, std::uint32_t b) const {
        return glm::dot(glm::dvec3(face_normals[a]), glm::dvec3(face_normals[b])) > kCosSharp;
    }
};

glm::dvec3 unit_or_zero(const glm::dvec3& v) {
    const double square = glm::dot(v, v);
    return square > 0.0 && std::isfinite(square) ? v / std::sqrt(square) : glm::dvec3(0.0);
}

double corner_angle(std::span<const glm::vec3> positions, std::span<const std::uint32_t> indices,
                    std::uint32_t corner) {
    const glm::dvec3 place(positions[indices[corner]]);
    const glm::dvec3 next(positions[indices[next_corner(corner)]]);
    const glm::dvec3 previous(positions[indices[previous_corner(corner)]]);
    return dmath::acos(glm::dot(unit_or_zero(next - place), unit_or_zero(previous - place)));
}

}  // namespace

CornerNormals corner_normals(std::span<const glm::vec3> positions,
                             std::span<const std::uint32_t> indices,
                             std::span<const glm::vec3> face_normals) {
    const CornerLists lists =
        corner_lists(indices, positions.size(), [](std::uint32_t) { return true; });
    FanSplitter splitter(indices, BluntEdges{face_normals.data()});
    CornerNormals result;
    result.normal_of_corner.resize(indices.size());
    std::vector<glm::dvec3> sums;
    for (std::size_t v = 0; v < positions.size(); ++v) {
        const std::span<const std::uint32_t> corners = lists.at(v);
        const std::span<const std::uint32_t> fan = splitter.split(corners);
        const auto first = static_cast<std::uint32_t>(result.normals.size());
        sums.clear();
        for (std::size_t i = 0; i < corners.size(); ++i) {
            if (fan[i] == sums.size()) sums.emplace_back(0.0);
            sums[fan[i]] += corner_angle(positions, indices, corners[i]) *
                            glm::dvec3(face_normals[corners[i] / 3]);
            result.normal_of_corner[corners[i]] = first + fan[i];
        }
        for (const glm::dvec3& sum : sums) {
            const glm::dvec3 normal = unit_or_zero(sum);
            result.normals.emplace_back(normal == glm::dvec3(0.0) ? glm::dvec3(0.0, 0.0, 1.0)
                                                                  : normal);
        }
    }
    return result;
}

}  // namespace burnish
