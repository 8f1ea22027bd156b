#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <burnish/error.hpp>
#include <burnish/renderer.hpp>
#include <chrono>
#include <exception>

#include "core/cpu.hpp"
#include "core/frame_account.hpp"
#include "core/tile_watch.hpp"
#include "core/within_memory.hpp"
#include "draw.hpp"
#include "image/stream.hpp"
#include "image/tile_image.hpp"
#include "machine/show_register.hpp"
#include "raster/bin.hpp"
#include "raster/tile_chunks.hpp"
#include "raster/tile_order.hpp"
#include "reference/render_double.hpp"
#include "shade/normalisation_cube.hpp"
#include "shade/packets.hpp"

namespace burnish {

namespace {

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

std::int32_t tile_count(std::int32_t pixels) {
    return (pixels + kTileSize - 1) / kTileSize;
}

/// Pixels of the frame in tile (x, y).
std::uint64_t pixels_of(FrameSize frame, std::int32_t x, std::int32_t y) {
    return static_cast<std::uint64_t>(std::min(kTileSize, frame.width - x * kTileSize)) *
           static_cast<std::uint64_t>(std::min(kTileSize, frame.height - y * kTileSize));
}

/// Triangles `first` .. `last` - 1 of draw `draw`.
struct ChunkRange {
    std::uint32_t draw;
    std::size_t first, last;
};

/// Triangles of one chunk in a tile.
struct TileList {
    const Chunk* chunk;
    std::span<const TileEntry> entries;
};

/// What one worker needs to turn bins into pixels.
// Lines come in pairs: what two workers write all the time must not share one.
struct alignas(128) Worker {
    explicit Worker(PixelFormat format) : image(format) {}
    TileVisibility visibility;
    PacketShader shader;
    TileImage image;
    std::vector<TileList> lists;  ///< of the tile, in order
    bool has_background = false;  ///< pixels that no fragment wrote are what they should be
    std::uint64_t tiles = 0;
    StageClock* clock = nullptr;  ///< while the frame is accounted for
};

void require_machine(const Scene& scene, const char* shown) {
    if (!scene.machine.double_precision) return;
    throw Error(ErrorCode::bad_option,
                fmt::format("{} with profile double, which delivers colours only; expected one of "
                            "the machines",
                            shown));
}

void require_program_of(const Scene& scene, std::size_t object) {
    require_machine(scene, "a program");
    scene.machine.validate();
    if (object >= scene.objects.size())
        throw Error(ErrorCode::bad_option,
                    fmt::format("object {} of a scene that has {}, counted from 0", object,
                                scene.objects.size()));
}

std::string shortage_of_program(std::size_t object) {
    return fmt::format("out of memory for the program of object {}, counted from 0", object);
}

void require_colors(const Framebuffer& target, const char* shown) {
    if (target.format() != PixelFormat::depth32f) return;
    throw Error(ErrorCode::bad_option,
                fmt::format("{} into a frame of depths, which takes the depth buffer alone; "
                            "expected a frame of colours",
                            shown));
}

}  // namespace

struct Renderer::State {
    State(const RendererOptions& options)
        : pool(options.threads),
          account(options.accounting
                      ? std::make_unique<FrameAccount>(select_table(options.isa), pool.size())
                      : nullptr),
          kernels(account ? account->timed() : select_table(options.isa)),
          memory_cap(options.memory_cap),
          double_samples(options.double_samples),
          hooks{options.progress, options.stop} {
        pool.keep_account(account.get());
        maps.models.stop = options.stop;
        surfaces.stop = options.stop;
    }

