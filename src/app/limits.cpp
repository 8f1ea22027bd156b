#include "app/limits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <burnish/error.hpp>
#include <burnish/files.hpp>

namespace burnish::app {

using metrics::Comparison;
using metrics::Metric;

metrics::CompareOptions with_limits(metrics::CompareOptions measured,
                                    const std::vector<Threshold>& limits) {
    std::vector<Metric>& list = measured.metrics;
    for (const Threshold& t : limits) list.push_back(t.metric);
    list.push_back(Metric::nonfinite);
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    return measured;
}

void require_one_size(const std::filesystem::path& test_path, const Framebuffer& test,
                      const std::filesystem::path& reference_path, const Framebuffer& reference) {
    if (test.width() == reference.width() && test.height() == reference.height()) return;
    throw Error(ErrorCode::bad_input,
                fmt::format("{}: {} x {} pixels, expected {} x {} as in {}", test_path.string(),
                            test.width(), test.height(), reference.width(), reference.height(),
                            reference_path.string()));
}

void require_pixels(const Comparison& comparison, const std::filesystem::path& reference) {
    if (comparison.pixels > 0) return;
    throw Error(ErrorCode::bad_input,
                fmt::format("{}: no pixel to compare: {} of those in the mask are NaN or infinite",
                            reference.string(), comparison[Metric::nonfinite]));
}

std::vector<std::string> failures(const std::filesystem::path& test, std::vector<Threshold> limits,
                                  const Comparison& comparison) {
    const bool allowed = std::any_of(limits.begin(), limits.end(), [](const Threshold& t) {
        return t.metric == Metric::nonfinite;
    });
    if (!limits.empty() && !allowed) limits.push_back({Metric::nonfinite, 0.0});
    std::vector<std::string> lines;
    for (const Threshold& t : limits) {
        const double value = comparison[t.metric];
        if (metrics::is_worse(t.metric, value, t.limit))
            lines.push_back(fmt::format("{}: {} {:.6g}, expected {}", test.string(),
                                        metric_name(t.metric), value,
                                        metrics::limit_text(t.metric, t.limit)));
    }
    return lines;
}

std::vector<std::string> failures(const std::filesystem::path& test,
                                  const std::filesystem::path& reference_path,
                                  const Framebuffer& reference,
                                  const std::vector<Threshold>& limits, WorkerPool& pool) {
    metrics::CompareOptions measured;
    measured.metrics.clear();
    const Comparison comparison =
        compare(load_frame(test), reference, with_limits(measured, limits), pool);
    require_pixels(comparison, reference_path);
    return failures(test, limits, comparison);
}

}  // namespace burnish::app
