#pragma once

#include <burnish/multipass.hpp>
#include <burnish/scene.hpp>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "models/layer.hpp"
#include "models/model_needs.hpp"

namespace burnish {

/// An axis of a table.
struct AxisReport {
    std::string argument;            ///< in the language of models
    double first = 0.0, last = 0.0;  ///< the argument at the ends
    bool logarithmic = false;        ///< texels lie at equal ratios, not at equal differences
    int texels = 1;
};

/// A table of a compiled model, for reports.
struct TableReport {
    std::string function;  ///< in the language of models
    std::vector<AxisReport> axes;
    int unit = -1;
    double interpolation = 0.0;  ///< largest error between texels, in its own numbers
};

/// A reflectance model as a program for a machine.
struct CompiledModel {
    ProgramMaterial program;
    std::vector<LayerQuantity> layer;
    std::vector<TableReport> tables;
    ModelNeeds needs;                 ///< in one pass
    std::vector<ProgramPass> passes;  ///< of a machine that has to split it; else empty
};

/// Splits the model of `material` into what combiners compute and what becomes dependent textures,
/// and finds ranges, scales, axes, table sizes, stages and units for `machine`, and the passes if
/// it is one that splits programs.
/// @param light  colour times intensity
/// Throws Error{bad_program} that names the model, the machine and every resource that it is short
/// of, with counts; for a text of the material with line and column where an expression is to
/// blame.
CompiledModel compile_model(const Material& material, const Machine& machine,
                            const glm::vec3& light, const glm::vec3& ambient);

/// Texels of a compiled model: what the machine takes, or as fine as double precision asks for
/// (TexelCoding::fine), which no nine-bit machine can sample. Programs are the same.
enum class TexelPrecision { machine, fine };

/// compile_model for one material on one machine and in one light after the other: what depends on
/// the material alone is worked out once, its texels kept as TexelQuantities does.
class ModelCompiler {
  public:
    /// Throws Error{stopped}, as compile does, when `stop` says so: it is asked for every row of
    /// the material's texels.
    explicit ModelCompiler(const Material& material, std::function<bool()> stop = {});
    ~ModelCompiler();
    ModelCompiler(const ModelCompiler&) = delete;
    ModelCompiler& operator=(const ModelCompiler&) = delete;

    CompiledModel compile(const Machine& machine, const glm::vec3& light, const glm::vec3& ambient,
                          TexelPrecision precision = TexelPrecision::machine);

  private:
    struct Parts;
    std::unique_ptr<Parts> m_parts;
};

/// The light of that number; of a scene without lights one that is dark.
Light light_of(const Scene& scene, std::size_t number);

/// What a model is compiled for.
struct LightOfModel {
    glm::vec3 light;    ///< colour times intensity
    glm::vec3 ambient;  ///< of the first light alone
};
LightOfModel light_of_model(const Scene& scene, std::size_t number);

/// Compiled models, kept while they are drawn again.
class CompiledModels {
  public:
    std::function<bool()> stop;  ///< of all ModelCompilers

    /// Throws what ModelCompiler throws.
    const CompiledModel& get(const std::shared_ptr<const Material>& material,
                             const Machine& machine, const glm::vec3& light,
                             const glm::vec3& ambient);

    /// Forgets what was not asked for since the last call but `frames` - 1.
    void drop_unused(int frames = 1);

  private:
    struct Entry {
        std::shared_ptr<const Material> material;
        Machine machine;
        glm::vec3 light, ambient;
        CompiledModel model;
        int idle;  ///< calls of drop_unused since it was asked for
    };
    std::vector<std::unique_ptr<Entry>> m_entries;
    /// Of the material that was compiled last, which may have more lights or moving ones: kept
    /// while it is drawn.
    std::unique_ptr<ModelCompiler> m_compiler;
    std::shared_ptr<const Material> m_compiled_last;
};

}  // namespace burnish
