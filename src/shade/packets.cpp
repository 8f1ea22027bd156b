#include "shade/packets.hpp"

#include <algorithm>
#include <cstring>

#include "shade/attributes.hpp"

namespace burnish {

namespace {

constexpr std::size_t kPlaneBlock = 8192;  // plane equations; 96 KB
constexpr std::size_t kPixelSlack = 64;    // kernels read whole vectors

}  // namespace

PacketShader::PacketShader()
    : m_pixels(kPacketSize + kPixelSlack), m_weights(2 * kPacketSize), m_texels(kPacketSize) {
    m_runs.reserve(kPacketSize);
    m_packet.pixels = m_pixels.data();
    m_packet.texel = m_texels.data();
    m_packet.weight_x = m_weights.data();
    m_packet.weight_y = m_weights.data() + kPacketSize;
    m_attributes.resize(static_cast<std::size_t>(kMaxAttributes) * kAttributeStride);
    m_packet.attributes = m_attributes.data();
}

void PacketShader::begin(const KernelTable& kernels, std::int32_t left, std::int32_t top,
                         std::size_t triangle_count, StoreFormat format, void* tile) {
    m_kernels = &kernels;
    m_left = left;
    m_top = top;
    m_format = format;
    m_tile = tile;
    m_current = m_loaded = nullptr;
    m_packet.count = 0;  // an exception may have left fragments of an earlier tile
    m_runs.clear();
    m_planes_by_id.assign(triangle_count, nullptr);
    m_plane_block = m_plane_used = 0;
}

AttributePlane* PacketShader::allocate_planes(std::size_t count) {
    if (m_plane_used + count > kPlaneBlock) {
        ++m_plane_block;
        m_plane_used = 0;
    }
    if (m_plane_block >= m_plane_blocks.size()) {
        m_plane_blocks.push_back(std::make_unique<AttributePlane[]>(kPlaneBlock));
    }
    AttributePlane* planes = m_plane_blocks[m_plane_block].get() + m_plane_used;
    m_plane_used += count;
    return planes;
}

const AttributePlane* PacketShader::planes_of(const ShadedDraw& draw, const SetupTriangle& triangle,
                                              std::uint32_t id) {
    const AttributePlane*& known = m_planes_by_id[id];
    if (known == nullptr) {
        AttributePlane* planes =
            allocate_planes(static_cast<std::size_t>(draw.shading->interpolated()) + 1);
        attribute_planes(*draw.shading, draw.mesh, triangle, planes);
        known = planes;
    }
    return known;
}

void PacketShader::add(const ShadedDraw& draw, const SetupTriangle& triangle, std::uint32_t id,
                       const std::uint16_t* pixels, int count) {
    if (draw.shading != m_current || m_packet.count + count > kPacketSize) {
        shade();
        m_current = draw.shading;
    }
    std::uint16_t* to = m_pixels.data() + m_packet.count;
    for (int i = 0; i < count; i += 8) std::memcpy(to + i, pixels + i, 8 * sizeof *pixels);
    m_runs.push_back({planes_of(draw, triangle, id), m_packet.count, count,
                      m_left - triangle.reference_x, m_top - triangle.reference_y});
    m_packet.count += count;
}

void PacketShader::finish() {
    shade();
    m_current = nullptr;
}

void PacketShader::shade() {
    if (m_packet.count == 0) return;
    const auto planes = static_cast<std::size_t>(m_current->program.plane_count) * kPacketSize;
    if (m_planes.size() < planes) {
        m_planes.resize(planes);
        m_loaded = nullptr;
    }
    m_packet.planes = m_planes.data();
    if (m_loaded != m_current) load_constants(m_current->program, m_packet);
    m_loaded = m_current;
    const AttributesCtx runs{m_runs.data(), static_cast<int>(m_runs.size()),
                             m_current->interpolated()};
    shade_packet(*m_current, *m_kernels, runs, m_format, m_tile, m_packet);
    m_shaded += static_cast<std::uint64_t>(m_packet.count);
    m_packet.count = 0;
    m_runs.clear();
}

}  // namespace burnish
