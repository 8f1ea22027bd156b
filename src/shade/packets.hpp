#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/aligned.hpp"
#include "geometry/triangle.hpp"
#include "kernels/kernel_table.hpp"
#include "shade/shading.hpp"

namespace burnish {

/// What shading needs of a draw.
struct ShadedDraw {
    const Shading* shading;
    ScreenMesh mesh;
};

/// A tile to shade into: its first pixel, and where its pixels go, in the order of
/// kernels/packet.hpp.
struct ShadedTile {
    std::int32_t left, top;
    StoreFormat format;
    void* pixels;
};

/// Cuts the fragments of a tile into packets, across triangles, and shades them. A worker's
/// scratch; order does not matter to the result, since no pixel comes twice.
class PacketShader {
  public:
    PacketShader();

    void shade(const TileFragments& fragments, std::span<const ShadedDraw> draws,
               const ShadedTile& tile, const KernelTable& kernels);

    /// Since the last reset.
    [[nodiscard]] std::uint64_t shaded_pixels() const { return m_shaded; }
    void reset_count() { m_shaded = 0; }

  private:
    void shade_packet(const ShadedTile& tile, const KernelTable& kernels);

    std::uint64_t m_shaded = 0;
    const Shading* m_current = nullptr;  ///< of the packet's fragments
    const Shading* m_loaded = nullptr;   ///< whose constants the planes hold
    Packet m_packet{};
    std::vector<Run> m_runs;
    AlignedVector<AttributePlane> m_plane_equations;  ///< of the runs, one after the other
    AlignedVector<float> m_attributes;
    AlignedVector<std::int16_t> m_planes, m_weights;
    AlignedVector<std::int32_t> m_texels;
};

}  // namespace burnish
