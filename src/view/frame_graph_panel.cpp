#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <string>
#include <vector>

#include "view/panels.hpp"

namespace burnish::view {

namespace {

constexpr float kWidth = 380.0F;

void text(const std::string& line) {
    ImGui::TextUnformatted(line.c_str());
}

void plots(const FrameTimes& times) {
    if (times.count() == 0) return text("turn the scene: frames are counted while it moves");
    std::vector<float> intervals;
    std::vector<float> draws;
    for (const FrameTimes::Frame& frame : times.last()) {
        intervals.push_back(static_cast<float>(frame.interval_ms));
        draws.push_back(static_cast<float>(frame.draw_ms));
    }
    const auto plot = [](const char* id, const char* title, const std::vector<float>& values) {
        ImGui::PlotLines(id, values.data(), static_cast<int>(values.size()), 0, title, 0.0F, 50.0F,
                         ImVec2(kWidth - 20.0F, 32.0F));
    };
    plot("##frame", "from frame to frame, 0 .. 50 ms", intervals);
    plot("##drawing", "drawing, 0 .. 50 ms", draws);
    text(fmt::format("{:.1f} frames/s, median {:.2f} ms, 99.5 % {:.2f} ms", times.per_second(),
                     times.quantile(0.5), times.quantile(0.995)));
}

void stages(const FrameStats& stats) {
    if (stats.stages.empty()) return;
    ImGui::Separator();
    text("stages, the times of all threads added up");
    for (const StageCost& stage : stats.stages) {
        const std::string items =
            stage.items > 0 ? fmt::format("  {} {}", stage.items, stage.unit) : "";
        text(fmt::format("{:<12}{:>8.2f} ms{}", stage.name, stage.ms, items));
    }
}

}  // namespace

void frame_graph_panel(const FrameTimes& times, const Picture* picture) {
    // Beside the program where the window has room.
    const float left = ImGui::GetIO().DisplaySize.x - program_panel_width() - kWidth - 4.0F;
    ImGui::SetNextWindowPos(ImVec2(std::max(left, 0.0F), 0.0F), ImGuiCond_FirstUseEver);
    if (ImGui::Begin("frames", nullptr, ImGuiWindowFlags_AlwaysAutoResize)) {
        plots(times);
        if (picture != nullptr) {
            const FrameStats& stats = picture->stats;
            text(fmt::format("geometry {:.2f} ms, tiles {:.2f} ms", stats.geometry_ms,
                             stats.tiles_ms));
            text(fmt::format("{} pixels, {} triangles, {:.0f} MB of memory", stats.shaded_pixels,
                             stats.triangles, static_cast<double>(resident_bytes()) / 1e6));
            stages(stats);
        }
        if (ImGui::Button("copy as JSON")) ImGui::SetClipboardText(times.json().c_str());
    }
    ImGui::End();
}

}  // namespace burnish::view
