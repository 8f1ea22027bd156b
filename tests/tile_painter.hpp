#pragma once

#include <algorithm>
#include <cstdint>

#include "core/aligned.hpp"
#include "kernels/kernel_table.hpp"
#include "raster/bin.hpp"

namespace burnish {

/// What single triangles cover in a tile, as tile_triangle and a kernel say, or their mask.
/// Triangles take turns between the two inner loops of the kernels: those that test and write
/// depth, each nearer than the ones before, and those that pass without.
class TilePainter {
  public:
    explicit TilePainter(const KernelTable& kernels)
        : m_kernels(kernels), m_depth(kTilePixels + 1), m_far(kTileBlocks), m_id(kTilePixels + 1) {
        clear();
    }

    /// Draws a triangle; false if tile_triangle finds nothing of it in the tile.
    bool draw(SetupTriangle triangle, std::int32_t tile_x, std::int32_t tile_y) {
        const DepthRule rule = begin(triangle);
        if (!tile_triangle(triangle, tile_x, tile_y, m_seen)) return false;
        m_seen.id = m_current;
        m_seen.pass_less = rule.pass_less;
        m_seen.pass_equal = rule.pass_equal;
        m_seen.pass_greater = rule.pass_greater;
        m_seen.depth_write = rule.write;
        std::uint64_t drawn = 0;
        m_kernels.rasterize({&m_seen, 1, m_depth.data(), m_id.data(), m_far.data(), &drawn});
        return true;
    }

    /// Draws a triangle of a chunk as the tile lists it, a tiny one by its mask.
    bool draw(const Chunk& chunk, const TileEntry& entry, std::int32_t tile_x,
              std::int32_t tile_y) {
        SetupTriangle triangle = chunk.triangles()[entry.triangle];
        if (entry.is_large != 0) return draw(triangle, tile_x, tile_y);
        const DepthRule rule = begin(triangle);
        const TileEntry alone{entry.covered, 0, entry.x, entry.y, 0};
        std::uint64_t drawn = 0;
        (entry.covered != 0 ? m_kernels.rasterize_tiny : m_kernels.rasterize_small)(
            {&alone, 1, &triangle, rule, tile_x * kTileSize, tile_y * kTileSize, m_current,
             m_depth.data(), m_id.data(), m_far.data(), &drawn, m_blank, m_blank});
        return true;
    }

    /// Whether the last triangle covers tile pixel (x, y).
    [[nodiscard]] bool covers(int x, int y) const {
        const int index = (y / 8 * 8 + x / 8) * 64 + y % 8 * 8 + x % 8;
        return m_id[static_cast<std::size_t>(index)] == m_current;
    }
    /// Pixels of the tile that it covers, those outside the frame too.
    [[nodiscard]] std::int64_t count() const {
        return std::count(m_id.begin(), m_id.begin() + kTilePixels, m_current);
    }
    /// As the kernel got it.
    [[nodiscard]] const TileTriangle& seen() const { return m_seen; }

  private:
    /// Gives the triangle a depth of its own, and says how it is tested.
    DepthRule begin(SetupTriangle& triangle) {
        if (++m_current == kMost) clear();
        triangle.z = triangle.z_low = triangle.z_high =
            1.0F - static_cast<float>(m_current) / static_cast<float>(2 * kMost);
        triangle.zx = triangle.zy = 0.0F;
        return m_current % 2 == 0 ? DepthRule{1, 0, 0, 1} : DepthRule{1, 1, 1, 0};
    }

    static constexpr std::uint32_t kMost = 1U << 20;  // depths that floats can tell apart

    void clear() {
        m_current = 1;
        std::fill(m_depth.begin(), m_depth.end(), 1.0F);
        std::fill(m_far.begin(), m_far.end(), 1.0F);
        std::fill(m_id.begin(), m_id.end(), kNoTriangle);
    }

    const KernelTable& m_kernels;
    AlignedVector<float> m_depth, m_far;
    std::uint8_t m_blank[kTileBlocks] = {};  ///< none
    AlignedVector<std::uint32_t> m_id;
    TileTriangle m_seen{};
    std::uint32_t m_current = 0;
};

}  // namespace burnish
