#pragma once

#include <cstdint>

#include "geometry/triangle.hpp"

namespace burnish {

/// Pixels whose centres a triangle may cover, inclusive; empty if x0 > x1 or y0 > y1.
struct PixelRect {
    std::int32_t x0, y0, x1, y1;
};

enum class SetupResult : std::uint8_t {
    drawn,
    degenerate,  ///< zero area after snapping
    culled,      ///< faces away, or covers no pixel centre of the frame
};

/// Which side of a triangle is dropped: the sign of the window area, y down, counts. Front faces
/// are counter-clockwise as one sees them, so their area is negative.
enum class Facing : std::uint8_t { any, front_only, back_only };

/// Snapped corners to a SetupTriangle and its bounding box within the frame. `out.vertex`, `draw`
/// and `clipped` must be set before; they are permuted along with the corners.
SetupResult setup_triangle(const ScreenVertex& v0, const ScreenVertex& v1, const ScreenVertex& v2,
                           Facing facing, FrameSize frame, SetupTriangle& out, PixelRect& box);

/// Pixels whose centres lie in the bounding box of the triangle, cut to the frame.
PixelRect pixel_box(const SetupTriangle& triangle, FrameSize frame);

/// A triangle as the tile at (tile_x, tile_y), in tiles, sees it: edges that do not cross the tile
/// are left out. False if the triangle covers no pixel of the tile. `frame` cuts the bounding box.
bool tile_triangle(const SetupTriangle& triangle, std::int32_t tile_x, std::int32_t tile_y,
                   FrameSize frame, TileTriangle& out);

}  // namespace burnish
