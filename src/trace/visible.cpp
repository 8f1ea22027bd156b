#include "trace/visible.hpp"

#include <algorithm>

#include "raster/bin.hpp"
#include "raster/tile.hpp"

namespace burnish {

namespace {

/// The last fragment of a pixel, chunk after chunk as the renderer does when its bins are full.
class PixelWatch {
  public:
    PixelWatch(const FrameDraws& frame, std::int32_t x, std::int32_t y)
        : m_frame(frame),
          m_tile_x(x / kTileSize),
          m_tile_y(y / kTileSize),
          m_pixel(tile_index(x % kTileSize, y % kTileSize)) {
        for (const auto& draw : frame.draws) m_rules.push_back(draw->depth);
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

    [[nodiscard]] const std::optional<VisibleTriangle>& found() const { return m_found; }

  private:
    [[nodiscard]] ChunkSource source(std::uint32_t draw) const {
        const Draw& d = *m_frame.draws[draw];
        return {d.mesh(), draw, d.facing, m_frame.viewport, m_frame.size};
    }

    void draw_chunk(std::uint32_t draw, std::size_t first, std::size_t last) {
        m_chunk.fill(source(draw), first, last);
        if (m_chunk.tile(m_tile_x, m_tile_y).empty()) return;
        m_tile.begin(m_tile_x, m_tile_y, m_frame.size, m_depth.empty() ? nullptr : m_depth.data());
        m_tile.draw(m_chunk, m_rules, table_reference());
        m_depth.assign(m_tile.depth(), m_tile.depth() + kTilePixels);
        if (const SetupTriangle* shown = shown_triangle()) {
            const SetupTriangle setup = *shown;
            const auto place = static_cast<std::size_t>(shown - m_chunk.triangles().data());
            const std::size_t triangle = isolate(draw, first, place);
            m_found = {triangle, setup, depth_alone()};
        }
    }

    const SetupTriangle* shown_triangle() {
        const TileFragments fragments = m_tile.collect(table_reference());
        const std::uint16_t* pixels = fragments.pixels;
        for (std::size_t i = 0; i < fragments.triangles.size(); ++i) {
            const std::uint16_t* const end = pixels + fragments.size[i];
            if (std::find(pixels, end, m_pixel) != end) return fragments.triangles[i];
            pixels = end;
        }
        return nullptr;
    }

    /// Which triangle the one at `place` of the chunk from `first` on is: clipped ones take several
    /// places, culled ones none. Leaves the chunk with it alone.
    std::size_t isolate(std::uint32_t draw, std::size_t first, std::size_t place) {
        std::size_t triangle = first;
        for (std::size_t before = 0;; ++triangle) {
            m_chunk.fill(source(draw), triangle, triangle + 1);
            before += m_chunk.counts().binned;
            if (before > place) return triangle;
        }
    }

    /// Depth of the chunk's only triangle at the pixel, whatever the depth buffer kept.
    float depth_alone() {
        const std::vector<DepthRule> always(m_rules.size(), DepthRule{1, 1, 1, 1});
        m_tile.begin(m_tile_x, m_tile_y, m_frame.size, nullptr);
        m_tile.draw(m_chunk, always, table_reference());
        return m_tile.depth()[m_pixel];
    }

    FrameDraws m_frame;
    std::int32_t m_tile_x, m_tile_y;
    std::size_t m_pixel;
    std::vector<DepthRule> m_rules;
    std::vector<float> m_depth;  ///< of the tile; empty before the first chunk that touches it
    Chunk m_chunk;
    TileVisibility m_tile;
    std::optional<VisibleTriangle> m_found;
};

}  // namespace

std::optional<VisibleTriangle> visible_triangle(const FrameDraws& frame, std::int32_t x,
                                                std::int32_t y) {
    PixelWatch watch(frame, x, y);
    watch.draw_all();
    return watch.found();
}

}  // namespace burnish
