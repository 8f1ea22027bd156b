#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

/// Elementary functions in double made of + - * / and sqrt only, so that their bits are the same on
/// every CPU and C library. Whatever reaches a machine image goes through here; std:: is for the
/// double-precision renderer. Absolute error below 4e-16 for sin and cos, below 2e-15 for atan,
/// atan2 and acos; relative error below 1e-14 for exp2 and log2 (away from 1), times the larger of
/// 1 and y for pow. tests/dmath.cpp measures it.
namespace burnish::dmath {

inline constexpr double kPi = 3.14159265358979323846;

namespace detail {

/// Horner sum of c[0] + c[1] x + ...
template <int N>
constexpr double horner(const double (&c)[N], double x) {
    double sum = c[N - 1];
    for (int i = N - 2; i >= 0; --i) sum = sum * x + c[i];
    return sum;
}

/// Taylor series on [-pi/4, pi/4].
constexpr double sin_small(double x) {
    constexpr double c[] = {1.0,
                            -1.0 / 6,
                            1.0 / 120,
                            -1.0 / 5040,
                            1.0 / 362880,
                            -1.0 / 39916800,
                            1.0 / 6227020800.0,
                            -1.0 / 1307674368000.0,
                            1.0 / 355687428096000.0};
    return x * horner(c, x * x);
}

constexpr double cos_small(double x) {
    constexpr double c[] = {1.0,
                            -1.0 / 2,
                            1.0 / 24,
                            -1.0 / 720,
                            1.0 / 40320,
                            -1.0 / 3628800,
                            1.0 / 479001600,
                            -1.0 / 87178291200.0,
                            1.0 / 20922789888000.0,
                            -1.0 / 6402373705728000.0};
    return horner(c, x * x);
}

struct Quadrant {
    double rest;  ///< in [-pi/4, pi/4]
    unsigned index;
};

/// x = index * pi/2 + rest; pi/2 in three parts, the first two with 33 bits each, so that their
/// products with an index below 2^20 are exact. |x| < 10^6.
inline Quadrant reduce(double x) {
    constexpr double kHigh = 1.57079632673412561417e+00;
    constexpr double kMid = 6.07710050630396597660e-11;
    constexpr double kLow = 2.02226624879595063154e-21;
    const double n = std::floor(x * (2.0 / kPi) + 0.5);
    const double rest = ((x - n * kHigh) - n * kMid) - n * kLow;
    return {rest, static_cast<unsigned>(static_cast<std::int64_t>(n) & 3)};
}

}  // namespace detail

/// Radians, |x| < 10^6.
inline double sin(double x) {
    const detail::Quadrant q = detail::reduce(x);
    const double s = (q.index & 1) != 0 ? detail::cos_small(q.rest) : detail::sin_small(q.rest);
    return (q.index & 2) != 0 ? -s : s;
}

inline double cos(double x) {
    const detail::Quadrant q = detail::reduce(x);
    const double c = (q.index & 1) != 0 ? detail::sin_small(q.rest) : detail::cos_small(q.rest);
    return q.index == 1 || q.index == 2 ? -c : c;
}

inline double tan(double x) {
    return sin(x) / cos(x);
}

/// Any finite x. Three half-angle steps bring |x| <= 1 below 0.1, then the power series.
inline double atan(double x) {
    if (x > 1.0) return 0.5 * kPi - atan(1.0 / x);
    if (x < -1.0) return -0.5 * kPi - atan(1.0 / x);
    for (int i = 0; i < 3; ++i) x = x / (1.0 + std::sqrt(1.0 + x * x));
    constexpr double c[] = {1.0,     -1.0 / 3,  1.0 / 5,  -1.0 / 7,
                            1.0 / 9, -1.0 / 11, 1.0 / 13, -1.0 / 15};
    return 8.0 * x * detail::horner(c, x * x);
}

/// Angle of the point (x, y) in (-pi, pi]; 0 for the origin.
inline double atan2(double y, double x) {
    if (x == 0.0 && y == 0.0) return 0.0;
    // tan(angle / 2) without cancellation, whichever side the point is on.
    const double r = std::sqrt(x * x + y * y);
    if (x > 0.0) return 2.0 * atan(y / (r + x));
    if (y == 0.0) return kPi;
    return (y > 0.0 ? kPi : -kPi) - 2.0 * atan(y / (r - x));
}

/// x is clamped to [-1, 1].
inline double acos(double x) {
    x = x < -1.0 ? -1.0 : x > 1.0 ? 1.0 : x;
    return atan2(std::sqrt((1.0 - x) * (1.0 + x)), x);
}

/// 2^x; 0 below -1022, infinity above 1023.
inline double exp2(double x) {
    if (!(x >= -1022.0)) return 0.0;
    if (x > 1023.0) return HUGE_VAL;
    constexpr double kLn2 = 0.69314718055994530942;
    const double n = std::floor(x + 0.5);
    const double f = (x - n) * kLn2;
    double term = 1.0;
    double sum = 1.0;
    for (int i = 1; i <= 15; ++i) {
        term *= f / i;
        sum += term;
    }
    return sum * std::bit_cast<double>(
                     static_cast<std::uint64_t>(static_cast<std::int64_t>(n) + 1023) << 52);
}

/// Base-2 logarithm of a positive normal number.
inline double log2(double x) {
    constexpr double kInvLn2 = 1.44269504088896340736;
    const auto bits = std::bit_cast<std::uint64_t>(x);
    int exponent = static_cast<int>(bits >> 52) - 1023;
    double m = std::bit_cast<double>((bits & 0x000fffffffffffffU) | 0x3ff0000000000000U);
    if (m > 1.4142135623730951) {
        m *= 0.5;
        ++exponent;
    }
    const double s = (m - 1.0) / (m + 1.0);  // |s| < 0.1716
    double sum = 0.0;
    for (int k = 23; k >= 1; k -= 2) sum = sum * (s * s) + 1.0 / k;
    return exponent + 2.0 * s * sum * kInvLn2;
}

/// x^y for x >= 0: 0^0 = 1, 0^y = 0.
inline double pow(double x, double y) {
    if (y == 0.0) return 1.0;
    if (x <= 0.0) return 0.0;
    return exp2(y * log2(x));
}

}  // namespace burnish::dmath
