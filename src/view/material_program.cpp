#include "view/material_program.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <burnish/error.hpp>
#include <burnish/program_text.hpp>

#include "models/abp_modified.hpp"
#include "view/complaint.hpp"
#include "view/edited_scene.hpp"

namespace burnish::view {
namespace {

std::string line(const std::string& reg, const std::string& what) {
    return fmt::format("{:<10}{}\n", reg, what);
}

std::string interpolators_text(const ProgramMaterial& m) {
    std::string text;
    const auto add = [&](const char* reg, ColorInput input) {
        if (input != ColorInput::vertex) text += line(reg, std::string(input_name(input)));
    };
    add("col0.rgb", m.col0_rgb);
    add("col0.a", m.col0_a);
    add("col1.rgb", m.col1_rgb);
    add("col1.a", m.col1_a);
    for (std::size_t i = 0; i < m.uv.size(); ++i) {
        if (m.uv[i] != CoordinateInput::uv)
            text += line(fmt::format("tex{}", i), std::string(input_name(m.uv[i])));
    }
    return text;
}

/// Quantities of the material that are texels, then tables.
std::string texels_text(const CompiledModel& model) {
    std::string text;
    for (const LayerQuantity& q : model.layer) {
        if (!q.texture) continue;
        const auto& units = model.program.units;
        const auto unit = std::find(units.begin(), units.end(), q.texture) - units.begin();
        const char* channels = q.components == 3 ? "rgb" : q.channel == 3 ? "a" : "r";
        text +=
            line(fmt::format("tex{}.{}", unit, channels),
                 q.definition == q.name ? q.name : fmt::format("{} = {}", q.name, q.definition));
    }
    for (const TableReport& table : model.tables) {
        std::string axes;
        for (const AxisReport& axis : table.axes)
            axes += fmt::format("{}{} = {:.4g} .. {:.4g}", axes.empty() ? "" : ", ", axis.argument,
                                axis.first, axis.last);
        text += line(fmt::format("tex{}", table.unit),
                     fmt::format("table {} of {}", table.function, axes));
    }
    return text;
}

std::string inputs_text(CompiledModels& models, const Scene& scene,
                        const std::shared_ptr<const Material>& material) {
    if (has_own_maps(*material)) return "";
    const auto [light, ambient] = light_of_model(scene, 0);
    const CompiledModel& model = models.get(material, scene.machine.for_programs(), light, ambient);
    return interpolators_text(model.program) + texels_text(model);
}

}  // namespace

std::vector<MaterialProgram> MaterialPrograms::of(Renderer& renderer, const Scene& scene,
                                                  bool anew) {
    std::vector<MaterialProgram> programs;
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        const std::shared_ptr<const Material> material = material_of(scene.objects[i]);
        if (!material || material->program) continue;
        const bool seen = std::any_of(
            programs.begin(), programs.end(),
            [&](const MaterialProgram& each) { return each.material == material->name; });
        if (seen) continue;
        MaterialProgram& program = programs.emplace_back();
        program.material = material->name;
        std::string& inputs = m_inputs[material->name];
        try {
            program.text = print_combiners(renderer.program(scene, i).combiners);
            if (anew) inputs = inputs_text(m_models, scene, material);
            program.inputs = inputs;
        } catch (const std::exception& error) {
            program.error = complaint(error);
        }
    }
    if (anew) m_models.drop_unused();
    return programs;
}

}  // namespace burnish::view
