#include "metrics/selection.hpp"

#include <burnish/error.hpp>

#include "metrics/pixel.hpp"

namespace burnish::metrics {
namespace {

bool covered(const Framebuffer& frame, int x, int y) {
    return pixel(frame, x, y).a >= 0.5;
}

bool surrounded(const Framebuffer& frame, int x, int y) {
    if (x == 0 || y == 0 || x + 1 == frame.width() || y + 1 == frame.height()) return false;
    for (int j = y - 1; j <= y + 1; ++j)
        for (int i = x - 1; i <= x + 1; ++i)
            if (!covered(frame, i, j)) return false;
    return true;
}

bool lies_in(Region region, const Framebuffer& frame, int x, int y) {
    switch (region) {
        case Region::all:
            return true;
        case Region::covered:
            return covered(frame, x, y);
        case Region::interior:
            break;
    }
    return surrounded(frame, x, y);
}

}  // namespace

Selection::Selection(const Framebuffer& test, const Framebuffer& reference, Region region,
                     WorkerPool& pool)
    : m_width(reference.width()), m_height(reference.height()) {
    if (test.width() != m_width || test.height() != m_height)
        throw Error(ErrorCode::bad_option, "pictures of two sizes, expected one");
    if (test.format() != PixelFormat::rgba32f || reference.format() != PixelFormat::rgba32f)
        throw Error(ErrorCode::bad_option, "a picture that is not rgba32f");
    const auto rows = static_cast<std::size_t>(m_height);
    const auto columns = static_cast<std::size_t>(m_width);
    m_inside.resize(rows * columns);
    std::vector<std::size_t> counts(rows), nonfinite(rows);
    for_each_index(pool, rows, 8, [&](std::size_t row, int) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < m_width; ++x) {
            if (!lies_in(region, reference, x, y)) continue;
            const bool numbers = finite(pixel(test, x, y)) && finite(pixel(reference, x, y));
            m_inside[row * columns + static_cast<std::size_t>(x)] = numbers ? 1 : 0;
            ++(numbers ? counts : nonfinite)[row];
        }
    });
    for (std::size_t y = 0; y < rows; ++y) {
        m_count += counts[y];
        m_nonfinite += nonfinite[y];
    }
}

}  // namespace burnish::metrics
