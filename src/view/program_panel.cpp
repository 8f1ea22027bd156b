#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <burnish/error.hpp>
#include <burnish/program_text.hpp>

#include "models/compile_model.hpp"
#include "view/panels.hpp"

namespace burnish::view {
namespace {

const ImVec4 kErrorColor(1.0F, 0.45F, 0.4F, 1.0F);

/// Numbers of the lines beside a text, red where something is wrong.
void line_numbers(const std::string& text, const std::vector<ProgramError>& errors,
                  const std::string& material) {
    std::size_t lines = 1;
    for (const char c : text) lines += c == '\n' ? 1 : 0;
    ImGui::BeginGroup();
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(0.0F, 0.0F));
    ImGui::Dummy(ImVec2(1.0F, ImGui::GetStyle().FramePadding.y));
    for (std::size_t line = 1; line <= lines; ++line) {
        bool wrong = false;
        for (const ProgramError& error : errors)
            wrong = wrong || (error.material == material && error.line == line);
        const std::string number = fmt::format("{}{:>3} ", wrong ? '>' : ' ', line);
        if (wrong)
            ImGui::TextColored(kErrorColor, "%s", number.c_str());
        else
            ImGui::TextDisabled("%s", number.c_str());
    }
    ImGui::PopStyleVar();
    ImGui::EndGroup();
}

void edit_pipeline(Session& session, const Material& material) {
    std::string printed;
    try {
        printed = print_combiners(material.program->combiners);
    } catch (const Error& error) {
        ImGui::TextWrapped("%s", error.what());
        return;
    }
    const MaterialEdit* edit = nullptr;
    for (const MaterialEdit& each : session.state.materials)
        if (each.name == material.name && each.combiners) edit = &each;
    std::string text = edit == nullptr ? printed : *edit->combiners;
    for (const ProgramError& error : session.program_errors)
        if (error.material == material.name)
            ImGui::TextColored(kErrorColor, "line %zu, column %zu: %s", error.line, error.column,
                               error.message.c_str());
    std::size_t lines = 2;
    for (const char c : text) lines += c == '\n' ? 1 : 0;
    line_numbers(text, session.program_errors, material.name);
    ImGui::SameLine();
    const ImVec2 size(-1.0F, static_cast<float>(lines) * ImGui::GetTextLineHeight() + 8.0F);
    if (ImGui::InputTextMultiline("##program", &text, size))
        session.edit_of(material.name).combiners = text;
    if (edit != nullptr && ImGui::Button("as loaded")) session.forget_edit(material.name);
}

/// What a reflectance model becomes on the machine that is looked at.
void show_model(const Session& session, const Material& material) {
    try {
        Machine machine = session.state.machine.empty() ? session.loaded().machine
                                                        : machine_profile(session.state.machine);
        if (machine.double_precision) {
            ImGui::TextUnformatted("double precision has formulas, no program");
            return;
        }
        machine.multipass = true;
        const CompiledModel compiled = compile_model(material, machine_for(session.state, machine),
                                                     glm::vec3(1.0F), session.loaded().ambient);
        ImGui::TextUnformatted(print_combiners(compiled.program.combiners).c_str());
    } catch (const Error& error) {
        ImGui::TextWrapped("%s", error.what());
    }
}

}  // namespace

void program_panel(Session& session, const Picture* picture) {
    const ImVec2 display = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos(ImVec2(display.x, 0.0F), ImGuiCond_FirstUseEver, ImVec2(1.0F, 0.0F));
    ImGui::SetNextWindowSize(ImVec2(std::min(620.0F, 0.6F * display.x), 0.7F * display.y),
                             ImGuiCond_FirstUseEver);
    if (ImGui::Begin("program")) {
        if (picture != nullptr)
            for (const PaneReport& pane : picture->panes)
                if (!pane.error.empty()) ImGui::TextColored(kErrorColor, "%s", pane.error.c_str());
        int number = 0;
        for (const Material* material : session.materials()) {
            ImGui::PushID(number++);
            if (ImGui::CollapsingHeader(material->name.c_str(),
                                        number == 1 ? ImGuiTreeNodeFlags_DefaultOpen : 0)) {
                if (material->program)
                    edit_pipeline(session, *material);
                else
                    show_model(session, *material);
            }
            ImGui::PopID();
        }
    }
    ImGui::End();
}

}  // namespace burnish::view
