#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <burnish/combiner.hpp>

#include "view/panels.hpp"

namespace burnish::view {
namespace {

const ImVec4 kChangedColor(1.0F, 0.85F, 0.4F, 1.0F);

/// Four numbers; those that nothing fills are left out.
template <class Cell>
std::string four(const std::array<bool, 4>& filled, const Cell& cell) {
    std::string text;
    for (std::size_t c = 0; c < 4; ++c) text += filled[c] ? cell(c) : fmt::format("{:>8}", "-");
    return text;
}

void register_row(const TracedRegister& r, int one) {
    ImGui::TableNextRow();
    const bool changed = r.changed[0] || r.changed[1] || r.changed[2] || r.changed[3];
    const auto cell = [changed](const std::string& text) {
        ImGui::TableNextColumn();
        if (changed)
            ImGui::TextColored(kChangedColor, "%s", text.c_str());
        else
            ImGui::TextUnformatted(text.c_str());
    };
    cell(std::string(register_name(r.reg)));
    cell(four(r.filled, [&](std::size_t c) { return fmt::format("{:>8}", r.codes[c]); }));
    cell(four(r.filled, [&](std::size_t c) { return fmt::format("{:>8.4f}", r.color[c].value); }));
    cell(four(r.filled, [&](std::size_t c) { return fmt::format("{:>8.4f}", r.color[c].exact); }));
    cell(four(r.filled,
              [&](std::size_t c) { return fmt::format("{:>8.2f}", r.color[c].error() * one); }));
}

void stage_table(const TracedStage& stage, int one) {
    if (!ImGui::CollapsingHeader(stage.name.c_str(), ImGuiTreeNodeFlags_DefaultOpen)) return;
    if (!stage.text.empty()) ImGui::TextUnformatted(stage.text.c_str());
    constexpr ImGuiTableFlags kFlags =
        ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_RowBg | ImGuiTableFlags_BordersInnerV;
    if (!ImGui::BeginTable(stage.name.c_str(), 5, kFlags)) return;
    for (const char* title : {"register", "code r g b a", "value", "exact", "error, in codes"})
        ImGui::TableSetupColumn(title);
    ImGui::TableHeadersRow();
    for (const TracedRegister& r : stage.registers) register_row(r, one);
    ImGui::EndTable();
}

void fetches(const TracedFragment& fragment) {
    if (fragment.fetches.empty() || !ImGui::CollapsingHeader("texture fetches")) return;
    for (const TracedFetch& fetch : fragment.fetches) {
        std::string text = fmt::format(
            "tex{}  u {:.5f}  v {:.5f}  texels ({}, {}) .. ({}, {}), "
            "weights {}/256 {}/256  ->",
            fetch.unit, fetch.u.value, fetch.v.value, fetch.x0, fetch.y0, fetch.x1, fetch.y1,
            fetch.weight_x, fetch.weight_y);
        for (const int code : fetch.codes) text += fmt::format(" {}", code);
        ImGui::TextUnformatted(text.c_str());
    }
}

void fragment_tables(const TracedFragment& fragment, const PixelTrace& trace) {
    ImGui::TextUnformatted(fmt::format("object {}, material '{}', triangle {}, depth {:.6f}",
                                       fragment.object, fragment.material, fragment.triangle,
                                       fragment.depth)
                               .c_str());
    fetches(fragment);
    for (const TracedStage& stage : fragment.stages) stage_table(stage, trace.one);
    std::string stored = "stored";
    for (const double value : trace.stored) stored += fmt::format(" {:g}", value);
    ImGui::TextUnformatted(stored.c_str());
}

}  // namespace

void trace_panel(Session& session, const Picture* picture) {
    if (!session.state.pixel) return;
    ImGui::SetNextWindowPos(ImVec2(0.0F, ImGui::GetIO().DisplaySize.y), ImGuiCond_FirstUseEver,
                            ImVec2(0.0F, 1.0F));
    ImGui::SetNextWindowSize(ImVec2(std::min(1010.0F, ImGui::GetIO().DisplaySize.x), 300.0F),
                             ImGuiCond_FirstUseEver);
    bool open = true;
    const std::string title =
        fmt::format("pixel {}, {}###trace", session.state.pixel->x, session.state.pixel->y);
    if (ImGui::Begin(title.c_str(), &open)) {
        if (picture == nullptr || (!picture->trace && picture->trace_error.empty()))
            ImGui::TextUnformatted("...");
        else if (!picture->trace)
            ImGui::TextWrapped("%s", picture->trace_error.c_str());
        else if (!picture->trace->fragment)
            ImGui::TextUnformatted("background");
        else
            fragment_tables(*picture->trace->fragment, *picture->trace);
    }
    ImGui::End();
    if (!open) session.state.pixel.reset();
}

}  // namespace burnish::view
