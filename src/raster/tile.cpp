#include "raster/tile.hpp"

#include <algorithm>

namespace burnish {

namespace {

constexpr int kBatch = 32;  // triangles per call of the kernel: 4 KB
constexpr int kBlocksPerRow = kTileSize / kBlockSize;

/// Pixels of a block that lie inside the frame.
std::uint64_t frame_mask(std::int32_t left, std::int32_t top, FrameSize frame) {
    const std::int32_t columns = std::clamp(frame.width - left, 0, kBlockSize);
    const std::int32_t rows = std::clamp(frame.height - top, 0, kBlockSize);
    if (columns == kBlockSize && rows == kBlockSize) return ~std::uint64_t{0};
    const std::uint64_t row = (std::uint64_t{1} << columns) - 1;
    std::uint64_t mask = 0;
    for (std::int32_t y = 0; y < rows; ++y) mask |= row << (kBlockSize * y);
    return mask;
}

}  // namespace

TileVisibility::TileVisibility()
    : m_depth(kTilePixels), m_block_far(kTileBlocks), m_id(kTilePixels) {}

void TileVisibility::begin(std::int32_t x, std::int32_t y, FrameSize frame, const float* depth) {
    m_tile_x = x;
    m_tile_y = y;
    m_frame = frame;
    m_triangles.clear();
    std::fill(m_id.begin(), m_id.end(), kNoTriangle);
    if (depth == nullptr) {
        std::fill(m_depth.begin(), m_depth.end(), 1.0F);
        std::fill(m_block_far.begin(), m_block_far.end(), 1.0F);
        return;
    }
    std::copy_n(depth, kTilePixels, m_depth.begin());
    for (std::size_t block = 0; block < kTileBlocks; ++block) {
        const auto first = m_depth.begin() + static_cast<std::ptrdiff_t>(block * kBlockPixels);
        m_block_far[block] = *std::max_element(first, first + kBlockPixels);
    }
}

void TileVisibility::draw(const Chunk& chunk, std::span<const DepthRule> rules,
                          const KernelTable& kernels) {
    TileTriangle batch[kBatch];
    RasterizeCtx ctx{batch, 0, m_depth.data(), m_id.data(), m_block_far.data()};
    const std::span<const std::uint32_t> entries = chunk.tile(m_tile_x, m_tile_y);
    for (std::size_t i = 0; i < entries.size(); ++i) {
        constexpr std::size_t kAhead = 4;  // a mesh's triangles lie far apart along a tile
        if (i + kAhead < entries.size()) {
            const auto* next =
                reinterpret_cast<const char*>(&chunk.triangles()[entries[i + kAhead]]);
            __builtin_prefetch(next);
            __builtin_prefetch(next + 64);
        }
        const SetupTriangle& triangle = chunk.triangles()[entries[i]];
        TileTriangle& seen = batch[ctx.count];
        if (!tile_triangle(triangle, m_tile_x, m_tile_y, seen)) continue;
        const DepthRule& rule = rules[triangle.draw];
        seen.id = static_cast<std::uint32_t>(m_triangles.size());
        seen.pass_less = rule.pass_less;
        seen.pass_equal = rule.pass_equal;
        seen.pass_greater = rule.pass_greater;
        seen.depth_write = rule.write;
        m_triangles.push_back(&triangle);
        if (++ctx.count == kBatch) {
            kernels.rasterize(ctx);
            ctx.count = 0;
        }
    }
    if (ctx.count > 0) kernels.rasterize(ctx);
}

void TileVisibility::match_block(int block, const KernelTable& kernels, BlockTriangles& out) const {
    const std::int32_t x = left() + block % kBlocksPerRow * kBlockSize;
    const std::int32_t y = top() + block / kBlocksPerRow * kBlockSize;
    const int first = block * kBlockPixels;
    kernels.match(
        {m_id.data() + first, frame_mask(x, y, m_frame), static_cast<std::uint16_t>(first), &out});
}

}  // namespace burnish
