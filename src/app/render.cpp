#include <fmt/format.h>

#include <algorithm>
#include <burnish/error.hpp>
#include <burnish/files.hpp>
#include <chrono>
#include <cstdio>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/limits.hpp"
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

/// What pictures have to be like, if --reference was given.
class Check {
  public:
    explicit Check(const RenderOptions& options) : m_options(options) {
        if (m_limits.empty()) m_limits.push_back({metrics::Metric::max, 0.0});
    }

    /// Reads the reference of frame `i`, before the time for the picture is spent.
    void prepare(int i, const Framebuffer& frame, const std::string& name) {
        if (m_options.reference.empty()) return;
        m_path = numbered_name(m_options.reference, i);
        m_reference.emplace(load_frame(m_path));
        require_one_size(name, frame, m_path, *m_reference);
    }

    /// Compares what was written.
    void compare(const std::string& name) {
        if (!m_reference) return;
        for (std::string& line : failures(name, m_path, *m_reference, m_limits, m_pool))
            m_failures.push_back(std::move(line));
    }

    /// Throws CheckFailed if a picture broke a limit.
    void require_success() {
        if (!m_failures.empty()) throw CheckFailed(std::move(m_failures));
    }

  private:
    const RenderOptions& m_options;
    std::vector<Threshold> m_limits = m_options.limits;
    WorkerPool m_pool{m_options.picture.threads};
    std::string m_path;
    std::optional<Framebuffer> m_reference;
    std::vector<std::string> m_failures;
};

/// Frames that are drawn of those that a turn has.
FrameRange frames_of(const RenderOptions& options) {
    return options.frames.value_or(FrameRange{0, std::max(options.turntable, 1) - 1});
}

}  // namespace

void run(const RenderOptions& options) {
    const std::string pattern = output_pattern(options);
    numbered_name(pattern, 0);
    numbered_name(options.reference, 0);
    const auto [first, last] = frames_of(options);
    const auto count = static_cast<std::size_t>(last - first) + 1;
    std::size_t drawn = 0;
    Progress progress(options.picture.quiet);
    RendererOptions how = renderer_options(options.picture);
    how.double_samples = options.samples_side * options.samples_side;
    how.accounting = options.stats != StatsFormat::none;
    how.progress = [&](std::size_t done, std::size_t tiles) {
        progress.done(drawn * tiles + done, count * tiles);
    };
    Renderer renderer(how);
    const Scene scene = load_picture(options.picture);
    const int side = enlargement(options.samples_side, scene);
    Framebuffer frame(scene.width, scene.height, frame_format(options, scene, pattern));
    Check check(options);
    for (int i = first; i <= last; ++i) {
        const std::string name = numbered_name(pattern, i);
        check.prepare(i, frame, name);
        Scene turn = scene;
        if (i > 0)
            turn.camera = turned(scene.camera, 360.0F * static_cast<float>(i) /
                                                   static_cast<float>(options.turntable));
        const Clock::time_point start = Clock::now();
        const FrameStats stats = draw_supersampled(renderer, turn, side, frame, options.shown);
        const double frame_ms = ms_since(start);
        save_image(frame, name);
        check.compare(name);
        ++drawn;
        if (i < last) continue;
        progress.finish();
        report(options, pattern, frame, stats, renderer, scene.machine.double_precision, frame_ms);
    }
    check.require_success();
}

}  // namespace burnish::app
