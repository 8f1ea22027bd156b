#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <vector>

#include "kernel_test.hpp"

/// Vertices, coverage and depth, and the fragments of a tile.
namespace burnish {
namespace {

INSTANTIATE_TEST_SUITE_P(Isa, KernelTest, every_table(), isa_name);

// ---- transform

struct Vertices {
    AlignedVector<float> x, y, z;

    Vertices(Random& random, int count, float reach) {
        const auto padded = static_cast<std::size_t>((count + 15) / 16 * 16);
        for (AlignedVector<float>* coordinate : {&x, &y, &z}) {
            coordinate->resize(padded, kNan);
            for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
                (*coordinate)[i] = random.real(-reach, reach);
                if (random.chance(60))
                    (*coordinate)[i] = random.pick(std::array{kNan, kInfinity, -kInfinity, 3e38F,
                                                              -3e38F, 0.0F, -0.0F, 1e-42F});
            }
        }
    }
};

/// A perspective matrix with a camera somewhere, or twelve random numbers.
void random_matrix(Random& random, float (&m)[16]) {
    for (float& x : m) x = random.real(-1.0F, 1.0F);
    if (random.chance(3)) return;
    for (float& x : m) x = 0.0F;
    m[0] = random.real(0.5F, 2.0F);
    m[5] = random.real(0.5F, 2.0F);
    m[10] = -1.01F;
    m[11] = -1.0F;
    m[12] = random.real(-0.5F, 0.5F);
    m[14] = random.real(0.0F, 5.0F);
    m[15] = random.real(0.0F, 5.0F);
}

struct Transformed {
    AlignedVector<ScreenVertex> screen;
    AlignedVector<HomogeneousVertex> homogeneous;

    Transformed()
        : screen(80, ScreenVertex{-77, -78, -79.0F, 0xabcdU}),
          homogeneous(80, HomogeneousVertex{-1.5F, -2.5F, -3.5F, -4.5F}) {}

