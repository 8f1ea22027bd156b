#include "raster/bin.hpp"

#include <algorithm>

#include "core/stage_clock.hpp"
#include "geometry/clip.hpp"

namespace burnish {

namespace {

constexpr std::int32_t tiles(std::int32_t pixels) {
    return (pixels + kTileSize - 1) / kTileSize;
}

/// The part of a tiny triangle in one of up to four tiles: what lies before the tile is shifted out
/// of the mask, what lies behind it is cut. x and y: from the tile to the mask's corner.
TileEntry tiny_part(const TileEntry& whole, std::int32_t x, std::int32_t y) {
    constexpr std::uint64_t kRows = 0x0101010101010101U, kAll = ~std::uint64_t{0};
    std::uint64_t inside = kAll;
    const std::int32_t left = std::max(-x, 0), right = std::max(x + kTinySize - kTileSize, 0);
    const std::int32_t above = std::max(-y, 0), below = std::max(y + kTinySize - kTileSize, 0);
    inside &= (0xffU << left & 0xffU >> right) * kRows;
    inside &= kAll << kTinySize * above & kAll >> kTinySize * below;
    return {(whole.covered & inside) >> (left + kTinySize * above), whole.triangle,
            static_cast<std::uint8_t>(std::max(x, 0)), static_cast<std::uint8_t>(std::max(y, 0))};
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
    return m_count * (sizeof(SetupTriangle) + sizeof(std::uint64_t)) +
           m_unsorted.size() * sizeof(PlacedEntry) + m_entries.size() * sizeof(TileEntry) +
           m_first.size() * sizeof(std::uint32_t);
}

std::span<const TileEntry> Chunk::tile(std::int32_t x, std::int32_t y) const {
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

void Chunk::fill(const ChunkSource& source, std::size_t first, std::size_t last,
                 const KernelTable& kernels) {
    const StageScope setup(FrameStage::setup, last - first);
    m_count = 0;
    m_unsorted.clear();
    m_counts = {};
    m_counts.submitted = last - first;
    SetupCtx ctx{};
    ctx.vertices = source.mesh.screen.data();
    ctx.draw = source.draw;
    ctx.width = source.frame.width;
    ctx.height = source.frame.height;
    ctx.drop_positive = source.facing == Facing::front_only ? 1 : 0;
    ctx.drop_negative = source.facing == Facing::back_only ? 1 : 0;
    for (std::size_t i = first; i < last; ++i) {
        ctx.indices = source.mesh.indices.data() + 3 * i;
        ctx.number = static_cast<std::uint32_t>(i);
        ctx.count = static_cast<std::int32_t>(last - i);
        const SetupCounts counts = set_up(ctx, kernels);
        m_counts.nonfinite += static_cast<std::uint64_t>(counts.nonfinite);
        m_counts.degenerate += static_cast<std::uint64_t>(counts.degenerate);
        i += static_cast<std::size_t>(counts.taken);
        if (i < last) add_clipped(source, i, ctx, kernels);
    }
    const StageScope bin(FrameStage::bin, m_count);
    for (std::uint32_t i = 0; i < m_count; ++i) add_to_tiles(i);
    sort_into_tiles(source.frame);
}

/// Appends the triangles that are drawn.
SetupCounts Chunk::set_up(SetupCtx ctx, const KernelTable& kernels) {
    const std::size_t room = m_count + static_cast<std::size_t>(ctx.count) + 1;
    if (m_triangles.size() < room) {
        m_triangles.resize(room);
        m_covered.resize(room);
    }
    SetupCounts counts{};
    ctx.triangles = m_triangles.data() + m_count;
    ctx.covered = m_covered.data() + m_count;
    ctx.counts = &counts;
    kernels.setup(ctx);
    m_count += static_cast<std::size_t>(counts.drawn);
    return counts;
}

/// Triangle `number` of the draw; `ctx` as for the others.
void Chunk::add_clipped(const ChunkSource& source, std::size_t number, SetupCtx ctx,
                        const KernelTable& kernels) {
    const auto& homogeneous = source.mesh.homogeneous;
    const std::span vertex = source.mesh.indices.subspan(3 * number, 3);
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
            if ((corners[i].outcode & Outcode::needs_clip) == 0) {
                corners[i].outcode = 0;
                continue;
            }
        }
        if (!project(v, source.viewport, corners[i])) return;
    }
    std::uint32_t indices[3 * ClipPolygon::kMaxCorners];
    ctx.count = polygon.count - 2;
    for (int i = 0; i < ctx.count; ++i) {
        indices[3 * i] = 0;
        indices[3 * i + 1] = static_cast<std::uint32_t>(i) + 1;
        indices[3 * i + 2] = static_cast<std::uint32_t>(i) + 2;
    }
    ctx.vertices = corners;
    ctx.indices = indices;
    const std::size_t before = m_count;
    set_up(ctx, kernels);
    for (std::size_t i = before; i < m_count; ++i) {
        m_triangles[i].number = static_cast<std::uint32_t>(number);
        m_triangles[i].clipped = 1;
    }
}

void Chunk::add_to_tiles(std::uint32_t index) {
    const PixelRect& box = m_triangles[index].box;
    const TileEntry whole{m_covered[index], index, static_cast<std::uint8_t>(box.x0 % kTileSize),
                          static_cast<std::uint8_t>(box.y0 % kTileSize)};
    const std::int32_t x0 = box.x0 / kTileSize, x1 = box.x1 / kTileSize;
    const std::int32_t y0 = box.y0 / kTileSize, y1 = box.y1 / kTileSize;
    if (x0 == x1 && y0 == y1) {
        add_entry(x0, y0, whole);
        ++m_counts.binned;
        return;
    }
    const std::size_t before = m_unsorted.size();
    for (std::int32_t y = y0; y <= y1; ++y) {
        for (std::int32_t x = x0; x <= x1; ++x) {
            if (whole.covered != 0) {
                const TileEntry part =
                    tiny_part(whole, box.x0 - x * kTileSize, box.y0 - y * kTileSize);
                if (part.covered != 0) add_entry(x, y, part);
                continue;
            }
            TileTriangle seen;
            if (tile_triangle(m_triangles[index], x, y, seen)) add_entry(x, y, whole);
        }
    }
    if (m_unsorted.size() != before) ++m_counts.binned;
}

void Chunk::add_entry(std::int32_t x, std::int32_t y, const TileEntry& entry) {
    m_unsorted.push_back({static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y), entry});
}

