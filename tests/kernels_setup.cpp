#include <algorithm>
#include <array>
#include <cstring>
#include <utility>
#include <vector>

#include "kernel_test.hpp"

/// Triangles from corners, and tiny ones by their masks.
namespace burnish {
namespace {

INSTANTIATE_TEST_SUITE_P(Isa, KernelTest, every_table(), isa_name);

// ---- setup

/// Vertices that triangles share. Corners of one triangle lie anywhere, near each other, or on
/// pixel centres.
struct Soup {
    std::vector<ScreenVertex> vertices;
    std::vector<std::uint32_t> indices;
    SetupCtx ctx{};

    Soup(Random& random, int triangles) {
        ctx.count = triangles;
        ctx.number = static_cast<std::uint32_t>(random.below(1 << 30));
        ctx.draw = static_cast<std::uint32_t>(random.below(1 << 30));
        ctx.width = random.between(1, 300);
        ctx.height = random.between(1, 300);
        ctx.drop_positive = static_cast<std::uint8_t>(random.chance(4) ? 1 : 0);
        ctx.drop_negative = static_cast<std::uint8_t>(random.chance(4) ? 1 : 0);
        const int extent = random.pick(std::array{1, 3, 6, 9, 40, 2000});
        const int step = random.pick(std::array{1, 1, 16, 128, 256});
        const int codes = random.chance(3) ? 3 : 60;
        for (int i = 0; i < triangles; ++i) {
            const int x = random.between(-8, ctx.width + 8), y = random.between(-8, ctx.height + 8);
            for (int corner = 0; corner < 3; ++corner) {
                const bool again = random.chance(6) && !vertices.empty();
                indices.push_back(static_cast<std::uint32_t>(
                    again ? random.below(static_cast<int>(vertices.size()))
                          : static_cast<int>(vertices.size())));
                if (again) continue;
                vertices.push_back(vertex(random, x, y, extent, step));
                if (random.chance(codes))
                    vertices.back().outcode = 1U << random.between(0, random.chance(9) ? 7 : 3);
            }
        }
        ctx.vertices = vertices.data();
        ctx.indices = indices.data();
    }

    static ScreenVertex vertex(Random& random, int x, int y, int extent, int step) {
        const auto place = [&](int pixel) {
            const int at = 256 * pixel + random.between(-128 * extent, 128 * extent);
            return at / step * step + (step == 256 ? 128 : 0);
        };
        const auto end = [&] { return random.pick(std::array{-8193 * 256, 24576 * 256}); };
        ScreenVertex v{place(x), place(y), 0.0F, 0};
        if (random.chance(100)) v.x = end();
        if (random.chance(100)) v.y = end();
        v.z = random.chance(4) ? random.pick(std::array{0.0F, -0.0F, 0.5F, 1.0F})
                               : random.real(0.0F, 1.0F);
        return v;
    }
};

struct Triangles {
    AlignedVector<SetupTriangle> triangles;
    std::vector<SetupPlace> places;
    SetupCounts counts{-1, -1, -1, -1, {}};

