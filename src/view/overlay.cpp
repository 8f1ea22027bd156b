#include <imgui.h>

#include <algorithm>

#include "view/keys.hpp"
#include "view/panels.hpp"

namespace burnish::view {
namespace {

constexpr ImU32 kLine = IM_COL32(255, 255, 255, 160);
constexpr ImU32 kShadow = IM_COL32(0, 0, 0, 160);
constexpr ImU32 kText = IM_COL32(255, 255, 255, 255);
constexpr ImU32 kWrong = IM_COL32(150, 30, 30, 235);

void label(ImDrawList& list, const ImVec2& at, ImU32 behind, const std::string& text, float wrap) {
    const ImVec2 size = ImGui::CalcTextSize(text.c_str(), nullptr, false, wrap);
    list.AddRectFilled(ImVec2(at.x - 4.0F, at.y - 2.0F),
                       ImVec2(at.x + size.x + 4.0F, at.y + size.y + 2.0F), behind);
    list.AddText(nullptr, 0.0F, at, kText, text.c_str(), nullptr, wrap);
}

}  // namespace

void picture_overlay(const Session& session, const Picture* picture) {
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    if (session.state.split) {
        for (const float line : session.state.lines) {
            const float x = std::floor(line * size.x);
            list.AddRectFilled(ImVec2(x, 0.0F), ImVec2(x + 1.0F, size.y), kLine);
        }
        const std::vector<Machine> machines = split_machines();
        for (std::size_t i = 0; i < machines.size(); ++i) {
            const float from = i == 0 ? 0.0F : session.state.lines[i - 1];
            label(list, ImVec2(from * size.x + 8.0F, size.y - 24.0F), kShadow, machines[i].name,
                  0.0F);
        }
    }
    if (session.state.pixel) {
        const auto x = static_cast<float>(session.state.pixel->x);
        const auto y = static_cast<float>(session.state.pixel->y);
        list.AddRect(ImVec2(x - 4.0F, y - 4.0F), ImVec2(x + 5.0F, y + 5.0F), kLine);
    }
    float y = 8.0F;
    const auto complain = [&](const std::string& text) {
        const float width = std::max(size.x - 320.0F, 120.0F);
        label(list, ImVec2(std::min(300.0F, size.x * 0.25F), y), kWrong, text, width);
        y += ImGui::CalcTextSize(text.c_str(), nullptr, false, width).y + 8.0F;
    };
    for (const std::string& message : {session.message, session.shot_message, session.wish_message})
        if (!message.empty()) complain(message);
    for (const std::string& message : session.edit_messages()) complain(message);
    if (picture == nullptr) return;
    for (const PaneReport& pane : picture->panes)
        if (!pane.error.empty()) complain(pane.error);
    if (session.shows_programs) return;  // the panel has them at their lines
    for (const ProgramError& misfit : misfits_of(*picture)) complain(of_material(misfit));
}

void key_list_panel(OpenPanels& open) {
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos(ImVec2(0.5F * size.x, 0.5F * size.y), ImGuiCond_Always,
                            ImVec2(0.5F, 0.5F));
    ImGui::SetNextWindowBgAlpha(1.0F);
    constexpr ImGuiWindowFlags kFlags = ImGuiWindowFlags_AlwaysAutoResize |
                                        ImGuiWindowFlags_NoCollapse |
                                        ImGuiWindowFlags_NoFocusOnAppearing;
    if (ImGui::Begin("keys", &open.key_list, kFlags)) {
        const auto row = [](const char* name, const char* text) {
            ImGui::Text("%-22s%s", name, text);
        };
        for (const KeyBinding& binding : key_bindings()) row(binding.name, binding.text);
        ImGui::Separator();
        for (const MouseHint& hint : mouse_hints()) row(hint.name, hint.text);
    }
    ImGui::End();
}

}  // namespace burnish::view
