#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "bench/count_instructions.hpp"
#include "bench/run_benchmarks.hpp"
#include "core/cpu.hpp"
#include "tests/kernel_packet.hpp"

/// Every stage of every table that this CPU can run: stage/<name>/<variant>/<isa>. Results are
/// compared with the reference before anything is timed. Items are fragments, vertices for
/// `transform` and `light_vertices`, triangles for `setup`, `rasterize_tiny`, `rasterize_small` and
/// `attribute_planes`, covered pixels for `rasterize`; `cycles` are those of the time-stamp counter
/// per item, which runs at the CPU's nominal clock.
namespace burnish {
namespace {

/// --instructions: every kernel runs once, and its instructions are counted (x86-64).
bool count_only = false;

template <class Ctx>
using PacketStage = void (*KernelTable::*)(Packet&, const Ctx&) noexcept;

/// Registers `run` for each table; `difference` is empty where the table is right.
void add(const std::string& name, std::int64_t items,
         const std::function<std::string(const KernelTable&)>& difference,
         const std::function<void(const KernelTable&, benchmark::State&)>& run) {
    for (const KernelTable* table : available_tables()) {
        const auto body = [=](benchmark::State& state) {
            const std::string text = difference(*table);
            if (!text.empty()) return state.SkipWithError(("not the reference: " + text).c_str());
            if (count_only) {
                run(counted_kernels(*table), state);
                state.counters["instructions"] = static_cast<double>(counted_instructions());
                return;
            }
            const std::uint64_t start = cycles_so_far();
            run(*table, state);
            count_items(state, items, cycles_so_far() - start);
        };
        auto* registered =
            benchmark::RegisterBenchmark(("stage/" + name + "/" + table->isa).c_str(), body);
        if (count_only) registered->Iterations(1);
    }
}

template <class Ctx>
void add_packet_stage(const std::string& name, PacketStage<Ctx> stage, const PacketMemory& before,
                      const Ctx& ctx, const Written& written) {
    add(
        name, before.count,
        [=](const KernelTable& table) {
            return stage_difference(table, stage, before, ctx, written);
        },
        [=](const KernelTable& table, benchmark::State& state) {
            PacketMemory memory = before;
            Packet packet = memory.view();
            for (auto _ : state) {
                (table.*stage)(packet, ctx);
                benchmark::ClobberMemory();
            }
        });
}

void fill_planes(PacketMemory& packet, Random& random, int count, int low, int high) {
    for (int k = 0; k < count; ++k)
        for (int i = 0; i < kPacketSize; ++i)
            packet.plane(k)[i] = static_cast<std::int16_t>(random.between(low, high));
}

// ---- before shading

struct Grid {
    static constexpr int kCount = 4096;
    AlignedVector<float> x, y, z;
    AlignedVector<ScreenVertex> screen{kCount};
    AlignedVector<HomogeneousVertex> homogeneous{kCount};

    Grid() {
        Random random(1);
        for (AlignedVector<float>* v : {&x, &y, &z})
            for (int i = 0; i < kCount; ++i) v->push_back(random.real(-1.0F, 1.0F));
    }
    TransformCtx context() {
        // 60 degrees, 3 units away, 1024 x 768, 1/16 pixel.
        return {x.data(),
                y.data(),
                z.data(),
                kCount,
                {1.3F, 0, 0, 0, 0, 1.73F, 0, 0, 0, 0, -1.02F, -1, 0, 0, 2.86F, 3},
                {512, 384, 1024, 768, 16, 0.5F},
                screen.data(),
                homogeneous.data()};
    }
};

void add_transform() {
    static Grid grid;
    static Grid reference;
    add(
        "transform", Grid::kCount,
        [](const KernelTable& table) -> std::string {
            table.transform(grid.context());
            table_reference().transform(reference.context());
            const auto bytes = sizeof(ScreenVertex) * Grid::kCount;
            const bool same = std::memcmp(grid.screen.data(), reference.screen.data(), bytes) == 0;
            return same ? "" : "screen vertices";
        },
        [](const KernelTable& table, benchmark::State& state) {
            const TransformCtx ctx = grid.context();
            for (auto _ : state) {
                table.transform(ctx);
                benchmark::ClobberMemory();
            }
        });
}

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

/// Vertices with a half vector and a cosine each, as two-combiner machines want them.
struct LitVertices {
    static constexpr int kCount = 1024;
    static constexpr std::array<std::int8_t, 4> kValues{
        VertexValue::half, VertexValue::half + 1, VertexValue::half + 2, VertexValue::n_dot_l};
    std::vector<float> frames = std::vector<float>(kCount * LightVerticesCtx::kFrameFloats);
    std::vector<float> out = std::vector<float>(kCount * kValues.size());