    void run(const KernelTable& table, TransformCtx ctx) {
        ctx.screen = screen.data();
        ctx.homogeneous = homogeneous.data();
        table.transform(ctx);
    }
};

void check_transform(const KernelTable& table, const TransformCtx& ctx, const std::string& where) {
    Transformed got, want;
    got.run(table, ctx);
    want.run(table_reference(), ctx);
    for (std::size_t i = 0; i < got.screen.size(); ++i) {
        const ScreenVertex& g = got.screen[i];
        const ScreenVertex& w = want.screen[i];
        const HomogeneousVertex& gh = got.homogeneous[i];
        const HomogeneousVertex& wh = want.homogeneous[i];
        ASSERT_TRUE(g.x == w.x && g.y == w.y && same_bits(g.z, w.z) && g.outcode == w.outcode)
            << table.isa << " transform, " << where << ", vertex " << i << " of " << ctx.count
            << ": got " << g.x << ' ' << g.y << ' ' << g.z << ' ' << g.outcode << ", want " << w.x
            << ' ' << w.y << ' ' << w.z << ' ' << w.outcode;
        ASSERT_TRUE(same_bits(gh.x, wh.x) && same_bits(gh.y, wh.y) && same_bits(gh.z, wh.z) &&
                    same_bits(gh.w, wh.w))
            << table.isa << " transform, " << where << ", homogeneous vertex " << i << " of "
            << ctx.count << ": got " << gh.x << ' ' << gh.y << ' ' << gh.z << ' ' << gh.w
            << ", want " << wh.x << ' ' << wh.y << ' ' << wh.z << ' ' << wh.w;
    }
}

TEST_P(KernelTest, TransformOfAnyVertices) {
    for (unsigned seed = 0; seed < 4000; ++seed) {
        Random random(seed);
        const int count = random.between(1, 70);
        const Vertices v(random, count, random.chance(4) ? 1e5F : 3.0F);
        TransformCtx ctx{v.x.data(), v.y.data(), v.z.data(), count, {}, {}, nullptr, nullptr};
        random_matrix(random, ctx.m);
        const auto width = static_cast<float>(random.between(1, 16384));
        const auto height = static_cast<float>(random.between(1, 16384));
        const auto subpixels = static_cast<float>(16 << random.below(5));
        ctx.viewport = {width / 2, height / 2, width,
                        height,    subpixels,  random.chance(2) ? 0.5F : 0.0F};
        ASSERT_NO_FATAL_FAILURE(check_transform(table(), ctx, "seed " + std::to_string(seed)));
    }
}

// Every coordinate at each border of the view and of the guard band, and next to it. Half the width
// is one pixel, so window x = x + 1 without rounding.
TEST_P(KernelTest, TransformAtTheBordersOfView) {
    std::vector<float> borders;
    for (const float border : {0.0F, 1.0F, 2.0F, kGuardLow, kGuardHigh}) {
        for (const float window : {border, std::nextafter(border, kInfinity),
                                   std::nextafter(border, -kInfinity), border + 1, border - 1})
            borders.push_back(window);
    }
    const auto n = static_cast<int>(borders.size());
    AlignedVector<float> x(std::size_t{32}, 0.0F), y = x, z = x;
    for (int i = 0; i < n * n * 4; i += n) {
        for (int k = 0; k < n; ++k) {
            const auto at = static_cast<std::size_t>(k);
            x[at] = borders[at] - 1.0F;
            y[at] = 1.0F - borders[static_cast<std::size_t>(i / n % n)];
            z[at] = borders[static_cast<std::size_t>((i / n + k) % 15)] * 2.0F - 1.0F;
        }
        const TransformCtx ctx{x.data(),
                               y.data(),
                               z.data(),
                               n,
                               {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1},
                               {1, 1, 2, 2, 256, 0.5F},
                               nullptr,
                               nullptr};
        ASSERT_NO_FATAL_FAILURE(check_transform(table(), ctx, "row " + std::to_string(i / n)));
    }
}

// ---- light at the vertices

TEST_P(KernelTest, LightAtRandomVertices) {
    for (int seed = 0; seed < 600; ++seed) {
        Random random(static_cast<unsigned>(seed));
        const int count = random.between(1, 40), stride = random.between(1, 24);
        std::vector<float> frames(static_cast<std::size_t>(count) * LightVerticesCtx::kFrameFloats);
        for (float& x : frames) x = random.chance(9) ? 0.0F : random.real(-2.0F, 2.0F);
        std::vector<std::int8_t> values(static_cast<std::size_t>(stride));
        for (std::int8_t& v : values)
            v = static_cast<std::int8_t>(random.between(VertexValue::none, VertexValue::count - 1));
        LightVerticesCtx ctx{};
        ctx.frames = frames.data();
        ctx.count = count;
        ctx.values = values.data();
        ctx.stride = stride;
        for (int c = 0; c < 3; ++c) {
            ctx.light[c] = random.real(-3.0F, 3.0F);
            ctx.eye[c] = random.real(-3.0F, 3.0F);
            ctx.tint[c] = random.real(0.0F, 2.0F);
            ctx.base[c] = random.real(0.0F, 1.0F);
        }
        ctx.light_w = random.chance(2) ? 1.0F : 0.0F;
        ctx.eye_w = random.chance(2) ? 1.0F : 0.0F;
        ctx.orthonormal = random.chance(2) ? 1 : 0;
        ctx.raw_half = random.chance(2) ? 1 : 0;
        constexpr float kUntouched = -77.5F;
        const std::size_t size = static_cast<std::size_t>(count * stride) + 16;
        std::vector<float> got(size, kUntouched), want(size, kUntouched);
        ctx.out = got.data();
        table().light_vertices(ctx);
        ctx.out = want.data();
        table_reference().light_vertices(ctx);
        for (std::size_t i = 0; i < size; ++i)
            ASSERT_TRUE(same_bits(got[i], want[i]))
                << name("light_vertices") << ", seed " << seed << ", float " << i << " of "
                << stride << " per vertex: got " << got[i] << ", want " << want[i];
    }
}

// ---- rasterize

struct Point {
    int x, y;  ///< 1/256 pixel from the tile's corner
};

std::int64_t floor_256(std::int64_t x) {
    return x >> 8;
}

/// Adds the edge from p to q (inside to its left in a y-down window, where the area is positive).
/// False if the tile has no pixel inside. Edges that all of the tile is inside of are dropped.
bool add_edge(TileTriangle& t, const Point& p, const Point& q) {
    const std::int64_t a = p.y - q.y;
    const std::int64_t b = q.x - p.x;
    const bool top_left = a > 0 || (a == 0 && b > 0);
    const std::int64_t exact = a * (128 - p.x) + b * (128 - p.y) - (top_left ? 0 : 1);
    const std::int64_t c = floor_256(exact);
    const auto corner = [&](int x, int y) { return a * x + b * y + c; };
    const auto corners = {corner(0, 0), corner(63, 0), corner(0, 63), corner(63, 63)};
    if (std::max(corners) < 0) return false;
    if (std::min(corners) >= 0) return true;
    t.a[t.edges] = static_cast<std::int32_t>(a);
    t.b[t.edges] = static_cast<std::int32_t>(b);
    t.c[t.edges] = static_cast<std::int32_t>(c);
    ++t.edges;
    return true;
}

/// Tile pixels from `low` to `high` (1/256 pixel) whose centres may lie between.
bool pixel_range(int low, int high, std::int32_t& first, std::int32_t& last) {
    first = std::max(0, (low - 128 + 255) >> 8);
    last = std::min(kTileSize - 1, (high - 128) >> 8);
    return first <= last;
}

/// Coverage of a triangle in the tile; nothing if it misses or has no area.
std::optional<TileTriangle> tile_triangle(Point p, Point q, Point r) {
    const std::int64_t area =
        std::int64_t{q.x - p.x} * (r.y - p.y) - std::int64_t{r.x - p.x} * (q.y - p.y);
    if (area == 0) return {};
    if (area < 0) std::swap(q, r);
    TileTriangle t{};
    if (!pixel_range(std::min({p.x, q.x, r.x}), std::max({p.x, q.x, r.x}), t.x0, t.x1) ||
        !pixel_range(std::min({p.y, q.y, r.y}), std::max({p.y, q.y, r.y}), t.y0, t.y1))
        return {};
    if (!add_edge(t, p, q) || !add_edge(t, q, r) || !add_edge(t, r, p)) return {};
    return t;
}

Point random_point(Random& random) {
    switch (random.below(4)) {
        case 0:  // on pixel centres, where the fill rule decides
            return {random.between(-4, 68) * 256 + 128, random.between(-4, 68) * 256 + 128};
        case 1:  // anywhere in the guard band
            return {random.between(-8192 * 256, 24575 * 256),
                    random.between(-8192 * 256, 24575 * 256)};
        default:
            return {random.between(-20 * 256, 84 * 256), random.between(-20 * 256, 84 * 256)};
    }
}

void set_depth(TileTriangle& t, Random& random) {
    t.offset_x = random.between(-16384, 16384);
    t.offset_y = random.between(-16384, 16384);
    if (random.chance(3)) {  // level, and often equal to others
        t.z = static_cast<float>(random.between(0, 4)) * 0.25F;
        t.z_low = t.z_high = t.z;
        return;
    }
    t.zx = random.real(-0.01F, 0.01F);
    t.zy = random.real(-0.01F, 0.01F);
    t.z = 0.5F - static_cast<float>(t.offset_x + 32) * t.zx -
          static_cast<float>(t.offset_y + 32) * t.zy;
    t.z_low = random.real(0.0F, 0.6F);
    t.z_high = random.real(t.z_low, 1.0F);
}

std::vector<TileTriangle> random_triangles(Random& random, int wanted) {
    std::vector<TileTriangle> triangles;
    const int tests = random.below(9);  // the last: each its own
    const bool writes = !random.chance(5);
    while (static_cast<int>(triangles.size()) < wanted) {
        auto t = tile_triangle(random_point(random), random_point(random), random_point(random));
        if (!t) continue;
        set_depth(*t, random);
        const int pass = tests == 8 ? random.below(8) : tests;
        t->pass_less = static_cast<std::uint8_t>(pass & 1);
        t->pass_equal = static_cast<std::uint8_t>(pass >> 1 & 1);
        t->pass_greater = static_cast<std::uint8_t>(pass >> 2);
        t->depth_write = static_cast<std::uint8_t>(tests == 8 ? random.below(2) : writes ? 1 : 0);
        t->id = static_cast<std::uint32_t>(triangles.size()) * 3 + 1;
        triangles.push_back(*t);
    }
    return triangles;
}

struct Tile {
    AlignedVector<float> depth;
    AlignedVector<std::uint32_t> id;
    AlignedVector<float> block_far;
    std::vector<std::uint64_t> drawn;  ///< of all triangles so far

