#pragma once

#include <array>
#include <vector>

#include "bench/kernels/stages.hpp"

namespace burnish::bench {

/// One tile's depths and ids.
struct Tile {
    AlignedVector<float> depth = AlignedVector<float>(kTilePixels + 1, 1.0F);
    AlignedVector<std::uint32_t> id = AlignedVector<std::uint32_t>(kTilePixels + 1, kNoTriangle);
    AlignedVector<float> block_far = AlignedVector<float>(kTileBlocks, 1.0F);

    std::vector<std::uint64_t> drawn;
    std::array<std::uint8_t, kTileBlocks> blank{};  ///< none

    void draw(const KernelTable& table, const std::vector<TileTriangle>& triangles) {
        drawn.resize(triangles.size());
        table.rasterize({triangles.data(), static_cast<int>(triangles.size()), depth.data(),
                         id.data(), block_far.data(), drawn.data()});
    }
    void draw_depths(const KernelTable& table, const std::vector<TileTriangle>& triangles) {
        table.rasterize({triangles.data(), static_cast<int>(triangles.size()), depth.data(),
                         nullptr, block_far.data(), nullptr});
    }
};

}  // namespace burnish::bench