    FrameStats render(const Scene& scene, Framebuffer& target,
                      const std::optional<ShownRegister>& shown, std::optional<Aov> aov);
    void prepare(const Scene& scene, const Framebuffer& target,
                 const std::optional<ShownRegister>& shown, std::optional<Aov> aov,
                 TileWatch& watch);
    void transform(const Scene& scene, TileWatch& watch);
    void bin(FrameStats& stats, TileWatch& watch);
    template <class Fill>
    bool fill_all(std::size_t count, const Fill& fill);
    template <class Fill>
    std::size_t fill_what_fits(std::size_t count, const Fill& fill);
    void draw_tiles(Framebuffer& target, bool first_round, bool last_round, TileWatch& watch);
    void draw_tile(Worker& worker, std::int32_t x, std::int32_t y, Framebuffer& target,
                   bool first_round, bool last_round);
    std::size_t first_list(std::span<const TileList> lists, std::int32_t x, std::int32_t y) const;
    void shade_visible(Worker& worker);
    void draw_ordered(Worker& worker, const Chunk& chunk, std::span<const TileEntry> entries);
    std::size_t tile_number(std::int32_t x, std::int32_t y) const;
    float* saved_depth(std::int32_t x, std::int32_t y);
    OutputTile output_of(Worker& worker) const;

    WorkerPool pool;
    std::unique_ptr<FrameAccount> account;  ///< null: nobody asked
    const KernelTable& kernels;
    std::size_t memory_cap;
    int double_samples;
    FrameHooks hooks;
    reference::SurfaceCache surfaces;

    FrameView frame{};
    bool depth_alone = false;  ///< the frame shows the depth buffer: fragments have no colours
    FrameSize size{};
    std::vector<std::unique_ptr<Draw>> draws;
    std::vector<DepthRule> depth_rules;
    std::vector<bool> overwrites;  ///< where a draw covers a pixel nothing before it matters
    std::vector<ShadedDraw> shaded_draws;
    std::vector<ChunkRange> ranges;
    std::size_t next_range = 0;  ///< first one not binned yet
    std::vector<std::unique_ptr<Chunk>> chunks;
    std::size_t chunk_count = 0;  ///< of this round
    bool did_not_fit = false;     ///< the chunks of the last frame
    std::vector<std::unique_ptr<Worker>> workers;
    TileChunks tile_chunks;
    TileOrder tile_order;
    AlignedVector<float> depth;  ///< tile by tile; only when the bins were flushed
    DerivedMaps maps;
    std::size_t programs_asked = 0;  ///< since maps were swept
    HalfVectorCube half_cube;

    FrameView view_of(const Scene& scene, const FrameSize& of_size) {
        return {.scene = &scene,
                .view = make_view(scene.camera, of_size.width, of_size.height),
                .viewport = make_viewport(scene.machine, of_size.width, of_size.height),
                .half_cube = half_cube.of(scene.machine)};
    }

    void sweep_maps(int frames) {
        maps.drop_unused(frames);
        programs_asked = 0;
    }
    /// Without frames between them nobody else forgets: all objects once are as a frame.
    void note_program_asked(const Scene& scene) {
        if (programs_asked >= scene.objects.size()) sweep_maps(2);
        ++programs_asked;
    }
    /// What a frame did not need is forgotten, however it ends. What follows an object that is
    /// refused was not asked for: it stays for another frame.
    class Sweep {
      public:
        explicit Sweep(State& state) : m_state(state) {}
        ~Sweep() {
            m_state.sweep_maps(std::uncaught_exceptions() > m_exceptions ? 2 : 1);
            m_state.surfaces.drop_orphans();  // of frames in double precision before
        }
        Sweep(const Sweep&) = delete;
        Sweep& operator=(const Sweep&) = delete;

