#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <burnish/combiner.hpp>

#include "view/panels.hpp"
#include "view/trace_tables.hpp"

namespace burnish::view {
namespace {

void triangle_lines(const TracedFragment& f) {
    std::string text = fmt::format(
        "object {}, material '{}', triangle {}{}, depth {:.7f}, 1/w {:.7f} (exact {:.7f})\n"
        "vertices",
        f.object, f.material, f.triangle, f.clipped ? ", clipped" : "", f.depth, f.one_over_w.value,
        f.one_over_w.exact);
    for (std::size_t i = 0; i < 3; ++i)
        text += fmt::format("  {}: {:.5f}", f.vertices[i], f.barycentrics[i]);
    ImGui::TextUnformatted(text.c_str());
}

void unit_lines(const TracedUnit& unit) {
    ImGui::TextWrapped("unit %d: %s%s%s", unit.unit, unit.text.c_str(),
                       unit.problem.empty() ? "" : ", off: ", unit.problem.c_str());
    number_table(fmt::format("unit {}", unit.unit), unit.numbers);
}

void stage_table(const TracedStage& stage, int one) {
    if (!ImGui::CollapsingHeader(stage.name.c_str(), ImGuiTreeNodeFlags_DefaultOpen)) return;
    if (!stage.text.empty()) ImGui::TextUnformatted(stage.text.c_str());
    std::vector<ColorRow> rows;
    for (const TracedRegister& r : stage.registers) {
        const bool changed = r.changed[0] || r.changed[1] || r.changed[2] || r.changed[3];
        rows.push_back({std::string(register_name(r.reg)), r.codes, r.color, r.filled, changed});
    }
    color_table(stage.name, rows, one);
}

/// What one light gives the fragment, or one of the texels around its sample point.
void light_tables(const TracedFragment& f, int one) {
    if (!f.interpolants.empty() && ImGui::CollapsingHeader("interpolants"))
        number_table("interpolants", f.interpolants);
    if (!f.units.empty() && ImGui::CollapsingHeader("texture units"))
        for (const TracedUnit& unit : f.units) unit_lines(unit);
    if (!f.fetches.empty() && ImGui::CollapsingHeader("texture fetches"))
        for (std::size_t i = 0; i < f.fetches.size(); ++i)
            fetch_table(fmt::format("fetch {}", i), f.fetches[i], one);
    for (const TracedStage& stage : f.stages) stage_table(stage, one);
    color_table("light", {{"result", f.light_codes, f.light_color}}, one);
}

/// A part that opens; its first one is open.
template <class Part>
void tree(const std::string& name, bool open, const Part& part) {
    if (!ImGui::TreeNodeEx(name.c_str(), open ? ImGuiTreeNodeFlags_DefaultOpen : 0)) return;
    part();
    ImGui::TreePop();
}

void all_lights(const TracedFragment& f, int one) {
    const std::size_t lights = f.further_lights.size() + 1;
    if (lights == 1) return light_tables(f, one);
    for (std::size_t i = 0; i < lights; ++i) {
        const TracedFragment& light = i == 0 ? f : f.further_lights[i - 1];
        tree(fmt::format("light {} of {}", i + 1, lights), i == 0,
             [&] { light_tables(light, one); });
    }
    color_table("lights", {{"all lights", f.codes, f.color}}, one);
}

/// With the filter after combining: the program at each texel, and what the filter makes of it.
void corner_tables(const TracedFragment& f, int one) {
    const auto name = [](const TracedCorner& corner) {
        return fmt::format("{} {}, level {}", corner.below ? "lower" : "upper",
                           corner.right ? "right" : "left", corner.level);
    };
    if (!f.interpolants.empty() && ImGui::CollapsingHeader("interpolants"))
        number_table("interpolants", f.interpolants);
    std::vector<ColorRow> rows;
    for (const TracedFragment& each : f.corners) {
        rows.push_back({name(*each.corner), each.codes, each.color});
        tree("texel " + rows.back().name, false, [&] {
            number_table("place", {{"texel", "uv", {each.corner->u, each.corner->v}}});
            all_lights(each, one);
        });
    }
    const TracedCorner& place = *f.corners.front().corner;
    std::vector<TracedInterpolant> weights{{"weight of the right texels", "x", {place.weight_x}},
                                           {"weight of the lower texels", "y", {place.weight_y}}};
    if (place.level_weight)
        weights.push_back({"weight of the upper level", "k", {*place.level_weight}});
    number_table("weights", weights);
    rows.push_back({"filtered", f.codes, f.color});
    color_table("filter", rows, one);
}

void fragment_tables(const TracedFragment& fragment, int one) {
    triangle_lines(fragment);
    if (fragment.corners.empty())
        all_lights(fragment, one);
    else
        corner_tables(fragment, one);
    if (fragment.blend) blend_table("blend", *fragment.blend);
}

/// The layers of the pixel, the uppermost first, and what the frame holds.
void layers(const PixelTrace& trace) {
    std::string stored = "stored";
    for (const double value : trace.stored) stored += fmt::format(" {:g}", value);
    ImGui::TextUnformatted(
        fmt::format("{}, machine {}, 1 is code {}", stored, trace.machine.name, trace.one).c_str());
    if (!trace.fragment) return ImGui::TextUnformatted("background");
    if (trace.below.empty()) return fragment_tables(*trace.fragment, trace.one);
    const std::size_t count = trace.below.size() + 1;
    for (std::size_t i = count; i > 0; --i) {
        const TracedFragment& layer = i == count ? *trace.fragment : trace.below[i - 1];
        tree(fmt::format("fragment {} of {}", i, count), i == count,
             [&] { fragment_tables(layer, trace.one); });
    }
}

}  // namespace

void trace_panel(Session& session, const Picture* picture) {
    if (!session.state.pixel) return;
    const ImVec2 display = ImGui::GetIO().DisplaySize;
    // Beside the controls and below the program, where the window has room.
    ImGui::SetNextWindowPos(display, ImGuiCond_FirstUseEver, ImVec2(1.0F, 1.0F));
    ImGui::SetNextWindowSize(
        ImVec2(std::min(1010.0F, display.x),
               std::max(0.45F * display.y, std::min(300.0F, 0.6F * display.y))),
        ImGuiCond_FirstUseEver);
    bool open = true;
    const std::string title =
        fmt::format("pixel {}, {}###trace", session.state.pixel->x, session.state.pixel->y);
    if (ImGui::Begin(title.c_str(), &open, ImGuiWindowFlags_HorizontalScrollbar)) {
        const glm::ivec2 pixel = *session.state.pixel;
        if (pixel.x >= session.state.width || pixel.y >= session.state.height)
            ImGui::TextUnformatted("outside of the picture");
        else if (picture == nullptr || (!picture->trace && picture->trace_error.empty()))
            ImGui::TextUnformatted("...");
        else if (!picture->trace)
            ImGui::TextWrapped("%s", picture->trace_error.c_str());
        else
            layers(*picture->trace);
    }
    ImGui::End();
    if (!open) session.state.pixel.reset();
}

}  // namespace burnish::view
