#pragma once

#include <array>
#include <burnish/framebuffer.hpp>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "core/parallel.hpp"
#include "metrics/flip.hpp"
#include "metrics/plane.hpp"
#include "metrics/selection.hpp"

/// All measures of how a picture differs from its reference: docs/metrics.md. Frames are rgba32f
/// and of one size, values as they are, without a transfer function. Computed in double precision,
/// the same numbers with any number of workers.
namespace burnish::metrics {

enum class Metric : std::uint8_t {
    rmse,
    psnr,              ///< decibels, peak 1; infinite for equal pictures
    max,               ///< largest absolute difference of a channel
    p99,               ///< 99 of 100 absolute differences are at most this large
    bias,              ///< mean of test - reference
    ssim,              ///< metrics/ssim.hpp
    flip,              ///< mean of metrics/flip.hpp's map
    flip_hdr,          ///< the same with exposures
    energy_ratio,      ///< sum of test / sum of reference; NaN if the latter is 0
    levels,            ///< values of the test in the highlight: highlight_levels()
    reference_levels,  ///< values of the reference there
    step_excess,       ///< FrameErrors::step_excess
    nonfinite,         ///< pixels left out since they are NaN or infinite
    count
};
inline constexpr auto kMetricCount = static_cast<std::size_t>(Metric::count);

/// In the order above.
std::span<const Metric> all_metrics();
/// As in the enumeration.
std::string_view metric_name(Metric metric);
std::optional<Metric> metric_named(std::string_view name);
std::vector<std::string_view> metric_names();

/// Where a limit lies: true if `value` is worse than `limit`, or is NaN. PSNR, SSIM and levels must
/// not be below it, |bias| and |energy_ratio - 1| not above, the others not above.
bool is_worse(Metric metric, double value, double limit);

struct CompareOptions {
    Region region = Region::all;
    std::vector<Metric> metrics{all_metrics().begin(), all_metrics().end()};  ///< to be computed
    FlipOptions flip;
};

struct Comparison {
    std::size_t pixels = 0;                     ///< that counted
    std::array<double, kMetricCount> values{};  ///< NaN: not asked for, or without meaning here
    Plane ssim;                                 ///< maps of all pixels; empty unless asked for
    Plane flip;
    Plane flip_hdr;
    std::optional<Exposures> exposures;  ///< of flip_hdr

    [[nodiscard]] double operator[](Metric metric) const {
        return values[static_cast<std::size_t>(metric)];
    }
};

/// Throws Error{bad_option} for frames of two sizes or another format, and for options out of
/// range.
Comparison compare(const Framebuffer& test, const Framebuffer& reference,
                   const CompareOptions& options, WorkerPool& pool);

/// Decibels of a root mean square error, for a peak of 1; infinite for 0.
double psnr(double rmse);

/// Mean of a map over the selected pixels; NaN if there are none.
double mean(const Plane& map, const Selection& selection);

}  // namespace burnish::metrics
