#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/aligned.hpp"
#include "geometry/triangle.hpp"
#include "kernels/kernel_table.hpp"
#include "raster/setup.hpp"

namespace burnish {

/// What became of the triangles of a chunk.
struct BinCounts {
    std::uint64_t submitted = 0;
    std::uint64_t nonfinite = 0;
    std::uint64_t degenerate = 0;
    std::uint64_t clipped = 0;
    std::uint64_t binned = 0;  ///< set up, to be sorted into tiles
};

/// Where a chunk's triangles come from and where they go.
struct ChunkSource {
    ScreenMesh mesh;
    std::uint32_t draw;  ///< number within the frame
    Facing facing;
    Viewport viewport;
    FrameSize frame;
};

/// Tiles, inclusive; none where x0 > x1.
struct TileRect {
    std::int32_t x0, y0, x1, y1;

    [[nodiscard]] bool has(std::int32_t x, std::int32_t y) const {
        return x >= x0 && y >= y0 && x <= x1 && y <= y1;
    }
};

/// Consecutive triangles of one draw, set up and sorted into the tiles that they touch. Chunks are
/// filled in parallel and read in order, so no image depends on the schedule. Memory is kept for
/// the next frame.
class Chunk {
  public:
    /// Triangles `first` .. `last` - 1 of the source.
    void fill(const ChunkSource& source, std::size_t first, std::size_t last,
              const KernelTable& kernels);

    /// Triangles that touch the tile at (x, y), in submission order, and small ones that may do.
    [[nodiscard]] std::span<const TileEntry> tile(std::int32_t x, std::int32_t y) const {
        if (!m_tiles.has(x, y)) return {};
        const std::size_t at = tile_number(x, y);
        return {m_entries.data() + m_first[at], m_first[at + 1] - m_first[at]};
    }
    [[nodiscard]] std::span<const SetupTriangle> triangles() const {
        return {m_triangles.data(), m_count};
    }
    [[nodiscard]] const BinCounts& counts() const { return m_counts; }
    /// Bytes in use.
    [[nodiscard]] std::size_t bytes() const;
    /// Calls f(number of the tile, length) for every list that is not empty, in a frame of
    /// `columns` tiles in a row.
    template <class F>
    void for_each_list(std::size_t columns, F&& f) const {
        std::size_t entry = 0;
        for (std::int32_t y = m_tiles.y0; y <= m_tiles.y1; ++y) {
            std::size_t tile =
                static_cast<std::size_t>(y) * columns + static_cast<std::size_t>(m_tiles.x0);
            for (std::int32_t x = m_tiles.x0; x <= m_tiles.x1; ++x, ++tile, ++entry) {
                const std::uint32_t length = m_first[entry + 1] - m_first[entry];
                if (length > 0) f(tile, length);
            }
        }
    }

  private:
    SetupCounts set_up(SetupCtx ctx, const KernelTable& kernels);
    void add_clipped(const ChunkSource& source, std::size_t number, SetupCtx ctx,
                     const KernelTable& kernels);
    void sort_into_tiles();
    void add_parts(std::uint32_t index);
    [[nodiscard]] std::int32_t columns() const { return m_tiles.x1 - m_tiles.x0 + 1; }
    [[nodiscard]] std::size_t tile_number(std::int32_t x, std::int32_t y) const {
        return static_cast<std::size_t>((y - m_tiles.y0) * columns() + x - m_tiles.x0);
    }

    struct PlacedEntry {
        std::uint32_t tile;
        TileEntry entry;
    };

    UnsetVector<SetupTriangle> m_triangles;  ///< the first m_count are in use
    UnsetVector<SetupPlace> m_places;        ///< of each
    std::size_t m_count = 0;
    PixelRect m_bounds{};
    std::vector<PlacedEntry> m_parts;    ///< of triangles in several tiles, in order
    std::vector<std::uint32_t> m_first;  ///< per tile of the rectangle, one more at the end
    std::vector<TileEntry> m_entries;    ///< tile by tile
    TileRect m_tiles{0, 0, -1, -1};
    BinCounts m_counts;
};

/// Triangles per chunk for a frame of `triangles`: small enough that workers finish together,
/// and that the lists of a worst case (every triangle in every tile) stay within some 64 MB.
std::size_t chunk_size(FrameSize frame, std::size_t triangles);

}  // namespace burnish
