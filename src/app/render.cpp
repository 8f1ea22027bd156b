#include <fmt/format.h>

#include <burnish/error.hpp>
#include <burnish/files.hpp>
#include <chrono>
#include <cstdio>

#include "app/output_name.hpp"
#include "app/picture.hpp"
#include "app/progress.hpp"
#include "app/stats.hpp"
#include "app/supersample.hpp"
#include "app/verbs.hpp"

namespace burnish::app {
namespace {

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

std::string output_pattern(const RenderOptions& options) {
    std::string pattern = options.output;
    if (pattern.empty()) {
        pattern = options.picture.input.stem().string();
        pattern += options.turntable > 0 ? "-{frame:4}.png" : ".png";
    }
    if (options.turntable > 1 && !has_frame_number(pattern))
        throw Error(ErrorCode::bad_option,
                    fmt::format("-o {} names one file, expected {{frame:4}} in it for --turntable",
                                pattern));
    return pattern;
}

/// A file of floats can hold a register as it is, signs and all.
PixelFormat frame_format(const RenderOptions& options, const Scene& scene,
                         const std::string& pattern) {
    const bool floats = std::filesystem::path(pattern).extension() == ".exr";
    return options.shown && floats ? PixelFormat::rgba32f : scene.format;
}

/// How many times larger a picture is drawn to be averaged. The double renderer takes its samples
/// itself.
int enlargement(const RenderOptions& options, const Scene& scene) {
    if (scene.machine.double_precision) return 1;
    const int side = options.samples_side;
    if (side > 4)
        throw Error(ErrorCode::bad_option,
                    fmt::format("--samples {}, expected 1, 4, 9 or 16 with machine {}", side * side,
                                scene.machine.name));
    return side;
}

/// The lines that tell what was done. They leave standard output to data when there is any.
void report(const RenderOptions& options, const std::string& name, const Framebuffer& frame,
            const FrameStats& stats, const Renderer& renderer, bool double_precision,
            double frame_ms) {
    const bool data_on_stdout = name == "-" || options.stats == StatsFormat::json;
    std::FILE* stats_stream = name == "-" ? stderr : stdout;
    if (options.stats == StatsFormat::json)
        fmt::print(stats_stream, "{}\n", stats_json(stats, renderer, frame_ms));
    if (!options.picture.quiet)
        fmt::print(data_on_stdout ? stderr : stdout, "{}: {} x {}, {:.2f} ms, {}, {} thread{}\n",
                   name == "-" ? "standard output" : name, frame.width(), frame.height(), frame_ms,
                   double_precision ? "double precision" : renderer.isa(), renderer.threads(),
                   renderer.threads() == 1 ? "" : "s");
    if (options.stats == StatsFormat::text || options.picture.verbose)
        fmt::print(data_on_stdout ? stderr : stats_stream, "{}",
                   stats_text(stats, renderer, frame_ms));
}

}  // namespace

void run(const RenderOptions& options) {
    const std::string pattern = output_pattern(options);
    numbered_name(pattern, 0);
    Renderer renderer = make_renderer(options.picture, options.samples_side * options.samples_side,
                                      options.stats != StatsFormat::none);
    const Scene scene = load_picture(options.picture);
    const int side = enlargement(options, scene);
    const int frames = options.turntable > 0 ? options.turntable : 1;
    Framebuffer frame(scene.width, scene.height, frame_format(options, scene, pattern));
    Progress progress(options.picture.quiet);
    for (int i = 0; i < frames; ++i) {
        Scene turn = scene;
        if (i > 0)
            turn.camera =
                turned(scene.camera, 360.0F * static_cast<float>(i) / static_cast<float>(frames));
        const Clock::time_point start = Clock::now();
        const FrameStats stats = draw_supersampled(renderer, turn, side, frame, options.shown);
        const double frame_ms = ms_since(start);
        const std::string name = numbered_name(pattern, i);
        save_image(frame, name);
        progress.done(static_cast<std::size_t>(i) + 1, static_cast<std::size_t>(frames));
        if (i + 1 == frames)
            report(options, pattern, frame, stats, renderer, scene.machine.double_precision,
                   frame_ms);
    }
}

}  // namespace burnish::app
