#include "models/local_geometry.hpp"

#include <cmath>

#include "core/dmath.hpp"

namespace burnish {

namespace {

constexpr double kLeastDistance = 1.0 / 64.0;  // in widths
constexpr double kOctaves = 8.0;
constexpr double kMostDistance = 4.0;
constexpr double kLn2 = 0.6931471805599453;
constexpr double kTurn = 2.0 * dmath::kPi;

/// The digits of i behind the point, in reverse.
double radical_inverse(std::size_t i, std::size_t base) {
    double value = 0.0, digit = 1.0;
    for (; i > 0; i /= base) {
        digit /= static_cast<double>(base);
        value += digit * static_cast<double>(i % base);
    }
    return value;
}

glm::dvec3 unit(const glm::dvec3& v) {
    return v / std::sqrt(glm::dot(v, v));
}

/// Columns x, y and `axis`, right-handed; x turned by `turn` of a circle from wherever it is.
glm::dmat3 frame_around(const glm::dvec3& axis, double turn) {
    const glm::dvec3 other =
        std::abs(axis.x) < 0.5 ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0.0, 1.0, 0.0);
    const glm::dvec3 x = unit(glm::cross(other, axis));
    const glm::dvec3 turned =
        x * dmath::cos(kTurn * turn) + glm::cross(axis, x) * dmath::sin(kTurn * turn);
    return {turned, glm::cross(axis, turned), axis};
}

/// A half vector around p.n; along, around: [0, 1).
glm::dvec3 even_half_vector(const TexelParameters& p, double along, double around) {
    const glm::dmat3 frame = frame_around(p.n, around);
    return frame[2] * along + frame[0] * std::sqrt(1.0 - along * along);
}

glm::dvec3 lobe_half_vector(const TexelParameters& p, double along, double around) {
    const double distance = kLeastDistance * dmath::exp2(kOctaves * along);
    return unit(p.n + p.t * (p.alpha_x * distance * dmath::cos(kTurn * around)) +
                p.b * (p.alpha_y * distance * dmath::sin(kTurn * around)));
}

/// Of the two in equal parts, per solid angle.
double density(const TexelParameters& p, const glm::dvec3& h) {
    const double cosine = glm::dot(p.n, h);
    const double u = glm::dot(p.t, h) / (cosine * p.alpha_x);
    const double w = glm::dot(p.b, h) / (cosine * p.alpha_y);
    const double square = u * u + w * w;
    double sum = 1.0 / kTurn;
    if (square > kLeastDistance * kLeastDistance && square < kMostDistance * kMostDistance) {
        // Even in log2 of the distance, that is 1 / (octaves ln 2 distance) in it.
        const double in_plane = 1.0 / (kTurn * kOctaves * kLn2 * square * p.alpha_x * p.alpha_y);
        sum += in_plane / (cosine * cosine * cosine);
    }
    return 0.5 * sum;
}

}  // namespace

std::vector<LocalGeometry> local_geometries(const TexelSource& source, const glm::dvec3& light,
                                            std::size_t count) {
    const glm::dvec3 half = unit(light + glm::dvec3(0.0, 0.0, 1.0));
    std::vector<LocalGeometry> found;
    for (std::size_t i = 1; found.size() < count && i < 64 * count; ++i) {
        LocalGeometry g{};
        g.uv = {radical_inverse(i, 2), radical_inverse(i, 3)};
        const TexelParameters p = source.at(static_cast<int>(g.uv.x * source.width()),
                                            static_cast<int>(g.uv.y * source.height()));
        const double along = radical_inverse(i, 5), around = radical_inverse(i, 7);
        const bool even = radical_inverse(i, 11) < 0.5;
        const glm::dvec3 local =
            even ? even_half_vector(p, along, around) : lobe_half_vector(p, along, around);
        // Any rotation that brings the half vector where it is.
        const glm::dmat3 rotation =
            frame_around(half, radical_inverse(i, 13)) * glm::transpose(frame_around(local, 0.0));
        g.t = rotation[0];
        g.b = rotation[1];
        g.n = rotation[2];
        if (g.n.z <= 0.0 || glm::dot(g.n, light) <= 0.0) continue;
        g.jitter = {radical_inverse(i, 17), radical_inverse(i, 19)};
        g.weight = g.n.z / density(p, local);
        found.push_back(g);
    }
    return found;
}

}  // namespace burnish
