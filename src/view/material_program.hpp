#pragma once

#include <burnish/renderer.hpp>
#include <burnish/scene.hpp>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "models/compile_model.hpp"

namespace burnish::view {

/// What a material's model is compiled to, before anybody edited it.
struct MaterialProgram {
    std::string material;  ///< its name
    std::string text;      ///< of print_combiners, in the scene's first light
    std::string error;     ///< why there is none; empty: there is
    std::string inputs;    ///< what its registers begin with, a line each; empty: not known yet
};

/// Programs of models for a panel, compiled again where something changed.
class MaterialPrograms {
  public:
    /// @param stop  asked while models are compiled, as RendererOptions::stop is
    explicit MaterialPrograms(std::function<bool()> stop) { m_models.stop = std::move(stop); }

    /// Of every material with a model in `scene`, each name once. Throws
    /// Error{stopped}, and nothing else of a material.
    /// @param anew  what registers begin with is looked at again, which compiles models of their
    ///              own; else it is what it was the last time
    std::vector<MaterialProgram> of(Renderer& renderer, const Scene& scene, bool anew);

  private:
    CompiledModels m_models;
    std::map<std::string, std::string> m_inputs;  ///< by material
};

}  // namespace burnish::view
