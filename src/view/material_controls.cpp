#include <imgui.h>

#include <burnish/materials.hpp>
#include <string>

#include "view/panels.hpp"

namespace burnish::view {
namespace {

const ImVec4 kTracedColor(1.0F, 0.85F, 0.4F, 1.0F);

void edit_color(const char* label, const glm::vec3& loaded, std::optional<glm::vec3>& edited) {
    glm::vec3 value = edited.value_or(loaded);
    if (ImGui::ColorEdit3(label, &value.x, ImGuiColorEditFlags_Float))
        edited = glm::clamp(value, glm::vec3(0.0F), glm::vec3(1.0F));
}

/// @param mapped  the loaded one comes from a map
void edit_number(const char* label, bool mapped, float loaded, float low, float high,
                 std::optional<float>& edited) {
    float value = edited.value_or(loaded);
    if (ImGui::SliderFloat(label, &value, low, high, mapped && !edited ? "a map" : "%.3f",
                           ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp))
        edited = value;
}

void edit_model(const Material& loaded, MaterialEdit& edit) {
    std::string model(model_name(edit.model.value_or(loaded.model)));
    if (choose_word("model", model_names(), "", model)) edit.model = model_named(model);
    edit_color("kd", loaded.kd, edit.kd);
    edit_color("ks", loaded.ks, edit.ks);
    // Maps of t / alpha hold their widths.
    const bool has_vectors = loaded.tangent_map != nullptr;
    edit_number("alpha x", has_vectors || loaded.alpha_x_map.texture, loaded.alpha_x, 0.01F, 1.0F,
                edit.alpha_x);
    edit_number("alpha y", has_vectors || loaded.alpha_y_map.texture, loaded.alpha_y, 0.01F, 1.0F,
                edit.alpha_y);
    edit_number("N", loaded.exponent_map.texture != nullptr, loaded.exponent, 1.0F, 1024.0F,
                edit.exponent);
}

}  // namespace

bool material_header(const Material& material, bool open, const Picture* picture) {
    const bool is_traced = picture != nullptr && picture->trace && picture->trace->fragment &&
                           picture->trace->fragment->material == material.name;
    bool* const was_traced = ImGui::GetStateStorage()->GetBoolRef(ImGui::GetID("traced"), false);
    const bool is_new = is_traced && !*was_traced;
    if (is_new) ImGui::SetNextItemOpen(true);
    // While a new trace is being made nothing is known.
    if (picture != nullptr && picture->trace) *was_traced = is_traced;
    if (is_traced) ImGui::PushStyleColor(ImGuiCol_Text, kTracedColor);
    const bool is_open =
        ImGui::CollapsingHeader(material.name.c_str(), open ? ImGuiTreeNodeFlags_DefaultOpen : 0);
    if (is_traced) ImGui::PopStyleColor();
    if (is_new) ImGui::SetScrollHereY(0.0F);
    return is_open;
}

void material_controls(Session& session, const Picture* picture) {
    int number = 0;
    if (session.materials().empty())
        ImGui::TextUnformatted("raw vertices without a material:\nthere is nothing to choose");
    for (const std::shared_ptr<const Material>& material : session.materials()) {
        ImGui::PushID(number++);
        const bool open = material_header(*material, number == 1, picture);
        if (open && material->program) {
            ImGui::TextUnformatted("a pipeline: P shows its program");
        } else if (open) {
            MaterialEdit& edit = session.edit_of(material->name);
            edit_model(*material, edit);
            const bool is_untouched = edit == MaterialEdit{.name = material->name};
            if (is_untouched || ImGui::Button("as loaded")) session.forget_edit(material->name);
        }
        ImGui::PopID();
    }
}

}  // namespace burnish::view
