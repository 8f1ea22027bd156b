#include "shade/packets.hpp"

#include <algorithm>
#include <bit>

namespace burnish {

PacketShader::PacketShader()
    : m_pixels(kPacketSize + PixelList::kSlack),
      m_stored(kPacketSize + PixelList::kSlack),
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
    forget_columns();
}

void PacketShader::shade(const TileFragments& fragments, std::span<const ShadedDraw> draws,
                         const KernelTable& kernels) {
    const auto& triangles = fragments.triangles;
    for (std::size_t first = 0, end = 0; first < triangles.size(); first = end) {
        const std::uint32_t draw = triangles[first]->draw;
        const auto same = [&](const SetupTriangle* t) { return t->draw == draw; };
        end = static_cast<std::size_t>(
            std::partition_point(triangles.begin() + static_cast<std::ptrdiff_t>(first),
                                 triangles.end(), same) -
            triangles.begin());
        const std::uint32_t pixel = fragments.first[first];
        const auto count = static_cast<int>(fragments.first[end] - pixel);
        if (count == 0) continue;
        start_draw(draws[draw], kernels);
        if (m_interpolates || m_needs_depth) {
            list_visible(fragments, first, end);
            if (m_draw.shading->quads_of_pixels) {
                shade_pixel_quads(fragments.pixels, kernels);
            } else {
                shade_visible(fragments.pixels, kernels);
            }
        } else {  // then all triangles of the draw are one
            append(*triangles[first], {fragments.pixels + pixel, nullptr, count}, kernels);
        }
    }
    shade_packet(kernels);
}

/// Whether a triangle is visible is hard to predict, so every one is written.
void PacketShader::list_visible(const TileFragments& fragments, std::size_t first,
                                std::size_t end) {
    m_visible.resize(end - first + 1);
    std::size_t visible = 0;
    for (std::size_t k = first; k < end; ++k) {
        m_visible[visible] = {fragments.triangles[k], fragments.first[k]};
        visible += fragments.first[k + 1] != fragments.first[k] ? 1 : 0;
    }
    m_visible[visible] = {nullptr, fragments.first[end]};
    m_visible.resize(visible + 1);
}

void PacketShader::shade_visible(const std::uint16_t* pixels, const KernelTable& kernels) {
    const bool quads = m_draw.shading->quads;
    for (std::size_t k = 0; k + 1 < m_visible.size(); ++k) {
        if (m_interpolates && m_next_column == m_planes.size()) look_ahead(k);
        const auto [triangle, first] = m_visible[k];
        const auto count = static_cast<int>(m_visible[k + 1].first - first);
        if (!quads && m_packet.count + count < kPacketSize) {  // as append does it
            if (m_packet.count == 0) m_packet.pixels = pixels + first;
            m_copied = false;
            if (m_interpolates) ++m_next_column;
            add_run(*triangle, count);
        } else if (quads) {
            PixelMask mask;
            mask_pixels(pixels + first, count, mask);
            list_quads(mask, m_list);
            append(*triangle, {m_list.shaded, m_list.stored, m_list.count}, kernels);
        } else {
            append(*triangle, {pixels + first, nullptr, count}, kernels);
        }
    }
}

void PacketShader::shade_pixel_quads(const std::uint16_t* pixels, const KernelTable& kernels) {
    const std::uint32_t begin = m_visible.front().first, end = m_visible.back().first;
    m_seen.resize(kTilePixels);
    for (std::size_t k = 0; k + 1 < m_visible.size(); ++k)
        for (std::uint32_t i = m_visible[k].first; i < m_visible[k + 1].first; ++i)
            m_seen[pixels[i]] = m_visible[k].triangle;
    PixelMask mask;
    mask_pixels(pixels + begin, static_cast<int>(end - begin), mask);
    list_quads(mask, m_list);
    const auto triangle_at = [&](int i) {
        int shown = i;
        for (int k = i & ~3; m_list.stored[shown] == kNoPixel; ++k) shown = k;
        return m_seen[m_list.shaded[shown]];
    };
    for (int first = 0, next = 0; first < m_list.count; first = next) {
        const SetupTriangle* const triangle = triangle_at(first);
        for (next = first + 1; next < m_list.count && triangle_at(next) == triangle;) ++next;
        append(*triangle, {m_list.shaded + first, m_list.stored + first, next - first}, kernels);
    }
}

void PacketShader::add(const SetupTriangle& triangle, const PixelMask& pixels,
                       const KernelTable& kernels) {
    if (holds_any(pixels)) shade_packet(kernels);
    if (m_draw.shading->quads) {
        list_quads(pixels, m_list);
    } else {
        list_pixels(pixels, m_list);
    }
    const std::uint16_t* const stored = m_draw.shading->quads ? m_list.stored : m_list.shaded;
    append(triangle, {m_list.shaded, stored, m_list.count}, kernels);
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
    m_interpolates = draw.shading->interpolated() > 0 || draw.shown != nullptr;
    m_needs_depth = draw.output->late_depth || draw.shown != nullptr;
    forget_columns();
}

