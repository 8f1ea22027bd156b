#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <burnish/error.hpp>
#include <burnish/materials.hpp>

#include "lab/stage_bits_text.hpp"
#include "view/panels.hpp"

namespace burnish::view {
namespace {

constexpr const char* kAsScene = "as the scene";

std::vector<std::string_view> available_isas() {
    std::vector<std::string_view> names;
    for (const IsaInfo& isa : instruction_sets())
        if (isa.available) names.push_back(isa.name);
    return names;
}

void file_controls(const Session& session, const Picture* picture) {
    ImGui::TextUnformatted(session.state.input.filename().string().c_str());
    if (picture == nullptr) return;
    std::string panes;
    for (const PaneReport& pane : picture->panes)
        panes +=
            fmt::format("{} {:.1f} ms{}{}\n", pane.machine, pane.ms,
                        pane.divisor > 1.0 ? fmt::format(", sides / {:.1f}", pane.divisor) : "",
                        pane.samples > 1 ? fmt::format(", {} samples", pane.samples) : "");
    ImGui::TextUnformatted(panes.c_str());
}

void machine_controls(Session& session) {
    ViewState& state = session.state;
    choose_word("machine", machine_profile_names(), "scene's: " + session.loaded().machine.name,
                state.machine);

    std::string half_vector = state.half_vector.value_or("");
    if (choose_word("half vector", {"pixel", "vertex", "cube:64"}, kAsScene, half_vector)) {
        state.half_vector.reset();
        if (!half_vector.empty()) state.half_vector = half_vector;
    }
    std::string order;
    if (state.filter_order) order = *state.filter_order == FilterOrder::before ? "before" : "after";
    if (choose_word("filter order", {"before", "after"}, kAsScene, order)) {
        state.filter_order.reset();
        if (!order.empty()) state.filter_order = filter_order_of(order);
    }
    std::string method;
    if (state.mipmaps) method = mip_method_names()[static_cast<std::size_t>(state.mipmaps->method)];
    if (choose_word("mip levels", mip_method_names(), kAsScene, method)) {
        state.mipmaps.reset();
        if (!method.empty()) state.mipmaps.emplace().method = *mip_method_named(method);
    }
    ImGui::Checkbox("split", &state.split);
    ImGui::SameLine();
    ImGui::Checkbox("error", &state.heat_map);
    if (state.heat_map)
        ImGui::SliderFloat("gain", &state.gain, 1.0F, 100.0F, "%.1f",
                           ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
}

/// A slider for each stage; all the way to the right is exact.
void bits_controls(std::string& text) {
    if (!ImGui::CollapsingHeader("bits per stage")) return;
    lab::StageBits bits;
    try {
        lab::set_stage_bits(bits, text);
    } catch (const Error&) {
        text.clear();
        bits = {};
    }
    bool active = !text.empty();
    bool changed = ImGui::Checkbox("chosen bits instead of the machine's", &active);
    const auto slider = [&](const char* label, int least, int& value) {
        constexpr int kMost = 16;
        int shown = value == kExactBits ? kMost + 1 : value;
        const char* const format = shown > kMost ? "exact" : "%d";
        if (!ImGui::SliderInt(label, &shown, least, kMost + 1, format,
                              ImGuiSliderFlags_AlwaysClamp))
            return;
        value = shown > kMost ? kExactBits : shown;
        changed = active = true;
    };
    slider("half vectors", 1, bits.half_vector);
    slider("textures", 1, bits.textures);
    slider("filters", 1, bits.filter);
    slider("combiners", 2, bits.combiners);
    slider("tables", 1, bits.table);
    slider("frame", 1, bits.frame);
    if (!changed) return;
    text = !active ? ""
                   : fmt::format(
                         "half_vector={},textures={},filter={},combiners={},table={},"
                         "frame={}",
                         lab::bits_text(bits.half_vector), lab::bits_text(bits.textures),
                         lab::bits_text(bits.filter), lab::bits_text(bits.combiners),
                         lab::bits_text(bits.table), lab::bits_text(bits.frame));
}

void worker_controls(Session& session) {
    ImGui::SliderInt("threads", &session.renderer.threads, 0, 16,
                     session.renderer.threads == 0 ? "all" : "%d", ImGuiSliderFlags_AlwaysClamp);
    choose_word("isa", available_isas(), "best", session.renderer.isa);
}

}  // namespace

bool choose_word(const char* label, const std::vector<std::string_view>& words,
                 const std::string& none, std::string& chosen) {
    bool changed = false;
    if (!ImGui::BeginCombo(label, chosen.empty() ? none.c_str() : chosen.c_str())) return false;
    const auto offer = [&](const std::string& shown, const std::string& value) {
        if (!ImGui::Selectable(shown.c_str(), chosen == value)) return;
        changed = chosen != value;
        chosen = value;
    };
    if (!none.empty()) offer(none, "");
    for (const std::string_view word : words) offer(std::string(word), std::string(word));
    ImGui::EndCombo();
    return changed;
}

void controls_panel(Session& session, const Picture* picture) {
    ImGui::SetNextWindowPos(ImVec2(8.0F, 8.0F), ImGuiCond_FirstUseEver);
    if (ImGui::Begin("burnish", nullptr, ImGuiWindowFlags_AlwaysAutoResize)) {
        ImGui::PushItemWidth(150.0F);
        file_controls(session, picture);
        machine_controls(session);
        worker_controls(session);
        bits_controls(session.state.bits);
        ImGui::Separator();
        material_controls(session, picture);
        ImGui::Separator();
        ImGui::TextUnformatted("H: all keys");
        ImGui::PopItemWidth();
    }
    ImGui::End();
}

}  // namespace burnish::view
