#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/dmath.hpp"

/// What the operations of models that are not arithmetic are, of numbers.
namespace burnish {

inline double exponential_of(double x) {
    constexpr double kLog2E = 1.4426950408889634;
    return dmath::exp2(x * kLog2E);
}

/// x^y, x counted as 0 where it is negative.
inline double power_of(double x, double y) {
    if (x <= 0.0 && y < 0.0) return std::numeric_limits<double>::infinity();
    return dmath::pow(x, y);
}

/// Of what is negative: 0.
inline double root_of(double x) {
    return std::sqrt(std::max(x, 0.0));
}

}  // namespace burnish
