#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <burnish/error.hpp>
#include <burnish/program_text.hpp>
#include <utility>

#include "view/panels.hpp"

namespace burnish::view {
namespace {

const ImVec4 kErrorColor(1.0F, 0.45F, 0.4F, 1.0F);

/// Numbers of the lines beside a text, red where something is wrong.
void line_numbers(const std::string& text, const std::vector<ProgramError>& errors) {
    std::size_t lines = 1;
    for (const char c : text) lines += c == '\n' ? 1 : 0;
    ImGui::BeginGroup();
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(0.0F, 0.0F));
    ImGui::Dummy(ImVec2(1.0F, ImGui::GetStyle().FramePadding.y));
    for (std::size_t line = 1; line <= lines; ++line) {
        bool wrong = false;
        for (const ProgramError& error : errors) wrong = wrong || error.line == line;
        const std::string number = fmt::format("{}{:>3} ", wrong ? '>' : ' ', line);
        if (wrong)
            ImGui::TextColored(kErrorColor, "%s", number.c_str());
        else
            ImGui::TextDisabled("%s", number.c_str());
    }
    ImGui::PopStyleVar();
    ImGui::EndGroup();
}

void wrapped_error(const std::string& text) {
    ImGui::PushStyleColor(ImGuiCol_Text, kErrorColor);
    ImGui::TextWrapped("%s", text.c_str());
    ImGui::PopStyleColor();
}

void show_errors(const std::vector<ProgramError>& errors) {
    for (const ProgramError& error : errors) wrapped_error(located(error));
}

/// What is wrong with the material's text, in itself or for a machine of the picture.
std::vector<ProgramError> errors_of(const Session& session, const Picture* picture,
                                    const std::string& material) {
    std::vector<ProgramError> errors = session.program_errors();
    if (picture != nullptr) {
        const std::vector<ProgramError> misfits = misfits_of(*picture);
        errors.insert(errors.end(), misfits.begin(), misfits.end());
    }
    std::erase_if(errors, [&](const ProgramError& each) { return each.material != material; });
    return errors;
}

/// Scrolls the child that is open to the cursor, where it moved. `top`: where the text begins.
void follow_cursor(const std::string& text, int cursor, float top) {
    int* const last = ImGui::GetStateStorage()->GetIntRef(ImGui::GetID("cursor"), -1);
    if (cursor < 0 || cursor == std::exchange(*last, cursor)) return;
    const auto end = text.begin() + std::min(cursor, static_cast<int>(text.size()));
    const float height = ImGui::GetTextLineHeight();
    const float y = top + height * static_cast<float>(std::count(text.begin(), end, '\n'));
    if (y < ImGui::GetScrollY() + height) ImGui::SetScrollY(y - height);
    if (y + 3.0F * height > ImGui::GetScrollY() + ImGui::GetWindowHeight())
        ImGui::SetScrollY(y + 3.0F * height - ImGui::GetWindowHeight());
}

struct TextField {
    bool changed = false;  ///< by a hand
    bool active = false;   ///< has the keys: it shows a text of its own, not the one it is given
};

/// A text with the numbers of its lines, as high as the panel has room.
TextField edit_text(const std::vector<ProgramError>& errors, std::string& text) {
    constexpr float kFewestLines = 8.0F;
    constexpr float kLinesBelow = 6.0F;  // the button, errors, what is folded
    const float line = ImGui::GetTextLineHeight();
    const float whole =
        line * static_cast<float>(std::count(text.begin(), text.end(), '\n') + 2) + 8.0F;
    const float room =
        std::max(ImGui::GetContentRegionAvail().y - kLinesBelow * line, kFewestLines * line);
    TextField field;
    if (ImGui::BeginChild("text", ImVec2(0.0F, std::min(whole, room)))) {
        line_numbers(text, errors);
        ImGui::SameLine();
        int cursor = -1;
        const auto tell = [](ImGuiInputTextCallbackData* data) {
            *static_cast<int*>(data->UserData) = data->CursorPos;
            return 0;
        };
        const float top = ImGui::GetCursorPosY();
        field.changed =
            ImGui::InputTextMultiline("##program", &text, ImVec2(-1.0F, whole),
                                      ImGuiInputTextFlags_CallbackAlways, tell, &cursor);
        field.active = ImGui::IsItemActive();
        follow_cursor(text, cursor, top);
    }
    ImGui::EndChild();
    return field;
}

void edit_pipeline(Session& session, const Material& material,
                   const std::vector<ProgramError>& errors) {
    std::string text;
    const MaterialEdit* edit = session.find_edit(material.name);
    const bool is_edited = edit != nullptr && edit->combiners;
    try {
        text = is_edited ? *edit->combiners : print_combiners(material.program->combiners);
    } catch (const Error& error) {
        ImGui::TextWrapped("%s", error.what());
        return;
    }
    if (edit_text(errors, text).changed) session.edit_of(material.name).combiners = text;
    if (is_edited && ImGui::Button("revert")) session.revert_program(material.name);
    show_errors(errors);
}

/// What the model is compiled to for the last picture; null until it is known.
const MaterialProgram* own_program(const Picture* picture, const std::string& material) {
    if (picture == nullptr) return nullptr;
    const auto& programs = picture->programs;
    const auto found =
        std::find_if(programs.begin(), programs.end(),
                     [&](const MaterialProgram& each) { return each.material == material; });
    return found == programs.end() ? nullptr : &*found;
}

void folded_text(const char* title, const std::string& text) {
    if (text.empty() || !ImGui::TreeNode(title)) return;
    ImGui::TextWrapped("%s", text.c_str());
    ImGui::TreePop();
}

void edit_model(Session& session, const Material& material, const Picture* picture,
                const std::vector<ProgramError>& errors) {
    const MaterialProgram* own = own_program(picture, material.name);
    const MaterialEdit* edit = session.find_edit(material.name);
    const bool is_edited = edit != nullptr && edit->combiners;
    if (!is_edited && (own == nullptr || !own->error.empty())) {
        ImGui::TextWrapped("%s", own == nullptr ? "..." : own->error.c_str());
        return;
    }
    std::optional<Session::ProgramInHand>& in_hand = session.program_in_hand;
    const bool was_in_hand = in_hand && in_hand->material == material.name;
    std::string begun = was_in_hand ? in_hand->own : own != nullptr ? own->text : "";
    std::string text = is_edited ? *edit->combiners : begun;
    const TextField field = edit_text(errors, text);
    if (field.changed) {
        MaterialEdit& changed = session.edit_of(material.name);
        if (!changed.combiners) changed.compiled = begun;
        changed.combiners = text;
    }
    if (field.active && !is_edited)
        in_hand = {material.name, std::move(begun)};
    else if (was_in_hand)
        in_hand.reset();
    if (is_edited && ImGui::Button("revert")) session.revert_program(material.name);
    show_errors(errors);
    if (own == nullptr) return;
    folded_text("what registers begin with", own->inputs);
    if (is_edited) folded_text("the model's own", own->error.empty() ? own->text : own->error);
}

}  // namespace

float program_panel_width() {
    return std::min(620.0F, 0.6F * ImGui::GetIO().DisplaySize.x);
}

void program_panel(Session& session, const Picture* picture) {
    const ImVec2 display = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos(ImVec2(display.x, 0.0F), ImGuiCond_FirstUseEver, ImVec2(1.0F, 0.0F));
    ImGui::SetNextWindowSize(ImVec2(program_panel_width(), 0.55F * display.y),
                             ImGuiCond_FirstUseEver);
    if (ImGui::Begin("program")) {
        if (picture != nullptr) {
            for (const PaneReport& pane : picture->panes)
                if (!pane.error.empty()) wrapped_error(pane.error);
        }
        int number = 0;
        for (const std::shared_ptr<const Material>& material : session.materials()) {
            ImGui::PushID(number++);
            if (material_header(*material, number == 1, picture)) {
                const std::vector<ProgramError> errors =
                    errors_of(session, picture, material->name);
                if (material->program)
                    edit_pipeline(session, *material, errors);
                else
                    edit_model(session, *material, picture, errors);
            }
            ImGui::PopID();
        }
    }
    ImGui::End();
}

}  // namespace burnish::view
