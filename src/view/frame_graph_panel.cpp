#include <fmt/format.h>
#include <imgui.h>

#include <vector>

#include "view/panels.hpp"

namespace burnish::view {

void frame_graph_panel(const FrameTimes& times, const Picture* picture) {
    ImGui::SetNextWindowPos(ImGui::GetIO().DisplaySize, ImGuiCond_FirstUseEver, ImVec2(1.0F, 1.0F));
    ImGui::SetNextWindowSize(ImVec2(380.0F, 430.0F), ImGuiCond_FirstUseEver);
    if (ImGui::Begin("frames")) {
        std::vector<float> intervals;
        std::vector<float> draws;
        for (const FrameTimes::Frame& frame : times.last()) {
            intervals.push_back(static_cast<float>(frame.interval_ms));
            draws.push_back(static_cast<float>(frame.draw_ms));
        }
        const auto plot = [](const char* label, const std::vector<float>& values) {
            ImGui::PlotLines(label, values.data(), static_cast<int>(values.size()), 0, nullptr,
                             0.0F, 50.0F, ImVec2(240.0F, 60.0F));
        };
        plot("frame", intervals);
        plot("drawing", draws);
        ImGui::TextUnformatted(fmt::format("{:.1f} frames/s, median {:.2f} ms, 99.5 % {:.2f} ms",
                                           times.per_second(), times.quantile(0.5),
                                           times.quantile(0.995))
                                   .c_str());
        if (picture != nullptr) {
            const FrameStats& stats = picture->stats;
            ImGui::TextUnformatted(
                fmt::format("geometry {:.2f} ms, tiles {:.2f} ms\n{} pixels shaded, {} triangles\n"
                            "{:.1f} MB of memory",
                            stats.geometry_ms, stats.tiles_ms, stats.shaded_pixels, stats.triangles,
                            static_cast<double>(resident_bytes()) / 1e6)
                    .c_str());
            for (const StageCost& stage : stats.stages)
                ImGui::TextUnformatted(fmt::format("{:<12}{:>8.2f} ms  {} {}", stage.name, stage.ms,
                                                   stage.items, stage.unit)
                                           .c_str());
        }
        if (ImGui::Button("copy as JSON")) ImGui::SetClipboardText(times.json().c_str());
    }
    ImGui::End();
}

}  // namespace burnish::view