    LitVertices() {
        for (std::size_t i = 0; i < frames.size(); ++i)
            frames[i] = 0.25F + 0.5F * static_cast<float>(i * 7 % 31) / 31.0F;
    }
    LightVerticesCtx context() {
        LightVerticesCtx ctx{};
        ctx.frames = frames.data();
        ctx.count = kCount;
        ctx.light[1] = ctx.eye[2] = 3.0F;
        ctx.eye_w = 1.0F;
        ctx.values = kValues.data();
        ctx.stride = static_cast<int>(kValues.size());
        ctx.out = out.data();
        return ctx;
    }
};

void add_light_vertices() {
    static LitVertices vertices, reference;
    add(
        "light_vertices", LitVertices::kCount,
        [](const KernelTable& table) -> std::string {
            table.light_vertices(vertices.context());
            table_reference().light_vertices(reference.context());
            return vertices.out == reference.out ? "" : "values of vertices";
        },
        [](const KernelTable& table, benchmark::State& state) {
            const LightVerticesCtx ctx = vertices.context();
            for (auto _ : state) {
                table.light_vertices(ctx);
                benchmark::ClobberMemory();
            }
        });
}

struct Tile {
    AlignedVector<float> depth = AlignedVector<float>(kTilePixels + 1, 1.0F);
    AlignedVector<std::uint32_t> id = AlignedVector<std::uint32_t>(kTilePixels + 1, kNoTriangle);
    AlignedVector<float> block_far = AlignedVector<float>(kTileBlocks, 1.0F);

    std::vector<std::uint64_t> drawn;
    std::array<std::uint8_t, kTileBlocks> blank{};  ///< none

    void draw(const KernelTable& table, const std::vector<TileTriangle>& triangles) {
        drawn.resize(triangles.size());
        table.rasterize({triangles.data(), static_cast<int>(triangles.size()), depth.data(),
                         id.data(), block_far.data(), drawn.data()});
    }
    void draw_depths(const KernelTable& table, const std::vector<TileTriangle>& triangles) {
        table.rasterize({triangles.data(), static_cast<int>(triangles.size()), depth.data(),
                         nullptr, block_far.data(), nullptr});
    }
};

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

// ---- from triangles to registers

void add_attributes() {
    constexpr int kAttributes = 14;  // tangent frame, position, texture coordinates
    static Equations equations(kAttributes);
    static std::array<std::vector<Run>, 4> runs;
    Random random(2);
    for (int e = 0; e <= kAttributes; ++e)
        for (int r = 0; r < kPacketSize; ++r)
            equations.set(
                e, r,
                {random.real(0.5F, 1.0F), random.real(0.0F, 0.01F), random.real(0.0F, 0.01F)});
    Written written;
    for (int k = 0; k < kAttributes; ++k) written.attributes.push_back(k);
    const std::array lengths{1, 4, 16, 64};
    for (std::size_t v = 0; v < lengths.size(); ++v) {
        const int length = lengths[v];
        for (int first = 0; first < kPacketSize; first += length)
            runs[v].push_back({first, length, 100, 200});
        add_packet_stage("attributes/runs_of_" + std::to_string(length), &KernelTable::attributes,
                         PacketMemory(),
                         AttributesCtx{runs[v].data(), static_cast<int>(runs[v].size()),
                                       kAttributes, equations.data()},
                         written);
    }
}

/// The triangles between the vertices of a grid, as tiny ones of a mesh are.
struct GridTriangles {
    static constexpr int kSide = 12, kAttributes = 6;  // uv, a half vector and a cosine
    static constexpr int kStride = 8;
    std::vector<HomogeneousVertex> homogeneous;
    std::vector<float> rows = std::vector<float>(kSide * kSide * kStride + 3);
    std::vector<PlaneTriangle> triangles;

