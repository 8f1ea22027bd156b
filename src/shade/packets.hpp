#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/aligned.hpp"
#include "geometry/triangle.hpp"
#include "kernels/kernel_table.hpp"
#include "shade/output.hpp"
#include "shade/pixel_list.hpp"
#include "shade/plane_batch.hpp"
#include "shade/shading.hpp"
#include "shade/shown.hpp"

namespace burnish {

/// What shading needs of a draw.
struct ShadedDraw {
    const Shading* shading;
    const FragmentOutput* output;
    ScreenMesh mesh;
    const ShownValues* shown = nullptr;  ///< what goes to the tile instead of colours
};

/// A tile to shade into: its first pixel, and where its pixels go.
struct ShadedTile {
    std::int32_t left, top;
    OutputTile output;
};

/// Cuts the fragments of a tile into packets, across triangles, and shades them. A worker's
/// scratch. No pixel comes twice in a packet, so that the order within does not matter.
class PacketShader {
  public:
    PacketShader();

    /// Starts a tile; forgets what an exception may have left of an earlier one.
    void begin(const ShadedTile& tile);

    /// Shades what a visibility buffer shows: no pixel twice, and in any order. Nothing is pending
    /// before or after.
    void shade(const TileFragments& fragments, std::span<const ShadedDraw> draws,
               const KernelTable& kernels);

    /// The draw of the triangles that follow; shades what is pending of another one.
    void start_draw(const ShadedDraw& draw, const KernelTable& kernels);

    /// Adds the pixels of one triangle after all that were added before. They wait for a packet to
    /// be full, another draw, or a fragment of the same pixel.
    void add(const SetupTriangle& triangle, const PixelMask& pixels, const KernelTable& kernels);

    /// Shades what is pending.
    void flush(const KernelTable& kernels);

    /// Since the last reset.
    [[nodiscard]] std::uint64_t shaded_pixels() const { return m_shaded; }
    void reset_count() { m_shaded = 0; }

  private:
    /// Fragments of one triangle: where they are shaded and, where the list does not outlive the
    /// call, stored; else null.
    struct Fragments {
        const std::uint16_t* shaded;
        const std::uint16_t* stored;
        int count;
    };
    void add_run(const SetupTriangle& triangle, int count);
    void append(const SetupTriangle& triangle, Fragments fragments, const KernelTable& kernels);
    /// Whether some of the packet's fragments are shaded and not stored.
    [[nodiscard]] bool stores_apart() const {
        return m_copied && (m_draw.output->late_depth || m_draw.shading->quads);
    }
    void shade_packet(const KernelTable& kernels);
    AttributesCtx runs(const Shading& shading, const KernelTable& kernels);
    void list_visible(const TileFragments& fragments, std::size_t first, std::size_t end);
    void shade_visible(const std::uint16_t* pixels, const KernelTable& kernels);
    /// The visible triangles' fragments by quads of pixels; of those that see no fragment of the
    /// draw, the first that does stands in for the triangle.
    void shade_pixel_quads(const std::uint16_t* pixels, const KernelTable& kernels);
    void look_ahead(std::size_t first);
    void take_column(const SetupTriangle& triangle);
    void make_room();
    void forget_columns();
    void shade_colors(const Shading& shading, const KernelTable& kernels);
    void show_values(const KernelTable& kernels);
    void write_colors(const Shading& shading, const std::optional<Blend>& blend,
                      const KernelTable& kernels);
    [[nodiscard]] bool holds_any(const PixelMask& pixels) const;
    void hold(const PixelMask& pixels);

    std::uint64_t m_shaded = 0;
    ShadedTile m_tile{};
    ShadedDraw m_draw{};                ///< of the packet's fragments
    const Shading* m_loaded = nullptr;  ///< whose constants the planes hold
    Packet m_packet{};
    bool m_interpolates = false;  ///< the draw needs runs
    bool m_needs_depth = false;   ///< and those of the depth
    /// The packet's pixels need no copy: they are m_pixels, and m_stored where they are stored
    /// apart, or lie in a list that stays.
    bool m_copied = false;
    AlignedVector<std::uint16_t> m_pixels, m_stored;
    /// A triangle with fragments, the first of them; the next one's is its end.
    struct Visible {
        const SetupTriangle* triangle;
        std::uint32_t first;
    };
    std::vector<Visible> m_visible;            ///< of the draw, and the end
    std::vector<const SetupTriangle*> m_seen;  ///< at pixels of the tile
    PixelMask m_pending;
    PixelList m_list;
    std::vector<Run> m_runs;
    std::vector<DepthRun> m_depth_runs;
    PlaneBatch m_planes;  ///< of the packet's triangles and, where they are known, later ones
    std::size_t m_first_column = 0;  ///< of the packet's first run
    std::size_t m_next_column = 0;   ///< of the triangle that comes next
    std::vector<ShownRun> m_shown_runs;
    AlignedVector<float> m_attributes;
    AlignedVector<std::int16_t> m_registers, m_weights;
    AlignedVector<std::int32_t> m_texels;
};

}  // namespace burnish