    /// Cleared, or with levels from which triangles differ little; bounds exact or loose.
    explicit Tile(Random& random)
        : depth(kTilePixels, 1.0F), id(kTilePixels, kNoTriangle), block_far(kTileBlocks, 1.0F) {
        if (random.chance(2)) return;
        for (float& d : depth) d = static_cast<float>(random.between(0, 8)) * 0.125F;
        for (int block = 0; block < kTileBlocks; ++block) {
            const float* first = depth.data() + block * kBlockPixels;
            block_far[static_cast<std::size_t>(block)] =
                *std::max_element(first, first + kBlockPixels) + (random.chance(2) ? 0.5F : 0.0F);
        }
    }
    void run(const KernelTable& table, const std::vector<TileTriangle>& triangles) {
        const std::size_t before = drawn.size();
        drawn.resize(before + triangles.size(), ~std::uint64_t{0});
        table.rasterize({triangles.data(), static_cast<int>(triangles.size()), depth.data(),
                         id.data(), block_far.data(), drawn.data() + before});
    }
};

void expect_same(const Tile& got, const Tile& want, const std::string& where) {
    for (std::size_t i = 0; i < kTilePixels; ++i) {
        ASSERT_EQ(got.id[i], want.id[i]) << where << ", pixel " << i;
        ASSERT_TRUE(same_bits(got.depth[i], want.depth[i]))
            << where << ", pixel " << i << ": got " << got.depth[i] << ", want " << want.depth[i];
        ASSERT_GE(got.block_far[i / kBlockPixels], got.depth[i])
            << where << ", pixel " << i << ": beyond its block's bound";
    }
    ASSERT_EQ(got.drawn, want.drawn) << where;
}

TEST_P(KernelTest, RasterizeOfRandomTriangles) {
    for (unsigned seed = 0; seed < 3000; ++seed) {
        Random random(seed);
        const std::vector<TileTriangle> triangles = random_triangles(random, random.between(1, 12));
        Tile got(random);
        Tile want = got;
        got.run(table(), triangles);
        want.run(table_reference(), triangles);
        ASSERT_NO_FATAL_FAILURE(
            expect_same(got, want, name("rasterize") + ", seed " + std::to_string(seed)));
    }
}

TEST_P(KernelTest, RasterizeOneByOneEqualsAllAtOnce) {
    for (unsigned seed = 0; seed < 300; ++seed) {
        Random random(seed);
        const std::vector<TileTriangle> triangles = random_triangles(random, 30);
        Tile got(random);
        Tile want = got;
        for (const TileTriangle& t : triangles) got.run(table(), {t});
        want.run(table_reference(), triangles);
        ASSERT_NO_FATAL_FAILURE(
            expect_same(got, want, name("rasterize") + ", seed " + std::to_string(seed)));
    }
}

TEST_P(KernelTest, ClearedWordsAndNoOthers) {
    AlignedVector<std::uint32_t> words(kTilePixels + 16, 7U);
    table().clear_words({words.data() + 16, 0x3f800001U, kTilePixels - 16});
    for (std::size_t i = 0; i < words.size(); ++i)
        ASSERT_EQ(words[i], i < 16 || i >= kTilePixels ? 7U : 0x3f800001U)
            << name("clear_words") << ", word " << i;
}

// Depths alone: those that are left beside ids.
TEST_P(KernelTest, RasterizeWithoutIds) {
    for (unsigned seed = 0; seed < 1500; ++seed) {
        Random random(seed);
        const std::vector<TileTriangle> triangles = random_triangles(random, random.between(1, 12));
        Tile got(random);
        Tile want = got;
        table().rasterize({triangles.data(), static_cast<int>(triangles.size()), got.depth.data(),
                           nullptr, got.block_far.data(), nullptr});
        want.run(table_reference(), triangles);
        got.id = want.id;
        got.drawn = want.drawn;
        ASSERT_NO_FATAL_FAILURE(
            expect_same(got, want, name("rasterize") + ", seed " + std::to_string(seed)));
    }
}

// Bits instead of ids: what rasterize leaves of a triangle that is drawn alone, and its depths.
TEST_P(KernelTest, CoverOfRandomTriangles) {
    for (unsigned seed = 0; seed < 3000; ++seed) {
        Random random(seed);
        Tile got(random);
        Tile want = got;
        for (const TileTriangle& t : random_triangles(random, random.between(1, 6))) {
            want.id.assign(kTilePixels, kNoTriangle);
            want.drawn.clear();
            want.run(table_reference(), {t});
            std::array<std::uint64_t, kTileBlocks> passed{};
            std::uint64_t blocks = ~std::uint64_t{0};
            table().cover({&t, got.depth.data(), got.block_far.data(), passed.data(), &blocks});
            ASSERT_EQ(blocks, want.drawn[0]) << name("cover") << ", seed " << seed;
            got.id.assign(kTilePixels, kNoTriangle);
            for (std::size_t i = 0; i < kTilePixels; ++i)
                if ((passed[i / kBlockPixels] >> i % kBlockPixels & 1) != 0) got.id[i] = t.id;
            got.drawn = want.drawn;
            ASSERT_NO_FATAL_FAILURE(
                expect_same(got, want, name("cover") + ", seed " + std::to_string(seed)));
        }
    }
}

// A frame that ends at pixel (36, 21) of the tile: the box does, too, and whole blocks do not
// count.
TEST_P(KernelTest, CoverStopsAtTheBoundingBox) {
    Random random(0);
    TileTriangle t{};
    t.x0 = 3;
    t.x1 = 36;
    t.y0 = 9;
    t.y1 = 21;
    t.pass_less = t.pass_equal = 1;
    Tile tile(random);
    std::array<std::uint64_t, kTileBlocks> passed{};
    std::uint64_t blocks = 0;
    table().cover({&t, tile.depth.data(), tile.block_far.data(), passed.data(), &blocks});
    for (int y = 0; y < kTileSize; ++y) {
        for (int x = 0; x < kTileSize; ++x) {
            const auto block = static_cast<std::size_t>(y / 8 * 8 + x / 8);
            const bool inside = x >= 3 && x <= 36 && y >= 9 && y <= 21;
            ASSERT_EQ((passed[block] >> (y % 8 * 8 + x % 8) & 1) != 0, inside) << x << ", " << y;
        }
    }
}

// Slivers and points: all triangles with corners on a 3 x 3 grid of half pixels around a block
// edge.
TEST_P(KernelTest, RasterizeOfSmallTriangles) {
    std::vector<Point> grid;
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 4; ++x) grid.push_back({7 * 256 + 128 * x, 55 * 256 + 128 * y});
    for (const Point& p : grid) {
        for (const Point& q : grid) {
            for (const Point& r : grid) {
                auto t = tile_triangle(p, q, r);
                if (!t) continue;
                t->z = t->z_low = t->z_high = 0.5F;
                t->pass_less = t->depth_write = 1;
                Random random(0);
                Tile got(random);
                Tile want = got;
                got.run(table(), {*t});
                want.run(table_reference(), {*t});
                ASSERT_NO_FATAL_FAILURE(expect_same(got, want, name("rasterize")))
                    << p.x << ' ' << p.y << ' ' << q.x << ' ' << q.y << ' ' << r.x << ' ' << r.y;
            }
        }
    }
}

