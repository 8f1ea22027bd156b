#include "metrics/frame_errors.hpp"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <vector>

#include "metrics/pixel.hpp"

namespace burnish::metrics {
namespace {

struct RowErrors {
    double squares = 0.0, sum = 0.0, test = 0.0, reference = 0.0, step = -1.0;
    std::vector<double> absolute;
};

/// Largest amount by which two pixels differ more in `test` than in `reference`.
double step_excess(const Framebuffer& test, const Framebuffer& reference, glm::ivec2 a,
                   glm::ivec2 b) {
    const glm::dvec4 got = glm::abs(pixel(test, b.x, b.y) - pixel(test, a.x, a.y));
    const glm::dvec4 want = glm::abs(pixel(reference, b.x, b.y) - pixel(reference, a.x, a.y));
    const glm::dvec3 excess(got - want);
    return std::max({excess.r, excess.g, excess.b});
}

RowErrors row_errors(const Framebuffer& test, const Framebuffer& reference,
                     const Selection& selection, int y) {
    RowErrors row;
    for (int x = 0; x < selection.width(); ++x) {
        if (!selection.contains(x, y)) continue;
        const glm::dvec4 got = pixel(test, x, y);
        const glm::dvec4 want = pixel(reference, x, y);
        for (int c = 0; c < 3; ++c) {
            const double difference = got[c] - want[c];
            row.squares += difference * difference;
            row.sum += difference;
            row.test += got[c];
            row.reference += want[c];
            row.absolute.push_back(std::abs(difference));
        }
        const glm::ivec2 here(x, y);
        for (const glm::ivec2 next : {glm::ivec2(x + 1, y), glm::ivec2(x, y + 1)}) {
            if (next.x < selection.width() && next.y < selection.height() &&
                selection.contains(next.x, next.y))
                row.step = std::max(row.step, step_excess(test, reference, here, next));
        }
    }
    return row;
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
    const auto count = 3.0 * static_cast<double>(errors.pixels);
    double squares = 0.0, sum = 0.0;
    std::vector<double> absolute;
    absolute.reserve(3 * errors.pixels);
    errors.step_excess = -1.0;
    for (const RowErrors& row : rows) {
        squares += row.squares;
        sum += row.sum;
        errors.test_sum += row.test;
        errors.reference_sum += row.reference;
        errors.step_excess = std::max(errors.step_excess, row.step);
        absolute.insert(absolute.end(), row.absolute.begin(), row.absolute.end());
    }
    errors.rmse = std::sqrt(squares / count);
    errors.bias = sum / count;
    const auto p99 =
        absolute.begin() + static_cast<std::ptrdiff_t>((absolute.size() * 99 - 1) / 100);
    std::nth_element(absolute.begin(), p99, absolute.end());
    errors.p99 = *p99;
    errors.largest = *std::max_element(p99, absolute.end());
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
