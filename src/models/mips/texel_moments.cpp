#include "models/mips/texel_moments.hpp"

#include <algorithm>
#include <cmath>

#include "models/mips/slope_lobe.hpp"

namespace burnish::mips {

namespace {

/// Of texels whose tangents' lines agree less than this, of 0 .. 1, the common axis says nothing.
constexpr double kLeastAgreement = 1e-3;

double luminance(const glm::dvec3& c) {
    return glm::dot(c, glm::dvec3(0.2126, 0.7152, 0.0722));
}

void add_weighted(TexelMoments& to, const TexelMoments& m, double weight) {
    to.t += m.t * weight;
    to.doubled += m.doubled * weight;
    to.exponent += m.exponent * weight;
    to.slope += m.slope * weight;
    to.second = to.second + m.second * weight;
}

double rounded(double x, double range, double steps) {
    return range > 0.0 ? std::floor(x / range * steps + 0.5) / steps * range : 0.0;
}

}  // namespace

TexelMoments moments_of(const TexelParameters& p, const LobeShape& shape, MipMethod method) {
    TexelMoments m;
    m.n = p.n;
    m.b = p.b;
    m.kd = p.kd;
    m.ks = p.ks;
    m.alpha_x = p.alpha_x;
    m.alpha_y = p.alpha_y;
    m.energy = p.ks * shape.energy_per_ks(p);
    m.t = p.t;
    const glm::dvec2 line =
        glm::dvec2(p.t) - glm::dvec2(p.n) * (p.t.z / std::max(p.n.z, kLeastNormalZ));
    const double squares = glm::dot(line, line);
    if (squares > 0.0)
        m.doubled = glm::dvec2(line.x * line.x - line.y * line.y, 2.0 * line.x * line.y) / squares;
    m.exponent = p.exponent;
    m.slope = slope_of(p.n);
    m.second = Symmetric::outer(m.slope);
    if (method == MipMethod::moments || method == MipMethod::moments_unweighted)
        m.second = m.second + slope_covariance(p, shape.variance(p));
    return m;
}

glm::dvec3 common_axis(const TexelMoments& m) {
    const double length = std::sqrt(glm::dot(m.doubled, m.doubled));
    if (length < kLeastAgreement) return {1.0, 0.0, 0.0};
    const double cosine = m.doubled.x / length;
    const double x = std::sqrt(std::max(0.5 * (1.0 + cosine), 0.0));
    const double y = std::sqrt(std::max(0.5 * (1.0 - cosine), 0.0));
    return {x, m.doubled.y < 0.0 ? -y : y, 0.0};
}

void MomentSum::add(const TexelMoments& m, double weight) {
    m_weight += weight;
    m_sum.n += m.n * weight;
    m_sum.b += m.b * weight;
    m_sum.kd += m.kd * weight;
    m_sum.ks += m.ks * weight;
    m_sum.alpha_x += m.alpha_x * weight;
    m_sum.alpha_y += m.alpha_y * weight;
    m_sum.energy += m.energy * weight;
    add_weighted(m_sum, m, weight);
    if (!m_by_energy) return;
    const double by_energy = weight * luminance(m.energy);
    m_energy_weight += by_energy;
    add_weighted(m_energy, m, by_energy);
}

TexelMoments MomentSum::mean() const {
    TexelMoments m;
    m.n = m_sum.n / m_weight;
    m.b = m_sum.b / m_weight;
    m.kd = m_sum.kd / m_weight;
    m.ks = m_sum.ks / m_weight;
    m.alpha_x = m_sum.alpha_x / m_weight;
    m.alpha_y = m_sum.alpha_y / m_weight;
    m.energy = m_sum.energy / m_weight;
    if (m_energy_weight > 0.0) {
        add_weighted(m, m_energy, 1.0 / m_energy_weight);
    } else {
        add_weighted(m, m_sum, 1.0 / m_weight);
    }
    return m;
}

void MomentStorage::include(const TexelMoments& m) {
    m_slope = std::max({m_slope, std::abs(m.slope.x), std::abs(m.slope.y)});
    m_second = std::max({m_second, m.second.xx, m.second.yy});
    m_energy = glm::max(m_energy, m.energy);
}

TexelMoments MomentStorage::stored(const TexelMoments& m) const {
    if (is_exact()) return m;
    const double codes = std::ldexp(1.0, m_bits);
    const double unsigned_steps = codes - 1.0, signed_steps = 0.5 * codes - 1.0;
    TexelMoments s = m;
    for (int c = 0; c < 2; ++c) s.slope[c] = rounded(m.slope[c], m_slope, signed_steps);
    s.second = {rounded(m.second.xx, m_second, unsigned_steps),
                rounded(m.second.xy, m_second, signed_steps),
                rounded(m.second.yy, m_second, unsigned_steps)};
    for (int c = 0; c < 3; ++c) s.energy[c] = rounded(m.energy[c], m_energy[c], unsigned_steps);
    return s;
}

double MomentStorage::least_variance() const {
    if (is_exact()) return 0.0;
    const double step = 1.0 / (std::ldexp(1.0, m_bits) - 1.0);
    return step * step;
}

}  // namespace burnish::mips