TEST_P(KernelTest, WholeTileInFrontLowersEveryBound) {
    Random random(0);
    Tile tile(random);
    TileTriangle t{};
    t.x1 = t.y1 = kTileSize - 1;
    t.z = t.z_low = t.z_high = 0.25F;
    t.pass_less = t.depth_write = 1;
    std::fill(tile.block_far.begin(), tile.block_far.end(), 1.0F);
    std::fill(tile.depth.begin(), tile.depth.end(), 1.0F);
    tile.run(table(), {t});
    for (const float bound : tile.block_far) EXPECT_EQ(bound, 0.25F) << name("rasterize");
    EXPECT_EQ(tile.drawn.front(), ~std::uint64_t{0}) << name("rasterize");
    for (const std::uint32_t id : tile.id) ASSERT_EQ(id, 0U) << name("rasterize");
}

// ---- collect

/// A visibility buffer and the blocks that show each triangle, or more of them.
struct Visible {
    AlignedVector<std::uint32_t> id = AlignedVector<std::uint32_t>(kTilePixels, kNoTriangle);
    std::vector<std::uint64_t> drawn;

    /// `per_block`: triangles that share a block; `empty`: one pixel in so many shows nothing.
    Visible(Random& random, int triangles, int per_block, int empty)
        : drawn(static_cast<std::size_t>(triangles)) {
        for (std::size_t block = 0; block < kTileBlocks; ++block) {
            std::vector<int> here;
            for (int i = 0; i < per_block; ++i) here.push_back(random.below(triangles));
            for (std::size_t i = 0; i < kBlockPixels; ++i) {
                if (random.chance(empty)) continue;
                const int k = random.pick(here);
                id[block * kBlockPixels + i] = static_cast<std::uint32_t>(k);
                drawn[static_cast<std::size_t>(k)] |= std::uint64_t{1} << block;
            }
        }
        for (std::uint64_t& blocks : drawn) {  // drawn there, then drawn over
            if (random.chance(3)) blocks |= random.engine();
        }
    }
};

