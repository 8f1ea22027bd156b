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

/// test - reference, rgba32f with alpha 1. Both frames are rgba32f and of one size.
Framebuffer difference_frame(const Framebuffer& test, const Framebuffer& reference);

enum class DifferenceSign {
    shown,    ///< 128 where the pictures are the same, more where the test is brighter
    ignored,  ///< 0 where the pictures are the same
};
/// The same times `gain` as bytes, a difference of 1 being 127 or 255 of them. NaN is as 0.
Image8 difference_image(const Framebuffer& test, const Framebuffer& reference, double gain,
                        DifferenceSign sign);

}  // namespace burnish::metrics
