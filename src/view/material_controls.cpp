#include <imgui.h>

#include <burnish/materials.hpp>
#include <string>

#include "view/panels.hpp"

namespace burnish::view {
namespace {

void edit_color(const char* label, const glm::vec3& loaded, std::optional<glm::vec3>& edited) {
    glm::vec3 value = edited.value_or(loaded);
    if (ImGui::ColorEdit3(label, &value.x, ImGuiColorEditFlags_Float))
        edited = glm::clamp(value, glm::vec3(0.0F), glm::vec3(1.0F));
}

void edit_number(const char* label, float loaded, float low, float high,
                 std::optional<float>& edited) {
    float value = edited.value_or(loaded);
    if (ImGui::SliderFloat(label, &value, low, high, "%.3f",
                           ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp))
        edited = value;
}

void edit_model(const Material& loaded, MaterialEdit& edit) {
    std::string model(model_name(edit.model.value_or(loaded.model)));
    if (choose_word("model", model_names(), "", model)) edit.model = model_named(model);
    edit_color("kd", loaded.kd, edit.kd);
    edit_color("ks", loaded.ks, edit.ks);
    edit_number("alpha x", loaded.alpha_x, 0.01F, 1.0F, edit.alpha_x);
    edit_number("alpha y", loaded.alpha_y, 0.01F, 1.0F, edit.alpha_y);
    edit_number("N", loaded.exponent, 1.0F, 1024.0F, edit.exponent);
}

}  // namespace

void material_controls(Session& session) {
    int number = 0;
    if (session.materials().empty())
        ImGui::TextUnformatted("raw vertices without a material:\nthere is nothing to choose");
    for (const std::shared_ptr<const Material>& material : session.materials()) {
        ImGui::PushID(number++);
        const bool open = ImGui::CollapsingHeader(material->name.c_str(),
                                                  number == 1 ? ImGuiTreeNodeFlags_DefaultOpen : 0);
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
