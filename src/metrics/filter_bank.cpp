#include "metrics/filter_bank.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace burnish::metrics {
namespace {

/// Columns that are filtered at a time: their sums stay in registers.
constexpr int kBlock = 8;

int padded(int width) {
    return (width + kBlock - 1) / kBlock * kBlock;
}

int radius_of(const std::vector<FilterBank::Pass>& passes) {
    int radius = 0;
    for (const FilterBank::Pass& pass : passes) radius = std::max(radius, pass.taps.radius());
    return radius;
}

/// out[x] for x < width, a multiple of kBlock: `at` gives the row of an offset.
template <class RowOfOffset>
void filter_row(const Taps& taps, const RowOfOffset& at, double* out, int width) {
    const double* const centre = at(0);
    const double first = taps.odd ? 0.0 : taps.weights[0];
    const double sign = taps.odd ? -1.0 : 1.0;
    for (int x = 0; x < width; x += kBlock) {
        double sums[kBlock];
        for (int i = 0; i < kBlock; ++i) sums[i] = first * centre[x + i];
        for (int k = 1; k <= taps.radius(); ++k) {
            const double weight = taps.weights[static_cast<std::size_t>(k)];
            const double* const after = at(k) + x;
            const double* const before = at(-k) + x;
            for (int i = 0; i < kBlock; ++i) sums[i] += weight * (after[i] + sign * before[i]);
        }
        std::copy_n(sums, kBlock, out + x);
    }
}

/// Rows of a band from top to bottom; what was filtered along rows is kept as long as columns need
/// it.
class Band {
  public:
    Band(const FilterBank& bank, int width, int height)
        : m_bank(bank),
          m_width(width),
          m_height(height),
          m_stride(padded(width)),
          m_row_radius(radius_of(bank.rows)),
          m_column_radius(radius_of(bank.columns)),
          m_planes(size(bank.planes, m_stride + 2 * m_row_radius)),
          m_filtered(size(2 * m_column_radius + 1, static_cast<int>(bank.rows.size()) * m_stride)),
          m_results(size(static_cast<int>(bank.columns.size()), m_stride)) {
        for (int p = 0; p < bank.planes; ++p) m_plane_rows.push_back(plane(p));
        for (std::size_t c = 0; c < bank.columns.size(); ++c)
            m_result_rows.push_back(m_results.data() + c * static_cast<std::size_t>(m_stride));
    }

    /// Rows first .. last - 1.
    void run(int first, int last, const PlaneRows& fill, const FilteredRows& take) {
        for (int y = first - m_column_radius; y < last + m_column_radius; ++y) {
            add_row(y, fill);
            const int done = y - m_column_radius;
            if (done >= first) take_row(done, take);
        }
    }

  private:
    static std::size_t size(int rows, int columns) {
        return static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns);
    }
    double* plane(int p) {
        return m_planes.data() + size(p, m_stride + 2 * m_row_radius) + m_row_radius;
    }
    /// Result r of row y, which may lie outside the picture.
    double* filtered(int y, int r) {
        const int kept = 2 * m_column_radius + 1;
        const int slot = (y + kept) % kept;
        return m_filtered.data() + size(slot * static_cast<int>(m_bank.rows.size()) + r, m_stride);
    }

    void add_row(int y, const PlaneRows& fill) {
        fill(std::clamp(y, 0, m_height - 1), m_plane_rows);
        for (double* const row : m_plane_rows) {
            std::fill(row - m_row_radius, row, row[0]);
            std::fill(row + m_width, row + m_stride + m_row_radius, row[m_width - 1]);
        }
        int r = 0;
        for (const FilterBank::Pass& pass : m_bank.rows) {
            const double* const row = plane(pass.source);
            filter_row(
                pass.taps, [row](int k) { return row + k; }, filtered(y, r++), m_stride);
        }
    }

    void take_row(int y, const FilteredRows& take) {
        std::size_t c = 0;
        for (const FilterBank::Pass& pass : m_bank.columns) {
            m_around.clear();
            const int radius = pass.taps.radius();
            for (int k = -radius; k <= radius; ++k)
                m_around.push_back(filtered(y + k, pass.source));
            const double* const* const centre = m_around.data() + radius;
            double* const out = m_results.data() + c++ * static_cast<std::size_t>(m_stride);
            filter_row(
                pass.taps, [centre](int k) { return centre[k]; }, out, m_stride);
        }
        take(y, m_result_rows);
    }

    const FilterBank& m_bank;
    int m_width, m_height, m_stride, m_row_radius, m_column_radius;
    std::vector<double> m_planes, m_filtered, m_results;
    std::vector<double*> m_plane_rows;
    std::vector<const double*> m_result_rows;
    std::vector<const double*> m_around;
};

}  // namespace

Taps gaussian(double sigma, int radius) {
    Taps taps;
    for (int x = 0; x <= radius; ++x)
        taps.weights.push_back(std::exp(-x * x / (2 * sigma * sigma)));
    return taps;
}

double sum(const Taps& taps) {
    double total = 0.0;
    for (std::size_t k = 1; k < taps.weights.size(); ++k) total += 2.0 * taps.weights[k];
    return total + taps.weights[0];
}

Taps scaled(Taps taps, double factor) {
    for (double& weight : taps.weights) weight *= factor;
    return taps;
}

void run_bank(const FilterBank& bank, int width, int height, const PlaneRows& fill,
              const FilteredRows& take, WorkerPool& pool) {
    // Rows above and below a band are filtered again by the next one, so bands are not small.
    const int least = 8 * std::max(1, radius_of(bank.columns));
    const int rows = std::max(least, (height + 2 * pool.size() - 1) / (2 * pool.size()));
    const int bands = (height + rows - 1) / rows;
    for_each_index(pool, static_cast<std::size_t>(bands), 1, [&](std::size_t index, int) {
        const int first = static_cast<int>(index) * rows;
        Band(bank, width, height).run(first, std::min(first + rows, height), fill, take);
    });
}

}  // namespace burnish::metrics
