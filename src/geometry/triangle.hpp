#pragma once

#include <cstdint>
#include <span>

#include "kernels/tile_stages.hpp"

namespace burnish {

/// Frame size in pixels.
struct FrameSize {
    std::int32_t width, height;
};

/// Transformed vertices of one draw and the triangles between them.
struct ScreenMesh {
    std::span<const ScreenVertex> screen;
    std::span<const HomogeneousVertex> homogeneous;
    std::span<const std::uint32_t> indices;  ///< three per triangle
};

/// A triangle with everything that tiles need, stored once: one cache line and a bit.
struct SetupTriangle {
    std::int32_t x[3], y[3];  ///< window, 1/256 pixel; ordered so that the area is positive
    float z, zx, zy;          ///< depth at the centre of the reference pixel, and per pixel
    float z_low, z_high;      ///< range of the corners
    std::int32_t reference_x, reference_y;  ///< pixel inside the frame, near the triangle
    std::uint32_t vertex[3];                ///< of the draw, in the order of x, y; before clipping
    std::uint32_t draw;
    std::uint8_t clipped;  ///< 1: x, y are not those of `vertex`
};

}  // namespace burnish
