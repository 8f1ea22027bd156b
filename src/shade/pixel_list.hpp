#pragma once

#include <cstdint>

#include "geometry/triangle.hpp"

namespace burnish {

/// Fragments of one triangle: where they are shaded, and of quads where they are stored.
struct PixelList {
    static constexpr int kSlack = 16;  ///< kernels read past the last, and so do copies

    std::uint16_t shaded[kTilePixels + kSlack];
    std::uint16_t stored[kTilePixels + kSlack];  ///< kNoPixel for those that only help
    int count;
};

/// The pixels of a mask, block after block, rising in each; stored where they are shaded.
void list_pixels(const PixelMask& mask, PixelList& out);

/// The same as whole 2x2 quads at even coordinates: upper left, upper right, lower left, lower
/// right. Pixels that are not of the mask help.
void list_quads(const PixelMask& mask, PixelList& out);

/// The mask of `count` pixels.
void mask_pixels(const std::uint16_t* pixels, int count, PixelMask& out);

}  // namespace burnish
