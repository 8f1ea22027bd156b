#pragma once

#include <array>
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

/// Pixels, inclusive; empty if x0 > x1 or y0 > y1.
struct PixelRect {
    std::int16_t x0, y0, x1, y1;
};

/// A triangle with everything that tiles need, stored once: a cache line. Edge i runs from corner i
/// to the next; edge functions are made of the corners, tile by tile.
struct alignas(64) SetupTriangle {
    std::int32_t x[3], y[3];  ///< window, 1/256 pixel; ordered so that the area is positive
    PixelRect box;            ///< pixels whose centres it may cover, cut to the frame
    float z, zx, zy;          ///< depth at the centre of the reference pixel, and per pixel
    float z_low, z_high;      ///< range of the corners
    std::int16_t reference_x, reference_y;  ///< pixel inside the frame, near the triangle
    std::uint32_t number;                   ///< of the draw's triangles, in the order of submission
    std::uint32_t draw : 30;
    std::uint32_t swapped : 1;  ///< x, y have the second corner and the third exchanged
    std::uint32_t clipped : 1;  ///< x, y are not those of the triangle's vertices
};
static_assert(sizeof(SetupTriangle) == 64);

/// Vertices of the draw at the corners, in the order of x, y; before clipping.
inline std::array<std::uint32_t, 3> corner_vertices(const ScreenMesh& mesh,
                                                    const SetupTriangle& triangle) {
    const std::uint32_t* const v = mesh.indices.data() + std::size_t{3} * triangle.number;
    return triangle.swapped != 0 ? std::array{v[0], v[2], v[1]} : std::array{v[0], v[1], v[2]};
}

/// What a fragment of a draw has to pass, as the kernels take it.
struct DepthRule {
    std::uint8_t pass_less, pass_equal, pass_greater, write;
};

/// Pixels of a tile: bit i of word k is pixel 64 k + i.
struct PixelMask {
    std::uint64_t blocks = 0;  ///< bit k: word k has bits; others hold anything
    std::array<std::uint64_t, kTileBlocks> word;
};

/// Visible fragments of a tile, triangle after triangle, draw after draw.
struct TileFragments {
    std::span<const SetupTriangle* const> triangles;
    const std::uint32_t* first;   ///< of each triangle's fragments, and the end; many have none
    const std::uint16_t* pixels;  ///< tile indices, no two alike; readable 16 past the last
    int count;

    [[nodiscard]] int size(std::size_t triangle) const {
        return static_cast<int>(first[triangle + 1] - first[triangle]);
    }
};

}  // namespace burnish
