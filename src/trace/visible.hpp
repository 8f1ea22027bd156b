#pragma once

#include <memory>
#include <optional>
#include <span>

#include "draw.hpp"

namespace burnish {

/// The draws of a frame, transformed, and the pixels that they go to.
struct FrameDraws {
    std::span<const std::unique_ptr<Draw>> draws;
    Viewport viewport;
    FrameSize size;
};

/// The triangle that a pixel shows.
struct VisibleTriangle {
    std::size_t triangle;  ///< of its draw, in the order of submission
    SetupTriangle setup;   ///< of a clipped triangle, the piece that covers the pixel
    float depth;           ///< window depth at the pixel
};

/// Nothing where pixel (x, y), which lies in the frame, shows the background.
std::optional<VisibleTriangle> visible_triangle(const FrameDraws& frame, std::int32_t x,
                                                std::int32_t y);

}  // namespace burnish
