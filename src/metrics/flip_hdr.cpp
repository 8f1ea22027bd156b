#include <fmt/format.h>

#include <algorithm>
#include <burnish/error.hpp>
#include <cmath>
#include <glm/glm.hpp>
#include <vector>

#include "metrics/flip.hpp"
#include "metrics/flip_map.hpp"
#include "metrics/pixel.hpp"

namespace burnish::metrics {
namespace {

/// K. Narkowicz, "ACES Filmic Tone Mapping Curve", 2016: a quotient of two polynomials, without the
/// exposure of 0.6 that is in it (EG 2021, section 3.2): (k0 x^2 + k1 x) / (k3 x^2 + k4 x + k5).
constexpr double kK0 = 0.6 * 0.6 * 2.51, kK1 = 0.6 * 0.03;
constexpr double kK3 = 0.6 * 0.6 * 2.43, kK4 = 0.6 * 0.59, kK5 = 0.14;
/// What the brightest and the median luminance are mapped to by the first and the last exposure.
constexpr double kTarget = 0.85;
/// Stops beyond are of no picture of floats, and squares of numbers stay finite.
constexpr double kLargestExposure = 300.0;

double tone_mapped(double x) {
    return std::clamp((kK0 * x * x + kK1 * x) / (kK3 * x * x + kK4 * x + kK5), 0.0, 1.0);
}

/// Positive x that is mapped to kTarget.
double mapped_to_target() {
    const double a = kK0 - kK3 * kTarget;
    const double half_b = 0.5 * (kK1 - kK4 * kTarget) / a;
    return -half_b + std::sqrt(half_b * half_b + kK5 * kTarget / a);
}

/// Rec. 709, 0 where it would be negative.
double luminance(const glm::dvec4& p) {
    return std::max(0.0, 0.2126 * p.r + 0.7152 * p.g + 0.0722 * p.b);
}

/// Of an ordered list that is not empty: the middle one, or the mean of the two in the middle.
double median(const std::vector<double>& ordered) {
    const std::size_t half = ordered.size() / 2;
    return ordered.size() % 2 == 1 ? ordered[half] : 0.5 * (ordered[half - 1] + ordered[half]);
}

void check(const Exposures& e) {
    if (e.count < 1 || e.count > kMostExposures)
        throw Error(ErrorCode::bad_option,
                    fmt::format("{} exposures, expected 1 .. {}", e.count, kMostExposures));
    if (!(e.start <= e.stop && e.start >= -kLargestExposure && e.stop <= kLargestExposure))
        throw Error(ErrorCode::bad_option,
                    fmt::format("exposures from {} to {}, expected rising ones of -{} .. {}",
                                e.start, e.stop, kLargestExposure, kLargestExposure));
}

}  // namespace

Exposures exposures_for(const Framebuffer& reference) {
    std::vector<double> luminances;
    for (int y = 0; y < reference.height(); ++y)
        for (int x = 0; x < reference.width(); ++x)
            if (const glm::dvec4 p = pixel(reference, x, y); finite(p))
                luminances.push_back(luminance(p));
    std::sort(luminances.begin(), luminances.end());
    if (luminances.empty() || luminances.back() == 0.0) return {0.0, 0.0, 1};
    const double brightest = luminances.back();
    double middle = median(luminances);
    if (middle == 0.0) {
        luminances.erase(luminances.begin(),
                         std::upper_bound(luminances.begin(), luminances.end(), 0.0));
        middle = median(luminances);
    }
    const double x = mapped_to_target();
    const double start = std::log2(x / brightest);
    const double stop = std::log2(x / middle);
    return {start, stop, std::clamp(static_cast<int>(std::ceil(stop - start)), 2, kMostExposures)};
}

Plane flip_hdr(const Framebuffer& test, const Framebuffer& reference, const FlipOptions& options,
               WorkerPool& pool) {
    const Exposures e = options.exposures ? *options.exposures : exposures_for(reference);
    check(e);
    Plane largest(reference.width(), reference.height());
    for (int i = 0; i < e.count; ++i) {
        const double stops = e.start + i * (e.stop - e.start) / std::max(1, e.count - 1);
        const double factor = std::exp2(stops);
        const auto to_linear = [factor](std::span<glm::dvec3> row) {
            for (glm::dvec3& rgb : row)
                for (int c = 0; c < 3; ++c) rgb[c] = tone_mapped(factor * std::max(0.0, rgb[c]));
        };
        const Plane map = flip_map(test, reference, options.pixels_per_degree, to_linear, pool);
        for (std::size_t p = 0; p < map.values.size(); ++p)
            largest.values[p] = std::max(largest.values[p], map.values[p]);
    }
    return largest;
}

}  // namespace burnish::metrics
