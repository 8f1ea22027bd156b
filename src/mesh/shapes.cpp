#include <fmt/format.h>

#include <array>
#include <burnish/error.hpp>
#include <burnish/shapes.hpp>
#include <cmath>
#include <cstdint>

#include "core/dmath.hpp"

namespace burnish::shapes {
namespace {

constexpr double kTurn = 2.0 * dmath::kPi;

glm::dvec3 unit(const glm::dvec3& v) {
    return v / std::sqrt(glm::dot(v, v));
}

void check_count(const char* name, int value, int least) {
    if (value < least)
        throw Error(ErrorCode::bad_option,
                    fmt::format("{} = {}, expected at least {}", name, value, least));
}

void check_triangles(int columns, int rows) {
    constexpr std::int64_t kMaxTriangles = std::int64_t{1} << 28;
    const std::int64_t count = std::int64_t{2} * columns * rows;
    if (count > kMaxTriangles)
        throw Error(ErrorCode::limit,
                    fmt::format("{} triangles, expected at most {}", count, kMaxTriangles));
}

void check_size(const char* name, float value) {
    if (!(value > 0.0F) || !std::isfinite(value))
        throw Error(ErrorCode::bad_option,
                    fmt::format("{} = {}, expected a positive number", name, value));
}

struct Place {
    glm::dvec3 position;
    glm::dvec3 normal;   ///< any length
    glm::dvec3 tangent;  ///< any length
};

std::uint32_t add_vertex(MeshData& mesh, const Place& place, double u, double v) {
    mesh.positions.emplace_back(place.position);
    mesh.normals.emplace_back(unit(place.normal));
    mesh.tangents.emplace_back(glm::vec3(unit(place.tangent)), 1.0F);
    mesh.uvs.emplace_back(u, v);
    return static_cast<std::uint32_t>(mesh.positions.size() - 1);
}

void add_triangle(MeshData& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    mesh.indices.insert(mesh.indices.end(), {a, b, c});
}

/// Two triangles per cell of a grid whose vertices begin at `first`, `columns` + 1 to a row.
void add_grid(MeshData& mesh, std::uint32_t first, int columns, int rows) {
    const auto pitch = static_cast<std::uint32_t>(columns + 1);
    for (int y = 0; y < rows; ++y) {
        for (int x = 0; x < columns; ++x) {
            const std::uint32_t a =
                first + static_cast<std::uint32_t>(y) * pitch + static_cast<std::uint32_t>(x);
            add_triangle(mesh, a, a + 1, a + 1 + pitch);
            add_triangle(mesh, a, a + 1 + pitch, a + pitch);
        }
    }
}

/// Latitude row in 0 .. rows, at `turn` of a turn eastward from the back.
Place ellipsoid_place(const glm::dvec3& radii, double turn, int row, int rows) {
    const double sin_lon = dmath::sin(kTurn * turn);
    const double cos_lon = dmath::cos(kTurn * turn);
    const double latitude = dmath::kPi * (static_cast<double>(row) / rows - 0.5);
    const bool pole = row == 0 || row == rows;
    const double ring = pole ? 0.0 : dmath::cos(latitude);
    const double height = pole ? (row == 0 ? -1.0 : 1.0) : dmath::sin(latitude);
    const glm::dvec3 on_unit_sphere(-sin_lon * ring, height, -cos_lon * ring);
    return {on_unit_sphere * radii, on_unit_sphere / radii,
            glm::dvec3(-cos_lon * radii.x, 0.0, sin_lon * radii.z)};
}

struct KnotFrame {
    glm::dvec3 center, center_1;      ///< the curve and its derivative by t
    glm::dvec3 outward, outward_1;    ///< unit normal of the torus, likewise
    glm::dvec3 sideways, sideways_1;  ///< perpendicular to the curve and to `outward`
};

/// t in [0, 2 pi). The torus' own normal makes a frame that closes on itself.
KnotFrame knot_frame(const KnotShape& shape, double t) {
    const double p = shape.turns_around_axis;
    const double q = shape.turns_around_tube;
    const double r = shape.torus_radius;
    const double sp = dmath::sin(p * t), cp = dmath::cos(p * t);
    const double sq = dmath::sin(q * t), cq = dmath::cos(q * t);
    const double ring = shape.axis_radius + r * cq;
    const double ring_1 = -r * q * sq;
    const double ring_2 = -r * q * q * cq;
    const glm::dvec3 away(cp, sp, 0.0), away_1 = p * glm::dvec3(-sp, cp, 0.0), z(0.0, 0.0, 1.0);
    KnotFrame f;
    f.center = ring * away + r * sq * z;
    f.center_1 = ring_1 * away + ring * away_1 + r * q * cq * z;
    f.outward = cq * away + sq * z;
    f.outward_1 = -q * sq * away + cq * away_1 + q * cq * z;
    const glm::dvec3 center_2 =
        (ring_2 - p * p * ring) * away + 2.0 * ring_1 * away_1 - r * q * q * sq * z;
    const double speed = std::sqrt(glm::dot(f.center_1, f.center_1));
    const glm::dvec3 along = f.center_1 / speed;
    const glm::dvec3 along_1 = (center_2 - glm::dot(center_2, along) * along) / speed;
    f.sideways = glm::cross(along, f.outward);
    f.sideways_1 = glm::cross(along_1, f.outward) + glm::cross(along, f.outward_1);
    return f;
}

}  // namespace

MeshData sphere(int columns, int rows, const glm::vec3& radii) {
    check_count("columns", columns, 3);
    check_count("rows", rows, 2);
    check_triangles(columns, rows);
    for (int i = 0; i < 3; ++i) check_size("radius", radii[i]);
    MeshData mesh;
    const glm::dvec3 r(radii);
    // A pole needs one vertex per column: its triangle's tangent and u lie in the column's middle.
    const auto add_pole = [&](int row) {
        for (int x = 0; x < columns; ++x) {
            const double turn = (x + 0.5) / columns;
            add_vertex(mesh, ellipsoid_place(r, turn, row, rows), turn, row == 0 ? 0.0 : 1.0);
        }
    };
    add_pole(0);
    for (int y = 1; y < rows; ++y) {
        for (int x = 0; x <= columns; ++x) {
            const double turn = static_cast<double>(x % columns) / columns;
            add_vertex(mesh, ellipsoid_place(r, turn, y, rows), static_cast<double>(x) / columns,
                       static_cast<double>(y) / rows);
        }
    }
    add_pole(rows);

    const auto south = static_cast<std::uint32_t>(columns);
    const auto pitch = static_cast<std::uint32_t>(columns + 1);
    const std::uint32_t north = south + pitch * static_cast<std::uint32_t>(rows - 1);
    for (std::uint32_t x = 0; x < south; ++x) add_triangle(mesh, x, south + x + 1, south + x);
    add_grid(mesh, south, columns, rows - 2);
    for (std::uint32_t x = 0; x < south; ++x)
        add_triangle(mesh, north - pitch + x, north - pitch + x + 1, north + x);
    return mesh;
}

MeshData torus_knot(int segments, int sides, const KnotShape& shape) {
    check_count("segments", segments, 3);
    check_count("sides", sides, 3);
    check_count("turns around the axis", shape.turns_around_axis, 1);
    check_count("turns around the tube", shape.turns_around_tube, 0);
    check_triangles(segments, sides);
    check_size("axis radius", shape.axis_radius);
    check_size("torus radius", shape.torus_radius);
    check_size("tube radius", shape.tube_radius);
    if (!(shape.torus_radius < shape.axis_radius))
        throw Error(ErrorCode::bad_option,
                    fmt::format("torus radius = {}, expected less than the axis radius {}",
                                shape.torus_radius, shape.axis_radius));
    double length = 0.0;
    for (int i = 0; i < segments; ++i) {
        const glm::dvec3 speed = knot_frame(shape, kTurn * i / segments).center_1;
        length += std::sqrt(glm::dot(speed, speed)) * kTurn / segments;
    }
    const double tube = shape.tube_radius;
    const double periods = std::max(1.0, std::floor(length / (kTurn * tube) + 0.5));

    MeshData mesh;
    for (int y = 0; y <= sides; ++y) {
        const double angle = kTurn * (y % sides) / sides;
        const double c = dmath::cos(angle), s = dmath::sin(angle);
        for (int x = 0; x <= segments; ++x) {
            const KnotFrame f = knot_frame(shape, kTurn * (x % segments) / segments);
            // sideways = along x outward, so this turns right-handedly about the curve: u, v and
            // the normal then form a right-handed frame.
            const glm::dvec3 out = c * f.outward - s * f.sideways;
            const glm::dvec3 out_1 = c * f.outward_1 - s * f.sideways_1;
            add_vertex(mesh, {f.center + tube * out, out, f.center_1 + tube * out_1},
                       periods * x / segments, static_cast<double>(y) / sides);
        }
    }
    add_grid(mesh, 0, segments, sides);
    return mesh;
}

MeshData plane(int columns, int rows) {
    check_count("columns", columns, 1);
    check_count("rows", rows, 1);
    check_triangles(columns, rows);
    MeshData mesh;
    for (int y = 0; y <= rows; ++y) {
        for (int x = 0; x <= columns; ++x) {
            const double u = static_cast<double>(x) / columns;
            const double v = static_cast<double>(y) / rows;
            add_vertex(mesh, {{u - 0.5, v - 0.5, 0.0}, {0.0, 0.0, 1.0}, {1.0, 0.0, 0.0}}, u, v);
        }
    }
    add_grid(mesh, 0, columns, rows);
    return mesh;
}

MeshData ribbon(int columns, int rows) {
    check_count("columns", columns, 1);
    check_count("rows", rows, 1);
    check_triangles(columns, rows);
    constexpr double kHeight = 0.15, kWaves = 1.5;
    MeshData mesh;
    for (int y = 0; y <= rows; ++y) {
        for (int x = 0; x <= columns; ++x) {
            const double u = static_cast<double>(x) / columns;
            const double v = static_cast<double>(y) / rows;
            const double phase = kTurn * kWaves * u;
            const double rise = kHeight * kTurn * kWaves * dmath::cos(phase);
            add_vertex(mesh,
                       {{0.25 - 0.5 * v, 2.0 * u - 1.0, kHeight * dmath::sin(phase)},
                        {0.0, -rise, 2.0},
                        {0.0, 2.0, rise}},
                       u, v);
        }
    }
    add_grid(mesh, 0, columns, rows);
    return mesh;
}

MeshData cube() {
    struct Side {
        glm::dvec3 normal;
        glm::dvec3 right;
    };
    constexpr glm::dvec3 x(1.0, 0.0, 0.0), y(0.0, 1.0, 0.0), z(0.0, 0.0, 1.0);
    const std::array<Side, 6> sides = {Side{z, x},  Side{x, -z}, Side{-z, -x},
                                       Side{-x, z}, Side{y, x},  Side{-y, x}};
    MeshData mesh;
    for (const Side& side : sides) {
        const glm::dvec3 up = glm::cross(side.normal, side.right);
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (int v = 0; v <= 1; ++v) {
            for (int u = 0; u <= 1; ++u) {
                const glm::dvec3 position =
                    0.5 * side.normal + (u - 0.5) * side.right + (v - 0.5) * up;
                add_vertex(mesh, {position, side.normal, side.right}, u, v);
            }
        }
        add_grid(mesh, first, 1, 1);
    }
    return mesh;
}

}  // namespace burnish::shapes
