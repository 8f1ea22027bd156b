#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "core/dmath.hpp"
#include "models/generators/field.hpp"
#include "models/generators/noise.hpp"
#include "models/generators/surface.hpp"

namespace burnish::generators {
namespace {

/// Ridges grow on a grid of their own, so that a print is the same at every size.
constexpr int kGrid = 256;
constexpr double kPeriod = 7.0;  ///< from ridge to ridge, grid cells
constexpr int kReach = 7;        ///< of the filter, grid cells
constexpr int kAngles = 48;      ///< of the filter, over half a turn
constexpr int kRounds = 7;

/// Where the orientation turns by half a turn, with the walk around a core, against it around a
/// delta. Positions 0 .. 1, y upwards. The angle jumps by half a turn along the ray `cut`.
struct Singularity {
    double turn;  ///< 1/2 or -1/2
    glm::dvec2 at, cut;
};

/// Two cores in the middle, and a delta on each side below. The cuts of the cores meet at the
/// second one and cancel behind it; those of the deltas run away from the finger.
std::array<Singularity, 4> whorl(std::uint32_t seed) {
    Random random(seed);
    const auto near = [&](double x, double y) {
        return glm::dvec2(x, y) + random.between(glm::dvec2(-0.03), glm::dvec2(0.03));
    };
    const glm::dvec2 upper = near(0.5, 0.60), lower = near(0.5, 0.50);
    const glm::dvec2 left = near(0.14, 0.22), right = near(0.86, 0.22);
    const glm::dvec2 down = unit(lower - upper);
    return {{{0.5, upper, down},
             {0.5, lower, down},
             {-0.5, left, {-1.0, 0.0}},
             {-0.5, right, {1.0, 0.0}}}};
}

/// Angle of the ridges from the u axis (zero-pole model, Sherlock and Monro 1993).
double ridge_angle(const std::array<Singularity, 4>& field, const glm::dvec2& p) {
    double angle = 0.0;
    for (const Singularity& s : field) {
        const glm::dvec2 d = p - s.at;
        // From the ray opposite to the cut, so that the jump of atan2 lies on the cut.
        const double from_ray = dmath::atan2(s.cut.y * d.x - s.cut.x * d.y, -glm::dot(s.cut, d));
        angle += s.turn * (from_ray + dmath::atan2(-s.cut.y, -s.cut.x));
    }
    return angle;
}

/// A wave across the ridges under a bell, without a mean.
std::vector<double> ridge_filter(double angle) {
    constexpr int kSide = 2 * kReach + 1;
    const double sigma = 0.45 * kPeriod;
    std::vector<double> weights;
    double sum = 0.0;
    for (int y = -kReach; y <= kReach; ++y) {
        for (int x = -kReach; x <= kReach; ++x) {
            // Rows grow downwards.
            const double across = -x * dmath::sin(angle) - y * dmath::cos(angle);
            const double bell =
                dmath::exp2(-(x * x + y * y) / (2.0 * sigma * sigma) * 1.4426950409);
            weights.push_back(bell * dmath::cos(2.0 * dmath::kPi / kPeriod * across));
            sum += weights.back();
        }
    }
    double magnitude = 0.0;
    for (double& w : weights) {
        w -= sum / (kSide * kSide);
        magnitude += std::abs(w);
    }
    for (double& w : weights) w *= 3.0 / magnitude;
    return weights;
}

/// White noise, filtered along the ridges again and again until it is ridges: -1 .. 1.
Field ridge_pattern(std::uint32_t seed, const std::array<Singularity, 4>& field) {
    std::vector<std::vector<double>> filters;
    for (int k = 0; k < kAngles; ++k) filters.push_back(ridge_filter(k * dmath::kPi / kAngles));
    Field pattern(kGrid);
    std::vector<std::size_t> which;
    for (int y = 0; y < kGrid; ++y) {
        for (int x = 0; x < kGrid; ++x) {
            pattern.at(x, y) =
                2.0 * unit_interval(mix(seed, static_cast<std::uint32_t>(y * kGrid + x))) - 1.0;
            const double angle =
                ridge_angle(field, {(x + 0.5) / kGrid, 1.0 - (y + 0.5) / kGrid}) / dmath::kPi;
            const double turn = angle - std::floor(angle);
            which.push_back(static_cast<std::size_t>(turn * kAngles + 0.5) % kAngles);
        }
    }
    for (int round = 0; round < kRounds; ++round) {
        Field next(kGrid);
        for (int y = 0; y < kGrid; ++y) {
            for (int x = 0; x < kGrid; ++x) {
                const double* weight =
                    filters[which[static_cast<std::size_t>(y * kGrid + x)]].data();
                double sum = 0.0;
                for (int dy = -kReach; dy <= kReach; ++dy) {
                    for (int dx = -kReach; dx <= kReach; ++dx)
                        sum += *weight++ * pattern.at(x + dx, y + dy);
                }
                next.at(x, y) = std::clamp(sum, -1.0, 1.0);
            }
        }
        pattern = std::move(next);
    }
    return pattern;
}

/// The grid at (u, v) in 0 .. 1, v downwards, linearly in between.
double sample(const Field& field, double u, double v) {
    const double x = u * kGrid - 0.5, y = v * kGrid - 0.5;
    const double left = std::floor(x), top = std::floor(y);
    const int i = static_cast<int>(left), j = static_cast<int>(top);
    const double s = x - left, t = y - top;
    return (field.at(i, j) * (1.0 - s) + field.at(i + 1, j) * s) * (1.0 - t) +
           (field.at(i, j + 1) * (1.0 - s) + field.at(i + 1, j + 1) * s) * t;
}

}  // namespace

Surface fingerprint(std::uint32_t seed, int size) {
    const std::array<Singularity, 4> field = whorl(mix(seed, 1));
    const auto ridges = std::make_shared<const Field>(ridge_pattern(mix(seed, 2), field));
    const SurfaceNoise pressure(mix(seed, 3), size, 90.0, 90.0);
    const SurfaceNoise sweat(mix(seed, 4), size, 9.0, 9.0);
    return [=](int x, int y) {
        const double u = (x + 0.5) / size, v = (y + 0.5) / size;
        const double angle = ridge_angle(field, {u, 1.0 - v});
        SurfaceTexel texel;
        texel.direction = {dmath::cos(angle), dmath::sin(angle)};
        const double ex = (u - 0.5) / 0.40, ey = (v - 0.48) / 0.47;
        const double finger = 1.0 - ramp(0.75, 1.0, std::sqrt(ex * ex + ey * ey));
        const double contact = finger * (0.8 + 0.3 * pressure.at(x, y) + 0.15 * sweat.at(x, y));
        const double grease =
            std::clamp(contact, 0.0, 1.0) * ramp(-0.15, 0.25, sample(*ridges, u, v));
        texel.alpha_x = 0.15 + 0.15 * grease;
        texel.alpha_y = 0.15 + 0.35 * grease;
        texel.exponent = dmath::exp2(6.0 - 4.0 * grease);
        texel.kd = glm::dvec3(0.03, 0.03, 0.035) + grease * glm::dvec3(0.06, 0.06, 0.055);
        texel.ks = glm::dvec3(0.92, 0.92, 0.93) * (1.0 - 0.6 * grease);
        return texel;
    };
}

}  // namespace burnish::generators
