#include "view/material_program.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <burnish/error.hpp>
#include <burnish/program_text.hpp>

#include "models/abp_modified.hpp"
#include "models/program_inputs.hpp"
#include "view/complaint.hpp"
#include "view/edited_scene.hpp"

namespace burnish::view {
namespace {

std::string axes_text(const TableReport& table) {
    std::string axes;
    for (const AxisReport& axis : table.axes)
        axes += fmt::format("{}{} = {:.4g} .. {:.4g}", axes.empty() ? "" : ", ", axis.argument,
                            axis.first, axis.last);
    return axes;
}

/// What interpolators carry, then quantities of the material that are texels, then tables.
std::vector<ProgramInput> inputs_of(const CompiledModel& model) {
    std::vector<ProgramInput> inputs = interpolated_inputs(model.program);
    for (const LayerQuantity& q : model.layer) {
        if (!q.texture) continue;
        inputs.push_back(
            {fmt::format("tex{} {}", unit_of(q, model.program), channels_of(q)),
             q.definition == q.name ? q.name : fmt::format("{} = {}", q.name, q.definition)});
    }
    for (const TableReport& table : model.tables)
        inputs.push_back({fmt::format("tex{}", table.unit),
                          fmt::format("table {} of {}", table.function, axes_text(table))});
    return inputs;
}

std::string inputs_text(CompiledModels& models, const Scene& scene,
                        const std::shared_ptr<const Material>& material) {
    if (has_own_maps(*material)) return "";
    const auto [light, ambient] = light_of_model(scene, 0);
    const CompiledModel& model = models.get(material, scene.machine.for_programs(), light, ambient);
    const std::vector<ProgramInput> inputs = inputs_of(model);
    std::size_t width = 0;
    for (const ProgramInput& input : inputs) width = std::max(width, input.name.size());
    std::string text;
    for (const ProgramInput& input : inputs)
        text += fmt::format("{:<{}}  {}\n", input.name, width, input.value);
    return text;
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
        if (scene.machine.double_precision) {
            program.error = "double precision works by formulas; a machine has a program here";
            continue;
        }
        try {
            program.text = print_combiners(renderer.program(scene, i).combiners);
            if (anew) inputs = inputs_text(m_models, scene, material);
            program.inputs = inputs;
        } catch (const Error& error) {
            if (error.code() == ErrorCode::stopped) throw;
            program.error = error.what();
        } catch (const std::exception& error) {
            program.error = complaint(error);
        }
    }
    if (anew) m_models.drop_unused();
    return programs;
}

}  // namespace burnish::view
