#include "metrics/metrics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "metrics/frame_errors.hpp"
#include "metrics/ssim.hpp"

namespace burnish::metrics {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

enum class Good : std::uint8_t { low, high, near_zero, near_one };

struct Property {
    Metric metric;
    std::string_view name;
    Good good;
};
constexpr std::array<Property, kMetricCount> kProperties{
    {{Metric::rmse, "rmse", Good::low},
     {Metric::psnr, "psnr", Good::high},
     {Metric::max, "max", Good::low},
     {Metric::p99, "p99", Good::low},
     {Metric::bias, "bias", Good::near_zero},
     {Metric::ssim, "ssim", Good::high},
     {Metric::flip, "flip", Good::low},
     {Metric::flip_hdr, "flip_hdr", Good::low},
     {Metric::energy_ratio, "energy_ratio", Good::near_one},
     {Metric::levels, "levels", Good::high},
     {Metric::reference_levels, "reference_levels", Good::high},
     {Metric::step_excess, "step_excess", Good::low},
     {Metric::nonfinite, "nonfinite", Good::low}}};

constexpr std::array<Metric, kMetricCount> kMetrics = [] {
    std::array<Metric, kMetricCount> metrics{};
    for (std::size_t i = 0; i < metrics.size(); ++i) metrics[i] = kProperties[i].metric;
    return metrics;
}();
static_assert(std::is_sorted(kMetrics.begin(), kMetrics.end()), "in the order of the enumeration");

const Property& property(Metric metric) {
    return kProperties[static_cast<std::size_t>(metric)];
}

/// One comparison under way.
class Comparing {
  public:
    Comparing(const Framebuffer& test, const Framebuffer& reference, const CompareOptions& options,
              WorkerPool& pool)
        : m_test(test),
          m_reference(reference),
          m_options(options),
          m_pool(pool),
          m_selection(test, reference, options.region, pool) {
        m_result.values.fill(kNone);
        m_result.pixels = m_selection.count();
        set(Metric::nonfinite, static_cast<double>(m_selection.nonfinite()));
    }

    Comparison run() {
        if (m_selection.count() > 0) {
            add_errors();
            add_levels();
        }
        if (wants(Metric::ssim)) {
            m_result.ssim = ssim(m_test, m_reference, m_pool);
            set(Metric::ssim, mean_ssim(m_result.ssim, m_selection));
        }
        if (wants(Metric::flip)) {
            m_result.flip = flip(m_test, m_reference, m_options.flip, m_pool);
            set(Metric::flip, mean(m_result.flip, m_selection));
        }
        if (wants(Metric::flip_hdr)) add_flip_hdr();
        return std::move(m_result);
    }

  private:
    [[nodiscard]] bool wants(Metric metric) const {
        const std::vector<Metric>& wanted = m_options.metrics;
        return std::find(wanted.begin(), wanted.end(), metric) != wanted.end();
    }
    void set(Metric metric, double value) {
        if (wants(metric)) m_result.values[static_cast<std::size_t>(metric)] = value;
    }

    void add_errors() {
        const FrameErrors errors = frame_errors(m_test, m_reference, m_selection, m_pool);
        set(Metric::rmse, errors.rmse);
        set(Metric::psnr, psnr(errors.rmse));
        set(Metric::max, errors.largest);
        set(Metric::p99, errors.p99);
        set(Metric::bias, errors.bias);
        set(Metric::step_excess, errors.step_excess);
        set(Metric::energy_ratio,
            errors.reference_sum == 0.0 ? kNone : errors.test_sum / errors.reference_sum);
    }

    void add_levels() {
        if (!wants(Metric::levels) && !wants(Metric::reference_levels)) return;
        const Levels levels = highlight_levels(m_test, m_reference, m_selection);
        set(Metric::levels, static_cast<double>(levels.test));
        set(Metric::reference_levels, static_cast<double>(levels.reference));
    }

    void add_flip_hdr() {
        FlipOptions flip = m_options.flip;
        if (!flip.exposures) flip.exposures = exposures_for(m_reference);
        m_result.exposures = flip.exposures;
        m_result.flip_hdr = metrics::flip_hdr(m_test, m_reference, flip, m_pool);
        set(Metric::flip_hdr, mean(m_result.flip_hdr, m_selection));
    }

    const Framebuffer& m_test;
    const Framebuffer& m_reference;
    const CompareOptions& m_options;
    WorkerPool& m_pool;
    Selection m_selection;
    Comparison m_result;
};

}  // namespace

std::span<const Metric> all_metrics() {
    return kMetrics;
}

std::string_view metric_name(Metric metric) {
    return property(metric).name;
}

std::optional<Metric> metric_named(std::string_view name) {
    for (const Property& p : kProperties)
        if (p.name == name) return p.metric;
    return std::nullopt;
}

std::vector<std::string_view> metric_names() {
    std::vector<std::string_view> names;
    for (const Property& p : kProperties) names.push_back(p.name);
    return names;
}

bool is_worse(Metric metric, double value, double limit) {
    switch (property(metric).good) {
        case Good::low:
            return !(value <= limit);
        case Good::high:
            return !(value >= limit);
        case Good::near_zero:
            return !(std::abs(value) <= limit);
        case Good::near_one:
            break;
    }
    return !(std::abs(value - 1.0) <= limit);
}

double psnr(double rmse) {
    return -20.0 * std::log10(rmse);
}

double mean(const Plane& map, const Selection& selection) {
    double total = 0.0;
    for (int y = 0; y < map.height; ++y) {
        double row = 0.0;
        for (int x = 0; x < map.width; ++x)
            if (selection.contains(x, y)) row += map.row(y)[x];
        total += row;
    }
    return selection.count() == 0 ? kNone : total / static_cast<double>(selection.count());
}

Comparison compare(const Framebuffer& test, const Framebuffer& reference,
                   const CompareOptions& options, WorkerPool& pool) {
    return Comparing(test, reference, options, pool).run();
}

}  // namespace burnish::metrics
