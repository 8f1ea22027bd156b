#include "raster/bin.hpp"

#include <algorithm>

#include "core/stage_clock.hpp"
#include "geometry/clip.hpp"

namespace burnish {

namespace {

constexpr std::int32_t tiles(std::int32_t pixels) {
    return (pixels + kTileSize - 1) / kTileSize;
}

}  // namespace

std::size_t chunk_size(FrameSize frame, std::size_t triangles) {
    constexpr std::size_t kMaxEntries = std::size_t{1} << 23;
    constexpr std::size_t kChunks = 32;  // 5 instead of 32 left one of two workers idle a fifth
    const auto count = static_cast<std::size_t>(tiles(frame.width)) *
                       static_cast<std::size_t>(tiles(frame.height));
    const std::size_t most = std::clamp<std::size_t>(kMaxEntries / count, 64, 4096);
    return std::clamp<std::size_t>(triangles / kChunks, 64, most);
}

std::size_t Chunk::bytes() const {
    return m_triangles.size() * sizeof(SetupTriangle) + m_unsorted.size() * sizeof(TileEntry) +
           (m_entries.size() + m_first.size()) * sizeof(std::uint32_t);
}

std::span<const std::uint32_t> Chunk::tile(std::int32_t x, std::int32_t y) const {
    const std::int32_t column = x - m_x0, row = y - m_y0;
    if (column < 0 || row < 0 || column >= m_width || row >= m_height) return {};
    const auto at = static_cast<std::size_t>(row * m_width + column);
    return std::span(m_entries).subspan(m_first[at], m_first[at + 1] - m_first[at]);
}

void Chunk::add_lengths(std::uint64_t number, std::span<std::uint32_t> lengths,
                        std::span<std::uint64_t> sums, std::size_t columns) const {
    std::size_t entry = 0;
    for (std::int32_t y = m_y0; y < m_y0 + m_height; ++y) {
        const auto row = static_cast<std::size_t>(y) * columns + static_cast<std::size_t>(m_x0);
        for (std::size_t tile = row; tile < row + static_cast<std::size_t>(m_width); ++tile) {
            const std::uint32_t length = m_first[entry + 1] - m_first[entry];
            lengths[tile] += length;
            sums[tile] += number * length;
            ++entry;
        }
    }
}

void Chunk::fill(const ChunkSource& source, std::size_t first, std::size_t last) {
    const StageScope setup(FrameStage::setup, last - first);
    m_triangles.clear();
    m_unsorted.clear();
    m_counts = {};
    m_counts.submitted = last - first;
    const auto& indices = source.mesh.indices;
    for (std::size_t i = 3 * first; i < 3 * last; i += 3) {
        add(source,
            {static_cast<std::uint32_t>(i / 3), {indices[i], indices[i + 1], indices[i + 2]}});
    }
    m_counts.binned = m_triangles.size();
    const StageScope scope(FrameStage::bin, m_counts.binned);
    sort_into_tiles(source.frame);
}

void Chunk::add(const ChunkSource& source, const SourceTriangle& from) {
    const auto& screen = source.mesh.screen;
    const auto& vertex = from.vertex;
    const ScreenVertex &v0 = screen[vertex[0]], &v1 = screen[vertex[1]], &v2 = screen[vertex[2]];
    const std::uint32_t any = v0.outcode | v1.outcode | v2.outcode;
    if ((any & Outcode::nonfinite) != 0) {
        ++m_counts.nonfinite;
        return;
    }
    if ((v0.outcode & v1.outcode & v2.outcode & Outcode::frustum) != 0) return;
    if ((any & Outcode::needs_clip) != 0) return add_clipped(source, from);
    const SetupResult result = add_projected(source, from, false, v0, v1, v2);
    if (result == SetupResult::degenerate) ++m_counts.degenerate;
}

void Chunk::add_clipped(const ChunkSource& source, const SourceTriangle& from) {
    const auto& homogeneous = source.mesh.homogeneous;
    const auto& vertex = from.vertex;
    const ClipPolygon polygon =
        clip_triangle(homogeneous[vertex[0]], homogeneous[vertex[1]], homogeneous[vertex[2]]);
    if (polygon.count == 0) return;
    ++m_counts.clipped;
    ScreenVertex corners[ClipPolygon::kMaxCorners];
    for (int i = 0; i < polygon.count; ++i) {
        const ClipVertex& v = polygon.corner[static_cast<std::size_t>(i)];
        // A corner of the triangle keeps the position that its neighbours see.
        if (v.original >= 0) {
            corners[i] = source.mesh.screen[vertex[static_cast<std::size_t>(v.original)]];
            if ((corners[i].outcode & Outcode::needs_clip) == 0) continue;
        }
        if (!project(v, source.viewport, corners[i])) return;
    }
    for (int i = 2; i < polygon.count; ++i) {
        add_projected(source, from, true, corners[0], corners[i - 1], corners[i]);
    }
}

SetupResult Chunk::add_projected(const ChunkSource& source, const SourceTriangle& from,
                                 bool clipped, const ScreenVertex& v0, const ScreenVertex& v1,
                                 const ScreenVertex& v2) {
    SetupTriangle triangle;
    const SetupResult result = setup_triangle(v0, v1, v2, source.facing, source.frame, triangle);
    if (result != SetupResult::drawn) return result;
    const std::size_t before = m_unsorted.size();
    add_to_tiles(triangle, static_cast<std::uint32_t>(m_triangles.size()));
    if (m_unsorted.size() == before) return SetupResult::culled;
    triangle.draw = source.draw & ((std::uint32_t{1} << 30) - 1);
    triangle.number = from.number;
    triangle.clipped = clipped ? 1 : 0;
    m_triangles.push_back(triangle);
    return result;
}

void Chunk::add_to_tiles(const SetupTriangle& triangle, std::uint32_t index) {
    const PixelRect& box = triangle.box;
    const std::int32_t x0 = box.x0 / kTileSize, x1 = box.x1 / kTileSize;
    const std::int32_t y0 = box.y0 / kTileSize, y1 = box.y1 / kTileSize;
    const bool one_tile = x0 == x1 && y0 == y1;
    for (std::int32_t y = y0; y <= y1; ++y) {
        for (std::int32_t x = x0; x <= x1; ++x) {
            TileTriangle seen;
            if (!one_tile && !tile_triangle(triangle, x, y, seen)) continue;
            m_unsorted.push_back(
                {static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y), index});
        }
    }
}