    Triangles(const KernelTable& table, SetupCtx ctx)
        : triangles(static_cast<std::size_t>(ctx.count) + 1),
          places(static_cast<std::size_t>(ctx.count) + 1) {
        ctx.triangles = triangles.data();
        ctx.places = places.data();
        ctx.counts = &counts;
        table.setup(ctx);
    }
};

void expect_same(const Triangles& got, const Triangles& want, const std::string& where) {
    ASSERT_EQ(got.counts.taken, want.counts.taken) << where;
    ASSERT_EQ(got.counts.drawn, want.counts.drawn) << where;
    ASSERT_EQ(got.counts.nonfinite, want.counts.nonfinite) << where;
    ASSERT_EQ(got.counts.degenerate, want.counts.degenerate) << where;
    ASSERT_EQ(std::memcmp(&got.counts.bounds, &want.counts.bounds, sizeof(PixelRect)), 0) << where;
    for (std::size_t i = 0; i < static_cast<std::size_t>(want.counts.drawn); ++i) {
        const SetupPlace &g = got.places[i], &w = want.places[i];
        ASSERT_EQ(g.covered, w.covered) << where << ", drawn " << i;
        ASSERT_EQ(std::pair(g.x, g.y), std::pair(w.x, w.y)) << where << ", drawn " << i;
        ASSERT_EQ(g.tiles == 0, w.tiles == 0) << where << ", drawn " << i;
        ASSERT_EQ(g.tiles == SetupPlace::kLarge, w.tiles == SetupPlace::kLarge)
            << where << ", drawn " << i;
        ASSERT_EQ(std::memcmp(&got.triangles[i], &want.triangles[i], sizeof(SetupTriangle)), 0)
            << where << ", drawn " << i << ", number " << want.triangles[i].number;
    }
}

TEST_P(KernelTest, SetupOfRandomTriangles) {
    int drawn = 0, tiny = 0, stopped = 0, dropped = 0;
    for (unsigned seed = 0; seed < 4000; ++seed) {
        Random random(seed);
        const Soup soup(random, random.between(0, 70));
        const Triangles got(table(), soup.ctx), want(table_reference(), soup.ctx);
        ASSERT_NO_FATAL_FAILURE(
            expect_same(got, want, name("setup") + ", seed " + std::to_string(seed)));
        drawn += want.counts.drawn;
        for (int i = 0; i < want.counts.drawn; ++i)
            tiny += want.places[static_cast<std::size_t>(i)].covered != 0 ? 1 : 0;
        stopped += want.counts.taken < soup.ctx.count ? 1 : 0;
        dropped += want.counts.taken - want.counts.drawn;
    }
    EXPECT_GT(drawn - tiny, 5000);
    EXPECT_GT(tiny, 5000);
    EXPECT_GT(stopped, 500);
    EXPECT_GT(dropped, 10000);
}

// ---- rasterize_small, rasterize_tiny

using EntryStage = void (*KernelTable::*)(const RasterizeEntriesCtx&) noexcept;

struct Tile {
    AlignedVector<float> depth = AlignedVector<float>(kTilePixels + 1, 1.0F);
    AlignedVector<std::uint32_t> id = AlignedVector<std::uint32_t>(kTilePixels + 1, kNoTriangle);
    AlignedVector<float> block_far = AlignedVector<float>(kTileBlocks, 1.0F);
    std::vector<std::uint64_t> drawn;
    std::array<std::uint8_t, kTileBlocks> blank_depths{}, blank_ids{};

