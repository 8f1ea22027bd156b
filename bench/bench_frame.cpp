// Whole frames and the stages before shading, on scenes named as in docs/performance.md.
// The frame of every table and thread count is compared with the reference's before it is timed.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <burnish/renderer.hpp>
#include <chrono>
#include <cstring>
#include <string>
#include <vector>

#include "bench/frame_scenes.hpp"
#include "bench/run_benchmarks.hpp"
#include "core/cpu.hpp"
#include "geometry/camera.hpp"
#include "geometry/clip.hpp"
#include "raster/bin.hpp"
#include "raster/tile.hpp"

namespace burnish {
namespace {

constexpr int kWidth = 1920, kHeight = 1080;

/// S1c: 20,448 triangles.
Scene s1c() {
    return ellipsoid_scene(144, 72, kWidth, kHeight);
}

struct TimedScene {
    explicit TimedScene(Scene s) : scene(std::move(s)), want(kWidth, kHeight) {
        Renderer({.isa = "reference"}).render(scene, want);
    }
    Scene scene;
    Framebuffer want;
};
const TimedScene& timed_scene(const std::string& name) {
    if (name == "S8_blend") {
        static const TimedScene scene(layers_scene({.blend = Blend::alpha()}, kWidth, kHeight));
        return scene;
    }
    if (name == "S8_opaque") {
        static const TimedScene scene(layers_scene({}, kWidth, kHeight));
        return scene;
    }
    static const TimedScene scene(s1c());
    return scene;
}

bool same_frames(const Framebuffer& a, const Framebuffer& b) {
    for (int y = 0; y < a.height(); ++y) {
        const auto bytes = static_cast<std::size_t>(a.width()) * pixel_size(a.format());
        if (std::memcmp(a.row(y), b.row(y), bytes) != 0) return false;
    }
    return true;
}

void frame(benchmark::State& state, const std::string& name, const std::string& isa, int threads) {
    const auto& [scene, want] = timed_scene(name);
    RendererOptions options;
    options.isa = isa;
    options.threads = threads;
    Renderer renderer(options);
    Framebuffer target(kWidth, kHeight);
    const FrameStats stats = renderer.render(scene, target);
    if (!same_frames(target, want)) return state.SkipWithError("differs from the reference");
    double geometry_ms = 0.0, tiles_ms = 0.0;
    for (auto _ : state) {
        const FrameStats parts = renderer.render(scene, target);
        geometry_ms += parts.geometry_ms;
        tiles_ms += parts.tiles_ms;
    }
    const auto frames = static_cast<double>(state.iterations());
    state.counters["geometry_ms"] = geometry_ms / frames;
    state.counters["tiles_ms"] = tiles_ms / frames;
    state.counters["covered"] = static_cast<double>(stats.shaded_pixels) / (kWidth * kHeight);
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(stats.shaded_pixels));
}

/// How much longer a frame takes whose programs run at four texels: frames of both orders in turns,
/// counters of their medians.
void filter_order(benchmark::State& state, const std::string& name, const std::string& isa) {
    const auto scene_of = [&](int width, int height, FilterOrder order) {
        Scene scene = name == "S1a" ? lobe_scene(144, 72, width, height)
                                    : ellipsoid_scene(144, 72, width, height);
        scene.machine.filter_order = order;
        return scene;
    };
    const auto draw_small = [&](const std::string& table) {
        Framebuffer frame(160, 90);
        Renderer({.isa = table}).render(scene_of(160, 90, FilterOrder::after), frame);
        return frame;
    };
    if (!same_frames(draw_small(isa), draw_small("reference")))
        return state.SkipWithError("differs from the reference");
    constexpr std::array kOrders{FilterOrder::before, FilterOrder::after};
    Scene scene = scene_of(kWidth, kHeight, FilterOrder::before);
    Renderer renderer({.threads = 1, .isa = isa});
    Framebuffer target(kWidth, kHeight);
    std::array<std::vector<double>, 2> times;
    renderer.render(scene, target);  // compiles what there is to compile
    for (auto _ : state) {
        for (std::size_t i = 0; i < 2; ++i) {
            scene.machine.filter_order = kOrders[i];
            const auto start = std::chrono::steady_clock::now();
            renderer.render(scene, target);
            times[i].push_back(
                std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
                    .count());
        }
    }
    for (std::vector<double>& t : times) std::ranges::sort(t);
    const auto median = [&](std::size_t i) { return times[i][times[i].size() / 2]; };
    state.counters["before_ms"] = median(0);
    state.counters["after_ms"] = median(1);
    state.counters["ratio"] = median(1) / median(0);
}

/// The ellipsoid's vertices on the screen, for the stages after `transform`.
struct Geometry {
    Geometry() {
        const Scene scene = s1c();
        const Mesh& mesh = std::get<Mesh>(scene.objects[0].geometry);
        const View view = make_view(scene.camera, kWidth, kHeight);
        viewport = make_viewport(scene.machine, kWidth, kHeight);
        TransformCtx ctx{};
        for (int i = 0; i < 16; ++i)
            ctx.m[i] = static_cast<float>(view.clip_from_world[i / 4][i % 4]);
        const auto positions = mesh.positions();
        ctx.x = positions[0];
        ctx.y = positions[1];
        ctx.z = positions[2];
        ctx.count = static_cast<int>(mesh.vertex_count());
        ctx.viewport = viewport;
        screen.resize(mesh.vertex_count());
        homogeneous.resize(mesh.vertex_count());
        ctx.screen = screen.data();
        ctx.homogeneous = homogeneous.data();
        table_reference().transform(ctx);
        indices.assign(mesh.indices().begin(), mesh.indices().end());
    }
    [[nodiscard]] ScreenMesh mesh() const { return {screen, homogeneous, indices}; }