/// Counting sort over the rectangle of tiles that the chunk touches; stable, so order is kept.
void Chunk::sort_into_tiles(FrameSize frame) {
    std::int32_t x1 = -1, y1 = -1;
    m_x0 = tiles(frame.width);
    m_y0 = tiles(frame.height);
    for (const TileEntry& e : m_unsorted) {
        m_x0 = std::min<std::int32_t>(m_x0, e.x);
        m_y0 = std::min<std::int32_t>(m_y0, e.y);
        x1 = std::max<std::int32_t>(x1, e.x);
        y1 = std::max<std::int32_t>(y1, e.y);
    }
    m_width = std::max(x1 - m_x0 + 1, 0);
    m_height = std::max(y1 - m_y0 + 1, 0);
    const auto place = [&](const TileEntry& e) {
        return static_cast<std::size_t>((e.y - m_y0) * m_width + (e.x - m_x0));
    };
    // m_first[t + 1] first counts tile t, then runs through its entries, and ends as its end.
    m_first.assign(static_cast<std::size_t>(m_width) * static_cast<std::size_t>(m_height) + 2, 0);
    for (const TileEntry& e : m_unsorted) ++m_first[place(e) + 2];
    for (std::size_t t = 2; t < m_first.size(); ++t) m_first[t] += m_first[t - 1];
    m_entries.resize(m_unsorted.size());
    for (const TileEntry& e : m_unsorted) m_entries[m_first[place(e) + 1]++] = e.triangle;
}

}  // namespace burnish
