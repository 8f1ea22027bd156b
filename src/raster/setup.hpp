#pragma once

#include <cstdint>

#include "geometry/triangle.hpp"

namespace burnish {

/// Which side of a triangle is dropped: the sign of the window area, y down, counts. Front faces
/// are counter-clockwise as one sees them, so their area is negative.
enum class Facing : std::uint8_t { any, front_only, back_only };

/// A triangle as the tile at (tile_x, tile_y), in tiles, sees it: edges that do not cross the tile
/// are left out. False if the triangle covers no pixel of the tile.
bool tile_triangle(const SetupTriangle& triangle, std::int32_t tile_x, std::int32_t tile_y,
                   TileTriangle& out);

/// Whether the triangle covers all pixels of the frame that lie in a tile.
bool covers_tile(const SetupTriangle& triangle, std::int32_t tile_x, std::int32_t tile_y,
                 FrameSize frame);

}  // namespace burnish
