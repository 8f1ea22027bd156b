#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "reference/double_scene.hpp"

namespace burnish::reference {

struct FrameSize {
    int width, height;
};

/// Pixels, inclusive.
struct PixelBox {
    int x0, y0, x1, y1;
};

/// A triangle on the screen, in homogeneous coordinates, so that nothing needs to be clipped: one
/// that reaches behind the eye has the same edges as any other.
///
/// With p = (x, y, 1) in pixels, dot(row[i], p) / sum over i of the same is corner i's weight at p,
/// perspective-correct, and p lies inside where all three are positive.
struct ProjectedTriangle {
    std::array<glm::dvec3, 3> row;
    glm::dvec3 depth;  ///< dot(depth, p): window depth, 0 near .. 1 far
    PixelBox box;
    std::uint32_t object, number;
};

/// Counts of what is left out, as FrameStats has them.
struct ProjectionCounts {
    std::uint64_t submitted = 0, nonfinite = 0, degenerate = 0;
};

/// All triangles that may be seen, in the order of submission.
std::vector<ProjectedTriangle> project(const DoubleScene& scene, FrameSize size,
                                       ProjectionCounts& counts);

/// Whether p = (x, y, 1) is inside. On an edge: if the inside lies right of it, or below a level
/// one, as on the machines; so a point on an edge that two triangles share is in exactly one of
/// them.
[[nodiscard]] inline bool covers(const ProjectedTriangle& triangle, const glm::dvec3& p) {
    for (const glm::dvec3& row : triangle.row) {
        const double edge = row.x * p.x + row.y * p.y + row.z * p.z;
        if (edge > 0.0) continue;
        const bool top_left = row.x > 0.0 || (row.x == 0.0 && row.y > 0.0);
        if (!(edge == 0.0 && top_left)) return false;
    }
    return true;
}

/// Weights of the three corners at p.
[[nodiscard]] inline glm::dvec3 weights(const ProjectedTriangle& triangle, const glm::dvec3& p) {
    const glm::dvec3 over_w(glm::dot(triangle.row[0], p), glm::dot(triangle.row[1], p),
                            glm::dot(triangle.row[2], p));
    return over_w / (over_w.x + over_w.y + over_w.z);
}

/// Weights of the three corners at a sample, and how they change to the next one to the right and
/// below.
struct SampleWeights {
    glm::dvec3 here, across, down;
};

/// At a place in pixels, of samples that are `spacing` pixels apart.
[[nodiscard]] inline SampleWeights weights_at(const ProjectedTriangle& triangle,
                                              const glm::dvec2& place, double spacing) {
    const auto& row = triangle.row;
    const glm::dvec3 p(place, 1.0), all = row[0] + row[1] + row[2];
    const glm::dvec3 here = weights(triangle, p);
    const auto change = [&](int axis) {
        const glm::dvec3 own(row[0][axis], row[1][axis], row[2][axis]);
        return (own - here * all[axis]) * (spacing / glm::dot(all, p));
    };
    return {here, change(0), change(1)};
}

}  // namespace burnish::reference
