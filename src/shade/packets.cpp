#include "shade/packets.hpp"

#include <algorithm>
#include <bit>

#include "shade/attributes.hpp"

namespace burnish {

PacketShader::PacketShader()
    : m_pixels(kPacketSize + PixelList::kSlack),
      m_stored(kPacketSize + PixelList::kSlack),
      m_plane_equations(static_cast<std::size_t>(kPacketSize) * (kMaxInterpolated + 1)),
      m_attributes(static_cast<std::size_t>(kMaxAttributes) * kAttributeStride),
      m_weights(2 * kPacketSize),
      m_texels(kPacketSize) {
    m_runs.reserve(kPacketSize);
    m_depth_runs.reserve(kPacketSize);
    m_packet.attributes = m_attributes.data();
    m_packet.texel = m_texels.data();
    m_packet.weight_x = m_weights.data();
    m_packet.weight_y = m_weights.data() + kPacketSize;
}

void PacketShader::begin(const ShadedTile& tile) {
    m_tile = tile;
    m_draw = {};
    m_loaded = nullptr;
    m_pending.blocks = 0;
    m_packet.count = 0;
    m_runs.clear();
    m_depth_runs.clear();
    m_shown_triangles.clear();
}

void PacketShader::shade(const TileFragments& fragments, std::span<const ShadedDraw> draws,
                         const KernelTable& kernels) {
    const std::uint16_t* pixels = fragments.pixels;
    for (std::size_t k = 0; k < fragments.triangles.size(); ++k) {
        const int count = fragments.size[k];
        if (count == 0) continue;
        const SetupTriangle& triangle = *fragments.triangles[k];
        start_draw(draws[triangle.draw], kernels);
        if (m_draw.shading->quads) {
            PixelMask mask;
            mask_pixels(pixels, count, mask);
            list_quads(mask, m_list);
            append(triangle, {m_list.shaded, m_list.stored, m_list.count}, kernels);
        } else {
            append(triangle, {pixels, nullptr, count}, kernels);
        }
        pixels += count;
    }
    shade_packet(kernels);
}

void PacketShader::add(const SetupTriangle& triangle, const PixelMask& pixels,
                       const KernelTable& kernels) {
    if (holds_any(pixels)) shade_packet(kernels);
    if (m_draw.shading->quads) {
        list_quads(pixels, m_list);
    } else {
        list_pixels(pixels, m_list);
    }
    append(triangle, {m_list.shaded, m_list.stored, m_list.count}, kernels);
    if (m_packet.count > 0) hold(pixels);
}

void PacketShader::flush(const KernelTable& kernels) {
    shade_packet(kernels);
}

bool PacketShader::holds_any(const PixelMask& pixels) const {
    for (std::uint64_t rest = m_pending.blocks & pixels.blocks; rest != 0; rest &= rest - 1) {
        const auto block = static_cast<std::size_t>(std::countr_zero(rest));
        if ((m_pending.word[block] & pixels.word[block]) != 0) return true;
    }
    return false;
}

void PacketShader::hold(const PixelMask& pixels) {
    for (std::uint64_t rest = pixels.blocks; rest != 0; rest &= rest - 1) {
        const auto block = static_cast<std::size_t>(std::countr_zero(rest));
        const bool known = (m_pending.blocks >> block & 1) != 0;
        m_pending.word[block] = pixels.word[block] | (known ? m_pending.word[block] : 0);
    }
    m_pending.blocks |= pixels.blocks;
}

void PacketShader::start_draw(const ShadedDraw& draw, const KernelTable& kernels) {
    if (draw.shading == m_draw.shading) return;
    shade_packet(kernels);
    m_draw = draw;
}

void PacketShader::append(const SetupTriangle& triangle, Fragments fragments,
                          const KernelTable& kernels) {
    const auto planes = static_cast<std::size_t>(m_draw.shading->interpolated()) + 1;
    AttributePlane* equations = m_plane_equations.data() + m_runs.size() * planes;
    attribute_planes(*m_draw.shading, m_draw.mesh, triangle, equations);
    const std::int32_t offset_x = m_tile.left - triangle.reference_x,
                       offset_y = m_tile.top - triangle.reference_y;
    while (fragments.count > 0) {
        const int first = m_packet.count;
        const int count = std::min(fragments.count, kPacketSize - first);
        m_runs.push_back({equations, first, count, offset_x, offset_y});
        m_copied = fragments.stored != nullptr;
        if (m_copied) {
            m_packet.pixels = m_pixels.data();
            std::copy_n(fragments.shaded, count, m_pixels.data() + first);
            std::copy_n(fragments.stored, count, m_stored.data() + first);
            fragments.stored += count;
        } else if (first == 0) {
            m_packet.pixels = fragments.shaded;
        }
        if (m_draw.shown != nullptr) m_shown_triangles.push_back(&triangle);
        if (m_draw.output->late_depth || m_draw.shown != nullptr) {
            m_depth_runs.push_back({triangle.z, triangle.zx, triangle.zy, triangle.z_low,
                                    triangle.z_high, first, count, offset_x, offset_y});
        }
        fragments.shaded += count;
        fragments.count -= count;
        m_packet.count += count;
        if (m_packet.count < kPacketSize) continue;
        shade_packet(kernels);
        if (fragments.count > 0) {  // its equations become the first of the next packet
            equations = std::copy_n(equations, planes, m_plane_equations.data()) - planes;
        }
    }
}

void PacketShader::shade_packet(const KernelTable& kernels) {
    if (m_packet.count == 0) return;
    const Shading& shading = *m_draw.shading;
    const FragmentOutput& output = *m_draw.output;
    if (m_draw.shown == nullptr || output.late_depth) shade_colors(shading, kernels);
    if (m_copied) {
        test_fragments(shading, output, kernels, m_depth_runs.data(),
                       static_cast<int>(m_depth_runs.size()), m_tile.output, m_stored.data(),
                       m_packet);
    }
    if (m_tile.output.pixels == nullptr) {
        // The tests have left the depths.
    } else if (m_draw.shown != nullptr) {
        show_values(kernels);
    } else {
        write_colors(shading, output.blend, kernels);
    }
    m_shaded += static_cast<std::uint64_t>(m_packet.count);
    m_packet.pixels += m_packet.count;
    m_packet.count = 0;
    m_runs.clear();
    m_depth_runs.clear();
    m_shown_triangles.clear();
    m_pending.blocks = 0;
}

void PacketShader::shade_colors(const Shading& shading, const KernelTable& kernels) {
    const auto planes = static_cast<std::size_t>(shading.program.plane_count) * kPacketSize;
    if (m_planes.size() < planes) {
        m_planes.resize(planes);
        m_loaded = nullptr;
    }
    m_packet.planes = m_planes.data();
    if (m_loaded != &shading) load_constants(shading.program, m_packet);
    m_loaded = &shading;
    const AttributesCtx runs{m_runs.data(), static_cast<int>(m_runs.size()),
                             shading.interpolated()};
    burnish::shade_packet(shading, kernels, runs, m_packet);
}

void PacketShader::write_colors(const Shading& shading, const std::optional<Blend>& blend,
                                const KernelTable& kernels) {
    if (m_copied) m_packet.pixels = m_stored.data();
    write_pixels(shading.result, shading.program.numbers, blend, kernels, m_tile.output, m_packet);
}

/// The triangles are interpolated once more, for the values.
void PacketShader::show_values(const KernelTable& kernels) {
    const ShownValues& shown = *m_draw.shown;
    const auto planes = static_cast<std::size_t>(shown.values.interpolated()) + 1;
    m_shown_equations.resize(m_runs.size() * planes);
    m_shown_runs.clear();
    for (std::size_t i = 0; i < m_runs.size(); ++i) {
        const SetupTriangle& triangle = *m_shown_triangles[i];
        m_runs[i].planes = m_shown_equations.data() + i * planes;
        attribute_planes(shown.values, m_draw.mesh, triangle,
                         m_shown_equations.data() + i * planes);
        m_shown_runs.push_back({m_depth_runs[i], triangle.draw, triangle.number});
    }
    if (!shown.aov) {
        shade_colors(shown.values, kernels);
        return write_colors(shown.values, std::nullopt, kernels);
    }
    float own_depths[kPacketSize];
    const int depth = m_draw.shading->depth_attribute;
    if (depth >= 0) {
        std::copy_n(m_packet.attributes + depth * kAttributeStride, kPacketSize, own_depths);
    }
    kernels.attributes(
        m_packet, {m_runs.data(), static_cast<int>(m_runs.size()), shown.values.interpolated()});
    write_values(shown, m_packet, m_shown_runs, depth >= 0 ? own_depths : nullptr,
                 m_copied ? m_stored.data() : m_packet.pixels, m_tile.output);
}

}  // namespace burnish