void PacketShader::forget_columns() {
    m_planes.clear();
    m_first_column = m_next_column = 0;
}

/// Columns for the visible triangles from number `first` on, as many as there is room for.
void PacketShader::look_ahead(std::size_t first) {
    make_room();
    for (std::size_t k = first; k + 1 < m_visible.size() && !m_planes.full(); ++k) {
        const SetupTriangle& triangle = *m_visible[k].triangle;
        __builtin_prefetch(&m_draw.mesh.indices[std::size_t{3} * triangle.number]);
        m_planes.push(triangle);
    }
}

/// Forgets the columns before the packet's. It holds less than kPacketSize fragments, and so runs.
void PacketShader::make_room() {
    m_planes.drop(m_first_column);
    m_next_column -= m_first_column;
    m_first_column = 0;
}

void PacketShader::take_column(const SetupTriangle& triangle) {
    if (m_next_column == m_planes.size()) {
        if (m_planes.full()) make_room();
        m_planes.push(triangle);
    }
    ++m_next_column;
}

void PacketShader::add_run(const SetupTriangle& triangle, int count) {
    const int first = m_packet.count;
    const std::int32_t offset_x = m_tile.left - triangle.reference_x,
                       offset_y = m_tile.top - triangle.reference_y;
    m_packet.count += count;
    if (m_interpolates) m_runs.push_back({first, count, offset_x, offset_y});
    if (!m_needs_depth) return;
    m_depth_runs.push_back({triangle.z, triangle.zx, triangle.zy, triangle.z_low, triangle.z_high,
                            first, count, offset_x, offset_y});
}

void PacketShader::append(const SetupTriangle& triangle, Fragments fragments,
                          const KernelTable& kernels) {
    if (m_interpolates) take_column(triangle);
    while (fragments.count > 0) {
        const int first = m_packet.count;
        const int count = std::min(fragments.count, kPacketSize - first);
        m_copied = fragments.stored != nullptr;
        if (m_copied) {
            if (stores_apart()) std::copy_n(fragments.stored, count, m_stored.data() + first);
            fragments.stored += count;
        }
        if (m_copied && count < kPacketSize) {  // and so may wait for others
            m_packet.pixels = m_pixels.data();
            std::copy_n(fragments.shaded, count, m_pixels.data() + first);
        } else if (first == 0) {
            m_packet.pixels = fragments.shaded;
        }
        add_run(triangle, count);
        fragments.shaded += count;
        fragments.count -= count;
        if (m_packet.count < kPacketSize) continue;
        shade_packet(kernels);
        if (m_interpolates && fragments.count > 0) --m_first_column;
    }
}

void PacketShader::shade_packet(const KernelTable& kernels) {
    if (m_packet.count == 0) return;
    const Shading& shading = *m_draw.shading;
    const FragmentOutput& output = *m_draw.output;
    if (m_draw.shown == nullptr || output.late_depth) shade_colors(shading, kernels);
    if (stores_apart()) {
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
    m_first_column = m_next_column;
    m_pending.blocks = 0;
}

AttributesCtx PacketShader::runs(const Shading& shading, const KernelTable& kernels) {
    const int count = shading.interpolated();
    if (count == 0) return {m_runs.data(), static_cast<int>(m_runs.size()), 0, nullptr};
    const float* const equations = m_planes.equations(shading, m_draw.mesh, kernels);
    return {m_runs.data(), static_cast<int>(m_runs.size()), count, equations + m_first_column};
}

void PacketShader::shade_colors(const Shading& shading, const KernelTable& kernels) {
    const auto planes = static_cast<std::size_t>(shading.program.plane_count) * kPacketSize;
    if (m_registers.size() < planes) {
        m_registers.resize(planes);
        m_loaded = nullptr;
    }
    m_packet.planes = m_registers.data();
    if (m_loaded != &shading) load_constants(shading.program, m_packet);
    m_loaded = &shading;
    burnish::shade_packet(shading, kernels, runs(shading, kernels), m_packet);
}

void PacketShader::write_colors(const Shading& shading, const std::optional<Blend>& blend,
                                const KernelTable& kernels) {
    if (stores_apart()) m_packet.pixels = m_stored.data();
    write_pixels(shading.result, shading.program.numbers, blend, kernels, m_tile.output, m_packet);
}

/// The triangles are interpolated once more, for the values.
void PacketShader::show_values(const KernelTable& kernels) {
    const ShownValues& shown = *m_draw.shown;
    m_shown_runs.clear();
    for (std::size_t i = 0; i < m_runs.size(); ++i) {
        const SetupTriangle& triangle = m_planes.triangle(m_first_column + i);
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
    kernels.attributes(m_packet, runs(shown.values, kernels));
    write_values(shown, m_packet, m_shown_runs, depth >= 0 ? own_depths : nullptr,
                 stores_apart() ? m_stored.data() : m_packet.pixels, m_tile.output);
}

}  // namespace burnish
