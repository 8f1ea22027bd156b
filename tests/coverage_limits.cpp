// The ends of the ranges: vertices between the steps of the grid, tiles of the largest frame with
// corners at the ends of the guard band, its bins. The oracle is tests/exact_coverage.hpp.
#include <gtest/gtest.h>

#include <algorithm>
#include <burnish/machine.hpp>
#include <vector>

#include "geometry/camera.hpp"
#include "geometry/clip.hpp"
#include "kernel_test.hpp"
#include "raster/bin.hpp"
#include "tests/exact_coverage.hpp"
#include "tests/set_up.hpp"
#include "tests/tile_painter.hpp"

namespace burnish {
namespace {

// Floats between the steps of every grid go to the nearest step, or to the one below.
TEST(Snapping, MovesNoVertexByMoreThanItsGridAllows) {
    Random random(1);
    for (int i = 0; i < 100000; ++i) {
        const int bits = random.between(4, 8);
        const bool floor = random.chance(2);
        Machine machine;
        machine.subpixel_bits = bits;
        machine.snap_floor = floor;
        const Viewport viewport = make_viewport(machine, 100, 100);
        const float reach = random.chance(2) ? 200.0F : 8000.0F;
        const float x = random.real(-reach, reach), y = random.real(-reach, reach);
        ScreenVertex v{};
        HomogeneousVertex homogeneous{};
        place_window_vertex({x, y, 0.5F, 1.0F}, viewport, v, homogeneous);
        for (const auto& [window, snapped] : {std::pair{x, v.x}, std::pair{y, v.y}}) {
            const double step = 256 >> bits, exact = static_cast<double>(window) * 256.0;
            ASSERT_EQ(snapped % (256 >> bits), 0);
            // window * subpixels + bias is rounded once, to a float: half an ulp at 2^21 steps.
            const double slack = step * 0.125, moved = snapped - exact;
            ASSERT_GE(moved, (floor ? -step : -step / 2) - slack) << window << ", bits " << bits;
            ASSERT_LE(moved, (floor ? 0.0 : step / 2) + slack) << window << ", bits " << bits;
        }
    }
}

class Limits : public KernelTest {};
INSTANTIATE_TEST_SUITE_P(Isa, Limits, every_table(), isa_name);

constexpr FrameSize kLargest{16384, 16384};

exact::Point far_corner(Random& random) {
    constexpr int kLow = -8192 * 256, kHigh = 24575 * 256;
    const auto coordinate = [&] {
        switch (random.below(4)) {
            case 0:
                return random.chance(2) ? kLow : kHigh;
            case 1:
                return random.between(-8192, 24574) * 256 + 128;
            default:
                return random.between(kLow, kHigh);
        }
    };
    return {coordinate(), coordinate()};
}

void expect_int32(const TileTriangle& t) {
    for (int e = 0; e < t.edges; ++e) {
        ASSERT_LE(std::int64_t{std::abs(t.a[e])} + std::abs(t.b[e]), std::int64_t{1} << 24);
        for (const auto& [x, y] : {std::pair{0, 0}, {63, 0}, {0, 63}, {63, 63}}) {
            const std::int64_t value = std::int64_t{t.a[e]} * x + std::int64_t{t.b[e]} * y + t.c[e];
            ASSERT_LT(std::abs(value), std::int64_t{1} << 30);
        }
    }
}

/// Tile where one of the edges passes, so that most of them are cut.
std::pair<int, int> tile_at_an_edge(const exact::Triangle& t, Random& random) {
    const auto e = static_cast<std::size_t>(random.below(3));
    const exact::Point &p = t[e], &q = t[(e + 1) % 3];
    const std::int64_t part = random.between(0, 4096);
    const auto tile = [&](std::int64_t from, std::int64_t to) {
        const std::int64_t window = from + (to - from) * part / 4096;
        return static_cast<int>(std::clamp<std::int64_t>(window >> 14, 0, 255));
    };
    return {tile(p.x, q.x), tile(p.y, q.y)};
}

TEST_P(Limits, TilesOfTheLargestFrameAreExact) {
    TilePainter painter(table());
    int cut = 0;
    for (unsigned seed = 0; seed < 1500; ++seed) {
        Random random(seed);
        const exact::Triangle t{far_corner(random), far_corner(random), far_corner(random)};
        const auto screen = [](const exact::Point& p) {
            return ScreenVertex{static_cast<std::int32_t>(p.x), static_cast<std::int32_t>(p.y),
                                0.5F, 0};
        };
        const OneTriangle one =
            set_up(table(), {{screen(t[0]), screen(t[1]), screen(t[2])}}, kLargest);
        if (one.counts.drawn == 0) continue;
        const auto [tile_x, tile_y] = tile_at_an_edge(t, random);
        const bool drawn = painter.draw(one.triangle, tile_x, tile_y);
        if (drawn) {
            ASSERT_NO_FATAL_FAILURE(expect_int32(painter.seen())) << "seed " << seed;
        }
        for (int y = 0; y < kTileSize; ++y) {
            for (int x = 0; x < kTileSize; ++x) {
                const bool want =
                    exact::covers(t, tile_x * kTileSize + x, tile_y * kTileSize + y) != 0;
                ASSERT_EQ(drawn && painter.covers(x, y), want)
                    << "seed " << seed << ", tile " << tile_x << ", " << tile_y << ", pixel " << x
                    << ", " << y;
            }
        }
        cut += drawn && painter.count() < kTilePixels ? 1 : 0;
    }
    EXPECT_GT(cut, 300);
}

// Long thin triangles across the largest frame: every tile with a covered pixel lists the triangle,
// once.
TEST(Bins, OfTheLargestFrameMissNoTile) {
    std::vector<ScreenVertex> screen;
    std::vector<std::uint32_t> indices;
    for (unsigned seed = 0; seed < 20; ++seed) {
        Random random(seed);
        const exact::Point a = far_corner(random), b = far_corner(random);
        for (const exact::Point& p :
             {a, b, exact::Point{b.x + random.between(0, 900), b.y - random.between(0, 900)}}) {
            indices.push_back(static_cast<std::uint32_t>(screen.size()));
            screen.push_back(
                {static_cast<std::int32_t>(p.x), static_cast<std::int32_t>(p.y), 0.5F, 0});
        }
    }
    const std::vector<HomogeneousVertex> homogeneous(screen.size());
    Chunk chunk;
    chunk.fill({{screen, homogeneous, indices}, 0, Facing::any, {}, kLargest}, 0,
               indices.size() / 3, table_reference());
    int covered = 0;
    for (std::size_t k = 0; k < chunk.triangles().size(); ++k) {
        const exact::Triangle t = exact::corners(chunk.triangles()[k]);
        for (int step = 0; step <= 4000; ++step) {  // pixels near the middle line
            const exact::Point end{(t[1].x + t[2].x) / 2, (t[1].y + t[2].y) / 2};
            const auto px = static_cast<int>((t[0].x + (end.x - t[0].x) * step / 4000) >> 8);
            const auto py = static_cast<int>((t[0].y + (end.y - t[0].y) * step / 4000) >> 8);
            if (px < 0 || py < 0 || px >= kLargest.width || py >= kLargest.height) continue;
            if (exact::covers(t, px, py) == 0) continue;
            const auto list = chunk.tile(px / kTileSize, py / kTileSize);
            const auto is_it = [&](const TileEntry& entry) { return entry.triangle == k; };
            ASSERT_EQ(std::count_if(list.begin(), list.end(), is_it), 1) << px << ", " << py;
            ++covered;
        }
    }
    EXPECT_GT(covered, 1000);
}

}  // namespace
}  // namespace burnish
