#include "shade/attributes.hpp"

#include <algorithm>
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

/// Whether corners of a triangle do not have what their vertices have.
bool has_own_frames(const Shading& shading) {
    return shading.frames_from_uv && shading.frame_attributes > kUvAttributes;
}

/// Lets every corner have a row of its own.
void use_corners(const Shading& shading, const ScreenMesh& mesh,
                 std::span<const SetupTriangle* const> triangles, PlaneInputs& scratch,
                 AttributePlanesCtx& ctx) {
    const auto row = static_cast<std::size_t>(shading.interpolated());
    scratch.rows.resize(3 * triangles.size() * row + VertexRows::kSlack);
    scratch.homogeneous.resize(3 * triangles.size());
    for (std::size_t k = 0; k < triangles.size(); ++k) {
        CornerAttributes values;
        corner_attributes(shading, mesh, *triangles[k], values);
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t at = 3 * k + i;
            std::uint32_t& vertex = scratch.triangles[k].vertex[i];
            std::copy_n(values[i].data(), row, scratch.rows.data() + at * row);
            scratch.homogeneous[at] = mesh.homogeneous[vertex];
            vertex = static_cast<std::uint32_t>(at);
        }
    }
    ctx.homogeneous = scratch.homogeneous.data();
    ctx.rows = scratch.rows.data();
    ctx.row_stride = static_cast<std::ptrdiff_t>(row);
}

}  // namespace

void corner_attributes(const Shading& shading, const ScreenMesh& mesh,
                       const SetupTriangle& triangle, CornerAttributes& out) {
    const std::array<std::uint32_t, 3> vertex = corner_vertices(mesh, triangle);
    for (std::size_t i = 0; i < 3; ++i) {
        std::copy_n(shading.rows.row(vertex[i]), shading.interpolated(), out[i].data());
    }
    if (!has_own_frames(shading)) return;
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

void attribute_planes(const Shading& shading, const ScreenMesh& mesh,
                      std::span<const SetupTriangle* const> triangles, const KernelTable& kernels,
                      PlaneInputs& scratch, float* equations) {
    const int count = shading.interpolated();
    scratch.triangles.resize(triangles.size());
    for (std::size_t k = 0; k < triangles.size(); ++k) {
        const SetupTriangle& t = *triangles[k];
        const std::array<std::uint32_t, 3> vertex = corner_vertices(mesh, t);
        for (const std::uint32_t v : vertex) {  // those of a tile lie far apart in the mesh
            __builtin_prefetch(&mesh.homogeneous[v]);
            __builtin_prefetch(shading.rows.row(v));
        }
        scratch.triangles[k] = {{t.x[0], t.x[1], t.x[2]},
                                {t.y[0], t.y[1], t.y[2]},
                                {vertex[0], vertex[1], vertex[2]},
                                t.reference_x,
                                t.reference_y,
                                t.clipped != 0 ? 1 : 0};
    }
    AttributePlanesCtx ctx{scratch.triangles.data(),
                           static_cast<int>(triangles.size()),
                           mesh.homogeneous.data(),
                           shading.rows.values.data(),
                           static_cast<std::ptrdiff_t>(shading.rows.stride),
                           count,
                           equations};
    if (has_own_frames(shading)) use_corners(shading, mesh, triangles, scratch, ctx);
    kernels.attribute_planes(ctx);
}

}  // namespace burnish