    /// What blank blocks hold, in place of what is stored.
    void fill_blank() {
        for (std::size_t i = 0; i < kTilePixels; ++i) {
            if (blank_depths[i / kBlockPixels] != 0) depth[i] = 1.0F;
            if (blank_ids[i / kBlockPixels] != 0) id[i] = kNoTriangle;
        }
        blank_depths = blank_ids = {};
    }
    void run(const KernelTable& table, EntryStage stage, const std::vector<TileEntry>& entries,
             const std::vector<SetupTriangle>& triangles, const DepthRule& rule,
             bool depth_alone = false) {
        drawn.assign(entries.size(), ~std::uint64_t{0});
        (table.*stage)({entries.data(), static_cast<int>(entries.size()), triangles.data(), rule,
                        kLeft, kTop, 5, depth.data(), depth_alone ? nullptr : id.data(),
                        block_far.data(), depth_alone ? nullptr : drawn.data(), blank_depths.data(),
                        depth_alone ? nullptr : blank_ids.data()});
    }
    static constexpr std::int32_t kLeft = 640, kTop = 128;
};

/// A kernel and the reference on the same depths, with ids and without.
void check_entries(const KernelTable& table, EntryStage stage, Random& random,
                   const std::vector<TileEntry>& entries,
                   const std::vector<SetupTriangle>& triangles, const std::string& where) {
    const auto flag = [&] { return static_cast<std::uint8_t>(random.below(2)); };
    const DepthRule rule =
        random.chance(2) ? DepthRule{1, 0, 0, 1} : DepthRule{flag(), flag(), flag(), flag()};
    Tile got;
    for (std::size_t i = 0; i < kTilePixels; ++i)
        got.depth[i] = static_cast<float>(random.between(0, 8)) * 0.125F;
    if (stage == &KernelTable::rasterize_small) {
        for (auto* blank : {&got.blank_depths, &got.blank_ids})
            if (!random.chance(3))
                for (std::uint8_t& is_blank : *blank)
                    is_blank = static_cast<std::uint8_t>(random.below(2));
    }
    Tile want = got, alone = got;
    alone.fill_blank();
    got.run(table, stage, entries, triangles, rule);
    alone.run(table, stage, entries, triangles, rule, true);
    want.run(table_reference(), stage, entries, triangles, rule);
    for (Tile* tile : {&got, &alone, &want}) tile->fill_blank();
    for (std::size_t i = 0; i < kTilePixels; ++i) {
        ASSERT_EQ(got.id[i], want.id[i]) << where << ", pixel " << i;
        ASSERT_TRUE(same_bits(got.depth[i], want.depth[i])) << where << ", pixel " << i;
        ASSERT_TRUE(same_bits(alone.depth[i], want.depth[i])) << where << ", alone, " << i;
        ASSERT_GE(got.block_far[i / kBlockPixels], got.depth[i]) << where << ", pixel " << i;
        ASSERT_GE(alone.block_far[i / kBlockPixels], got.depth[i]) << where << ", alone, " << i;
    }
    ASSERT_EQ(got.drawn, want.drawn) << where;
}

SetupTriangle random_plane(Random& random) {
    SetupTriangle t{};
    t.reference_x = static_cast<std::int16_t>(random.between(600, 750));
    t.reference_y = static_cast<std::int16_t>(random.between(100, 250));
    t.z = random.chance(3) ? 0.5F : random.real(0.0F, 1.0F);
    t.zx = random.chance(3) ? 0.0F : random.real(-0.1F, 0.1F);
    t.zy = random.chance(3) ? 0.0F : random.real(-0.1F, 0.1F);
    t.z_low = random.real(0.0F, 0.6F);
    t.z_high = random.real(t.z_low, 1.0F);
    return t;
}

/// A mask whose pixels lie in the tile: some dense, most of few rows.
TileEntry random_entry(Random& random, std::uint32_t triangle) {
    TileEntry entry{0, triangle, static_cast<std::uint8_t>(random.below(kTileSize)),
                    static_cast<std::uint8_t>(random.below(kTileSize)), 0};
    const int columns = std::min(random.between(1, kTinySize), kTileSize - entry.x);
    const int rows = std::min(random.between(1, kTinySize), kTileSize - entry.y);
    while (entry.covered == 0) {
        for (int i = 0; i < kTinySize * kTinySize; ++i) {
            if (i % kTinySize < columns && i / kTinySize < rows && random.chance(2))
                entry.covered |= std::uint64_t{1} << i;
        }
    }
    return entry;
}

TEST_P(KernelTest, RasterizeTinyOfRandomMasks) {
    for (unsigned seed = 0; seed < 1500; ++seed) {
        Random random(seed);
        std::vector<SetupTriangle> triangles(static_cast<std::size_t>(random.between(1, 60)));
        for (SetupTriangle& t : triangles) t = random_plane(random);
        std::vector<TileEntry> entries;
        for (std::uint32_t i = 0; i < triangles.size(); ++i)
            if (!random.chance(4)) entries.push_back(random_entry(random, i));
        ASSERT_NO_FATAL_FAILURE(
            check_entries(table(), &KernelTable::rasterize_tiny, random, entries, triangles,
                          name("rasterize_tiny") + ", seed " + std::to_string(seed)));
    }
}

/// Corners around the tile, on pixel centres and edges of blocks as well; the first is in the tile.
/// Nothing without an area.
bool set_small_corners(Random& random, SetupTriangle& t) {
    const int step = random.pick(std::array{1, 16, 64, 128, 256});
    const int most = 256 * random.pick(std::array{2, 8, 24, kSmallSize});
    const auto corner = [&](int first, int origin) {
        const int at = first + random.between(-most / 2, most / 2);
        return (origin * 256 + at) / step * step;
    };
    const int x = random.between(0, 64 * 256), y = random.between(0, 64 * 256);
    for (int i = 0; i < 3; ++i) {
        t.x[i] = corner(x, Tile::kLeft);
        t.y[i] = corner(y, Tile::kTop);
    }
    const auto area = std::int64_t{t.x[1] - t.x[0]} * (t.y[2] - t.y[0]) -
                      std::int64_t{t.y[1] - t.y[0]} * (t.x[2] - t.x[0]);
    if (area < 0) {
        std::swap(t.x[1], t.x[2]);
        std::swap(t.y[1], t.y[2]);
    }
    const auto [left, right] = std::minmax({t.x[0], t.x[1], t.x[2]});
    const auto [top, bottom] = std::minmax({t.y[0], t.y[1], t.y[2]});
    t.box = {static_cast<std::int16_t>((left + 127) >> 8),
             static_cast<std::int16_t>((top + 127) >> 8),
             static_cast<std::int16_t>((right - 128) >> 8),
             static_cast<std::int16_t>((bottom - 128) >> 8)};
    return area != 0 && right - left <= 256 * kSmallSize && bottom - top <= 256 * kSmallSize &&
           t.box.x1 >= Tile::kLeft && t.box.x0 < Tile::kLeft + kTileSize &&
           t.box.y1 >= Tile::kTop && t.box.y0 < Tile::kTop + kTileSize;
}

/// A corner's pixel, now and then cut to a frame that ends with the tile.
void set_reference(Random& random, SetupTriangle& t) {
    const auto k = static_cast<std::size_t>(random.below(3));
    std::int32_t x = t.x[k] >> 8, y = t.y[k] >> 8;
    if (random.chance(4)) {
        x = std::clamp(x, Tile::kLeft, Tile::kLeft + kTileSize - 1);
        y = std::clamp(y, Tile::kTop, Tile::kTop + kTileSize - 1);
    }
    t.reference_x = static_cast<std::int16_t>(x);
    t.reference_y = static_cast<std::int16_t>(y);
}

TEST_P(KernelTest, RasterizeSmallOfRandomTriangles) {
    for (unsigned seed = 0; seed < 2000; ++seed) {
        Random random(seed);
        std::vector<SetupTriangle> triangles(static_cast<std::size_t>(random.between(1, 40)));
        std::vector<TileEntry> entries;
        for (std::uint32_t i = 0; i < triangles.size(); ++i) {
            triangles[i] = random_plane(random);
            if (!set_small_corners(random, triangles[i])) continue;
            set_reference(random, triangles[i]);
            entries.push_back({0, i, 0, 0, 0});
        }
        if (entries.empty()) continue;
        ASSERT_NO_FATAL_FAILURE(
            check_entries(table(), &KernelTable::rasterize_small, random, entries, triangles,
                          name("rasterize_small") + ", seed " + std::to_string(seed)));
    }
}

// Edges whose crossings are as close to whole columns as they can be: one step of 1/256 pixel off a
// pixel's centre, or on it, for every height up to the greatest.
TEST_P(KernelTest, RasterizeSmallNextToPixelCentres) {
    std::vector<SetupTriangle> triangles;
    std::vector<TileEntry> entries;
    for (const int height : {257, 4097, 16129, 16383, 16384}) {
        for (const int across : {-16384, -16129, -255, 0, 1, 8192, 16383}) {
            for (const int off : {-1, 0, 1}) {
                SetupTriangle t{};
                t.z_high = 1.0F;
                const int x = Tile::kLeft * 256 + (across < 0 ? 16384 : 0) + 128 + off;
                const int y = Tile::kTop * 256 + 128 + off;
                const int third = across < 0 ? 0 : std::min(across + 300, 16384);
                const int px[3] = {x, x + across, across < 0 ? x - 300 : x + third};
                const int py[3] = {y, y + height, y + height / 2};
                const auto area = std::int64_t{px[1] - px[0]} * (py[2] - py[0]) -
                                  std::int64_t{py[1] - py[0]} * (px[2] - px[0]);
                if (area == 0) continue;
                for (int i = 0; i < 3; ++i) {
                    const int from = area > 0 ? i : (3 - i) % 3;
                    t.x[i] = px[from];
                    t.y[i] = py[from];
                }
                t.box = {Tile::kLeft, Tile::kTop, Tile::kLeft + kTileSize - 1,
                         Tile::kTop + kTileSize - 1};
                t.reference_x = Tile::kLeft;
                t.reference_y = Tile::kTop;
                entries.push_back({0, static_cast<std::uint32_t>(triangles.size()), 0, 0, 0});
                triangles.push_back(t);
            }
        }
    }
    Random random(0);
    for (std::size_t i = 0; i < entries.size(); ++i)
        ASSERT_NO_FATAL_FAILURE(
            check_entries(table(), &KernelTable::rasterize_small, random, {entries[i]}, triangles,
                          name("rasterize_small") + ", triangle " + std::to_string(i)));
}

}  // namespace
}  // namespace burnish
