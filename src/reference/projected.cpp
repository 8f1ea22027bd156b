#include "reference/projected.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace burnish::reference {

namespace {

bool is_finite(const glm::dvec4& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z) && std::isfinite(v.w);
}

/// All three corners beyond the same side of the view volume.
bool outside(const std::array<glm::dvec4, 3>& clip) {
    const auto all = [&](auto&& beyond) {
        return beyond(clip[0]) && beyond(clip[1]) && beyond(clip[2]);
    };
    for (int axis = 0; axis < 3; ++axis) {
        if (all([&](const glm::dvec4& c) { return c[axis] < -c.w; })) return true;
        if (all([&](const glm::dvec4& c) { return c[axis] > c.w; })) return true;
    }
    return false;
}

/// (x, y, w) with x / w and y / w on the grid; corners behind the eye stay.
glm::dvec3 snapped(const glm::dvec3& corner, const CornerGrid& grid) {
    if (!(corner.z > 0.0)) return corner;
    const glm::dvec2 at = glm::dvec2(corner) / corner.z * grid.steps;
    return {glm::floor(at + (grid.downwards ? 0.0 : 0.5)) / grid.steps * corner.z, corner.z};
}

int pixel_of(double coordinate, int size) {
    return static_cast<int>(std::clamp(std::floor(coordinate), 0.0, size - 1.0));
}

/// The whole frame for a triangle that reaches the plane of the eye.
PixelBox pixel_box(const std::array<glm::dvec3, 3>& corner, FrameSize size) {
    glm::dvec2 low(std::numeric_limits<double>::infinity()), high(-low);
    for (const glm::dvec3& c : corner) {
        if (!(c.z > 0.0)) return {0, 0, size.width - 1, size.height - 1};
        const glm::dvec2 at = glm::dvec2(c) / c.z;
        low = glm::min(low, at);
        high = glm::max(high, at);
    }
    return {pixel_of(low.x, size.width), pixel_of(low.y, size.height), pixel_of(high.x, size.width),
            pixel_of(high.y, size.height)};
}

bool culled(Cull cull, double determinant) {
    // Window y goes down, so triangles that wind counter-clockwise have a negative one.
    return (cull == Cull::back && determinant > 0.0) || (cull == Cull::front && determinant < 0.0);
}

class ObjectProjection {
  public:
    ObjectProjection(const DoubleScene& scene, const DoubleObject& object, FrameSize size)
        : m_size(size), m_grid(scene.grid) {
        const glm::dmat4 clip_from_object = scene.view.clip_from_world * object.world_from_object;
        m_clip.reserve(object.vertices.size());
        for (const DoubleVertex& v : object.vertices)
            m_clip.push_back(clip_from_object * glm::dvec4(v.position, 1.0));
    }

    /// Corners as (x, y, w) with x and y in pixels times w.
    void add(const DoubleObject& object, std::size_t number, ProjectedTriangle& out,
             std::vector<ProjectedTriangle>& to, ProjectionCounts& counts) const {
        std::array<glm::dvec4, 3> clip;
        std::array<glm::dvec3, 3> corner;
        for (std::size_t i = 0; i < 3; ++i) {
            clip[i] = m_clip[object.indices[3 * number + i]];
            corner[i] = {(clip[i].x + clip[i].w) * (0.5 * m_size.width),
                         (clip[i].w - clip[i].y) * (0.5 * m_size.height), clip[i].w};
            if (m_grid) corner[i] = snapped(corner[i], *m_grid);
        }
        ++counts.submitted;
        if (!std::all_of(clip.begin(), clip.end(), is_finite)) {
            ++counts.nonfinite;
            return;
        }
        if (outside(clip)) return;
        out.row = {glm::cross(corner[1], corner[2]), glm::cross(corner[2], corner[0]),
                   glm::cross(corner[0], corner[1])};
        const double determinant = glm::dot(corner[0], out.row[0]);
        if (determinant == 0.0 || !std::isfinite(determinant)) {
            ++counts.degenerate;
            return;
        }
        if (culled(object.cull, determinant)) return;
        // The rows keep their sizes: scaled by the determinant they would no longer be each other's
        // exact negatives along an edge that two triangles share.
        if (determinant < 0.0) {
            for (glm::dvec3& row : out.row) row = -row;
        }
        const double scale = 0.5 / std::abs(determinant);
        out.depth =
            (out.row[0] * clip[0].z + out.row[1] * clip[1].z + out.row[2] * clip[2].z) * scale;
        out.depth.z += 0.5;
        out.box = pixel_box(corner, m_size);
        out.number = static_cast<std::uint32_t>(number);
        to.push_back(out);
    }

  private:
    FrameSize m_size;
    std::optional<CornerGrid> m_grid;
    std::vector<glm::dvec4> m_clip;
};

}  // namespace

std::vector<ProjectedTriangle> project(const DoubleScene& scene, FrameSize size,
                                       ProjectionCounts& counts) {
    std::vector<ProjectedTriangle> triangles;
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        const DoubleObject& object = scene.objects[i];
        const ObjectProjection projection(scene, object, size);
        ProjectedTriangle triangle{};
        triangle.object = static_cast<std::uint32_t>(i);
        for (std::size_t k = 0; k < object.indices.size() / 3; ++k)
            projection.add(object, k, triangle, triangles, counts);
    }
    return triangles;
}

}  // namespace burnish::reference
