#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "models/generators/hash.hpp"

/// Value noise: random numbers on a lattice, eased in between.
namespace burnish::generators {

/// Side at which marks have the sizes in texels that are given for them.
inline constexpr double kDesignSize = 512.0;

/// 0 .. 1 to 0 .. 1 with flat ends.
[[nodiscard]] constexpr double ease(double x) {
    return x * x * (3.0 - 2.0 * x);
}

/// 0 below `low`, 1 above `high`, eased in between.
[[nodiscard]] constexpr double ramp(double low, double high, double x) {
    return ease(std::clamp((x - low) / (high - low), 0.0, 1.0));
}

/// Noise in [-1, 1] that repeats with the texture; cells are `along` texels long and `across`
/// texels wide at the design size.
class SurfaceNoise {
  public:
    SurfaceNoise(std::uint32_t seed, int size, double along, double across)
        : m_seed(seed), m_u(cells(size, along)), m_v(cells(size, across)), m_size(size) {}

    [[nodiscard]] double at(int x, int y) const {
        const double u = (x + 0.5) * m_u / m_size;
        const double v = (y + 0.5) * m_v / m_size;
        const int row = static_cast<int>(v);
        const double top = row_at(u, static_cast<std::uint32_t>(row % m_v));
        const double bottom = row_at(u, static_cast<std::uint32_t>((row + 1) % m_v));
        return top + ease(v - row) * (bottom - top);
    }

  private:
    static int cells(int size, double texels) {
        return std::clamp(static_cast<int>(kDesignSize / texels + 0.5), 1, size);
    }
    /// Rows start at different places, lest cells line up in columns.
    [[nodiscard]] double row_at(double u, std::uint32_t row) const {
        const std::uint32_t state = mix(m_seed, row);
        const double shifted = u + unit_interval(state) * m_u;
        const int cell = static_cast<int>(shifted);
        const double left = value(state, cell);
        return left + ease(shifted - cell) * (value(state, cell + 1) - left);
    }
    [[nodiscard]] double value(std::uint32_t state, int cell) const {
        return 2.0 * unit_interval(mix(state, static_cast<std::uint32_t>(cell % m_u) + 1)) - 1.0;
    }

    std::uint32_t m_seed;
    int m_u;
    int m_v;
    int m_size;
};

/// Noise in [-1, 1] on the line, one cell per unit; `period` > 0 cells repeat.
[[nodiscard]] inline double line_noise(std::uint32_t seed, double x, int period = 0) {
    const double floor = std::floor(x);
    const auto value = [&](double cell) {
        if (period > 0) cell -= period * std::floor(cell / period);
        return 2.0 * unit_interval(
                         mix(seed, static_cast<std::uint32_t>(static_cast<std::int64_t>(cell)))) -
               1.0;
    };
    const double left = value(floor);
    return left + ease(x - floor) * (value(floor + 1.0) - left);
}

}  // namespace burnish::generators
