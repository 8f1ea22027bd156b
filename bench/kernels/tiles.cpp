#include <algorithm>
#include <bit>
#include <string>
#include <vector>

#include "bench/kernels/stages.hpp"
#include "bench/kernels/tile.hpp"

namespace burnish::bench {
namespace {

/// Adds the edge a * x + b * y >= limit (with `open`: > limit), x and y in pixels.
void add_edge(TileTriangle& t, int a, int b, int limit, bool open) {
    // At pixel centres, in 1/256 pixel; a and b are lengths in pixels.
    t.a[t.edges] = 256 * a;
    t.b[t.edges] = 256 * b;
    t.c[t.edges] = 128 * a + 128 * b - 256 * limit - (open ? 1 : 0);
    ++t.edges;
}

/// Upper left and lower right halves of squares of `side` pixels all over the tile, at a slope,
/// depth test less or equal so that drawing them again costs the same.
std::vector<TileTriangle> squares(int side) {
    std::vector<TileTriangle> triangles;
    for (int y = 0; y < kTileSize; y += side) {
        for (int x = 0; x < kTileSize; x += side) {
            TileTriangle t{};
            t.x0 = x;
            t.y0 = y;
            t.x1 = x + side - 1;
            t.y1 = y + side - 1;
            t.z = 0.5F;
            t.zx = t.zy = 0.001F;
            t.z_high = 1.0F;
            t.pass_less = t.depth_write = 1;
            TileTriangle upper = t;
            upper.id = static_cast<std::uint32_t>(triangles.size());
            add_edge(upper, side, 0, side * x, false);
            add_edge(upper, 0, side, side * y, false);
            add_edge(upper, -side, -side, -side * (x + y + side), true);
            triangles.push_back(upper);
            TileTriangle lower = t;
            lower.id = upper.id + 1;
            add_edge(lower, side, side, side * (x + y + side), false);
            add_edge(lower, -side, 0, -side * (x + side), true);
            add_edge(lower, 0, -side, -side * (y + side), true);
            triangles.push_back(lower);
        }
    }
    return triangles;
}

/// The fragments of squares(side), as `rasterize` left them.
struct Fragments {
    std::vector<std::uint16_t> pixels = std::vector<std::uint16_t>(kTilePixels + 16);
    std::vector<std::uint32_t> first;

    void collect(const KernelTable& table, const Tile& tile) {
        first.resize(tile.drawn.size() + 2);
        table.collect({tile.id.data(), tile.drawn.data(), static_cast<int>(tile.drawn.size()),
                       pixels.data(), first.data()});
        first.pop_back();  // scratch
    }
};

}  // namespace

void add_rasterize() {
    for (const int side : {4, 16, 64}) {
        const std::vector<TileTriangle> triangles = squares(side);
        add(
            "rasterize/squares_" + std::to_string(side), kTilePixels,
            [=](const KernelTable& table) -> std::string {
                Tile got;
                Tile want;
                got.draw(table, triangles);
                want.draw(table_reference(), triangles);
                if (std::count(want.id.begin(), want.id.begin() + kTilePixels, kNoTriangle) != 0)
                    return "holes";
                return got.id == want.id && got.depth == want.depth ? "" : "ids or depths";
            },
            [=](const KernelTable& table, benchmark::State& state) {
                Tile tile;
                for (auto _ : state) {
                    tile.draw(table, triangles);
                    benchmark::ClobberMemory();
                }
            });
    }
}

void add_clear() {
    add(
        "clear_words", kTilePixels,
        [](const KernelTable& table) -> std::string {
            AlignedVector<std::uint32_t> words(kTilePixels);
            table.clear_words({words.data(), 3, kTilePixels});
            return std::count(words.begin(), words.end(), 3U) == kTilePixels ? "" : "words";
        },
        [](const KernelTable& table, benchmark::State& state) {
            AlignedVector<std::uint32_t> words(kTilePixels);
            for (auto _ : state) {
                table.clear_words({words.data(), 3, kTilePixels});
                benchmark::ClobberMemory();
            }
        });
}

/// The bits that every triangle leaves, one after the other.
void add_cover() {
    for (const int side : {4, 16, 64}) {
        const std::vector<TileTriangle> triangles = squares(side);
        const auto draw = [=](const KernelTable& table, Tile& tile) {
            std::uint64_t hash = 0, blocks = 0;
            std::uint64_t passed[kTileBlocks];
            for (const TileTriangle& t : triangles) {
                table.cover({&t, tile.depth.data(), tile.block_far.data(), passed, &blocks});
                for (std::uint64_t rest = blocks; rest != 0; rest &= rest - 1)
                    hash = hash * 0x100000001b3U + passed[std::countr_zero(rest)];
            }
            return hash;
        };
        add(
            "cover/squares_" + std::to_string(side), kTilePixels,
            [=](const KernelTable& table) -> std::string {
                Tile got, want;
                return draw(table, got) == draw(table_reference(), want) ? "" : "pixels";
            },
            [=](const KernelTable& table, benchmark::State& state) {
                for (auto _ : state) {
                    Tile tile;
                    benchmark::DoNotOptimize(draw(table, tile));
                }
            });
    }
}

void add_rasterize_depths() {
    for (const int side : {4, 16, 64}) {
        const std::vector<TileTriangle> triangles = squares(side);
        add(
            "rasterize_depths/squares_" + std::to_string(side), kTilePixels,
            [=](const KernelTable& table) -> std::string {
                Tile got, want;
                got.draw_depths(table, triangles);
                want.draw(table_reference(), triangles);
                return got.depth == want.depth ? "" : "depths";
            },
            [=](const KernelTable& table, benchmark::State& state) {
                Tile tile;
                for (auto _ : state) {
                    tile.draw_depths(table, triangles);
                    benchmark::ClobberMemory();
                }
            });
    }
}

void add_collect() {
    for (const int side : {2, 4, 16, 64}) {
        Tile tile;
        tile.draw(table_reference(), squares(side));
        add(
            "collect/squares_" + std::to_string(side), kTilePixels,
            [=](const KernelTable& table) -> std::string {
                Fragments got;
                Fragments want;
                got.collect(table, tile);
                want.collect(table_reference(), tile);
                got.pixels.resize(kTilePixels);
                want.pixels.resize(kTilePixels);
                return got.first == want.first && got.pixels == want.pixels ? "" : "fragments";
            },
            [=](const KernelTable& table, benchmark::State& state) {
                Fragments out;
                for (auto _ : state) {
                    out.collect(table, tile);
                    benchmark::ClobberMemory();
                }
            });
    }
}

}  // namespace burnish::bench
