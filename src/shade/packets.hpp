#pragma once

#include <cstdint>
#include <memory>
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

/// Collects visible fragments of a tile into packets, across triangles, and shades each packet when
/// it is full or the material changes. A worker's scratch; order does not matter to the result,
/// since no pixel comes twice.
class PacketShader {
  public:
    PacketShader();

    /// Starts a tile with `triangle_count` triangles; pixels go to `tile`, in the order of
    /// kernels/packet.hpp. (left, top): the tile's first pixel.
    void begin(const KernelTable& kernels, std::int32_t left, std::int32_t top,
               std::size_t triangle_count, StoreFormat format, void* tile);

    /// `count` pixels of the tile that show `triangle`, the tile's triangle number `id`; at
    /// most 64. `pixels` is readable up to the next multiple of 8.
    void add(const ShadedDraw& draw, const SetupTriangle& triangle, std::uint32_t id,
             const std::uint16_t* pixels, int count);

    /// Shades what is left.
    void finish();

    /// Since the last reset.
    [[nodiscard]] std::uint64_t shaded_pixels() const { return m_shaded; }
    void reset_count() { m_shaded = 0; }

  private:
    const AttributePlane* planes_of(const ShadedDraw& draw, const SetupTriangle& triangle,
                                    std::uint32_t id);
    AttributePlane* allocate_planes(std::size_t count);
    void shade();

    const KernelTable* m_kernels = nullptr;
    std::int32_t m_left = 0, m_top = 0;
    StoreFormat m_format = StoreFormat::rgba8;
    void* m_tile = nullptr;
    const Shading* m_current = nullptr;  ///< of the fragments collected
    const Shading* m_loaded = nullptr;   ///< whose constants the planes hold
    std::uint64_t m_shaded = 0;

    Packet m_packet{};
    std::vector<Run> m_runs;
    AlignedVector<std::uint16_t> m_pixels;
    AlignedVector<float> m_attributes;
    AlignedVector<std::int16_t> m_planes, m_weights;
    AlignedVector<std::int32_t> m_texels;

    // Plane equations of the tile's triangles, made when the first of their pixels turns up.
    std::vector<const AttributePlane*> m_planes_by_id;
    std::vector<std::unique_ptr<AttributePlane[]>> m_plane_blocks;
    std::size_t m_plane_block = 0, m_plane_used = 0;
};

}  // namespace burnish
