#include <fmt/format.h>

#include <algorithm>
#include <burnish/error.hpp>
#include <burnish/files.hpp>
#include <cmath>
#include <cstdio>
#include <future>
#include <string>
#include <utility>
#include <vector>

#include "app/limits.hpp"
#include "app/progress.hpp"
#include "app/stats.hpp"
#include "app/text_table.hpp"
#include "app/verbs.hpp"
#include "metrics/heat_map.hpp"
#include "metrics/metrics.hpp"

namespace burnish::app {
namespace {

using metrics::Comparison;
using metrics::Metric;

bool contains(const std::vector<Metric>& list, Metric metric) {
    return std::find(list.begin(), list.end(), metric) != list.end();
}

/// With what pictures need.
metrics::CompareOptions complete(const CompareOptions& options) {
    metrics::CompareOptions measured = options.measured;
    if (!options.heat_map.empty() && !contains(measured.metrics, Metric::flip_hdr))
        measured.metrics.push_back(Metric::flip);
    return with_limits(std::move(measured), options.thresholds);
}

/// JSON has no word for what is not finite.
std::string json_number(double value) {
    return std::isfinite(value) ? fmt::format("{}", value) : "null";
}

std::string json(const CompareOptions& options, const metrics::CompareOptions& measured,
                 const Comparison& comparison, bool passed) {
    static constexpr const char* kRegions[]{"all", "covered", "interior"};
    std::string values;
    for (const Metric m : measured.metrics)
        values += fmt::format("{}\"{}\": {}", values.empty() ? "" : ", ", metric_name(m),
                              json_number(comparison[m]));
    std::string exposures;
    if (const auto& e = comparison.exposures)
        exposures = fmt::format(", \"exposures\": {{\"start\": {}, \"stop\": {}, \"count\": {}}}",
                                e->start, e->stop, e->count);
    return fmt::format(
        "{{\"test\": {}, \"reference\": {}, \"mask\": \"{}\", \"pixels\": {}, "
        "\"pixels_per_degree\": {}, \"encoding\": \"{}\"{}, \"metrics\": {{{}}}, \"passed\": "
        "{}}}\n",
        json_string(options.test.string()), json_string(options.reference.string()),
        kRegions[static_cast<std::size_t>(measured.region)], comparison.pixels,
        measured.flip.pixels_per_degree,
        measured.flip.encoding == metrics::Encoding::srgb ? "srgb" : "linear", exposures, values,
        passed);
}

std::string text(const metrics::CompareOptions& measured, const Comparison& comparison) {
    std::vector<TableRow> rows{{"pixels", fmt::format("{}", comparison.pixels)}};
    for (const Metric m : measured.metrics) {
        const double value = comparison[m];
        TableRow row{std::string(metric_name(m)),
                     std::isnan(value) ? "-" : fmt::format("{:.6g}", value)};
        if (const auto& e = comparison.exposures; e && m == Metric::flip_hdr)
            row.push_back(
                fmt::format("{} exposures, {:.2f} to {:.2f} stops", e->count, e->start, e->stop));
        rows.push_back(row);
    }
    return text_table(rows, 0);
}

bool holds_floats(const std::filesystem::path& path) {
    return path.extension() == ".exr";
}

void save_pictures(const CompareOptions& options, const Framebuffer& test,
                   const Framebuffer& reference, const Comparison& comparison) {
    using metrics::DifferenceSign;
    for (const auto& [path, sign] : {std::pair(options.difference, DifferenceSign::shown),
                                     {options.absolute_difference, DifferenceSign::ignored}}) {
        if (path.empty()) continue;
        if (holds_floats(path))
            save_image(difference_frame(test, reference, sign), path);
        else
            save_image(difference_image(test, reference, options.gain, sign), path);
    }
    if (options.heat_map.empty()) return;
    const metrics::Plane& map =
        comparison.flip.values.empty() ? comparison.flip_hdr : comparison.flip;
    if (holds_floats(options.heat_map))
        save_image(map_frame(map), options.heat_map);
    else
        save_image(heat_map(map), options.heat_map);
}

}  // namespace

void run(const CompareOptions& options) {
    Progress progress(options.quiet);
    std::future<Framebuffer> loading =
        std::async(options.threads == 1 ? std::launch::deferred : std::launch::async,
                   [&options] { return load_frame(options.reference); });
    const Framebuffer test = load_frame(options.test);
    const Framebuffer reference = loading.get();
    require_one_size(options.test, test, options.reference, reference);
    const metrics::CompareOptions measured = complete(options);
    WorkerPool pool(options.threads);
    const Comparison comparison = compare(test, reference, measured, pool);
    const double nonfinite = comparison[Metric::nonfinite];
    require_pixels(comparison, options.reference);
    save_pictures(options, test, reference, comparison);
    progress.finish();
    std::vector<std::string> lines = failures(options.test, options.thresholds, comparison);
    if (options.json)
        fmt::print("{}", json(options, measured, comparison, lines.empty()));
    else if (!options.quiet)
        fmt::print("{}", text(measured, comparison));
    if (nonfinite > 0.0 && options.thresholds.empty())
        fmt::print(stderr,
                   "burnish: {}: {} pixels are NaN or infinite, here or in the reference, "
                   "and left out\n",
                   options.test.string(), nonfinite);
    if (!lines.empty()) throw CheckFailed(std::move(lines));
}

}  // namespace burnish::app
