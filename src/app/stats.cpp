#include "app/stats.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

namespace burnish::app {
namespace {

struct Count {
    const char* name;
    std::uint64_t FrameStats::*value;
};
constexpr std::array<Count, 7> kCounts{{{"triangles", &FrameStats::triangles},
                                        {"nonfinite_triangles", &FrameStats::nonfinite_triangles},
                                        {"degenerate_triangles", &FrameStats::degenerate_triangles},
                                        {"clipped_triangles", &FrameStats::clipped_triangles},
                                        {"binned_triangles", &FrameStats::binned_triangles},
                                        {"flushes", &FrameStats::flushes},
                                        {"shaded_pixels", &FrameStats::shaded_pixels}}};

/// Workers that took at least one tile.
std::size_t busy_workers(const FrameStats& stats) {
    const auto& tiles = stats.tiles_per_worker;
    return tiles.size() - static_cast<std::size_t>(std::count(tiles.begin(), tiles.end(), 0U));
}

/// Members "stages", "kernels" and "waiting_ms" with a comma in front, if there are any.
std::string costs_json(const FrameStats& stats) {
    if (stats.stages.empty()) return {};
    std::string stages, kernels, waiting;
    for (const StageCost& stage : stats.stages) {
        if (stage.name == "waiting") {
            waiting = fmt::format("{:.4f}", stage.ms);
            continue;
        }
        stages += fmt::format("{}\"{}\": {{\"ms\": {:.4f}, \"calls\": {}, \"{}\": {}}}",
                              stages.empty() ? "" : ", ", stage.name, stage.ms, stage.calls,
                              stage.unit, stage.items);
    }
    for (const KernelCost& kernel : stats.kernels) {
        kernels += fmt::format(
            "{}\"{}\": {{\"stage\": \"{}\", \"ms\": {:.4f}, \"calls\": {}, \"items\": {}}}",
            kernels.empty() ? "" : ", ", kernel.name, kernel.stage, kernel.ms, kernel.calls,
            kernel.items);
    }
    return fmt::format(", \"stages\": {{{}}}, \"kernels\": {{{}}}, \"waiting_ms\": {}", stages,
                       kernels, waiting);
}

}  // namespace

std::string stages_text(const FrameStats& stats) {
    double sum = 0.0;
    for (const StageCost& stage : stats.stages) sum += stage.ms;
    std::string text;
    for (const StageCost& stage : stats.stages) {
        text += fmt::format("{:<12}{:10.3f} ms {:5.1f} %", stage.name, stage.ms,
                            sum > 0.0 ? 100.0 * stage.ms / sum : 0.0);
        if (stage.items > 0)
            text += fmt::format("  {:>11} {}, {:.2f} ns each", stage.items, stage.unit,
                                1e6 * stage.ms / static_cast<double>(stage.items));
        text += '\n';
    }
    return text;
}

std::string stats_json(const FrameStats& stats, const Renderer& renderer, double frame_ms) {
    std::string json = "{";
    for (const Count& count : kCounts)
        json += fmt::format("\"{}\": {}, ", count.name, stats.*count.value);
    return json + fmt::format(
                      "\"geometry_ms\": {:.3f}, \"tiles_ms\": {:.3f}, \"frame_ms\": {:.3f}, "
                      "\"isa\": \"{}\", \"threads\": {}, \"busy_threads\": {}, "
                      "\"tiles_per_worker\": [{}]{}}}",
                      stats.geometry_ms, stats.tiles_ms, frame_ms, renderer.isa(),
                      renderer.threads(), busy_workers(stats),
                      fmt::join(stats.tiles_per_worker, ", "), costs_json(stats));
}

std::string stats_text(const FrameStats& stats, const Renderer& renderer, double frame_ms) {
    std::string text;
    for (const Count& count : kCounts)
        text += fmt::format("{:<21}{}\n", count.name, stats.*count.value);
    return text + fmt::format(
                      "geometry_ms          {:.3f}\n"
                      "tiles_ms             {:.3f}\n"
                      "frame_ms             {:.3f}\n"
                      "isa                  {}\n"
                      "threads              {}, of which {} took tiles ({})\n{}",
                      stats.geometry_ms, stats.tiles_ms, frame_ms, renderer.isa(),
                      renderer.threads(), busy_workers(stats),
                      fmt::join(stats.tiles_per_worker, " "), stages_text(stats));
}

std::string json_string(const std::string& text) {
    std::string quoted = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') quoted += '\\';
        if (static_cast<unsigned char>(c) < 0x20)
            quoted += fmt::format("\\u{:04x}", static_cast<unsigned char>(c));
        else
            quoted += c;
    }
    return quoted + '"';
}

}  // namespace burnish::app
