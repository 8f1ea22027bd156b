#include "models/mips/filtered_texel.hpp"

#include <cmath>

#include "models/mips/slope_lobe.hpp"

namespace burnish::mips {

namespace {

double length(const glm::dvec3& v) {
    return std::sqrt(glm::dot(v, v));
}

/// Vectors shorter than this have no direction.
constexpr double kLeastLength = 1e-6;

TexelParameters averaged(const TexelMoments& m) {
    TexelParameters p;
    p.n = m.n;
    p.t = m.t;
    p.b = m.b;
    p.alpha_x = m.alpha_x;
    p.alpha_y = m.alpha_y;
    p.exponent = m.exponent;
    p.kd = m.kd;
    p.ks = m.ks;
    return p;
}

/// The tangent of `p` to its normal, which is unit.
void set_tangent(TexelParameters& p, const TexelMoments& m) {
    const bool directed = length(m.t) > kLeastLength;
    p.t = perpendicular(directed ? m.t / length(m.t) : common_axis(m), p.n);
    p.b = glm::cross(p.n, p.t);
}

TexelParameters normalized(const TexelMoments& m) {
    TexelParameters p = averaged(m);
    const double n = length(m.n);
    p.n = n > kLeastLength ? m.n / n : glm::dvec3(0.0, 0.0, 1.0);
    set_tangent(p, m);
    return p;
}

/// Toksvig, Mipmapping Normal Maps, NVIDIA TB-01256-001, 2004, equations 2 and 3: s' = ft s,
/// ft = |Na| / (|Na| + s (1 - |Na|)), the height times (1 + ft s) / (1 + s). Of two widths each
/// has its own s, the height the root of both factors.
void widen_by_length(TexelParameters& p, const LobeShape& shape, double normal_length) {
    const glm::dvec2 s = shape.phong_exponents(p);
    if (!(s.x > 0.0 && s.y > 0.0)) return;
    const glm::dvec2 ft = normal_length / (normal_length + s * (1.0 - normal_length));
    const glm::dvec2 height = (1.0 + ft * s) / (1.0 + s);
    shape.set_phong_exponents(p, ft * s);
    shape.scale_height(p, std::sqrt(height.x * height.y));
}

/// Olano, Baker, LEAN Mapping, I3D 2010: the covariance of slopes added to the lobe's own, the
/// height by 1 / sqrt(det). `variance`: of the normals.
void widen_by_covariance(TexelParameters& p, const TexelMoments& m, const LobeShape& shape,
                         const Symmetric& variance) {
    p.n = normal_of(m.slope);
    set_tangent(p, m);
    const double before = shape.energy_per_ks(p);
    const Symmetric own = slope_covariance(p, shape.variance(p));
    const glm::dvec3 axis = p.t;
    shape.set_variance(p, turn_to_axes(p, own + variance, axis, axis));
    shape.scale_height(p, before / shape.energy_per_ks(p));
}

}  // namespace

TexelParameters filtered_texel(const TexelMoments& m, const LobeShape& shape, MipMethod method,
                               double least_variance) {
    if (method == MipMethod::box) return averaged(m);
    TexelParameters p = normalized(m);
    if (method == MipMethod::normalize) return p;
    p.kd *= length(m.n);
    if (method == MipMethod::mag || shape.is_fibre()) return p;
    if (method == MipMethod::toksvig) {
        widen_by_length(p, shape, length(m.n));
        return p;
    }
    const Symmetric spread = m.second - Symmetric::outer(m.slope);
    if (method == MipMethod::clean) {
        // Baker, Olano, Clean Mapping, 2011: three channels, so one variance for both axes.
        const double mean = std::fmax(0.5 * (spread.xx + spread.yy), 0.0);
        widen_by_covariance(p, m, shape, {mean, 0.0, mean});
        return p;
    }
    if (method == MipMethod::lean) {
        widen_by_covariance(p, m, shape, at_least(spread, 0.0));
        return p;
    }
    p.n = normal_of(m.slope);
    const Symmetric lobe = at_least(spread, least_variance);
    shape.set_variance(p, turn_to_axes(p, lobe, common_axis(m), m.t));
    if (method == MipMethod::moments) shape.set_energy(p, m.energy);
    return p;
}

}  // namespace burnish::mips
