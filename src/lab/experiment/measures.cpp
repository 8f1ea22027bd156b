#include "lab/experiment/measures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "lab/experiment/highlight.hpp"
#include "metrics/metrics.hpp"

namespace burnish::lab {
namespace {

constexpr std::string_view kFlicker = "flicker";
constexpr std::string_view kFlipFlicker = "flip_flicker";
constexpr std::array<std::string_view, 3> kHighlight{"highlight", "shift_x", "shift_y"};

bool has(const std::vector<std::string>& names, std::string_view name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

std::vector<std::string_view> measure_names() {
    std::vector<std::string_view> names = metrics::metric_names();
    names.insert(names.end(), kHighlight.begin(), kHighlight.end());
    names.insert(names.end(), {kFlicker, kFlipFlicker});
    return names;
}

Measurement measure(const Framebuffer& test, const Framebuffer& reference,
                    const std::vector<std::string>& names, WorkerPool& pool) {
    metrics::CompareOptions options;
    options.region = metrics::Region::interior;
    options.metrics.clear();
    for (const std::string& name : names)
        if (const auto metric = metrics::metric_named(name)) options.metrics.push_back(*metric);
    metrics::Comparison comparison = metrics::compare(test, reference, options, pool);
    const metrics::Selection selection(test, reference, options.region, pool);
    std::optional<HighlightChange> highlight;
    Measurement result;
    for (const std::string& name : names) {
        if (const auto metric = metrics::metric_named(name)) {
            result.values.push_back({name, comparison[*metric]});
        } else if (std::find(kHighlight.begin(), kHighlight.end(), name) != kHighlight.end()) {
            if (!highlight) highlight = highlight_change(test, reference, selection);
            result.values.push_back({name, name == kHighlight[0]   ? highlight->area_ratio
                                           : name == kHighlight[1] ? highlight->shift_x
                                                                   : highlight->shift_y});
        }
    }
    result.flip = std::move(comparison.flip);
    return result;
}

bool need_series(const std::vector<std::string>& names) {
    return has(names, kFlicker) || has(names, kFlipFlicker);
}

SeriesMeasurement::SeriesMeasurement(const std::vector<std::string>& names)
    : m_flicker(has(names, kFlicker)),
      m_flip(has(names, kFlipFlicker)),
      m_series(metrics::Region::interior, m_flip) {}

void SeriesMeasurement::add(const Framebuffer& test, const Framebuffer& reference,
                            WorkerPool& pool) {
    m_series.add(test, reference, pool);
}

std::vector<Measured> SeriesMeasurement::values() const {
    std::vector<Measured> values;
    if (m_flicker) values.push_back({std::string(kFlicker), m_series.value()});
    if (m_flip) values.push_back({std::string(kFlipFlicker), m_series.flip_value()});
    return values;
}

}  // namespace burnish::lab
