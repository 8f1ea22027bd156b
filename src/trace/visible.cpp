#include "trace/visible.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "raster/bin.hpp"
#include "raster/tile.hpp"
#include "shade/packets.hpp"

namespace burnish {

namespace {

/// The fragments of a pixel in the order of submission, each through the tests of its draw.
class PixelWatch {
  public:
    PixelWatch(const FrameDraws& frame, std::int32_t x, std::int32_t y)
        : m_frame(frame),
          m_x(x),
          m_y(y),
          m_pixel(tile_index(x % kTileSize, y % kTileSize)),
          m_depth(kTilePixels, 1.0F),
          m_block_far(kTileBlocks, 1.0F),
          m_colors(4 * (kTilePixels + 1)) {
        m_mask.blocks = std::uint64_t{1} << m_pixel / kBlockPixels;
        m_mask.word[m_pixel / kBlockPixels] = std::uint64_t{1} << m_pixel % kBlockPixels;
    }

    void draw_all() {
        std::size_t triangles = 0;
        for (const auto& draw : m_frame.draws) triangles += draw->triangle_count();
        const std::size_t step = chunk_size(m_frame.size, triangles);
        for (std::uint32_t i = 0; i < m_frame.draws.size(); ++i) {
            const std::size_t count = m_frame.draws[i]->triangle_count();
            for (std::size_t first = 0; first < count; first += step) {
                draw_chunk(i, first, std::min(first + step, count));
            }
        }
    }

    [[nodiscard]] const std::vector<VisibleTriangle>& found() const { return m_passed; }

  private:
    [[nodiscard]] ChunkSource source(std::uint32_t draw) const {
        const Draw& d = *m_frame.draws[draw];
        return {d.mesh(), draw, d.facing, m_frame.viewport, m_frame.size};
    }

    void draw_chunk(std::uint32_t number, std::size_t first, std::size_t last) {
        m_chunk.fill(source(number), first, last, table_reference());
        const Draw& draw = *m_frame.draws[number];
        for (const TileEntry& entry : m_chunk.tile(m_x / kTileSize, m_y / kTileSize)) {
            const SetupTriangle& triangle = m_chunk.triangles()[entry.triangle];
            std::optional<float> depth = depth_alone(triangle);
            if (!depth || !covers(triangle, draw.depth, m_depth, m_block_far)) continue;
            if (draw.output.late_depth && !(depth = late_depth(draw, triangle))) continue;
            if (!draw.output.blend) m_passed.clear();
            m_passed.push_back({triangle, *depth});
        }
    }

    /// Whether the triangle covers the pixel and passes the rule there.
    bool covers(const SetupTriangle& triangle, const DepthRule& rule, AlignedVector<float>& depth,
                AlignedVector<float>& block_far) const {
        const PixelRect& box = triangle.box;
        if (m_x < box.x0 || m_x > box.x1 || m_y < box.y0 || m_y > box.y1) return false;
        TileTriangle seen;
        if (!tile_triangle(triangle, m_x / kTileSize, m_y / kTileSize, seen)) return false;
        seen.x0 = seen.x1 = m_x % kTileSize;
        seen.y0 = seen.y1 = m_y % kTileSize;
        seen.pass_less = rule.pass_less;
        seen.pass_equal = rule.pass_equal;
        seen.pass_greater = rule.pass_greater;
        seen.depth_write = rule.write;
        PixelMask passed;
        table_reference().cover(
            {&seen, depth.data(), block_far.data(), passed.word.data(), &passed.blocks});
        return passed.blocks != 0;
    }

    /// The triangle's depth at the pixel, whatever was drawn there; nothing if it is not covered.
    std::optional<float> depth_alone(const SetupTriangle& triangle) {
        if (!covers(triangle, {1, 1, 1, 1}, m_alone, m_alone_far)) return std::nullopt;
        return m_alone[m_pixel];
    }

    /// Shades the fragment into a pixel of NaNs, which no program leaves: dropped if they stay.
    /// Returns its depth.
    std::optional<float> late_depth(const Draw& draw, const SetupTriangle& triangle) {
        FragmentOutput plain = draw.output;
        plain.blend = std::nullopt;
        float* const pixel = m_colors.data() + 4 * m_pixel;
        std::fill_n(pixel, 4, std::numeric_limits<float>::quiet_NaN());
        const float before = m_depth[m_pixel];
        m_shader.begin(
            {m_x / kTileSize * kTileSize,
             m_y / kTileSize * kTileSize,
             {StoreFormat::rgba32f, m_colors.data(), m_depth.data(), m_block_far.data()}});
        m_shader.start_draw({&draw.shading, &plain, draw.mesh()}, table_reference());
        m_shader.add(triangle, m_mask, table_reference());
        m_shader.flush(table_reference());
        if (std::isnan(pixel[3])) return std::nullopt;
        if (draw.shading.depth_attribute < 0) return m_alone[m_pixel];
        return draw.output.depth.write != 0 ? m_depth[m_pixel] : before;
    }

    FrameDraws m_frame;
    std::int32_t m_x, m_y;
    std::size_t m_pixel;
    PixelMask m_mask;                           ///< the pixel
    AlignedVector<float> m_depth, m_block_far;  ///< of the tile; only the pixel's is used
    AlignedVector<float> m_alone = m_depth, m_alone_far = m_block_far;
    AlignedVector<float> m_colors;
    PacketShader m_shader;
    Chunk m_chunk;
    std::vector<VisibleTriangle> m_passed;
};

}  // namespace

std::vector<VisibleTriangle> visible_triangles(const FrameDraws& frame, std::int32_t x,
                                               std::int32_t y) {
    PixelWatch watch(frame, x, y);
    watch.draw_all();
    return watch.found();
}

}  // namespace burnish