    Viewport viewport{};
    std::vector<ScreenVertex> screen;
    std::vector<HomogeneousVertex> homogeneous;
    std::vector<std::uint32_t> indices;
};
const Geometry& geometry() {
    static const Geometry g;
    return g;
}

/// All chunks of the mesh, as one worker fills them.
std::vector<Chunk> bin_all(const Geometry& g, const KernelTable& kernels,
                           std::vector<Chunk> chunks = {}) {
    const FrameSize size{kWidth, kHeight};
    const std::size_t count = g.indices.size() / 3, step = chunk_size(size, count);
    chunks.resize((count + step - 1) / step);
    for (std::size_t i = 0; i < chunks.size(); ++i) {
        chunks[i].fill({g.mesh(), 0, Facing::any, g.viewport, size}, i * step,
                       std::min(count, (i + 1) * step), kernels);
    }
    return chunks;
}

void bin(benchmark::State& state, const KernelTable* kernels) {
    const Geometry& g = geometry();
    std::vector<Chunk> chunks = bin_all(g, *kernels);
    for (auto _ : state) chunks = bin_all(g, *kernels, std::move(chunks));
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(g.indices.size() / 3));
}

/// Coverage and depth of every tile of the frame.
std::uint64_t draw_tiles(const std::vector<Chunk>& chunks, const KernelTable& kernels,
                         TileVisibility& tile, std::uint64_t hash) {
    const DepthRule rule{1, 0, 0, 1};
    const FrameSize size{kWidth, kHeight};
    for (std::int32_t y = 0; y * kTileSize < kHeight; ++y) {
        for (std::int32_t x = 0; x * kTileSize < kWidth; ++x) {
            tile.begin(x, y, size, nullptr);
            for (const Chunk& chunk : chunks) tile.draw(chunk, {&rule, 1}, kernels);
            tile.finish(kernels);
            for (int i = 0; hash != 0 && i < kTilePixels; ++i) {
                std::uint32_t bits = 0;
                std::memcpy(&bits, tile.depth() + i, sizeof bits);
                hash = (hash ^ bits) * 0x100000001b3U;
            }
        }
    }
    return hash;
}

void tile(benchmark::State& state, const KernelTable* kernels) {
    const std::vector<Chunk> chunks = bin_all(geometry(), *kernels);
    TileVisibility visibility;
    if (draw_tiles(chunks, *kernels, visibility, 1) !=
        draw_tiles(chunks, table_reference(), visibility, 1)) {
        return state.SkipWithError("depths differ from the reference");
    }
    for (auto _ : state) {
        benchmark::DoNotOptimize(draw_tiles(chunks, *kernels, visibility, 0));
        benchmark::ClobberMemory();
    }
    state.SetItemsProcessed(state.iterations() *
                            static_cast<std::int64_t>(geometry().indices.size() / 3));
}

void register_frame(const std::string& scene, const std::string& isa, int threads) {
    const std::string name =
        "frame/" + scene + "_1080p/" + isa + "/threads:" + std::to_string(threads);
    benchmark::RegisterBenchmark(name.c_str(), frame, scene, isa, threads)
        ->Unit(benchmark::kMillisecond)
        ->UseRealTime()
        ->Repetitions(9)  // of which the median counts: machines are noisy
        ->ComputeStatistics(
            "min", [](const std::vector<double>& v) { return *std::ranges::min_element(v); })
        ->DisplayAggregatesOnly();
}

void register_all() {
    for (const KernelTable* table : available_tables()) {
        const std::string isa = table->isa;
        benchmark::RegisterBenchmark(("raster/bin/" + isa).c_str(), bin, table)
            ->Unit(benchmark::kMicrosecond);
        benchmark::RegisterBenchmark(("raster/tiles/" + isa).c_str(), tile, table)
            ->Unit(benchmark::kMicrosecond);
        if (table == &table_reference()) continue;
        for (const std::string scene : {"S1c", "S1a"})
            benchmark::RegisterBenchmark(("filter_order/" + scene + "_1080p/" + isa).c_str(),
                                         filter_order, scene, isa)
                ->Unit(benchmark::kMillisecond)
                ->UseRealTime();
        for (const std::string scene : {"S1c", "S8_opaque", "S8_blend"})
            for (const int threads : {1, 2}) register_frame(scene, isa, threads);
    }
}
}  // namespace
}  // namespace burnish

int main(int argc, char** argv) {
    burnish::register_all();
    return burnish::run_benchmarks(argc, argv);
}
