#pragma once

#include <burnish/scene.hpp>
#include <string_view>

/// A lobe as a curve, once as a picture and once as a formula.
namespace burnish::lab {

/// Half vectors of the strip reach this far from the normal along the tangent: three widths of 0.1.
inline constexpr double kStripReach = 0.3;

/// Widths of `abp` in both directions, so that the lobe is about exp(-h.t^2 / width^2) whatever the
/// exponent: width sqrt(N / 2).
double abp_width(double width, double exponent);

/// 1024 x 8 pixels of a flat square, h.t from -kStripReach to kStripReach from left to right, h.b
/// nearly 0: light and viewer are in one place. `abp`, ks 1, kd 0. Vertices are two pixels apart.
Scene lobe_strip(double width, double exponent, std::string_view machine, HalfVector half_vector);

}  // namespace burnish::lab
