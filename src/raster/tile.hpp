#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/aligned.hpp"
#include "kernels/kernel_table.hpp"
#include "raster/bin.hpp"

namespace burnish {

/// Place of pixel (x, y) of a tile, 0 .. 63 each, in the order of kernels/packet.hpp.
constexpr std::size_t tile_index(std::int32_t x, std::int32_t y) {
    const std::int32_t block = y / kBlockSize * (kTileSize / kBlockSize) + x / kBlockSize;
    return static_cast<std::size_t>(block * kBlockPixels + y % kBlockSize * kBlockSize +
                                    x % kBlockSize);
}

/// Depth and visibility of one tile; a worker's scratch. Pixels in the order of kernels/packet.hpp.
class TileVisibility {
  public:
    TileVisibility();

    /// Starts tile (x, y): nothing visible, depth 1 everywhere or, if `depth` is not null, as saved
    /// by an earlier round (kTilePixels floats).
    void begin(std::int32_t x, std::int32_t y, FrameSize frame, const float* depth);

    /// Draws the chunk's triangles in this tile, in order. `rules` belong to the draws.
    void draw(const Chunk& chunk, std::span<const DepthRule> rules, const KernelTable& kernels);
    /// The same for the depths alone; shows nothing.
    void draw_depths(const Chunk& chunk, std::span<const DepthRule> rules,
                     const KernelTable& kernels);

    /// What is visible of all that was drawn, inside the frame. Valid until the next `begin` or
    /// `forget`.
    TileFragments collect(const KernelTable& kernels);

    /// Nothing is visible any more; depth stays.
    void forget();
    [[nodiscard]] bool shows_anything() const { return !m_triangles.empty(); }

    /// Draws one triangle past the visibility buffer: its pixels inside the frame that pass `rule`.
    /// False if there are none.
    bool cover(const SetupTriangle& triangle, const DepthRule& rule, const KernelTable& kernels,
               PixelMask& passed);

    /// All depths are in place, until more is drawn.
    void finish(const KernelTable& kernels) { fill_depths(kernels); }

    /// All depths are 1 already when the next tile begins.
    void note_cleared() { m_cleared = true; }

    /// Of blocks that nothing was drawn in since begin() they may be those of an earlier tile,
    /// until finish() or cover().
    [[nodiscard]] float* depth() { return m_depth.data(); }
    [[nodiscard]] const float* depth() const { return m_depth.data(); }
    [[nodiscard]] float* block_far() { return m_block_far.data(); }
    [[nodiscard]] std::int32_t left() const { return m_tile_x * kTileSize; }
    [[nodiscard]] std::int32_t top() const { return m_tile_y * kTileSize; }

  private:
    void draw_entries(const Chunk& chunk, std::span<const DepthRule> rules,
                      const KernelTable& kernels, std::uint32_t* id);
    void draw_listed(void (*rasterize)(const RasterizeEntriesCtx&) noexcept, const Chunk& chunk,
                     std::span<const TileEntry> entries, std::span<const DepthRule> rules,
                     std::uint32_t* id);
    void draw_large(const Chunk& chunk, std::span<const TileEntry> entries,
                    std::span<const DepthRule> rules, const KernelTable& kernels,
                    std::uint32_t* id);
    void hide_outside();
    struct BlankBlocks;
    static void fill(BlankBlocks& blank, void* tile, std::uint32_t value,
                     const KernelTable& kernels);
    void fill_depths(const KernelTable& kernels);
    void fill_ids(const KernelTable& kernels);

    std::int32_t m_tile_x = 0, m_tile_y = 0;
    FrameSize m_frame{};
    AlignedVector<float> m_depth,
        m_block_far;                    ///< of depths one more, as RasterizeEntriesCtx has it
    AlignedVector<std::uint32_t> m_id;  ///< likewise
    /// Blocks that are not written yet, as RasterizeEntriesCtx has it: stores that clear a tile
    /// would wait for those of the tile before, which are on their way to the frame.
    struct BlankBlocks {
        void set() {
            flags.fill(1);
            any = true;
        }
        std::array<std::uint8_t, kTileBlocks> flags{};
        bool any = false;  ///< maybe
    };
    BlankBlocks m_blank_depths, m_blank_ids;
    bool m_cleared = false;                         ///< depths, since the last tile
    std::vector<const SetupTriangle*> m_triangles;  ///< the visibility buffer holds indices
    std::vector<std::uint64_t> m_drawn;             ///< per triangle, as RasterizeCtx has it
    std::vector<std::uint32_t> m_first;             ///< of TileFragments
    std::vector<std::uint16_t> m_pixels;
};

}  // namespace burnish