/// Counting sort over the rectangle of tiles that the chunk touches; stable, so order is kept.
void Chunk::sort_into_tiles(FrameSize frame) {
    std::int32_t x1 = -1, y1 = -1;
    m_x0 = tiles(frame.width);
    m_y0 = tiles(frame.height);
    for (const PlacedEntry& e : m_unsorted) {
        m_x0 = std::min<std::int32_t>(m_x0, e.x);
        m_y0 = std::min<std::int32_t>(m_y0, e.y);
        x1 = std::max<std::int32_t>(x1, e.x);
        y1 = std::max<std::int32_t>(y1, e.y);
    }
    m_width = std::max(x1 - m_x0 + 1, 0);
    m_height = std::max(y1 - m_y0 + 1, 0);
    const auto place = [&](const PlacedEntry& e) {
        return static_cast<std::size_t>((e.y - m_y0) * m_width + (e.x - m_x0));
    };
    // m_first[t + 1] first counts tile t, then runs through its entries, and ends as its end.
    m_first.assign(static_cast<std::size_t>(m_width) * static_cast<std::size_t>(m_height) + 2, 0);
    for (const PlacedEntry& e : m_unsorted) ++m_first[place(e) + 2];
    for (std::size_t t = 2; t < m_first.size(); ++t) m_first[t] += m_first[t - 1];
    m_entries.resize(m_unsorted.size());
    for (const PlacedEntry& e : m_unsorted) m_entries[m_first[place(e) + 1]++] = e.entry;
}

}  // namespace burnish