      private:
        State& m_state;
        int m_exceptions = std::uncaught_exceptions();
    };
};

Renderer::Renderer(const RendererOptions& options)
    : m_state(within_memory([] { return "out of memory for a renderer"; },
                            [&] { return std::make_unique<State>(options); })) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

std::string_view Renderer::isa() const noexcept {
    return m_state->kernels.isa;
}
int Renderer::threads() const noexcept {
    return m_state->pool.size();
}

FrameStats Renderer::render(const Scene& scene, Framebuffer& target) {
    if (scene.machine.double_precision) {
        if (target.format() == PixelFormat::depth32f) require_machine(scene, "a frame of depths");
        scene.machine.validate();
        return render_double(scene, target, m_state->pool,
                             {.samples = m_state->double_samples,
                              .hooks = m_state->hooks,
                              .surfaces = &m_state->surfaces});
    }
    return render_shown(scene, target, std::nullopt, std::nullopt);
}

FrameStats Renderer::render(const Scene& scene, Framebuffer& target, const ShownRegister& shown) {
    require_machine(scene, "a register");
    require_colors(target, "a register");
    require_showable(shown.reg, scene.machine);
    return render_shown(scene, target, shown, std::nullopt);
}

FrameStats Renderer::render(const Scene& scene, Framebuffer& target, Aov shown) {
    require_machine(scene, "geometry");
    require_colors(target, "geometry");
    return render_shown(scene, target, std::nullopt, shown);
}

ProgramMaterial Renderer::program(const Scene& scene, std::size_t object) {
    require_program_of(scene, object);
    const auto shortage = [&] { return shortage_of_program(object); };
    return within_memory(shortage, [&] {
        m_state->note_program_asked(scene);
        Object own = scene.objects[object];
        own.edited = nullptr;
        return program_of(own, scene, 0, m_state->maps);
    });
}

void Renderer::check(const Scene& scene, std::size_t object) {
    require_program_of(scene, object);
    const auto shortage = [&] { return shortage_of_program(object); };
    within_memory(shortage, [&] {
        m_state->note_program_asked(scene);
        Draw draw;
        prepare_draw(draw, m_state->view_of(scene, {scene.width, scene.height}),
                     scene.objects[object], m_state->maps);
    });
}

FrameStats Renderer::render_shown(const Scene& scene, Framebuffer& target,
                                  const std::optional<ShownRegister>& shown,
                                  std::optional<Aov> aov) {
    const auto shortage = [&] {
        return fmt::format("out of memory for a frame of {}x{} pixels", target.width(),
                           target.height());
    };
    return within_memory(shortage, [&] { return m_state->render(scene, target, shown, aov); });
}

/// The road: vertices, bins, tiles. The bins hold all triangles of a frame or, if they would exceed
/// the memory cap, as many as fit; then the tiles are drawn and the next ones follow.
FrameStats Renderer::State::render(const Scene& scene, Framebuffer& target,
                                   const std::optional<ShownRegister>& shown,
                                   std::optional<Aov> aov) {
    FrameStats stats;
    std::optional<ClockLoan> clock;
    const std::size_t tile_total = static_cast<std::size_t>(tile_count(target.width())) *
                                   static_cast<std::size_t>(tile_count(target.height()));
    TileWatch watch(hooks, tile_total);
    if (account) {
        account->start(tile_total);
        clock.emplace(account->clock(0), StageClock::place(FrameStage::prepare));
    }
    const auto start = Clock::now();
    prepare(scene, target, shown, aov, watch);
    transform(scene, watch);
    stats.geometry_ms = milliseconds_since(start);
    for (bool first_round = true; first_round || next_range < ranges.size(); first_round = false) {
        const auto round = Clock::now();
        const std::size_t binned = next_range;
        bin(stats, watch);
        stats.geometry_ms += milliseconds_since(round);
        const bool last_round = next_range == ranges.size();
        if (!last_round) ++stats.flushes;
        const auto tiles = Clock::now();
        if (!ranges.empty()) watch.begin_round(binned, next_range - binned, ranges.size());
        draw_tiles(target, first_round, last_round, watch);
        stats.tiles_ms += milliseconds_since(tiles);
    }
    for (const auto& worker : workers) {
        stats.shaded_pixels += worker->shader.shaded_pixels();
        stats.tiles_per_worker.push_back(worker->tiles);
    }
    clock.reset();
    if (account) account->finish(stats);
    return stats;
}

/// Camera, programs and raster state; the list of chunks.
void Renderer::State::prepare(const Scene& scene, const Framebuffer& target,
                              const std::optional<ShownRegister>& shown, std::optional<Aov> aov,
                              TileWatch& watch) {
    scene.machine.validate();
    size = {target.width(), target.height()};
    frame = view_of(scene, size);
    frame.shown = shown;
    frame.aov = aov;
    frame.format = target.format();
    while (draws.size() < scene.objects.size()) draws.push_back(std::make_unique<Draw>());
    draws.resize(scene.objects.size());
    ranges.clear();
    next_range = 0;
    std::size_t triangles = 0;
    bool all_write_depths = true;
    const Sweep sweep(*this);
    for (std::size_t i = 0; i < draws.size(); ++i) {
        watch.require_wanted();
        prepare_draw(*draws[i], frame, scene.objects[i], maps);
        triangles += draws[i]->triangle_count();
        all_write_depths = all_write_depths && draws[i]->output.depth.write != 0;
    }
    // The depths of the fragments seen last are then what the depth buffer holds.
    depth_alone =
        target.format() == PixelFormat::depth32f || (aov == Aov::depth && all_write_depths);
    const std::size_t step = chunk_size(size, triangles);
    for (std::uint32_t i = 0; i < draws.size(); ++i) {
        if (depth_alone && draws[i]->output.depth.write == 0) continue;
        const std::size_t count = draws[i]->triangle_count();
        for (std::size_t first = 0; first < count; first += step) {
            ranges.push_back({i, first, std::min(first + step, count)});
        }
    }
    if (account) {
        account->clock(0).count(StageClock::place(FrameStage::prepare), scene.objects.size());
    }
    if (!workers.empty() && workers.front()->image.format() != target.format()) workers.clear();
    while (workers.size() < static_cast<std::size_t>(pool.size())) {
        workers.push_back(std::make_unique<Worker>(target.format()));
    }
    for (std::size_t i = 0; i < workers.size(); ++i) {
        const auto& worker = workers[i];
        worker->clock = account ? &account->clock(static_cast<int>(i)) : nullptr;
        worker->tiles = 0;
        worker->image.set_background(depth_alone ? background_of(Aov::depth)
                                     : aov       ? background_of(*aov)
                                                 : scene.background);
        worker->shader.reset_count();
    }
}

void Renderer::State::transform(const Scene& scene, TileWatch& watch) {
    const StageScope scope(FrameStage::transform);
    depth_rules.clear();
    overwrites.clear();
    shaded_draws.clear();
    bool depths_matter = false;
    for (std::size_t i = 0; i < draws.size(); ++i) {
        watch.require_wanted();
        Draw& draw = *draws[i];
        draw.shaded = !depth_alone || draw.output.late_depth;
        transform_draw(draw, frame, scene.objects[i], kernels, pool);
        depth_rules.push_back(draw.depth);
        const DepthRule& rule = draw.output.depth;
        const bool always =
            rule.pass_less != 0 && rule.pass_equal != 0 && rule.pass_greater != 0 && !draw.ordered;
        overwrites.push_back(always && (rule.write != 0 || !depths_matter));
        depths_matter = depths_matter || rule.write != 0;
        shaded_draws.push_back(
            {&draw.shading, &draw.output, draw.mesh(), draw.shown ? &*draw.shown : nullptr});
    }
}

/// All chunks that are left, or as many as the memory cap allows; at least one.
void Renderer::State::bin(FrameStats& stats, TileWatch& watch) {
    const StageScope scope(FrameStage::bin);
    const std::size_t first = next_range;
    const std::size_t left = ranges.size() - first;
    while (chunks.size() < left) chunks.push_back(std::make_unique<Chunk>());
    const auto fill = [&](std::size_t i) {
        if (!watch.go_on()) return std::size_t{0};
        const ChunkRange& range = ranges[first + i];
        const Draw& draw = *draws[range.draw];
        chunks[i]->fill({draw.mesh(), range.draw, draw.facing, frame.viewport, size}, range.first,
                        range.last, kernels);
        return chunks[i]->bytes();
    };
    const bool all = first == 0 && !did_not_fit && fill_all(left, fill);
    chunk_count = all ? left : fill_what_fits(left, fill);
    watch.require_wanted();
    next_range = first + chunk_count;
    std::size_t bytes = 0;
    for (std::size_t i = 0; i < chunk_count; ++i) {
        const BinCounts& counts = chunks[i]->counts();
        bytes += chunks[i]->bytes();
        stats.triangles += counts.submitted;
        stats.nonfinite_triangles += counts.nonfinite;
        stats.degenerate_triangles += counts.degenerate;
        stats.clipped_triangles += counts.clipped;
        stats.binned_triangles += counts.binned;
    }
    if (first == 0) did_not_fit = chunk_count < left || bytes > memory_cap;
}

/// All chunks, each worker a part of its own: it has the vertices in its cache that it transformed.
/// False, and to be done again, if they do not fit.
template <class Fill>
bool Renderer::State::fill_all(std::size_t count, const Fill& fill) {
    std::atomic<std::size_t> bytes{0};
    for_each_index(pool, count, 1, [&](std::size_t i, int) {
        if (bytes.load(std::memory_order_relaxed) <= memory_cap)
            bytes.fetch_add(fill(i), std::memory_order_relaxed);
    });
    return bytes.load() <= memory_cap;
}

/// Chunks in order until the memory cap is met; how many.
template <class Fill>
std::size_t Renderer::State::fill_what_fits(std::size_t count, const Fill& fill) {
    std::atomic<std::size_t> next{0}, bytes{0};
    pool.run([&](int) {
        for (;;) {
            // Chunks are handed out in order and all that were handed out are finished, so those of
            // a round are consecutive whatever the schedule.
            const bool full = bytes.load(std::memory_order_relaxed) >= memory_cap;
            if (full && next.load(std::memory_order_relaxed) > 0) return;
            const std::size_t i = next.fetch_add(1, std::memory_order_relaxed);
            if (i >= count) return;
            bytes.fetch_add(fill(i), std::memory_order_relaxed);
        }
    });
    // How many were handed out depends on the schedule; how many fit does not. The rest is binned
    // again in the next round.
    const std::size_t filled = std::min(next.load(), count);
    std::size_t fitting = 0;
    for (std::size_t used = 0; fitting < filled && (fitting == 0 || used < memory_cap);)
        used += chunks[fitting++]->bytes();
    return fitting;
}

std::size_t Renderer::State::tile_number(std::int32_t x, std::int32_t y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(tile_count(size.width)) +
           static_cast<std::size_t>(x);
}

float* Renderer::State::saved_depth(std::int32_t x, std::int32_t y) {
    return depth.data() + tile_number(x, y) * kTilePixels;
}

void Renderer::State::draw_tiles(Framebuffer& target, bool first_round, bool last_round,
                                 TileWatch& watch) {
    const StageScope scope(FrameStage::packets);
    const std::int32_t columns = tile_count(size.width), rows = tile_count(size.height);
    const std::size_t count = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
    if (!last_round) depth.resize(count * kTilePixels);
    const std::span binned(chunks.data(), chunk_count);
    tile_chunks.find(binned, static_cast<std::size_t>(columns), static_cast<std::size_t>(rows));
    const WorkOrder& order = tile_order.plan(binned, static_cast<std::size_t>(columns),
                                             static_cast<std::size_t>(rows), pool.size());
    const auto draw = [&](std::size_t i, int w) {
        if (!watch.go_on()) return;
        const auto tile = static_cast<std::int32_t>(i);
        Worker& worker = *workers[static_cast<std::size_t>(w)];
        ++worker.tiles;
        const std::uint64_t start = account ? ticks() : 0,
                            fragments = worker.shader.shaded_pixels();
        draw_tile(worker, tile % columns, tile / columns, target, first_round, last_round);
        if (account)
            account->add_tile(i, ticks() - start, tile_order.weight(i),
                              worker.shader.shaded_pixels() - fragments);
        watch.tile_done();
    };
    for_each_piece(pool, order, draw, stream_fence);
    watch.require_wanted();
}

/// Everything of one tile, in one worker's cache, then once to the frame. Draws that need no order
/// are shaded when all of them have been rasterized and it is known what they show; before one that
/// needs order comes, what is visible so far is shaded, and its fragments follow one by one.
void Renderer::State::draw_tile(Worker& worker, std::int32_t x, std::int32_t y, Framebuffer& target,
                                bool first_round, bool last_round) {
    TileVisibility& visibility = worker.visibility;
    std::vector<TileList>& lists = worker.lists;
    lists.clear();
    for (const std::uint32_t i : tile_chunks.of(tile_number(x, y)))
        lists.push_back({chunks[i].get(), chunks[i]->tile(x, y)});
    if (lists.empty() && first_round && last_round) {
        const StageScope scope(FrameStage::resolve, pixels_of(size, x, y), worker.clock);
        return worker.image.resolve_empty(target, x * kTileSize, y * kTileSize);
    }
    {
        const StageScope scope(FrameStage::coverage, 0, worker.clock);
        visibility.begin(x, y, size, first_round ? nullptr : saved_depth(x, y));
    }
    worker.has_background = false;
    if (!first_round && !depth_alone) {
        worker.image.load(target, visibility.left(), visibility.top());
        worker.has_background = true;
    }
    worker.shader.begin({visibility.left(), visibility.top(), output_of(worker)});
    for (const auto& [chunk, entries] : std::span(lists).subspan(first_list(lists, x, y))) {
        if (draws[chunk->triangles()[entries.front().triangle].draw]->ordered) {
            shade_visible(worker);
            visibility.forget();
            draw_ordered(worker, *chunk, entries);
        } else {
            worker.shader.flush(kernels);
            const StageScope scope(FrameStage::coverage, 0, worker.clock);
            depth_alone ? visibility.draw_depths(*chunk, depth_rules, kernels)
                        : visibility.draw(*chunk, depth_rules, kernels);
        }
    }
    worker.shader.flush(kernels);
    shade_visible(worker);
    if (!last_round || depth_alone) {
        const StageScope scope(FrameStage::coverage, 0, worker.clock);
        visibility.finish(kernels);
    }
    if (!last_round) std::copy_n(visibility.depth(), kTilePixels, saved_depth(x, y));
    const StageScope scope(FrameStage::resolve, pixels_of(size, x, y), worker.clock);
    if (!depth_alone) {
        worker.image.resolve(target, visibility.left(), visibility.top());
    } else if (last_round) {
        if (worker.image.resolve_depths(visibility.depth(), target, visibility.left(),
                                        visibility.top()))
            visibility.note_cleared();
    }
}

/// The list from which on a tile has to be drawn: a triangle of its covers all that was before.
std::size_t Renderer::State::first_list(std::span<const TileList> lists, std::int32_t x,
                                        std::int32_t y) const {
    for (std::size_t i = lists.size(); i-- > 1;) {
        for (const TileEntry& entry : lists[i].entries) {
            const SetupTriangle& triangle = lists[i].chunk->triangles()[entry.triangle];
            if (!overwrites[triangle.draw]) break;
            if (covers_tile(triangle, x, y, size)) return i;
        }
    }
    return 0;
}

OutputTile Renderer::State::output_of(Worker& worker) const {
    TileVisibility& visibility = worker.visibility;
    if (depth_alone) return {{}, nullptr, visibility.depth(), visibility.block_far()};
    return {static_cast<StoreFormat>(worker.image.format()), worker.image.pixels(),
            visibility.depth(), visibility.block_far()};
}

/// Shades what the visibility buffer holds. Afterwards every pixel of the tile has a colour, if the
/// frame has any.
void Renderer::State::shade_visible(Worker& worker) {
    if (depth_alone) return;
    TileFragments fragments{};
    if (worker.visibility.shows_anything()) {
        const StageScope scope(FrameStage::coverage, 0, worker.clock);
        fragments = worker.visibility.collect(kernels);
    }
    if (!worker.has_background && fragments.count < kTilePixels) {
        const StageScope scope(FrameStage::resolve, 0, worker.clock);
        worker.image.clear();
    }
    worker.has_background = true;
    if (fragments.count == 0) return;
    worker.shader.shade(fragments, shaded_draws, kernels);
}

/// The triangles of a chunk in this tile, one after the other.
void Renderer::State::draw_ordered(Worker& worker, const Chunk& chunk,
                                   std::span<const TileEntry> entries) {
    PixelMask passed;
    worker.shader.start_draw(shaded_draws[chunk.triangles()[entries.front().triangle].draw],
                             kernels);
    for (const TileEntry& entry : entries) {
        const SetupTriangle& triangle = chunk.triangles()[entry.triangle];
        {
            const StageScope scope(FrameStage::coverage, 0, worker.clock);
            if (!worker.visibility.cover(triangle, depth_rules[triangle.draw], kernels, passed))
                continue;
        }
        worker.shader.add(triangle, passed, kernels);
    }
}

}  // namespace burnish
