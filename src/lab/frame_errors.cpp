#include "lab/frame_errors.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/glm.hpp>
#include <vector>

namespace burnish::lab {

namespace {

glm::dvec4 pixel(const Framebuffer& frame, int x, int y) {
    glm::vec4 value;
    std::memcpy(&value, frame.row(y) + static_cast<std::size_t>(x) * sizeof value, sizeof value);
    return value;
}

/// Interior pixels, row by row.
class Interior {
  public:
    explicit Interior(const Framebuffer& frame)
        : m_width(frame.width()),
          m_inside(static_cast<std::size_t>(frame.width()) *
                   static_cast<std::size_t>(frame.height())) {
        for (int y = 1; y + 1 < frame.height(); ++y)
            for (int x = 1; x + 1 < frame.width(); ++x)
                m_inside[index(x, y)] = surrounded(frame, x, y);
    }
    [[nodiscard]] bool contains(int x, int y) const { return m_inside[index(x, y)] != 0; }

  private:
    [[nodiscard]] std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(m_width) +
               static_cast<std::size_t>(x);
    }
    static bool surrounded(const Framebuffer& frame, int x, int y) {
        for (int j = y - 1; j <= y + 1; ++j)
            for (int i = x - 1; i <= x + 1; ++i)
                if (pixel(frame, i, j).a < 0.5) return false;
        return true;
    }

    int m_width;
    std::vector<char> m_inside;
};

}  // namespace

FrameErrors frame_errors(const Framebuffer& got, const Framebuffer& want) {
    const Interior interior(want);
    FrameErrors errors;
    std::vector<double> absolute;
    double squares = 0.0, sum = 0.0, step = -1.0;
    const auto compare_steps = [&](int x0, int y0, int x1, int y1) {
        if (!interior.contains(x1, y1)) return;
        const glm::dvec4 g = glm::abs(pixel(got, x1, y1) - pixel(got, x0, y0));
        const glm::dvec4 w = glm::abs(pixel(want, x1, y1) - pixel(want, x0, y0));
        for (int c = 0; c < 3; ++c) step = std::max(step, g[c] - w[c]);
    };
    for (int y = 0; y < want.height(); ++y) {
        for (int x = 0; x < want.width(); ++x) {
            if (!interior.contains(x, y)) continue;
            ++errors.pixels;
            const glm::dvec4 difference = pixel(got, x, y) - pixel(want, x, y);
            for (int c = 0; c < 3; ++c) {
                squares += difference[c] * difference[c];
                sum += difference[c];
                absolute.push_back(std::abs(difference[c]));
            }
            // Interior pixels are never on the frame's border.
            compare_steps(x, y, x + 1, y);
            compare_steps(x, y, x, y + 1);
        }
    }
    if (absolute.empty()) return errors;
    const auto count = static_cast<double>(absolute.size());
    std::sort(absolute.begin(), absolute.end());
    errors.rmse = std::sqrt(squares / count);
    errors.p99 = absolute[(absolute.size() * 99 - 1) / 100];
    errors.largest = absolute.back();
    errors.bias = sum / count;
    errors.step_excess = step;
    return errors;
}

double interior_peak(const Framebuffer& frame) {
    const Interior interior(frame);
    double peak = 0.0;
    for (int y = 0; y < frame.height(); ++y) {
        for (int x = 0; x < frame.width(); ++x) {
            if (!interior.contains(x, y)) continue;
            const glm::dvec4 p = pixel(frame, x, y);
            peak = std::max({peak, p.r, p.g, p.b});
        }
    }
    return peak;
}

}  // namespace burnish::lab
