#include <cstring>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bench/kernels/stages.hpp"
#include "bench/kernels/tile.hpp"

namespace burnish::bench {
namespace {

/// A sheet of quads, two triangles each, on which the stages for small triangles are timed: `size`
/// pixels a quad, turned a little so that no edge is level. Faces the eye.
struct Sheet {
    static constexpr int kSide = 40;
    static constexpr int kTriangles = 2 * kSide * kSide;
    std::vector<ScreenVertex> vertices;
    std::vector<std::uint32_t> indices;
    AlignedVector<SetupTriangle> triangles{kTriangles + 1};
    std::vector<SetupPlace> places = std::vector<SetupPlace>(kTriangles + 1);
    SetupCounts counts{};

    explicit Sheet(float size) {
        for (int y = 0; y <= kSide; ++y) {
            for (int x = 0; x <= kSide; ++x) {
                const auto u = static_cast<float>(x), v = static_cast<float>(y);
                const auto window = [&](float pixel) {
                    return static_cast<std::int32_t>(size * pixel * 16.0F) * 16 + 3 * 256;
                };
                vertices.push_back({window(u + 0.1F * v), window(v + 0.07F * (kSide - u)),
                                    0.4F + 0.002F * u + 0.003F * v, 0});
            }
        }
        for (std::uint32_t y = 0; y < kSide; ++y) {
            for (std::uint32_t x = 0; x < kSide; ++x) {
                const std::uint32_t a = y * (kSide + 1) + x, b = a + kSide + 1;
                indices.insert(indices.end(), {a, a + 1, b, b, a + 1, b + 1});
            }
        }
    }
    SetupCtx context() {
        SetupCtx ctx{};
        ctx.vertices = vertices.data();
        ctx.indices = indices.data();
        ctx.count = kTriangles;
        ctx.width = ctx.height = 1024;
        ctx.drop_negative = 1;
        ctx.triangles = triangles.data();
        ctx.places = places.data();
        ctx.counts = &counts;
        return ctx;
    }
    bool operator==(const Sheet& other) const {
        const auto drawn = static_cast<std::size_t>(counts.drawn);
        const auto same_mask = [](const SetupPlace& a, const SetupPlace& b) {
            return a.covered == b.covered;
        };
        return counts.drawn == other.counts.drawn &&
               std::equal(places.data(), places.data() + drawn, other.places.data(), same_mask) &&
               std::memcmp(triangles.data(), other.triangles.data(),
                           drawn * sizeof(SetupTriangle)) == 0;
    }
};

/// The triangles of a sheet in the tile from pixel (corner, corner) on: tiny ones that lie in it,
/// or small ones that reach into it.
std::vector<TileEntry> entries_of(const Sheet& sheet, bool tiny, int corner) {
    std::vector<TileEntry> entries;
    const int end = corner + kTileSize;
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(sheet.counts.drawn); ++i) {
        const PixelRect& box = sheet.triangles[i].box;
        const std::uint64_t covered = sheet.places[i].covered;
        const bool inside = box.x0 >= corner && box.y0 >= corner && box.x1 < end && box.y1 < end;
        const bool reaches = box.x1 >= corner && box.y1 >= corner && box.x0 < end && box.y0 < end;
        if (tiny ? covered == 0 || !inside : !reaches) continue;
        entries.push_back({tiny ? covered : 0, i, static_cast<std::uint8_t>(box.x0 % kTileSize),
                           static_cast<std::uint8_t>(box.y0 % kTileSize), 0});
    }
    return entries;
}

/// Into depths that are cleared again each time: 16 KB.
void add_rasterize_entries(const std::string& name, float size, bool tiny) {
    static std::vector<std::unique_ptr<Sheet>> sheets;
    sheets.push_back(std::make_unique<Sheet>(size));
    Sheet& sheet = *sheets.back();
    table_reference().setup(sheet.context());
    const int corner = tiny ? 0 : 4 * kTileSize;  // where the sheet is whole
    const std::vector<TileEntry> entries = entries_of(sheet, tiny, corner);
    const auto draw = [entries, tiny, corner, &sheet](const KernelTable& table, Tile& tile) {
        tile.drawn.resize(entries.size());
        (tiny ? table.rasterize_tiny : table.rasterize_small)(
            {entries.data(), static_cast<int>(entries.size()), sheet.triangles.data(),
             DepthRule{1, 0, 0, 1}, corner, corner, 0, tile.depth.data(), tile.id.data(),
             tile.block_far.data(), tile.drawn.data(), tile.blank.data(), tile.blank.data()});
    };
    add(
        name, static_cast<std::int64_t>(entries.size()),
        [=](const KernelTable& table) -> std::string {
            Tile got, want;
            draw(table, got);
            draw(table_reference(), want);
            got.id.back() = want.id.back();
            got.depth.back() = want.depth.back();
            return got.id == want.id && got.depth == want.depth ? "" : "ids or depths";
        },
        [=](const KernelTable& table, benchmark::State& state) {
            Tile tile;
            for (auto _ : state) {
                std::fill(tile.depth.begin(), tile.depth.end(), 1.0F);
                std::fill(tile.block_far.begin(), tile.block_far.end(), 1.0F);
                draw(table, tile);
                benchmark::ClobberMemory();
            }
        });
}

}  // namespace

/// Triangles of 2.5 pixels, of 8, and of 50, which are not tiny.
void add_setup() {
    for (const auto& [name, size] : {std::pair{"2", 2.24F}, {"8", 4.0F}, {"50", 10.0F}}) {
        add(
            std::string("setup/pixels_") + name, Sheet::kTriangles,
            [=](const KernelTable& table) -> std::string {
                Sheet got(size), want(size);
                table.setup(got.context());
                table_reference().setup(want.context());
                if (want.counts.drawn < Sheet::kTriangles / 2) return "triangles that are missing";
                return got == want ? "" : "triangles";
            },
            [=](const KernelTable& table, benchmark::State& state) {
                Sheet sheet(size);
                const SetupCtx ctx = sheet.context();
                for (auto _ : state) {
                    table.setup(ctx);
                    benchmark::ClobberMemory();
                }
            });
    }
}

void add_small_triangles() {
    add_rasterize_entries("rasterize_tiny/pixels_2", 2.24F, true);
    add_rasterize_entries("rasterize_tiny/pixels_8", 4.0F, true);
    add_rasterize_entries("rasterize_small/pixels_50", 10.0F, false);
    add_rasterize_entries("rasterize_small/pixels_300", 24.0F, false);
}

}  // namespace burnish::bench
