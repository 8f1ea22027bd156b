#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace burnish {

/// As many bits as a double has.
inline constexpr int kExactBits = 0;
inline constexpr int kMostBits = 24;

/// How a number finds its place on a grid.
enum class BitRounding {
    nearest,   ///< halves away from 0
    truncate,  ///< towards 0
    /// The NV2A's: a product of two codes is divided by one more than the code of 1, downwards;
    /// every other number is taken downwards.
    shift8,
    /// Up as often as the number lies beyond the grid's lower neighbour: right on average.
    stochastic,
};

/// Rounds the numbers of one pixel. Stochastic rounding draws from a hash of the pixel and of how
/// many numbers came before, exact ones too: the same number at the same place of the same program
/// is always rounded alike.
class Quantiser {
  public:
    explicit Quantiser(BitRounding rounding = BitRounding::nearest) : m_rounding(rounding) {}

    /// Another pixel; `stream` tells apart what is computed several times at one.
    void begin(std::uint32_t x, std::uint32_t y, std::uint32_t stream = 0) {
        m_pixel = (std::uint64_t{stream} << 48) ^ (std::uint64_t{y} << 24) ^ x;
        m_count = 0;
    }

    /// 0 .. 1 in 2^bits - 1 steps.
    double unsigned_number(double x, int bits) {
        const double one = std::ldexp(1.0, bits) - 1.0;
        return bits == kExactBits ? skip(x) : std::clamp(step(x * one) / one, 0.0, 1.0);
    }

    /// A sign and 2^(bits - 1) - 1 steps to 1, no end.
    double signed_number(double x, int bits) {
        const double one = std::ldexp(1.0, bits - 1) - 1.0;
        return bits == kExactBits ? skip(x) : step(x * one) / one;
    }

    /// The same of a product.
    double product(double x, int bits) {
        const double one = std::ldexp(1.0, bits - 1) - 1.0;
        if (bits == kExactBits) return skip(x);
        const double by = m_rounding == BitRounding::shift8 ? one * (one / (one + 1.0)) : one;
        return step(x * by) / one;
    }

    /// c = x/2 + 1/2 of x in -1 .. 1, in 2^bits - 1 steps with 1/2 as code 2^(bits - 1): 0 stays 0,
    /// -1 and 1 may be a step off. Rounding is that of x.
    double coded_number(double c, int bits) {
        if (bits == kExactBits) return skip(c);
        const double half = std::ldexp(1.0, bits - 1), one = 2.0 * half - 1.0;
        return std::clamp(step((c - 0.5) * one), -half, half - 1.0) / one + 0.5;
    }

  private:
    double skip(double x) {
        ++m_count;
        return x;
    }

    /// An integer.
    double step(double x) {
        const std::uint64_t place = m_count++;
        // A number of the grid stays where it is: x may be off by what its division has lost.
        const double nearest = std::round(x);
        if (std::abs(x - nearest) < 0x1p-24) return nearest;
        switch (m_rounding) {
            case BitRounding::nearest:
                return nearest;
            case BitRounding::truncate:
                return std::trunc(x);
            case BitRounding::shift8:
                return std::floor(x);
            case BitRounding::stochastic:
                break;
        }
        const double below = std::floor(x);
        return below + (uniform(place) < x - below ? 1.0 : 0.0);
    }

    /// 0 .. 1, from two rounds of a hash of 64 bits. Method: S. Vigna, "SplitMix64", 2015.
    [[nodiscard]] double uniform(std::uint64_t place) const {
        return static_cast<double>(mixed(mixed(m_pixel) + place) >> 11) * 0x1p-53;
    }
    static std::uint64_t mixed(std::uint64_t z) {
        z += 0x9e3779b97f4a7c15U;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
        return z ^ (z >> 31);
    }

    BitRounding m_rounding;
    std::uint64_t m_pixel = 0, m_count = 0;
};

}  // namespace burnish
