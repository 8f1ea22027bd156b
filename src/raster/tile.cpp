#include "raster/tile.hpp"

#include <algorithm>
#include <bit>
#include <utility>

namespace burnish {

namespace {

constexpr int kBatch = 32;       // triangles per call of the kernel: 4 KB
constexpr int kPixelSlack = 16;  // kernels write and read past the last pixel

void set_rule(const DepthRule& rule, TileTriangle& triangle) {
    triangle.pass_less = rule.pass_less;
    triangle.pass_equal = rule.pass_equal;
    triangle.pass_greater = rule.pass_greater;
    triangle.depth_write = rule.write;
}

enum class Size : std::uint8_t { tiny, small, large };
Size size_of(const TileEntry& entry) {
    if (entry.covered != 0) return Size::tiny;
    return entry.is_large != 0 ? Size::large : Size::small;
}

}  // namespace

TileVisibility::TileVisibility()
    : m_depth(kTilePixels + 1),
      m_block_far(kTileBlocks),
      m_id(kTilePixels + 1),
      m_pixels(kTilePixels + kPixelSlack) {}

void TileVisibility::begin(std::int32_t x, std::int32_t y, FrameSize frame, const float* depth) {
    m_tile_x = x;
    m_tile_y = y;
    m_frame = frame;
    m_triangles.clear();
    m_drawn.clear();
    const bool cleared = std::exchange(m_cleared, false);
    if (depth == nullptr) {
        if (!cleared) m_blank_depths.set();
        std::fill(m_block_far.begin(), m_block_far.end(), 1.0F);
        return;
    }
    m_blank_depths = {};
    std::copy_n(depth, kTilePixels, m_depth.begin());
    for (std::size_t block = 0; block < kTileBlocks; ++block) {
        const auto first = m_depth.begin() + static_cast<std::ptrdiff_t>(block * kBlockPixels);
        m_block_far[block] = *std::max_element(first, first + kBlockPixels);
    }
}

void TileVisibility::draw(const Chunk& chunk, std::span<const DepthRule> rules,
                          const KernelTable& kernels) {
    if (!shows_anything()) m_blank_ids.set();
    draw_entries(chunk, rules, kernels, m_id.data());
}

void TileVisibility::draw_depths(const Chunk& chunk, std::span<const DepthRule> rules,
                                 const KernelTable& kernels) {
    draw_entries(chunk, rules, kernels, nullptr);
}

/// `id`: the visibility buffer, or null for the depths alone.
void TileVisibility::draw_entries(const Chunk& chunk, std::span<const DepthRule> rules,
                                  const KernelTable& kernels, std::uint32_t* id) {
    const std::span<const TileEntry> entries = chunk.tile(m_tile_x, m_tile_y);
    for (auto first = entries.begin(); first != entries.end();) {
        const Size size = size_of(*first);
        const auto last = std::find_if(
            first, entries.end(), [&](const TileEntry& entry) { return size_of(entry) != size; });
        const std::span<const TileEntry> alike(first, last);
        if (size != Size::small || id == nullptr) fill_depths(kernels);
        if (size != Size::small && id != nullptr) fill_ids(kernels);
        switch (size) {
            case Size::tiny:
                draw_listed(kernels.rasterize_tiny, chunk, alike, rules, id);
                break;
            case Size::small:
                draw_listed(kernels.rasterize_small, chunk, alike, rules, id);
                break;
            case Size::large:
                draw_large(chunk, alike, rules, kernels, id);
        }
        first = last;
    }
}

void TileVisibility::draw_listed(void (*rasterize)(const RasterizeEntriesCtx&) noexcept,
                                 const Chunk& chunk, std::span<const TileEntry> entries,
                                 std::span<const DepthRule> rules, std::uint32_t* id) {
    const SetupTriangle* const triangles = chunk.triangles().data();
    const DepthRule& rule = rules[triangles[entries.front().triangle].draw];
    RasterizeEntriesCtx ctx{entries.data(),
                            static_cast<int>(entries.size()),
                            triangles,
                            rule,
                            left(),
                            top(),
                            0,
                            m_depth.data(),
                            id,
                            m_block_far.data(),
                            nullptr,
                            m_blank_depths.flags.data(),
                            m_blank_ids.flags.data()};
    if (id != nullptr) {
        const std::size_t first = m_triangles.size();
        for (const TileEntry& entry : entries) m_triangles.push_back(triangles + entry.triangle);
        m_drawn.resize(m_triangles.size());
        ctx.first_id = static_cast<std::uint32_t>(first);
        ctx.drawn = m_drawn.data() + first;
    }
    rasterize(ctx);
}

void TileVisibility::draw_large(const Chunk& chunk, std::span<const TileEntry> entries,
                                std::span<const DepthRule> rules, const KernelTable& kernels,
                                std::uint32_t* id) {
    TileTriangle batch[kBatch];
    std::uint64_t drawn[kBatch];
    RasterizeCtx ctx{batch, 0, m_depth.data(), id, m_block_far.data(), drawn};
    const auto flush = [&] {
        kernels.rasterize(ctx);
        if (id != nullptr) m_drawn.insert(m_drawn.end(), drawn, drawn + ctx.count);
        ctx.count = 0;
    };
    for (std::size_t i = 0; i < entries.size(); ++i) {
        constexpr std::size_t kAhead = 4;  // a mesh's triangles lie far apart along a tile
        if (i + kAhead < entries.size()) {
            __builtin_prefetch(&chunk.triangles()[entries[i + kAhead].triangle]);
        }
        const SetupTriangle& triangle = chunk.triangles()[entries[i].triangle];
        TileTriangle& seen = batch[ctx.count];
        if (!tile_triangle(triangle, m_tile_x, m_tile_y, seen)) continue;
        const DepthRule& rule = rules[triangle.draw];
        seen.id = static_cast<std::uint32_t>(m_triangles.size());
        set_rule(rule, seen);
        if (id != nullptr) m_triangles.push_back(&triangle);
        if (++ctx.count == kBatch) flush();
    }
    if (ctx.count > 0) flush();
}

/// Blocks reach beyond a frame that ends inside them; what was drawn there is not shown.
void TileVisibility::hide_outside() {
    const std::int32_t columns = std::min(m_frame.width - left(), kTileSize);
    const std::int32_t rows = std::min(m_frame.height - top(), kTileSize);
    if (columns == kTileSize && rows == kTileSize) return;
    for (std::int32_t y = 0; y < kTileSize; ++y) {
        for (std::int32_t x = y < rows ? columns : 0; x < kTileSize; ++x) {
            m_id[tile_index(x, y)] = kNoTriangle;
        }
    }
}

/// Fills blank blocks, neighbours at once.
void TileVisibility::fill(BlankBlocks& blank, void* tile, std::uint32_t value,
                          const KernelTable& kernels) {
    if (!blank.any) return;
    auto* const words = static_cast<std::uint32_t*>(tile);
    const auto begin = blank.flags.begin(), last = blank.flags.end();
    for (auto first = std::find(begin, last, 1); first != last;) {
        const auto end = std::find(first, last, 0);
        kernels.clear_words({words + (first - begin) * kBlockPixels, value,
                             static_cast<int>(end - first) * kBlockPixels});
        first = std::find(end, last, 1);
    }
    blank = {};
}

void TileVisibility::fill_depths(const KernelTable& kernels) {
    fill(m_blank_depths, m_depth.data(), std::bit_cast<std::uint32_t>(1.0F), kernels);
}
void TileVisibility::fill_ids(const KernelTable& kernels) {
    fill(m_blank_ids, m_id.data(), kNoTriangle, kernels);
}

TileFragments TileVisibility::collect(const KernelTable& kernels) {
    fill_ids(kernels);
    hide_outside();
    m_first.resize(m_triangles.size() + 2);
    kernels.collect({m_id.data(), m_drawn.data(), static_cast<int>(m_triangles.size()),
                     m_pixels.data(), m_first.data()});
    return {m_triangles, m_first.data(), m_pixels.data(),
            static_cast<int>(m_first[m_triangles.size()])};
}

void TileVisibility::forget() {
    m_triangles.clear();
    m_drawn.clear();
}

bool TileVisibility::cover(const SetupTriangle& triangle, const DepthRule& rule,
                           const KernelTable& kernels, PixelMask& passed) {
    TileTriangle seen;
    if (!tile_triangle(triangle, m_tile_x, m_tile_y, seen)) return false;
    fill_depths(kernels);
    set_rule(rule, seen);
    kernels.cover({&seen, m_depth.data(), m_block_far.data(), passed.word.data(), &passed.blocks});
    return passed.blocks != 0;
}

}  // namespace burnish
