#include "shade/attributes.hpp"

#include <array>
#include <cmath>

namespace burnish {

namespace {

struct Vector {
    double x, y, w;
};

Vector cross(const Vector& a, const Vector& b) {
    return {a.y * b.w - a.w * b.y, a.w * b.x - a.x * b.w, a.x * b.y - a.y * b.x};
}

/// Corner i in homogeneous window coordinates, counted from the centre of the reference pixel.
Vector corner(const ScreenMesh& mesh, const SetupTriangle& t, std::size_t i) {
    const HomogeneousVertex& h = mesh.homogeneous[t.vertex[i]];
    const double w = static_cast<double>(h.w);
    const double centre_x = t.reference_x + 0.5, centre_y = t.reference_y + 0.5;
    if (t.clipped != 0) {
        return {static_cast<double>(h.x) - centre_x * w, static_cast<double>(h.y) - centre_y * w,
                w};
    }
    return {(t.x[i] / 256.0 - centre_x) * w, (t.y[i] / 256.0 - centre_y) * w, w};
}

}  // namespace

void attribute_planes(const Shading& shading, const ScreenMesh& mesh, const SetupTriangle& triangle,
                      AttributePlane* out) {
    std::array<std::array<float, kMaxInterpolated>, 3> values;
    std::array<Vector, 3> v;
    for (std::size_t i = 0; i < 3; ++i) {
        vertex_attributes(shading, triangle.vertex[i], values[i].data());
        v[i] = corner(mesh, triangle, i);
    }
    // Rows of the inverse of the vertex matrix: b[i] . (x, y, 1) is corner i's weight over w.
    std::array<Vector, 3> b{cross(v[1], v[2]), cross(v[2], v[0]), cross(v[0], v[1])};
    const double determinant = v[0].x * b[0].x + v[0].y * b[0].y + v[0].w * b[0].w;
    const double scale = 1.0 / determinant;
    const auto count = static_cast<std::size_t>(shading.interpolated());
    if (!std::isfinite(scale)) {  // seen edge-on: no plane, so the first corner's values
        out[0] = {1.0F, 0.0F, 0.0F};
        for (std::size_t k = 0; k < count; ++k) out[k + 1] = {values[0][k], 0.0F, 0.0F};
        return;
    }
    for (Vector& row : b) row = {row.x * scale, row.y * scale, row.w * scale};
    const auto plane = [&](double a0, double a1, double a2) {
        return AttributePlane{static_cast<float>(a0 * b[0].w + a1 * b[1].w + a2 * b[2].w),
                              static_cast<float>(a0 * b[0].x + a1 * b[1].x + a2 * b[2].x),
                              static_cast<float>(a0 * b[0].y + a1 * b[1].y + a2 * b[2].y)};
    };
    out[0] = plane(1.0, 1.0, 1.0);
    for (std::size_t k = 0; k < count; ++k) {
        out[k + 1] = plane(static_cast<double>(values[0][k]), static_cast<double>(values[1][k]),
                           static_cast<double>(values[2][k]));
    }
}

}  // namespace burnish
