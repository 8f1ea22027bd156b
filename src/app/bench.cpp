#include <fmt/format.h>

#include <algorithm>
#include <burnish/error.hpp>
#include <chrono>
#include <cmath>
#include <vector>

#include "app/balance.hpp"
#include "app/picture.hpp"
#include "app/progress.hpp"
#include "app/stats.hpp"
#include "app/supersample.hpp"
#include "app/verbs.hpp"

namespace burnish::app {
namespace {

/// Milliseconds of many frames.
struct Times {
    std::vector<double> sorted;

    explicit Times(std::vector<double> values) : sorted(std::move(values)) {
        std::sort(sorted.begin(), sorted.end());
    }
    /// The smallest value that at least `share` of all do not exceed, share in (0, 1].
    double quantile(double share) const {
        const auto rank =
            static_cast<std::size_t>(std::ceil(share * static_cast<double>(sorted.size())));
        return sorted[std::max<std::size_t>(rank, 1) - 1];
    }
    double median() const {
        const std::size_t half = sorted.size() / 2;
        return sorted.size() % 2 == 1 ? sorted[half] : 0.5 * (sorted[half - 1] + sorted[half]);
    }
};

constexpr int kWarmUp = 2;

struct Measurement {
    std::vector<double> frame, geometry, tiles;
    FrameStats last;
};

Measurement measure(Renderer& renderer, const Scene& scene, Framebuffer& frame,
                    const BenchOptions& options) {
    Measurement result;
    const int side = enlargement(options.samples_side, scene);
    Progress progress(options.picture.quiet);
    const int frames = kWarmUp + options.frames;
    for (int i = 0; i < frames; ++i) {
        const auto start = std::chrono::steady_clock::now();
        result.last = draw_supersampled(renderer, scene, side, frame, options.shown);
        const std::chrono::duration<double, std::milli> time =
            std::chrono::steady_clock::now() - start;
        progress.done(static_cast<std::size_t>(i) + 1, static_cast<std::size_t>(frames));
        if (i < kWarmUp) continue;
        result.frame.push_back(time.count());
        result.geometry.push_back(result.last.geometry_ms);
        result.tiles.push_back(result.last.tiles_ms);
    }
    return result;
}

/// Million items per second.
double rate(double items, double ms) {
    return ms > 0.0 ? items / (1000.0 * ms) : 0.0;
}

/// Frames with their accounts, after those that warm up.
std::vector<FrameStats> accounts(const BenchOptions& options, int threads, int frames,
                                 const Scene& scene, Framebuffer& frame) {
    PictureOptions picture = options.picture;
    picture.threads = threads;
    RendererOptions how = renderer_options(picture);
    how.accounting = true;
    Renderer renderer(how);
    const int side = enlargement(options.samples_side, scene);
    std::vector<FrameStats> result;
    for (int i = 0; i < kWarmUp + frames; ++i) {
        FrameStats stats = draw_supersampled(renderer, scene, side, frame, options.shown);
        if (i >= kWarmUp) result.push_back(std::move(stats));
    }
    return result;
}

/// All stages, the waiting too: what the workers spent together.
double workers_ms(const FrameStats& stats) {
    double sum = 0.0;
    for (const StageCost& stage : stats.stages) sum += stage.ms;
    return sum;
}

void report_balance(const BenchOptions& options, const Scene& scene, Framebuffer& frame) {
    if (scene.machine.double_precision)
        throw Error(ErrorCode::bad_option,
                    "--balance with profile double, expected one of the machines");
    const Balance balance = simulate_balance(accounts(options, 1, options.frames, scene, frame));
    if (options.json)
        fmt::print("{}\n", balance_json(balance));
    else
        fmt::print("{}", balance_text(balance));
}

}  // namespace

void run(const BenchOptions& options) {
    const int samples = options.samples_side * options.samples_side;
    RendererOptions how = renderer_options(options.picture);
    how.double_samples = samples;
    Renderer renderer(how);
    const Scene scene = load_picture(options.picture);
    Framebuffer frame(scene.width, scene.height, scene.format);
    if (options.balance) return report_balance(options, scene, frame);
    Measurement measured = measure(renderer, scene, frame, options);
    const Times times(measured.frame);
    const double geometry = Times(measured.geometry).median();
    const double tiles = Times(measured.tiles).median();
    const double pixels = static_cast<double>(scene.width) * scene.height;
    const auto shaded = static_cast<double>(measured.last.shaded_pixels);
    double last_ms = measured.frame.back();
    if ((options.json || options.picture.verbose) && !scene.machine.double_precision) {
        measured.last = accounts(options, renderer.threads(), 1, scene, frame).front();
        last_ms = workers_ms(measured.last) / renderer.threads();
    }
    if (options.json) {
        fmt::print(
            "{{\"input\": {}, \"width\": {}, \"height\": {}, \"samples\": {}, \"machine\": {}, "
            "\"isa\": \"{}\", \"threads\": {}, \"frames\": {}, \"median_ms\": {:.4f}, \"min_ms\": "
            "{:.4f}, "
            "\"max_ms\": {:.4f}, \"p95_ms\": {:.4f}, \"geometry_ms\": {:.4f}, \"tiles_ms\": "
            "{:.4f}, \"mpixel_per_s\": {:.3f}, \"shaded_mpixel_per_s\": {:.3f}, \"last_frame\": "
            "{}}}\n",
            json_string(options.picture.input.string()), scene.width, scene.height, samples,
            json_string(scene.machine.name), renderer.isa(), renderer.threads(), options.frames,
            times.median(), times.sorted.front(), times.sorted.back(), times.quantile(0.95),
            geometry, tiles, rate(pixels, times.median()), rate(shaded, times.median()),
            stats_json(measured.last, renderer, last_ms));
        return;
    }
    fmt::print(
        "{}: {} x {}{}, machine {}, {}, {} thread{}, {} frames\n"
        "frame     median {:.3f} ms, min {:.3f}, max {:.3f}, p95 {:.3f}\n"
        "stages    geometry {:.3f} ms, tiles {:.3f} ms (medians)\n"
        "rate      {:.1f} Mpixel/s of the picture, {:.1f} shaded Mpixel/s\n",
        options.picture.input.string(), scene.width, scene.height,
        samples > 1 ? fmt::format(", {} samples", samples) : "", scene.machine.name, renderer.isa(),
        renderer.threads(), renderer.threads() == 1 ? "" : "s", options.frames, times.median(),
        times.sorted.front(), times.sorted.back(), times.quantile(0.95), geometry, tiles,
        rate(pixels, times.median()), rate(shaded, times.median()));
    if (options.picture.verbose) fmt::print("{}", stats_text(measured.last, renderer, last_ms));
}

}  // namespace burnish::app
