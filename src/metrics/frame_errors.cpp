#include "metrics/frame_errors.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "metrics/pixel.hpp"

namespace burnish::metrics {
namespace {

/// Calls body(got, want) for every channel of every selected pixel of row y.
template <class Body>
void for_each_pair(const Framebuffer& test, const Framebuffer& reference,
                   const Selection& selection, int y, const Body& body) {
    for (int x = 0; x < selection.width(); ++x) {
        if (!selection.contains(x, y)) continue;
        const glm::dvec4 got = pixel(test, x, y);
        const glm::dvec4 want = pixel(reference, x, y);
        for (int c = 0; c < 3; ++c) body(got[c], want[c]);
    }
}

/// Largest amount by which two pixels differ more in `test` than in `reference`.
double step_excess(const Framebuffer& test, const Framebuffer& reference, glm::ivec2 a,
                   glm::ivec2 b) {
    const glm::dvec4 got = glm::abs(pixel(test, b.x, b.y) - pixel(test, a.x, a.y));
    const glm::dvec4 want = glm::abs(pixel(reference, b.x, b.y) - pixel(reference, a.x, a.y));
    const glm::dvec3 excess(got - want);
    return std::max({excess.r, excess.g, excess.b});
}

struct RowErrors {
    double squares = 0.0, sum = 0.0, test = 0.0, reference = 0.0, largest = 0.0, step = -1.0;
};

RowErrors row_errors(const Framebuffer& test, const Framebuffer& reference,
                     const Selection& selection, int y) {
    RowErrors row;
    for_each_pair(test, reference, selection, y, [&row](double got, double want) {
        const double difference = got - want;
        row.squares += difference * difference;
        row.sum += difference;
        row.test += got;
        row.reference += want;
        row.largest = std::max(row.largest, std::abs(difference));
    });
    for (int x = 0; x < selection.width(); ++x) {
        if (!selection.contains(x, y)) continue;
        const glm::ivec2 here(x, y);
        for (const glm::ivec2 next : {glm::ivec2(x + 1, y), glm::ivec2(x, y + 1)}) {
            if (next.x < selection.width() && next.y < selection.height() &&
                selection.contains(next.x, next.y))
                row.step = std::max(row.step, step_excess(test, reference, here, next));
        }
    }
    return row;
}

/// The absolute difference that `rank` others are not larger than, without a list of them: floats
/// that are not negative are ordered as their bits, of which 16 are found at a time, by counting.
double ranked_difference(const Framebuffer& test, const Framebuffer& reference,
                         const Selection& selection, std::size_t rank, WorkerPool& pool) {
    constexpr std::size_t kValues = 65536;
    std::uint64_t found = 0;  // the upper bits of the result
    for (int shift = 48; shift >= 0; shift -= 16) {
        std::vector<std::vector<std::size_t>> counts(static_cast<std::size_t>(pool.size()));
        for (auto& of_worker : counts) of_worker.resize(kValues);
        const auto rows = static_cast<std::size_t>(selection.height());
        for_each_index(pool, rows, 8, [&](std::size_t y, int worker) {
            std::vector<std::size_t>& mine = counts[static_cast<std::size_t>(worker)];
            for_each_pair(test, reference, selection, static_cast<int>(y),
                          [&](double got, double want) {
                              const auto bits = std::bit_cast<std::uint64_t>(std::abs(got - want));
                              const bool candidate = shift == 48 || bits >> (shift + 16) == found;
                              if (candidate) ++mine[bits >> shift & (kValues - 1)];
                          });
        });
        std::size_t value = 0;
        for (;; ++value) {
            std::size_t here = 0;
            for (const auto& of_worker : counts) here += of_worker[value];
            if (rank < here) break;
            rank -= here;
        }
        found = found << 16 | value;
    }
    return std::bit_cast<double>(found);
}

std::size_t distinct(std::vector<double>& values) {
    std::sort(values.begin(), values.end());
    return static_cast<std::size_t>(std::unique(values.begin(), values.end()) - values.begin());
}

}  // namespace

FrameErrors frame_errors(const Framebuffer& test, const Framebuffer& reference,
                         const Selection& selection, WorkerPool& pool) {
    std::vector<RowErrors> rows(static_cast<std::size_t>(selection.height()));
    for_each_index(pool, rows.size(), 8, [&](std::size_t y, int) {
        rows[y] = row_errors(test, reference, selection, static_cast<int>(y));
    });
    FrameErrors errors;
    errors.pixels = selection.count();
    if (errors.pixels == 0) return errors;
    double squares = 0.0, sum = 0.0;
    errors.step_excess = -1.0;
    for (const RowErrors& row : rows) {
        squares += row.squares;
        sum += row.sum;
        errors.test_sum += row.test;
        errors.reference_sum += row.reference;
        errors.largest = std::max(errors.largest, row.largest);
        errors.step_excess = std::max(errors.step_excess, row.step);
    }
    const std::size_t count = 3 * errors.pixels;
    errors.rmse = std::sqrt(squares / static_cast<double>(count));
    errors.bias = sum / static_cast<double>(count);
    errors.p99 = ranked_difference(test, reference, selection, (count * 99 - 1) / 100, pool);
    return errors;
}

FrameErrors interior_errors(const Framebuffer& test, const Framebuffer& reference) {
    WorkerPool pool(1);
    return frame_errors(test, reference, Selection(test, reference, Region::interior, pool), pool);
}

Peak peak(const Framebuffer& frame, const Selection& selection) {
    Peak largest;
    for (int y = 0; y < selection.height(); ++y) {
        for (int x = 0; x < selection.width(); ++x) {
            if (!selection.contains(x, y)) continue;
            const glm::dvec4 p = pixel(frame, x, y);
            for (int c = 0; c < 3; ++c)
                if (p[c] > largest.value) largest = {p[c], c};
        }
    }
    return largest;
}

double interior_peak(const Framebuffer& frame) {
    WorkerPool pool(1);
    return peak(frame, Selection(frame, frame, Region::interior, pool)).value;
}

Levels highlight_levels(const Framebuffer& test, const Framebuffer& reference,
                        const Selection& selection) {
    const Peak top = peak(reference, selection);
    std::vector<double> got, want;
    for (int y = 0; y < selection.height(); ++y) {
        for (int x = 0; x < selection.width(); ++x) {
            if (!selection.contains(x, y)) continue;
            const double value = pixel(reference, x, y)[top.channel];
            if (!(value > 0.5 * top.value)) continue;
            want.push_back(value);
            got.push_back(pixel(test, x, y)[top.channel]);
        }
    }
    return {distinct(got), distinct(want)};
}

}  // namespace burnish::metrics