    GridTriangles() {
        Random random(21);
        for (float& x : rows) x = random.unit();
        for (int v = 0; v < kSide * kSide; ++v) {
            const float w = random.real(3.0F, 4.0F);
            homogeneous.push_back({100.0F * w, 100.0F * w, 0.5F * w, w});
        }
        for (int y = 0; y + 1 < kSide; ++y) {
            for (int x = 0; x + 1 < kSide; ++x) {
                const auto v = static_cast<std::uint32_t>(y * kSide + x);
                const int left = 1000 * x, top = 900 * y;
                triangles.push_back({{left, left + 1000, left},
                                     {top, top, top + 900},
                                     {v, v + 1, v + kSide},
                                     4 * x,
                                     3 * y,
                                     0});
            }
        }
    }
    void make(const KernelTable& table, int count, Equations& out) const {
        table.attribute_planes({triangles.data(), count, homogeneous.data(), rows.data(), kStride,
                                kAttributes, out.rows.data()});
    }
};

void add_attribute_planes() {
    static const GridTriangles grid;
    static Equations got(GridTriangles::kAttributes), want(GridTriangles::kAttributes);
    for (const int count : {4, 16, 96}) {
        add(
            "attribute_planes/triangles_" + std::to_string(count), count,
            [=](const KernelTable& table) -> std::string {
                grid.make(table, count, got);
                grid.make(table_reference(), count, want);
                for (std::size_t i = 0; i < got.rows.size(); ++i)
                    if (i % kAttributeStride < static_cast<std::size_t>(count) &&
                        !same_bits(got.rows[i], want.rows[i]))
                        return "equations";
                return "";
            },
            [=](const KernelTable& table, benchmark::State& state) {
                for (auto _ : state) {
                    grid.make(table, count, got);
                    benchmark::ClobberMemory();
                }
            });
    }
}

void add_lighting_and_encode() {
    PacketMemory packet;
    Random random(3);
    for (int k = 0; k < 12; ++k)
        for (int i = 0; i < kPacketSize; ++i) packet.attribute(k)[i] = random.real(-1.0F, 1.0F);
    LightingCtx ctx{0, {3, 4, 5}, 1.0F, {0, 0, 6}, 12, -1, -1, -1, -1};
    add_packet_stage("lighting/half_vector", &KernelTable::lighting, packet, ctx,
                     {.attributes = {12, 13, 14}});
    ctx = {0, {3, 4, 5}, 1.0F, {0, 0, 6}, 12, 15, 18, 21, 22};
    add_packet_stage("lighting/all", &KernelTable::lighting, packet, ctx,
                     {.attributes = {12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22}});
    ctx = {0, {0.6F, 0, 0.8F}, 0.0F, {0, 0, 6}, 12, 15, -1, -1, -1};
    add_packet_stage("lighting/half_vector_of_direction", &KernelTable::lighting, packet, ctx,
                     {.attributes = {12, 13, 14, 15, 16, 17}});
    ctx = {0, {3, 4, 5}, 1.0F, {0, 0, 6}, 12, -1, -1, -1, -1, 1.0F, 0, 1};
    add_packet_stage("lighting/half_vector_orthonormal", &KernelTable::lighting, packet, ctx,
                     {.attributes = {12, 13, 14}});
    add_packet_stage("encode_nine_bit", &KernelTable::encode_nine_bit, packet, EncodeCtx{0, 0},
                     {.planes = {0}});
    add_packet_stage("encode_wide", &KernelTable::encode_wide, packet, EncodeCtx{0, 0},
                     {.planes = {0}});
}

// ---- texels

constexpr int kTexture = 256;                         // texels, both ways
constexpr std::int32_t kPitch = 4 * (kTexture + 16);  // bytes

void add_texels() {
    static std::vector<std::uint8_t> texels;
    Random random(4);
    texels.resize(static_cast<std::size_t>(kPitch * (kTexture + 1)));
    for (std::uint8_t& t : texels) t = static_cast<std::uint8_t>(random.below(256));
    PacketMemory packet;
    // A quarter turn of the texture at one texel per pixel, as four blocks see it.
    for (int i = 0; i < kPacketSize; ++i) {
        const auto x = static_cast<float>(i / 64 * 8 + i % 8);
        const auto y = static_cast<float>(i % 64 / 8);
        packet.attribute(0)[i] = 0.3F + (x * 0.8F - y * 0.6F) / static_cast<float>(kTexture);
        packet.attribute(1)[i] = 0.9F + (x * 0.6F + y * 0.8F) / static_cast<float>(kTexture);
        packet.attribute(2)[i] = 1.0F + 0.001F * x;
    }
    AddressCtx ctx{0, 1, -1, kTexture, kTexture, kPitch, AddressMode::repeat, AddressMode::repeat,
                   1};
    const Written addresses{.addresses = true};
    add_packet_stage("address/repeat", &KernelTable::address, packet, ctx, addresses);
    Packet view = packet.view();
    table_reference().address(view, ctx);
    ctx.q = 2;
    add_packet_stage("address/repeat_over_q", &KernelTable::address, packet, ctx, addresses);
    ctx = {0,
           1,
           -1,
           kTexture,
           kTexture,
           kPitch,
           AddressMode::clamp_to_edge,
           AddressMode::clamp_to_edge,
           1};
    add_packet_stage("address/clamp", &KernelTable::address, packet, ctx, addresses);

    FetchCtx fetch{{}, {}, {}, 1, kPitch};
    for (int k = 0; k < 3; ++k) {
        fetch.texels[k] = texels.data();
        fetch.plane[k] = 4 * k;
    }
    Written fetched{.planes = {0, 1, 2, 3}};
    add_packet_stage("fetch_nine_bit", &KernelTable::fetch_nine_bit, packet, fetch, fetched);
    add_packet_stage("fetch_wide", &KernelTable::fetch_wide, packet, fetch, fetched);
    fetch.count = 3;
    for (int plane = 4; plane < 12; ++plane) fetched.planes.push_back(plane);
    add_packet_stage("fetch_nine_bit/three_maps", &KernelTable::fetch_nine_bit, packet, fetch,
                     fetched);
}

/// What levels, faces, slices and words cost besides the bilinear fetch.
void add_levels() {
    PacketMemory packet;
    Random random(5);
    for (int k = 0; k < 4; ++k)
        for (int i = 0; i < kPacketSize; ++i) packet.attribute(k)[i] = random.real(-1.0F, 1.0F);
    for (int i = 0; i < kPacketSize; ++i) {
        packet.attribute(6)[i] = random.real(0.5F, 200.0F);
        packet.plane(5)[i] = static_cast<std::int16_t>(random.below(900));
        packet.texel[static_cast<std::size_t>(i)] = 8 * random.below(256);
        packet.weight_x[static_cast<std::size_t>(i)] = static_cast<std::int16_t>(i % 256);
        packet.weight_y[static_cast<std::size_t>(i)] = static_cast<std::int16_t>(255 - i % 256);
    }
    add_packet_stage("cube_face", &KernelTable::cube_face, packet, CubeFaceCtx{0, 1, 2, 7, 8, 5},
                     {.planes = {5}, .attributes = {7, 8}});
    static Equations equations(3);
    static std::vector<Run> runs;
    for (int r = 0; r < kPacketSize / 16; ++r) {
        equations.set(0, r, {1.0F, 0.001F, 0.002F});
        equations.set(1, r, {0.3F, 0.8F, 0.1F});
        equations.set(2, r, {0.2F, 0.1F, 0.9F});
        equations.set(3, r, {1.0F, 0.0F, 0.0F});
        runs.push_back({16 * r, 16, 100, 200});
    }
    const FootprintCtx footprint{0, 1, -1, -1, 0, {256.0F, 256.0F, 1.0F}, 7};
    add_packet_stage(
        "plane_footprint/runs_of_16", &KernelTable::plane_footprint, packet,
        PlaneFootprintCtx{footprint,
                          {runs.data(), static_cast<int>(runs.size()), 3, equations.data()}},
        {.attributes = {7}});
    add_packet_stage("quad_footprint", &KernelTable::quad_footprint, packet,
                     QuadFootprintCtx{footprint}, {.attributes = {7}});
    add_packet_stage(
        "probe_extent/runs_of_16", &KernelTable::probe_extent, packet,
        ProbeExtentCtx{footprint,
                       {runs.data(), static_cast<int>(runs.size()), 3, equations.data()},
                       8,
                       9,
                       16.0F},
        {.attributes = {7, 8, 9, 10}});
    for (int i = 0; i < kPacketSize; ++i) packet.attribute(8)[i] = static_cast<float>(1 + i % 16);
    add_packet_stage("probe_point", &KernelTable::probe_point, packet,
                     ProbePointCtx{0, 1, -1, 2, 8, 11, 3}, {.attributes = {11, 12}});
    for (int k = 13; k < 17; ++k)
        for (int i = 0; i < kPacketSize; ++i)
            packet.attribute(k)[i] = static_cast<float>(random.below(4096));
    for (int k = 10; k < 14; ++k)
        for (int i = 0; i < kPacketSize; ++i)
            packet.plane(k)[i] = static_cast<std::int16_t>(random.below(256));
    const ProbeSumCtx sum{8, 3, 13, 4, {10, 11, 12, 13}, 0};
    add_packet_stage("probe_sum", &KernelTable::probe_sum, packet, sum,
                     {.attributes = {13, 14, 15, 16}});
    add_packet_stage("probe_mean", &KernelTable::probe_mean, packet, sum,
                     {.planes = {10, 11, 12, 13}});
    add_packet_stage("level_of_detail", &KernelTable::level_of_detail, packet,
                     LevelOfDetailCtx{6, 7, 0, 1024}, {.planes = {7}});
    LevelAddressCtx address{};
    address.v = 1;
    address.q = address.r = address.face = address.slice_weight = -1;
    address.lambda = 5;
    address.choice = LevelChoice::floor;
    address.mag_linear = address.min_linear = 1;
    address.pitch = kPitch;
    address.texel_bytes = 4;
    address.level_count = 9;
    for (int k = 0; k < address.level_count; ++k)
        address.levels[k] = {kTexture >> k, kTexture >> k, 1, 1000 * k};
    add_packet_stage("level_address", &KernelTable::level_address, packet, address,
                     {.addresses = true});
    TexelCornerCtx corner{};
    corner.v = 1;
    corner.q = -1;
    corner.lambda = 5;
    corner.to = 2;
    corner.weight = 6;
    corner.choice = LevelChoice::floor;
    corner.mag_linear = corner.min_linear = 1;
    corner.level_count = address.level_count;
    std::copy_n(address.levels, address.level_count, corner.levels);
    corner.level = 8;
    add_packet_stage("texel_corner", &KernelTable::texel_corner, packet, corner,
                     {.planes = {6, 7, 8}, .attributes = {2, 3}});
    for (int i = 0; i < kPacketSize; ++i) {
        packet.plane(6)[i] = static_cast<std::int16_t>(i % 256);
        packet.plane(7)[i] = static_cast<std::int16_t>(255 - i % 256);
        for (int k = 10; k < 26; ++k)
            packet.plane(k)[i] = static_cast<std::int16_t>(random.below(256));
    }
    add_packet_stage("filter_nine_bit", &KernelTable::filter_nine_bit, packet, FilterCtx{10, 6, 30},
                     {.planes = {30, 31, 32, 33}});
    add_packet_stage("filter_wide", &KernelTable::filter_wide, packet, FilterCtx{10, 6, 30},
                     {.planes = {30, 31, 32, 33}});
    add_packet_stage("blend_levels", &KernelTable::blend_levels, packet,
                     BlendLevelsCtx{10, 14, 20, 4, 5, 0}, {.planes = {20, 21, 22, 23}});
    static const std::vector<std::uint8_t> texels(8192, 77);
    add_packet_stage("fetch_hilo", &KernelTable::fetch_hilo, packet,
                     FetchHiloCtx{texels.data(), 20, 2112}, {.planes = {20, 21}});
    add_packet_stage("fetch_words", &KernelTable::fetch_words, packet,
                     FetchWordsCtx{texels.data(), 20, 2112}, {.planes = {20, 21, 22, 23}});
    for (std::int32_t& texel : packet.texel) texel = 4 * texel % 4096;
    Written fetched;
    for (int plane = 16; plane < 32; ++plane) fetched.planes.push_back(plane);
    add_packet_stage("fetch_quartet", &KernelTable::fetch_quartet, packet,
                     FetchQuartetCtx{texels.data(), {16, 20, 24, 28}, 2112}, fetched);
    add_packet_stage("prefetch_quartet", &KernelTable::prefetch_quartet, packet,
                     PrefetchQuartetCtx{texels.data(), 2112}, {});
    for (const int k : {0, 1})
        for (int i = 0; i < kPacketSize; ++i)
            packet.plane(k)[i] = static_cast<std::int16_t>(random.below(16385));
    LookUpTableCtx table{texels.data(),
                         {0, 60, 59.0F, 0.5F, 60.0F},
                         {1, 32, 31.0F, 0.5F, 32.0F},
                         252,
                         {20, -1, -1, -1}};
    add_packet_stage("look_up_table/of_two", &KernelTable::look_up_table, packet, table,
                     {.planes = {20}});
    table.s = {0, 1024, 1023.0F, 0.5F, 1024.0F};
    table.t.plane = -1;
    add_packet_stage("look_up_table/of_one", &KernelTable::look_up_table, packet, table,
                     {.planes = {20}});
    static const std::vector<std::int16_t> codes(65536, 13139);  // of two bytes 77
    LookUpTableCtx whole = table;
    whole.codes = codes.data();
    add_packet_stage("look_up_table/of_codes", &KernelTable::look_up_table, packet, whole,
                     {.planes = {20}});
    static const std::vector<std::uint8_t> summed(33 * 520, 3);
    AverageTableCtx sums{summed.data(), table.s, table.t, 0x1p-15F,
                         0.0F,          8.0F,    520,     {20, -1, -1, -1}};
    add_packet_stage("average_table/of_one", &KernelTable::average_table, packet, sums,
                     {.planes = {20}});
    sums.s = {0, 60, 59.0F, 0.5F, 60.0F};
    sums.t = {1, 32, 31.0F, 0.5F, 32.0F};
    sums.pitch = 520;
    add_packet_stage("average_table/of_two", &KernelTable::average_table, packet, sums,
                     {.planes = {20}});
    add_packet_stage("hilo", &KernelTable::hilo, packet, HiloCtx{5, 7, 0}, {.attributes = {7, 8}});
}

// ---- between two fetches

void add_texture_shader() {
    PacketMemory packet;
    Random random(9);
    for (int i = 0; i < kPacketSize; ++i) {
        for (int k = 0; k < 8; ++k) packet.attribute(k)[i] = random.real(-1.0F, 1.0F);
        packet.attribute(8)[i] = random.real(0.5F, 2.0F);
        for (int k = 0; k < 8; ++k)
            packet.plane(k)[i] = static_cast<std::int16_t>(random.below(256));
    }
    const Written one{.attributes = {20}};
    add_packet_stage("decode_nine_bit", &KernelTable::decode_nine_bit, packet,
                     DecodeCtx{3, 20, Reading::unsigned_texel}, one);
    add_packet_stage("decode_wide/expand", &KernelTable::decode_wide, packet,
                     DecodeCtx{3, 20, Reading::expanded}, one);
    add_packet_stage("affine", &KernelTable::affine, packet, AffineCtx{0, 20, 2.0F, -1.0F, 1.0F},
                     one);
    add_packet_stage("dot_product", &KernelTable::dot_product, packet,
                     DotCtx{{0, 1, 2}, {3, 4, 5}, 20}, one);
    add_packet_stage("hemisphere", &KernelTable::hemisphere, packet, HemisphereCtx{0, 1, 20}, one);
    add_packet_stage("offset", &KernelTable::offset, packet,
                     OffsetCtx{0, 1, -1, 2, 3, {0.1F, 0.2F, 0.3F, 0.4F}, 20},
                     Written{.attributes = {20, 21}});
    add_packet_stage("offset/over_q", &KernelTable::offset, packet,
                     OffsetCtx{0, 1, 8, 2, 3, {0.1F, 0.2F, 0.3F, 0.4F}, 20},
                     Written{.attributes = {20, 21}});
    add_packet_stage("reflect", &KernelTable::reflect, packet, ReflectCtx{{0, 1, 2}, {3, 4, 5}, 20},
                     Written{.attributes = {20, 21, 22}});
    add_packet_stage("quotient", &KernelTable::quotient, packet, QuotientCtx{0, 8, 20}, one);
    add_packet_stage("angle", &KernelTable::angle, packet, AngleCtx{0, 1, 20}, one);
    add_packet_stage("cull", &KernelTable::cull, packet,
                     CullCtx{{0, 1, 2, 3}, {0, 1, 0, 1}, -1, 20}, one);
    const MagnitudeCtx dim{4, 0, 8, 0.75F, 0.5F, 1};
    const Written dimmed{.planes = {8, 9, 10, 11}};
    add_packet_stage("dim_nine_bit", &KernelTable::dim_nine_bit, packet, dim, dimmed);
    add_packet_stage("dim_wide", &KernelTable::dim_wide, packet, dim, dimmed);
}

// ---- combiners

Operand operand(int first, int mapping) {
    return {{static_cast<std::int16_t>(first), static_cast<std::int16_t>(first + 1),
             static_cast<std::int16_t>(first + 2)},
            static_cast<std::uint8_t>(mapping)};
}

constexpr int kTrash = 30;

/// Inputs in planes 0 .. 12, outputs from 14 on.
PortionCtx portion(ProductKind ab, ProductKind cd, ThirdKind third) {
    PortionCtx ctx{};
    ctx.a = operand(0, 6);
    ctx.b = operand(3, 6);
    ctx.c = operand(6, 6);
    ctx.d = operand(9, 6);
    ctx.ab = ab;
    ctx.cd = cd;
    ctx.third = third;
    ctx.components = 3;
    ctx.mux_plane = 12;
    for (int c = 0; c < 3; ++c) {
        ctx.ab_out[c] = static_cast<std::int16_t>(14 + c);
        ctx.cd_out[c] = ctx.third_out[c] = kTrash;
        const auto plane = static_cast<std::int16_t>(17 + c);
        if (third != ThirdKind::none)
            ctx.third_out[c] = plane;
        else if (cd != ProductKind::none)
            ctx.cd_out[c] = plane;
    }
    return ctx;
}

void add_portions(const std::string& name, PacketStage<PortionCtx> stage,
                  const PacketMemory& packet, bool bounded = false) {
    const auto add_portion = [&](const char* variant, PortionCtx ctx, Written written) {
        ctx.bounded = bounded ? 1 : 0;
        written.trash_plane = kTrash;
        add_packet_stage(name + "/" + variant, stage, packet, ctx, written);
    };
    const Written first{.planes = {14, 15, 16}};
    const Written both{.planes = {14, 15, 16, 17, 18, 19}};
    add_portion("multiply", portion(ProductKind::multiply, ProductKind::none, ThirdKind::none),
                first);
    PortionCtx bump = portion(ProductKind::dot, ProductKind::none, ThirdKind::none);
    bump.a.mapping = bump.b.mapping = 2;
    bump.components = 1;
    add_portion("dot_of_expanded", bump, {.planes = {14}});
    PortionCtx scalar = portion(ProductKind::multiply, ProductKind::none, ThirdKind::none);
    scalar.components = 1;
    scalar.scale = OutputScale::two;
    add_portion("alpha_scale_two", scalar, {.planes = {14}});
    add_portion("two_products",
                portion(ProductKind::multiply, ProductKind::multiply, ThirdKind::none), both);
    add_portion("sum", portion(ProductKind::multiply, ProductKind::multiply, ThirdKind::sum), both);
    add_portion("mux", portion(ProductKind::multiply, ProductKind::multiply, ThirdKind::mux), both);
    // The two stages of the anisotropic lobe.
    PortionCtx dots = portion(ProductKind::dot, ProductKind::dot, ThirdKind::none);
    dots.a.mapping = dots.b.mapping = dots.c.mapping = dots.d.mapping = 2;
    dots.d = dots.b;
    dots.components = 1;
    dots.scale = OutputScale::four;
    add_portion("two_dots_of_expanded", dots, {.planes = {14, 17}});
    PortionCtx squares = portion(ProductKind::multiply, ProductKind::multiply, ThirdKind::sum);
    squares.b = squares.a;
    squares.d = squares.c;
    squares.components = 1;
    squares.ab_out[0] = kTrash;
    add_portion("sum_of_squares", squares, {.planes = {17}});
}

void add_final(const std::string& name, PacketStage<FinalCtx> stage, const PacketMemory& packet) {
    FinalCtx ctx{};
    ctx.a = operand(0, 0);
    ctx.b = operand(3, 0);
    ctx.c = operand(6, 0);
    ctx.d = operand(9, 0);
    ctx.e = ctx.b;
    ctx.f = ctx.c;
    ctx.g = operand(12, 0);
    for (int c = 0; c < 3; ++c) {
        ctx.spare0[c] = static_cast<std::int16_t>(c);
        ctx.secondary[c] = static_cast<std::int16_t>(3 + c);
    }
    for (int c = 0; c < 4; ++c) ctx.out[c] = static_cast<std::int16_t>(20 + c);
    const Written written{.planes = {20, 21, 22, 23}};
    add_packet_stage(name + "/blend", stage, packet, ctx, written);
    ctx.b.plane[0] = FinalCtx::kColorSum;
    ctx.d.plane[0] = FinalCtx::kFinalProduct;
    ctx.uses_color_sum = ctx.uses_final_product = 1;
    add_packet_stage(name + "/sum_and_product", stage, packet, ctx, written);
    ctx.uses_color_sum = ctx.uses_final_product = 0;
    ctx.b = operand(3, 0);
    ctx.c.plane[0] = ctx.d.plane[0] = FinalCtx::kZero;
    add_packet_stage(name + "/product", stage, packet, ctx, written);
    ctx.b.plane[0] = FinalCtx::kZero;
    ctx.c.plane[0] = FinalCtx::kFinalProduct;
    ctx.uses_final_product = 1;
    add_packet_stage(name + "/product_of_three", stage, packet, ctx, written);
}

void add_store(const std::string& name,
               void (*KernelTable::*stage)(Packet&, const StoreCtx&) noexcept,
               const PacketMemory& before) {
    const std::array<const char*, 3> formats{"rgba8", "rgba16", "rgba32f"};
    for (std::size_t f = 0; f < formats.size(); ++f) {
        const auto format = static_cast<StoreFormat>(f);
        const auto store = [=](const KernelTable& table, AlignedVector<std::uint8_t>& tile) {
            PacketMemory memory = before;
            Packet packet = memory.view();
            (table.*stage)(packet, {{0, 1, 2, 3}, format, tile.data()});
        };
        add(
            name + "/" + formats[f], before.count,
            [=](const KernelTable& table) -> std::string {
                AlignedVector<std::uint8_t> got(std::size_t{16} * kTilePixels);
                AlignedVector<std::uint8_t> want = got;
                store(table, got);
                store(table_reference(), want);
                return got == want ? "" : "pixels";
            },
            [=](const KernelTable& table, benchmark::State& state) {
                AlignedVector<std::uint8_t> tile(std::size_t{16} * kTilePixels);
                PacketMemory memory = before;
                Packet packet = memory.view();
                const StoreCtx ctx{{0, 1, 2, 3}, format, tile.data()};
                for (auto _ : state) {
                    (table.*stage)(packet, ctx);
                    benchmark::ClobberMemory();
                }
            });
    }
}

/// The inverse of store, blending, and store.
void add_blend(const std::string& name,
               void (*KernelTable::*stage)(Packet&, const BlendCtx&) noexcept,
               const PacketMemory& before) {
    const std::array<const char*, 3> formats{"rgba8", "rgba16", "rgba32f"};
    for (std::size_t f = 0; f < formats.size(); ++f) {
        BlendCtx ctx{};
        for (std::int16_t c = 0; c < 4; ++c) ctx.plane[c] = c;
        ctx.format = static_cast<StoreFormat>(f);
        ctx.source = {BlendOperand::source_alpha, 0};
        ctx.destination = {BlendOperand::source_alpha, 1};
        const auto blend = [=](const KernelTable& table, AlignedVector<std::uint8_t>& tile) {
            PacketMemory memory = before;
            Packet packet = memory.view();
            BlendCtx in_tile = ctx;
            in_tile.tile = tile.data();
            (table.*stage)(packet, in_tile);
        };
        add(
            name + "/" + formats[f], before.count,
            [=](const KernelTable& table) -> std::string {
                AlignedVector<std::uint8_t> got(std::size_t{16} * (kTilePixels + 1));
                AlignedVector<std::uint8_t> want = got;
                blend(table, got);
                blend(table_reference(), want);
                return got == want ? "" : "pixels";
            },
            [=](const KernelTable& table, benchmark::State& state) {
                AlignedVector<std::uint8_t> tile(std::size_t{16} * (kTilePixels + 1));
                PacketMemory memory = before;
                Packet packet = memory.view();
                BlendCtx in_tile = ctx;
                in_tile.tile = tile.data();
                for (auto _ : state) {
                    (table.*stage)(packet, in_tile);
                    benchmark::ClobberMemory();
                }
            });
    }
}

/// A packet's list of stored pixels, and the depths of its tile.
struct TestedTile {
    AlignedVector<std::uint16_t> stored = AlignedVector<std::uint16_t>(kPacketSize + 16);
    AlignedVector<float> depth = AlignedVector<float>(kTilePixels, 0.5F);
    AlignedVector<float> block_far = AlignedVector<float>(kTileBlocks, 0.5F);
    bool operator==(const TestedTile&) const = default;
};

/// Tests of fragments; `run` does one.
void add_fragment_test(const std::string& name, const PacketMemory& before,
                       const std::function<void(const KernelTable&, Packet&, TestedTile&)>& run) {
    const auto once = [=](const KernelTable& table) {
        PacketMemory memory = before;
        Packet packet = memory.view();
        TestedTile tile;
        std::copy_n(memory.pixels.begin(), kPacketSize, tile.stored.begin());
        run(table, packet, tile);
        tile.stored.resize(kPacketSize);
        return tile;
    };
    add(
        name, before.count,
        [=](const KernelTable& table) -> std::string {
            return once(table) == once(table_reference()) ? "" : "fragments or depths";
        },
        [=](const KernelTable& table, benchmark::State& state) {
            PacketMemory memory = before;
            Packet packet = memory.view();
            TestedTile tile;
            for (auto _ : state) {
                std::copy_n(memory.pixels.begin(), kPacketSize, tile.stored.begin());
                run(table, packet, tile);
                benchmark::ClobberMemory();
            }
        });
}

void add_fragment_tests() {
    Random random(6);
    PacketMemory packet;
    fill_planes(packet, random, 1, 0, 255);
    for (int i = 0; i < kPacketSize; ++i) packet.attribute(0)[i] = random.real(-1.0F, 1.0F);
    add_fragment_test("alpha_test", packet, [](const auto& table, Packet& p, TestedTile& tile) {
        table.alpha_test(p, {0, 128, 0, 0, 1, tile.stored.data()});
    });
    add_fragment_test("keep", packet, [](const auto& table, Packet& p, TestedTile& tile) {
        table.keep(p, {0, tile.stored.data()});
    });
    add_fragment_test("late_depth", packet, [](const auto& table, Packet& p, TestedTile& tile) {
        const DepthRun run{0.45F, 0.001F, 0.001F, 0.0F, 1.0F, 0, kPacketSize, 0, 0};
        table.late_depth(p, {&run, 1, -1, 1, 1, 0, 1, tile.depth.data(), tile.block_far.data(),
                             tile.stored.data()});
    });
}

void add_models() {
    Random random(5);
    PacketMemory nine_bit;
    fill_planes(nine_bit, random, 13, 0, 255);
    PacketMemory wide;
    fill_planes(wide, random, 13, 0, 16384);
    add_portions("portion_nine_bit", &KernelTable::portion_nine_bit, nine_bit);
    add_portions("portion_wide", &KernelTable::portion_wide, wide);
    add_portions("portion_wide/bounded", &KernelTable::portion_wide, wide, true);
    add_final("final_nine_bit", &KernelTable::final_nine_bit, nine_bit);
    add_final("final_wide", &KernelTable::final_wide, wide);
    add_store("store_nine_bit", &KernelTable::store_nine_bit, nine_bit);
    add_store("store_wide", &KernelTable::store_wide, wide);
    add_blend("blend_nine_bit", &KernelTable::blend_nine_bit, nine_bit);
    add_blend("blend_wide", &KernelTable::blend_wide, wide);
}

}  // namespace
}  // namespace burnish

int main(int argc, char** argv) {
    using namespace burnish;
    char** const end = std::remove(argv, argv + argc, std::string_view("--instructions"));
    count_only = can_count_instructions() && end != argv + argc;
    argc = static_cast<int>(end - argv);
    add_transform();
    add_setup();
    add_light_vertices();
    add_rasterize();
    add_rasterize_depths();
    add_cover();
    add_clear();
    add_rasterize_entries("rasterize_tiny/pixels_2", 2.24F, true);
    add_rasterize_entries("rasterize_tiny/pixels_8", 4.0F, true);
    add_rasterize_entries("rasterize_small/pixels_50", 10.0F, false);
    add_rasterize_entries("rasterize_small/pixels_300", 24.0F, false);
    add_collect();
    add_attribute_planes();
    add_attributes();
    add_lighting_and_encode();
    add_texels();
    add_levels();
    add_texture_shader();
    add_models();
    add_fragment_tests();
    return run_benchmarks(argc, argv);
}
