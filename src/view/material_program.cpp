#include "view/material_program.hpp"

#include <algorithm>
#include <burnish/error.hpp>
#include <burnish/program_text.hpp>

#include "view/edited_scene.hpp"

namespace burnish::view {
namespace {

MaterialProgram program_of_model(Renderer& renderer, const Scene& scene, std::size_t object,
                                 const std::string& name) {
    try {
        return {name, print_combiners(renderer.program(scene, object).combiners), ""};
    } catch (const Error& error) {
        return {name, "", error.what()};
    }
}

}  // namespace

std::vector<MaterialProgram> programs_of_models(Renderer& renderer, const Scene& scene) {
    std::vector<MaterialProgram> programs;
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        const std::shared_ptr<const Material> material = material_of(scene.objects[i]);
        if (!material || material->program) continue;
        const bool seen = std::any_of(
            programs.begin(), programs.end(),
            [&](const MaterialProgram& each) { return each.material == material->name; });
        if (!seen) programs.push_back(program_of_model(renderer, scene, i, material->name));
    }
    return programs;
}

}  // namespace burnish::view