void check_collect(const KernelTable& table, const Visible& v, const std::string& where) {
    struct Lists {
        std::vector<std::uint16_t> pixels = std::vector<std::uint16_t>(kTilePixels + 16, 0xffff);
        std::vector<std::uint32_t> first;
    };
    const auto lists = [&](const KernelTable& kernels) {
        Lists out;
        out.first.resize(v.drawn.size() + 2, 0xffff);
        kernels.collect({v.id.data(), v.drawn.data(), static_cast<int>(v.drawn.size()),
                         out.pixels.data(), out.first.data()});
        out.first.pop_back();  // scratch
        out.pixels.resize(out.first.back());
        return out;
    };
    const Lists got = lists(table), want = lists(table_reference());
    ASSERT_EQ(got.first, want.first) << where;
    ASSERT_EQ(got.pixels, want.pixels) << where;
}

TEST_P(KernelTest, CollectOfRandomTiles) {
    for (unsigned seed = 0; seed < 300; ++seed) {
        Random random(seed);
        const int triangles = random.pick(std::array{1, 2, 7, 40, 300});
        const int per_block = random.pick(std::array{1, 2, 5, 64});
        const int empty = random.pick(std::array{1, 2, 10, 1000000});
        const Visible v(random, triangles, per_block, empty);
        ASSERT_NO_FATAL_FAILURE(
            check_collect(table(), v, name("collect") + ", seed " + std::to_string(seed)));
    }
}

