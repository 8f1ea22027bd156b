#include "metrics/ssim.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>

#include "metrics/filter_bank.hpp"
#include "metrics/pixel.hpp"

namespace burnish::metrics {
namespace {

// Wang et al. 2004, section III.C, for a range of 1.
constexpr int kRadius = 5;
constexpr double kSigma = 1.5;
constexpr double kC1 = 0.01 * 0.01;
constexpr double kC2 = 0.03 * 0.03;

/// What is averaged over a window, of each channel.
enum Moment { of_test, of_reference, of_test_squared, of_reference_squared, of_product, kMoments };

FilterBank moments() {
    const Taps window = gaussian(kSigma, kRadius);
    const Taps taps = scaled(window, 1.0 / sum(window));
    FilterBank bank{.planes = 3 * kMoments, .rows = {}, .columns = {}};
    for (int p = 0; p < bank.planes; ++p) {
        bank.rows.push_back({p, taps});
        bank.columns.push_back({p, taps});
    }
    return bank;
}

double similarity(const double* mean) {
    const double mu_product = mean[of_test] * mean[of_reference];
    const double mu_squares =
        mean[of_test] * mean[of_test] + mean[of_reference] * mean[of_reference];
    const double covariance = mean[of_product] - mu_product;
    const double variances = mean[of_test_squared] + mean[of_reference_squared] - mu_squares;
    return (2.0 * mu_product + kC1) * (2.0 * covariance + kC2) /
           ((mu_squares + kC1) * (variances + kC2));
}

}  // namespace

Plane ssim(const Framebuffer& test, const Framebuffer& reference, WorkerPool& pool) {
    Plane map(reference.width(), reference.height());
    const auto fill = [&](int y, std::span<double* const> planes) {
        for (int x = 0; x < map.width; ++x) {
            const PixelPair pair = pixel_pair(test, reference, x, y);
            for (int c = 0; c < 3; ++c) {
                double* const* const of = planes.data() + c * kMoments;
                const double t = pair.test[c];
                const double r = pair.reference[c];
                of[of_test][x] = t;
                of[of_reference][x] = r;
                of[of_test_squared][x] = t * t;
                of[of_reference_squared][x] = r * r;
                of[of_product][x] = t * r;
            }
        }
    };
    const auto take = [&](int y, std::span<const double* const> means) {
        for (int x = 0; x < map.width; ++x) {
            double total = 0.0;
            for (std::size_t c = 0; c < 3; ++c) {
                double mean[kMoments];
                for (std::size_t m = 0; m < kMoments; ++m) mean[m] = means[c * kMoments + m][x];
                total += similarity(mean);
            }
            map.row(y)[x] = total / 3.0;
        }
    };
    run_bank(moments(), map.width, map.height, fill, take, pool);
    return map;
}

double mean_ssim(const Plane& map, const Selection& selection) {
    const bool whole_windows = std::min(map.width, map.height) > 2 * kRadius;
    const int margin = whole_windows ? kRadius : 0;
    double total = 0.0;
    std::size_t count = 0;
    for (int y = margin; y < map.height - margin; ++y) {
        double row = 0.0;
        for (int x = margin; x < map.width - margin; ++x) {
            if (!selection.contains(x, y)) continue;
            row += map.row(y)[x];
            ++count;
        }
        total += row;
    }
    return count == 0 ? std::numeric_limits<double>::quiet_NaN()
                      : total / static_cast<double>(count);
}

}  // namespace burnish::metrics
