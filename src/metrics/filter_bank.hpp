#pragma once

#include <functional>
#include <span>
#include <vector>

#include "core/parallel.hpp"

namespace burnish::metrics {

/// Weights of a filter along one axis, the one of offset k at [k]; that of offset -k is the same,
/// or minus it. out(x) = sum of weight(k) * in(x + k).
struct Taps {
    std::vector<double> weights;  ///< offsets 0 .. radius
    bool odd = false;

    [[nodiscard]] int radius() const { return static_cast<int>(weights.size()) - 1; }
};

/// Weights exp(-x^2 / (2 sigma^2)), not normalised.
Taps gaussian(double sigma, int radius);
/// The sum over all offsets, of even taps.
double sum(const Taps& taps);
/// All weights times `factor`.
Taps scaled(Taps taps, double factor);

/// Separable filters of a few planes of one picture: first along rows, then along columns.
struct FilterBank {
    struct Pass {
        int source = 0;  ///< a plane, or a filtered row
        Taps taps;
    };
    int planes = 0;
    std::vector<Pass> rows;     ///< of planes
    std::vector<Pass> columns;  ///< of the results of `rows`
};

/// Fills row y of every plane: `width` numbers at each pointer. May be called twice for a row.
using PlaneRows = std::function<void(int y, std::span<double* const> planes)>;
/// Takes row y of every result of `columns`.
using FilteredRows = std::function<void(int y, std::span<const double* const> results)>;

/// Runs the bank over a picture, whose border goes on outside of it. Both functions are called from
/// the workers of `pool`, the second one once for every row.
void run_bank(const FilterBank& bank, int width, int height, const PlaneRows& fill,
              const FilteredRows& take, WorkerPool& pool);

}  // namespace burnish::metrics
