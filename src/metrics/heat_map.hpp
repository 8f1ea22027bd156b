#pragma once

#include <burnish/framebuffer.hpp>
#include <burnish/texture.hpp>

#include "metrics/plane.hpp"

/// Pictures of errors.
namespace burnish::metrics {

/// A map of numbers 0 .. 1 as colours from black over purple and orange to light yellow, lightness
/// rising evenly: magma by N. Smith and S. van der Walt (matplotlib, CC0). What is less than 0,
/// more than 1 or NaN is as 0, 1 and 0.
Image8 heat_map(const Plane& map);

/// The numbers of a map as they are, a frame of format depth32f.
Framebuffer map_frame(const Plane& map);

enum class DifferenceSign {
    shown,    ///< test - reference
    ignored,  ///< its absolute value
};

/// Differences as they are, rgba32f with alpha 1. Both frames are rgba32f and of one size.
Framebuffer difference_frame(const Framebuffer& test, const Framebuffer& reference,
                             DifferenceSign sign);

/// Differences times `gain` as bytes: from 1 for -1 over 128 for 0 to 255 for 1, or without sign
/// from 0 to 255. NaN is as 0.
Image8 difference_image(const Framebuffer& test, const Framebuffer& reference, double gain,
                        DifferenceSign sign);

}  // namespace burnish::metrics