TEST_P(KernelTest, CollectOfAWholeTileIsEveryPixelInOrder) {
    const AlignedVector<std::uint32_t> id(kTilePixels, 1);
    const std::array<std::uint64_t, 3> drawn{0, ~std::uint64_t{0}, ~std::uint64_t{0}};
    std::vector<std::uint16_t> pixels(kTilePixels + 16);
    std::array<std::uint32_t, 5> first{};
    table().collect({id.data(), drawn.data(), 3, pixels.data(), first.data()});
    EXPECT_EQ(std::vector(first.begin(), first.end() - 1),
              (std::vector<std::uint32_t>{0, 0, kTilePixels, kTilePixels}));
    for (std::size_t i = 0; i < kTilePixels; ++i) ASSERT_EQ(pixels[i], i) << name("collect");
}

TEST_P(KernelTest, CollectOfFourThousandTriangles) {
    AlignedVector<std::uint32_t> id(kTilePixels);
    std::vector<std::uint64_t> drawn(kTilePixels);
    for (std::size_t i = 0; i < kTilePixels; ++i) {
        const std::size_t k = i * 1237 % kTilePixels;  // odd, so every triangle once
        id[i] = static_cast<std::uint32_t>(k);
        drawn[k] = std::uint64_t{1} << i / kBlockPixels;
    }
    std::vector<std::uint16_t> pixels(kTilePixels + 16);
    std::vector<std::uint32_t> first(kTilePixels + 2);
    table().collect({id.data(), drawn.data(), kTilePixels, pixels.data(), first.data()});
    for (std::size_t k = 0; k < kTilePixels; ++k) {
        ASSERT_EQ(first[k], k) << name("collect");
        ASSERT_EQ(id[pixels[k]], k) << name("collect");
    }
}

}  // namespace
}  // namespace burnish
