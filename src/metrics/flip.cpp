#include "metrics/flip.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <burnish/error.hpp>
#include <cmath>
#include <glm/glm.hpp>
#include <vector>

#include "metrics/filter_bank.hpp"
#include "metrics/flip_color.hpp"
#include "metrics/flip_filters.hpp"
#include "metrics/flip_map.hpp"
#include "metrics/pixel.hpp"

namespace burnish::metrics {
namespace {

// HPG 2020, sections 4.1.3 and 4.2, 4.3; the names of the paper in brackets.
constexpr double kColorExponent = 0.7;    // q_c
constexpr double kFeatureExponent = 0.5;  // q_f
constexpr double kKneeDifference = 0.4;   // p_c, of the largest difference
constexpr double kKneeError = 0.95;       // p_t

/// Difference of two filtered colours, 0 .. 1.
class ColorError {
  public:
    double operator()(const glm::dvec3& a, const glm::dvec3& b) const {
        const double difference = std::pow(hyab(a, b), kColorExponent);
        const double knee = kKneeDifference * m_largest;
        if (difference < knee) return difference * (kKneeError / knee);
        return kKneeError + (difference - knee) / (m_largest - knee) * (1.0 - kKneeError);
    }

  private:
    /// Green and blue are the farthest colours of a screen.
    double m_largest =
        std::pow(hyab(hunt_lab_from_linear({0.0, 1.0, 0.0}), hunt_lab_from_linear({0.0, 0.0, 1.0})),
                 kColorExponent);
};

/// What the filters leave of one picture at one pixel.
struct Seen {
    glm::dvec3 lab;
    double edge;
    double point;
};

Seen seen(std::span<const double* const> results, int x) {
    const auto at = [&](FlipResult r) { return results[static_cast<std::size_t>(r)][x]; };
    const glm::dvec3 opponent(at(FlipResult::y), at(FlipResult::cx),
                              at(FlipResult::cz_narrow) + at(FlipResult::cz_wide));
    const glm::dvec3 rgb = glm::clamp(linear_from_opponent(opponent), 0.0, 1.0);
    return {hunt_lab_from_linear(rgb), std::hypot(at(FlipResult::edge_x), at(FlipResult::edge_y)),
            std::hypot(at(FlipResult::point_x), at(FlipResult::point_y))};
}

double flip_of(const ColorError& color_error, const Seen& test, const Seen& reference) {
    const double color = color_error(test.lab, reference.lab);
    const double feature =
        std::max(std::abs(test.edge - reference.edge), std::abs(test.point - reference.point));
    return std::pow(color, 1.0 - std::pow(feature / std::numbers::sqrt2, kFeatureExponent));
}

void check_pixels_per_degree(double ppd) {
    if (ppd >= kLeastPixelsPerDegree && ppd <= kMostPixelsPerDegree) return;
    throw Error(ErrorCode::bad_option, fmt::format("{} pixels per degree, expected {} .. {}", ppd,
                                                   kLeastPixelsPerDegree, kMostPixelsPerDegree));
}

}  // namespace

Plane flip_map(const Framebuffer& test, const Framebuffer& reference, double pixels_per_degree,
               const ToLinear& to_linear, WorkerPool& pool) {
    check_pixels_per_degree(pixels_per_degree);
    const ColorError color_error;
    Plane map(reference.width(), reference.height());
    const auto fill = [&](int y, std::span<double* const> planes) {
        std::vector<glm::dvec3> rows[2];
        rows[0].reserve(static_cast<std::size_t>(map.width));
        rows[1].reserve(static_cast<std::size_t>(map.width));
        for (int x = 0; x < map.width; ++x) {
            const PixelPair pair = pixel_pair(test, reference, x, y);
            rows[0].push_back(pair.test);
            rows[1].push_back(pair.reference);
        }
        for (std::size_t picture = 0; picture < 2; ++picture) {
            to_linear(rows[picture]);
            for (std::size_t x = 0; x < rows[picture].size(); ++x) {
                const glm::dvec3 opponent = opponent_from_linear(rows[picture][x]);
                for (int c = 0; c < 3; ++c)
                    planes[3 * picture + static_cast<std::size_t>(c)][x] = opponent[c];
            }
        }
    };
    const auto take = [&](int y, std::span<const double* const> results) {
        const auto half = results.size() / 2;
        for (int x = 0; x < map.width; ++x)
            map.row(y)[x] =
                flip_of(color_error, seen(results.first(half), x), seen(results.last(half), x));
    };
    run_bank(flip_bank(pixels_per_degree), map.width, map.height, fill, take, pool);
    return map;
}

Plane flip(const Framebuffer& test, const Framebuffer& reference, const FlipOptions& options,
           WorkerPool& pool) {
    const bool coded = options.encoding == Encoding::srgb;
    const auto to_linear = [coded](std::span<glm::dvec3> row) {
        for (glm::dvec3& rgb : row) {
            rgb = glm::clamp(rgb, 0.0, 1.0);
            if (coded) rgb = {srgb_to_linear(rgb.r), srgb_to_linear(rgb.g), srgb_to_linear(rgb.b)};
        }
    };
    return flip_map(test, reference, options.pixels_per_degree, to_linear, pool);
}

}  // namespace burnish::metrics
