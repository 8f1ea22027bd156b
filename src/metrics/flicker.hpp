#pragma once

#include <burnish/framebuffer.hpp>
#include <cstddef>
#include <vector>

#include "core/parallel.hpp"
#include "metrics/flip.hpp"
#include "metrics/plane.hpp"
#include "metrics/selection.hpp"

namespace burnish::metrics {

/// What an error does in time: pictures T_t and their references R_t of a series, a pan by less
/// than a pixel a step, say. An error that stays is no flicker, nor is what moves in both.
class Flicker {
  public:
    /// Of two rgba32f series of one size. `with_flip`: FLIP maps are made, too.
    Flicker(Region region, bool with_flip, const FlipOptions& flip = {});

    /// The next pair. Throws Error{bad_option} for another size than before.
    void add(const Framebuffer& test, const Framebuffer& reference, WorkerPool& pool);

    [[nodiscard]] int frames() const { return m_frames; }
    /// Standard deviation over time of T_t - R_t (population: divided by their number), mean over
    /// the pixels that counted in every pair, and over r, g, b. 0 before the second pair, NaN
    /// without pixels.
    [[nodiscard]] double value() const;
    /// The same of the FLIP maps; NaN if they were not asked for.
    [[nodiscard]] double flip_value() const;
    /// Standard deviation of every pixel, mean over r, g, b; 0 where it did not count.
    [[nodiscard]] Plane map() const;

  private:
    /// Running mean and sum of squares about it, of one number for each of many places (Welford).
    struct Moments {
        std::vector<double> mean, squares;
        void add(std::size_t at, double value, int frames);
    };
    [[nodiscard]] double mean_deviation(const Moments& moments, std::size_t channels) const;

    Region m_region;
    bool m_with_flip;
    FlipOptions m_options;
    int m_frames = 0;
    int m_width = 0;
    int m_height = 0;
    std::vector<char> m_counts;
    Moments m_difference;  ///< three per pixel
    Moments m_flip;
};

}  // namespace burnish::metrics
