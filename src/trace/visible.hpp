#pragma once

#include <memory>
#include <span>
#include <vector>

#include "draw.hpp"

namespace burnish {

/// The draws of a frame, transformed, and the pixels that they go to.
struct FrameDraws {
    std::span<const std::unique_ptr<Draw>> draws;
    Viewport viewport;
    FrameSize size;
};

/// A triangle whose fragment is in a pixel's colour.
struct VisibleTriangle {
    SetupTriangle setup;  ///< of a clipped triangle, the piece that covers the pixel
    float depth;          ///< window depth at the pixel
};

/// What is visible at pixel (x, y), which lies in the frame, in the order of submission: all that
/// was blended after the last fragment that replaced the pixel's colour, which comes first if there
/// was one. Nothing where the pixel shows the background.
std::vector<VisibleTriangle> visible_triangles(const FrameDraws& frame, std::int32_t x,
                                               std::int32_t y);

}  // namespace burnish
