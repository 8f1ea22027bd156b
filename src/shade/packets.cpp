#include "shade/packets.hpp"

#include <algorithm>

#include "shade/attributes.hpp"

namespace burnish {

PacketShader::PacketShader()
    : m_plane_equations(static_cast<std::size_t>(kPacketSize) * (kMaxInterpolated + 1)),
      m_attributes(static_cast<std::size_t>(kMaxAttributes) * kAttributeStride),
      m_weights(2 * kPacketSize),
      m_texels(kPacketSize) {
    m_runs.reserve(kPacketSize);
    m_packet.attributes = m_attributes.data();
    m_packet.texel = m_texels.data();
    m_packet.weight_x = m_weights.data();
    m_packet.weight_y = m_weights.data() + kPacketSize;
}

void PacketShader::shade(const TileFragments& fragments, std::span<const ShadedDraw> draws,
                         const ShadedTile& tile, const KernelTable& kernels) {
    m_current = m_loaded = nullptr;
    m_runs.clear();  // an exception may have left fragments of an earlier tile
    m_packet.count = 0;
    m_packet.pixels = fragments.pixels;
    for (std::size_t k = 0; k < fragments.triangles.size(); ++k) {
        int left = fragments.size[k];
        if (left == 0) continue;
        const SetupTriangle& triangle = *fragments.triangles[k];
        const ShadedDraw& draw = draws[triangle.draw];
        if (draw.shading != m_current) {
            shade_packet(tile, kernels);
            m_current = draw.shading;
        }
        const auto planes = static_cast<std::size_t>(m_current->interpolated()) + 1;
        AttributePlane* equations = m_plane_equations.data() + m_runs.size() * planes;
        attribute_planes(*m_current, draw.mesh, triangle, equations);
        while (left > 0) {
            const int count = std::min(left, kPacketSize - m_packet.count);
            m_runs.push_back({equations, m_packet.count, count, tile.left - triangle.reference_x,
                              tile.top - triangle.reference_y});
            m_packet.count += count;
            left -= count;
            if (m_packet.count < kPacketSize) continue;
            shade_packet(tile, kernels);
            if (left > 0) {  // its equations become the first of the next packet
                equations = std::copy_n(equations, planes, m_plane_equations.data()) - planes;
            }
        }
    }
    shade_packet(tile, kernels);
}

void PacketShader::shade_packet(const ShadedTile& tile, const KernelTable& kernels) {
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
    burnish::shade_packet(*m_current, kernels, runs, tile.format, tile.pixels, m_packet);
    m_shaded += static_cast<std::uint64_t>(m_packet.count);
    m_packet.pixels += m_packet.count;
    m_packet.count = 0;
    m_runs.clear();
}

}  // namespace burnish
