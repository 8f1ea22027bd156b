#include "view/frame_times.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numeric>
#include <vector>

namespace burnish::view {
namespace {

constexpr std::size_t kMostIntervals = 1U << 18;

}  // namespace

void FrameTimes::shown(const Picture& picture, double now_ms) {
    const double interval = m_last_ms < 0.0 ? 0.0 : now_ms - m_last_ms;
    m_last_ms = now_ms;
    if (interval <= 0.0) return;
    m_frames.push_back({interval, picture.ms, picture.stats.geometry_ms, picture.stats.tiles_ms,
                        picture.stats.shaded_pixels, picture.stats.triangles,
                        picture.panes.front().divisor});
    if (m_frames.size() > kKept) m_frames.pop_front();
    m_intervals.push_back(static_cast<float>(interval));
    if (m_intervals.size() > kMostIntervals) m_intervals.pop_front();
}

double FrameTimes::quantile(double share) const {
    if (m_intervals.empty()) return 0.0;
    std::vector<float> sorted(m_intervals.begin(), m_intervals.end());
    const auto rank =
        static_cast<std::size_t>(std::ceil(share * static_cast<double>(sorted.size())));
    const auto at =
        sorted.begin() + static_cast<std::ptrdiff_t>(std::max<std::size_t>(rank, 1) - 1);
    std::nth_element(sorted.begin(), at, sorted.end());
    return static_cast<double>(*at);
}

double FrameTimes::per_second() const {
    const double ms = std::accumulate(m_intervals.begin(), m_intervals.end(), 0.0);
    return ms > 0.0 ? 1000.0 * static_cast<double>(m_intervals.size()) / ms : 0.0;
}

std::string FrameTimes::json() const {
    std::string text = fmt::format(
        "{{\"frames\": {}, \"per_second\": {:.2f}, \"median_ms\": {:.3f}, \"p95_ms\": {:.3f}, "
        "\"p99_5_ms\": {:.3f}, \"max_ms\": {:.3f}, \"resident_bytes\": {}, \"last\": [",
        count(), per_second(), quantile(0.5), quantile(0.95), quantile(0.995), quantile(1.0),
        resident_bytes());
    const char* comma = "";
    for (const Frame& frame : m_frames) {
        text += fmt::format(
            "{}{{\"interval_ms\": {:.3f}, \"draw_ms\": {:.3f}, \"geometry_ms\": {:.3f}, "
            "\"tiles_ms\": {:.3f}, \"shaded_pixels\": {}, \"triangles\": {}, \"divisor\": {:g}}}",
            comma, frame.interval_ms, frame.draw_ms, frame.geometry_ms, frame.tiles_ms,
            frame.pixels, frame.triangles, frame.divisor);
        comma = ", ";
    }
    return text + "]}";
}

std::size_t resident_bytes() {
    std::ifstream file("/proc/self/statm");
    std::size_t total = 0;
    std::size_t resident = 0;
    if (!(file >> total >> resident)) return 0;
    return resident * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

}  // namespace burnish::view
