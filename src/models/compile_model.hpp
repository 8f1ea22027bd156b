#pragma once

#include <burnish/scene.hpp>
#include <memory>
#include <string>
#include <vector>

#include "models/expression.hpp"
#include "models/layer.hpp"
#include "models/plan.hpp"

namespace burnish {

/// The model of `material` as an expression of named quantities and values of the pixel, in nodes of
/// `builder`. Throws Error{bad_program} for what is wrong in a text, with line and column.
ExprPtr model_expression(const Material& material, ExprBuilder& builder);

/// A table of a compiled model, for reports.
struct TableReport {
    std::string function;                ///< in the language of models
    std::vector<std::string> arguments;  ///< along its axes, likewise
    int unit = -1;
    int width = 1, height = 1;
    double interpolation = 0.0;  ///< largest error between texels, in its own numbers
};

/// A reflectance model as a program for a machine.
struct CompiledModel {
    ProgramMaterial program;
    std::vector<LayerQuantity> layer;
    std::vector<TableReport> tables;
};

/// Splits the model of `material` into what combiners compute and what becomes dependent textures,
/// and finds ranges, scales, axes, table sizes, stages and units for `machine`.
/// @param light  colour times intensity
/// Throws Error{bad_program} that names the resource that the machine is short of, and by how much;
/// for a text of the material with line and column.
CompiledModel compile_model(const Material& material, const Machine& machine,
                            const glm::vec3& light, const glm::vec3& ambient);

/// Compiled models, kept while they are drawn again.
class CompiledModels {
  public:
    const CompiledModel& get(const std::shared_ptr<const Material>& material,
                             const Machine& machine, const glm::vec3& light,
                             const glm::vec3& ambient);

    /// Forgets what was not asked for since the last call.
    void drop_unused();

  private:
    struct Entry {
        std::shared_ptr<const Material> material;
        Machine machine;
        glm::vec3 light, ambient;
        CompiledModel model;
        bool used;
    };
    std::vector<std::unique_ptr<Entry>> m_entries;
};

}  // namespace burnish
