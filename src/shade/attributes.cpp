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

double dot(const Vector& a, const Vector& b) {
    return a.x * b.x + a.y * b.y + a.w * b.w;
}

/// Corner i, at `vertex`, in homogeneous window coordinates, counted from the centre of the
/// reference pixel.
Vector corner(const ScreenMesh& mesh, const SetupTriangle& t, std::uint32_t vertex, std::size_t i) {
    const HomogeneousVertex& h = mesh.homogeneous[vertex];
    const double w = static_cast<double>(h.w);
    const double centre_x = t.reference_x + 0.5, centre_y = t.reference_y + 0.5;
    if (t.clipped != 0) {
        return {static_cast<double>(h.x) - centre_x * w, static_cast<double>(h.y) - centre_y * w,
                w};
    }
    return {(t.x[i] / 256.0 - centre_x) * w, (t.y[i] / 256.0 - centre_y) * w, w};
}

/// The inverse of the vertex matrix: row[i] . (x, y, 1) * scale is corner i's weight over w at
/// window position (x, y), counted from the centre of the reference pixel.
struct CornerRows {
    std::array<Vector, 3> row;
    double scale;  ///< not finite if the triangle is seen edge-on
};

CornerRows corner_rows(const ScreenMesh& mesh, const SetupTriangle& t) {
    const std::array<std::uint32_t, 3> vertex = corner_vertices(mesh, t);
    const Vector v[3] = {corner(mesh, t, vertex[0], 0), corner(mesh, t, vertex[1], 1),
                         corner(mesh, t, vertex[2], 2)};
    CornerRows rows{{cross(v[1], v[2]), cross(v[2], v[0]), cross(v[0], v[1])}, 0.0};
    rows.scale = 1.0 / dot(v[0], rows.row[0]);
    return rows;
}

/// dP/du and dP/dv of a triangle, unit length; false where u and v do not tell them apart.
bool surface_derivatives(const VertexFrame& a, const VertexFrame& b, const VertexFrame& c,
                         glm::vec3& along_u, glm::vec3& along_v) {
    const glm::dvec3 e = glm::dvec3(b.position) - glm::dvec3(a.position),
                     f = glm::dvec3(c.position) - glm::dvec3(a.position);
    const glm::dvec2 p = glm::dvec2(b.uv) - glm::dvec2(a.uv),
                     q = glm::dvec2(c.uv) - glm::dvec2(a.uv);
    const double area = p.x * q.y - q.x * p.y;
    const double side = area < 0.0 ? -1.0 : 1.0;
    const glm::dvec3 u = (e * q.y - f * p.y) * side, v = (f * p.x - e * q.x) * side;
    const double u_length = std::sqrt(glm::dot(u, u)), v_length = std::sqrt(glm::dot(v, v));
    if (area == 0.0 || !(u_length > 0.0) || !(v_length > 0.0)) return false;
    if (!std::isfinite(u_length) || !std::isfinite(v_length)) return false;
    along_u = glm::vec3(u / u_length);
    along_v = glm::vec3(v / v_length);
    return true;
}

}  // namespace

void corner_attributes(const Shading& shading, const ScreenMesh& mesh,
                       const SetupTriangle& triangle, CornerAttributes& out) {
    const std::array<std::uint32_t, 3> vertex = corner_vertices(mesh, triangle);
    for (std::size_t i = 0; i < 3; ++i) vertex_attributes(shading, vertex[i], out[i].data());
    const bool frames = shading.frame_attributes > kUvAttributes;
    if (!shading.frames_from_uv || !frames) return;
    glm::vec3 u, v;
    const auto frame = [&](std::size_t i) { return shading.frames[vertex[i]]; };
    if (!surface_derivatives(frame(0), frame(1), frame(2), u, v)) return;
    for (auto& corner : out) {
        for (int c = 0; c < 3; ++c) {
            corner[static_cast<std::size_t>(kUvAttributes + c)] = u[c];
            corner[static_cast<std::size_t>(kUvAttributes + 3 + c)] = v[c];
        }
    }
}

Barycentrics barycentrics(const ScreenMesh& mesh, const SetupTriangle& triangle, std::int32_t x,
                          std::int32_t y) {
    const CornerRows rows = corner_rows(mesh, triangle);
    if (!std::isfinite(rows.scale)) return {{1.0, 0.0, 0.0}, 1.0};
    const Vector pixel{static_cast<double>(x - triangle.reference_x),
                       static_cast<double>(y - triangle.reference_y), 1.0};
    const double a = dot(rows.row[0], pixel), b = dot(rows.row[1], pixel),
                 c = dot(rows.row[2], pixel);
    const double sum = a + b + c;
    return {{a / sum, b / sum, c / sum}, sum * rows.scale};
}

void attribute_planes(const Shading& shading, const ScreenMesh& mesh, const SetupTriangle& triangle,
                      AttributePlane* out) {
    CornerAttributes values;
    corner_attributes(shading, mesh, triangle, values);
    CornerRows rows = corner_rows(mesh, triangle);
    std::array<Vector, 3>& b = rows.row;
    const auto count = static_cast<std::size_t>(shading.interpolated());
    if (!std::isfinite(rows.scale)) {  // seen edge-on: no plane, so the first corner's values
        out[0] = {1.0F, 0.0F, 0.0F};
        for (std::size_t k = 0; k < count; ++k) out[k + 1] = {values[0][k], 0.0F, 0.0F};
        return;
    }
    for (Vector& row : b) row = {row.x * rows.scale, row.y * rows.scale, row.w * rows.scale};
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
