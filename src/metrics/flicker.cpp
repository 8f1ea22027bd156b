#include "metrics/flicker.hpp"

#include <burnish/error.hpp>
#include <cmath>
#include <limits>

#include "metrics/pixel.hpp"

namespace burnish::metrics {

void Flicker::Moments::add(std::size_t at, double value, int frames) {
    const double before = value - mean[at];
    mean[at] += before / frames;
    squares[at] += before * (value - mean[at]);
}

Flicker::Flicker(Region region, bool with_flip, const FlipOptions& flip)
    : m_region(region), m_with_flip(with_flip), m_options(flip) {}

void Flicker::add(const Framebuffer& test, const Framebuffer& reference, WorkerPool& pool) {
    const Selection selection(test, reference, m_region, pool);
    if (m_frames == 0) {
        m_width = selection.width();
        m_height = selection.height();
        const std::size_t pixels =
            static_cast<std::size_t>(m_width) * static_cast<std::size_t>(m_height);
        m_counts.assign(pixels, 1);
        m_difference = {std::vector<double>(3 * pixels), std::vector<double>(3 * pixels)};
        if (m_with_flip) m_flip = {std::vector<double>(pixels), std::vector<double>(pixels)};
    }
    if (selection.width() != m_width || selection.height() != m_height)
        throw Error(ErrorCode::bad_option, "a series of pictures of two sizes, expected one");
    const Plane flip_map = m_with_flip ? flip(test, reference, m_options, pool) : Plane();
    ++m_frames;
    for_each_index(pool, static_cast<std::size_t>(m_height), 8, [&](std::size_t row, int) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < m_width; ++x) {
            const std::size_t at =
                row * static_cast<std::size_t>(m_width) + static_cast<std::size_t>(x);
            if (!selection.contains(x, y)) m_counts[at] = 0;
            if (m_counts[at] == 0) continue;
            const PixelPair pair = pixel_pair(test, reference, x, y);
            for (int c = 0; c < 3; ++c)
                m_difference.add(3 * at + static_cast<std::size_t>(c),
                                 pair.test[c] - pair.reference[c], m_frames);
            if (m_with_flip) m_flip.add(at, flip_map.values[at], m_frames);
        }
    });
}

double Flicker::mean_deviation(const Moments& moments, std::size_t channels) const {
    double total = 0.0;
    std::size_t count = 0;
    for (std::size_t at = 0; at < moments.squares.size(); ++at) {
        if (m_counts[at / channels] == 0) continue;
        total += std::sqrt(moments.squares[at] / m_frames);
        ++count;
    }
    return count == 0 ? std::numeric_limits<double>::quiet_NaN()
                      : total / static_cast<double>(count);
}

double Flicker::value() const {
    return mean_deviation(m_difference, 3);
}

double Flicker::flip_value() const {
    return mean_deviation(m_flip, 1);
}

Plane Flicker::map() const {
    Plane map(m_width, m_height);
    for (std::size_t at = 0; at < map.values.size(); ++at) {
        if (m_counts[at] == 0) continue;
        for (std::size_t c = 0; c < 3; ++c)
            map.values[at] += std::sqrt(m_difference.squares[3 * at + c] / m_frames) / 3.0;
    }
    return map;
}

}  // namespace burnish::metrics
