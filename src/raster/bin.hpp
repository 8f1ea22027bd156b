#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/triangle.hpp"
#include "raster/setup.hpp"

namespace burnish {

/// What became of the triangles of a chunk.
struct BinCounts {
    std::uint64_t submitted = 0;
    std::uint64_t nonfinite = 0;
    std::uint64_t degenerate = 0;
    std::uint64_t clipped = 0;
    std::uint64_t binned = 0;
};

/// Where a chunk's triangles come from and where they go.
struct ChunkSource {
    ScreenMesh mesh;
    std::uint32_t draw;  ///< number within the frame
    Facing facing;
    Viewport viewport;
    FrameSize frame;
};

/// A triangle of the draw: its number, and the vertices at its corners.
struct SourceTriangle {
    std::uint32_t number;
    std::array<std::uint32_t, 3> vertex;
};

/// Consecutive triangles of one draw, set up and sorted into the tiles that they touch. Chunks are
/// filled in parallel and read in order, so no image depends on the schedule. Memory is kept for
/// the next frame.
class Chunk {
  public:
    /// Triangles `first` .. `last` - 1 of the source.
    void fill(const ChunkSource& source, std::size_t first, std::size_t last);

    /// Triangles that touch the tile at (x, y), in submission order: indices into `triangles()`.
    [[nodiscard]] std::span<const std::uint32_t> tile(std::int32_t x, std::int32_t y) const;
    [[nodiscard]] const std::vector<SetupTriangle>& triangles() const { return m_triangles; }
    [[nodiscard]] const BinCounts& counts() const { return m_counts; }
    /// Bytes in use.
    [[nodiscard]] std::size_t bytes() const;
    /// Adds the length of each tile's list to `lengths`, which has `columns` tiles in a row, and
    /// times `number`, this chunk's, to `sums`.
    void add_lengths(std::uint64_t number, std::span<std::uint32_t> lengths,
                     std::span<std::uint64_t> sums, std::size_t columns) const;

  private:
    void add(const ChunkSource& source, const SourceTriangle& from);
    void add_clipped(const ChunkSource& source, const SourceTriangle& from);
    SetupResult add_projected(const ChunkSource& source, const SourceTriangle& from, bool clipped,
                              const ScreenVertex& v0, const ScreenVertex& v1,
                              const ScreenVertex& v2);
    void add_to_tiles(const SetupTriangle& triangle, std::uint32_t index);
    void sort_into_tiles(FrameSize frame);

    struct TileEntry {
        std::uint16_t x, y;
        std::uint32_t triangle;
    };

    std::vector<SetupTriangle> m_triangles;
    std::vector<TileEntry> m_unsorted;
    std::vector<std::uint32_t> m_first;    ///< per tile of the rectangle, one more at the end
    std::vector<std::uint32_t> m_entries;  ///< triangles, tile by tile
    std::int32_t m_x0 = 0, m_y0 = 0, m_width = 0, m_height = 0;  ///< rectangle of touched tiles
    BinCounts m_counts;
};

/// Triangles per chunk for a frame of `triangles`: small enough that workers finish together,
/// and that the lists of a worst case (every triangle in every tile) stay within some 64 MB.
std::size_t chunk_size(FrameSize frame, std::size_t triangles);

}  // namespace burnish
