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

/// Vertices of the draw at the corners, in the order of x, y; before clipping.
inline std::array<std::uint32_t, 3> corner_vertices(const ScreenMesh& mesh,
                                                    const SetupTriangle& triangle) {
    const std::uint32_t* const v = mesh.indices.data() + std::size_t{3} * triangle.number;
    return triangle.swapped != 0 ? std::array{v[0], v[2], v[1]} : std::array{v[0], v[1], v[2]};
}

/// Pixels of a tile: bit i of word k is pixel 64 k + i.
struct PixelMask {
    std::uint64_t blocks = 0;  ///< bit k: word k has bits; others hold anything
    std::array<std::uint64_t, kTileBlocks> word;
};

/// Visible fragments of a tile, triangle after triangle.
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
