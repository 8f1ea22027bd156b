#pragma once

#include <cstdint>

#include "geometry/triangle.hpp"

namespace burnish {

enum class SetupResult : std::uint8_t {
    drawn,
    degenerate,  ///< zero area after snapping
    culled,      ///< faces away, or covers no pixel centre of the frame
};

/// Which side of a triangle is dropped: the sign of the window area, y down, counts. Front faces
/// are counter-clockwise as one sees them, so their area is negative.
enum class Facing : std::uint8_t { any, front_only, back_only };

/// Snapped corners to a SetupTriangle, but for its `number`, `draw` and `clipped`.
SetupResult setup_triangle(const ScreenVertex& v0, const ScreenVertex& v1, const ScreenVertex& v2,
                           Facing facing, FrameSize frame, SetupTriangle& out);

/// A triangle as the tile at (tile_x, tile_y), in tiles, sees it: edges that do not cross the tile
/// are left out. False if the triangle covers no pixel of the tile.
bool tile_triangle(const SetupTriangle& triangle, std::int32_t tile_x, std::int32_t tile_y,
                   TileTriangle& out);

/// Whether the triangle covers all pixels of the frame that lie in a tile.
bool covers_tile(const SetupTriangle& triangle, std::int32_t tile_x, std::int32_t tile_y,
                 FrameSize frame);

}  // namespace burnish
