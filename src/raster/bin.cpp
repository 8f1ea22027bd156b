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
            static_cast<std::uint8_t>(std::max(x, 0)), static_cast<std::uint8_t>(std::max(y, 0)),
            0};
}

}  // namespace

std::size_t chunk_size(FrameSize frame, std::size_t triangles) {
    constexpr std::size_t kMaxEntries = std::size_t{1} << 23;
    constexpr std::size_t kChunks = 32;  // 5 instead of 32 left one of two workers idle a fifth
    const auto count = static_cast<std::size_t>(tiles(frame.width)) *
                       static_cast<std::size_t>(tiles(frame.height));
    constexpr std::size_t kLargest = 4096;
    static_assert(kLargest * (ClipPolygon::kMaxCorners - 2) <= kMostEntries);  // of one tile
    const std::size_t most = std::clamp<std::size_t>(kMaxEntries / count, 64, kLargest);
    return std::clamp<std::size_t>(triangles / kChunks, 64, most);
}

std::size_t Chunk::bytes() const {
    return m_count * (sizeof(SetupTriangle) + sizeof(SetupPlace)) +
           m_parts.size() * sizeof(PlacedEntry) + m_entries.size() * sizeof(TileEntry) +
           m_first.size() * sizeof(std::uint32_t);
}

void Chunk::fill(const ChunkSource& source, std::size_t first, std::size_t last,
                 const KernelTable& kernels) {
    const StageScope setup(FrameStage::setup, last - first);
    m_count = 0;
    m_parts.clear();
    m_bounds = {32767, 32767, -1, -1};
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
    m_counts.binned = m_count;
    const StageScope bin(FrameStage::bin, m_count);
    sort_into_tiles();
}

/// Appends the triangles that are drawn.
SetupCounts Chunk::set_up(SetupCtx ctx, const KernelTable& kernels) {
    const std::size_t room = m_count + static_cast<std::size_t>(ctx.count) + 1;
    // Each on its own: a frame that ran out of memory may have left one of them behind.
    if (m_triangles.size() < room) m_triangles.resize(room);
    if (m_places.size() < room) m_places.resize(room);
    SetupCounts counts{};
    ctx.triangles = m_triangles.data() + m_count;
    ctx.places = m_places.data() + m_count;
    ctx.counts = &counts;
    kernels.setup(ctx);
    m_count += static_cast<std::size_t>(counts.drawn);
    m_bounds = {std::min(m_bounds.x0, counts.bounds.x0), std::min(m_bounds.y0, counts.bounds.y0),
                std::max(m_bounds.x1, counts.bounds.x1), std::max(m_bounds.y1, counts.bounds.y1)};
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

/// Counting sort over the rectangle of tiles that the chunk may touch; stable, so order is kept.
void Chunk::sort_into_tiles() {
    m_tiles = {0, 0, -1, -1};
    if (m_count != 0) {
        m_tiles = {m_bounds.x0 / kTileSize, m_bounds.y0 / kTileSize, m_bounds.x1 / kTileSize,
                   m_bounds.y1 / kTileSize};
    }
    const auto rows = static_cast<std::size_t>(m_tiles.y1 - m_tiles.y0 + 1);
    // m_first[t + 1] first counts tile t, then runs through its entries, and ends as its end.
    m_first.assign(static_cast<std::size_t>(columns()) * rows + 2, 0);
    for (std::uint32_t i = 0; i < m_count; ++i) {
        const SetupPlace& place = m_places[i];
        if (place.tiles == 0) {
            ++m_first[tile_number(place.x / kTileSize, place.y / kTileSize) + 2];
        } else {
            add_parts(i);
        }
    }
    for (const PlacedEntry& part : m_parts) ++m_first[part.tile + 2];
    for (std::size_t t = 2; t < m_first.size(); ++t) m_first[t] += m_first[t - 1];
    m_entries.resize(m_first.back());
    auto part = m_parts.begin();
    for (std::uint32_t i = 0; i < m_count; ++i) {
        const SetupPlace& place = m_places[i];
        if (place.tiles == 0) {
            const std::size_t tile = tile_number(place.x / kTileSize, place.y / kTileSize);
            m_entries[m_first[tile + 1]++] = {place.covered, i,
                                              static_cast<std::uint8_t>(place.x % kTileSize),
                                              static_cast<std::uint8_t>(place.y % kTileSize), 0};
            continue;
        }
        for (; part != m_parts.end() && part->entry.triangle == i; ++part)
            m_entries[m_first[part->tile + 1]++] = part->entry;
    }
}

/// A triangle whose box lies in several tiles, in those that it touches.
void Chunk::add_parts(std::uint32_t index) {
    const SetupTriangle& triangle = m_triangles[index];
    const PixelRect& box = triangle.box;
    const SetupPlace& place = m_places[index];
    const auto is_large = static_cast<std::uint8_t>(place.tiles == SetupPlace::kLarge ? 1 : 0);
    const TileEntry whole{place.covered, index, 0, 0, is_large};
    // Two tiles of a small one are listed as they are: hardly any has none of its pixels.
    const std::int32_t rows = box.y1 / kTileSize - box.y0 / kTileSize + 1,
                       columns = box.x1 / kTileSize - box.x0 / kTileSize + 1;
    const bool sure = is_large == 0 && rows * columns <= 2;
    for (std::int32_t y = box.y0 / kTileSize; y <= box.y1 / kTileSize; ++y) {
        for (std::int32_t x = box.x0 / kTileSize; x <= box.x1 / kTileSize; ++x) {
            TileEntry part = whole;
            TileTriangle seen;
            if (whole.covered != 0) {
                part = tiny_part(whole, box.x0 - x * kTileSize, box.y0 - y * kTileSize);
                if (part.covered == 0) continue;
            } else if (!sure && !tile_triangle(triangle, x, y, seen)) {
                continue;
            }
            m_parts.push_back({static_cast<std::uint32_t>(tile_number(x, y)), part});
        }
    }
}

}  // namespace burnish
