#pragma once

#include <burnish/renderer.hpp>
#include <burnish/scene.hpp>
#include <string>
#include <vector>

namespace burnish::view {

/// What a material's model is compiled to, before anybody edited it.
struct MaterialProgram {
    std::string material;  ///< its name
    std::string text;      ///< of print_combiners, in the scene's first light
    std::string error;     ///< why there is none; empty: there is
};

/// Of every material with a model in `scene`, each name once.
std::vector<MaterialProgram> programs_of_models(Renderer& renderer, const Scene& scene);

}  // namespace burnish::view
