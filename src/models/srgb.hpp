#pragma once

#include "core/dmath.hpp"

namespace burnish {

/// The transfer function of IEC 61966-2-1: linear light of an sRGB value, both 0 .. 1.
[[nodiscard]] inline double linear_from_srgb(double x) {
    return x <= 0.04045 ? x / 12.92 : dmath::pow((x + 0.055) / 1.055, 2.4);
}

/// The inverse, of linear light 0 .. 1.
[[nodiscard]] inline double srgb_from_linear(double x) {
    return x <= 0.0031308 ? x * 12.92 : 1.055 * dmath::pow(x, 1.0 / 2.4) - 0.055;
}

}  // namespace burnish
