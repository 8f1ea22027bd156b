#pragma once

#include <burnish/scene.hpp>
#include <memory>
#include <vector>

#include "models/layer.hpp"
#include "reference/shade.hpp"

namespace burnish::reference {

/// A model's formula over the maps of a material, whose quantities are those of a machine's layer.
class LayerFormula {
  public:
    virtual ~LayerFormula() = default;
    /// What a light of colour 1 adds at `uv`, v downward.
    [[nodiscard]] virtual glm::dvec3 at(const glm::dvec2& uv, const Directions& to) = 0;
};

/// Models that have a name by reflected(); texts by the expression that is compiled, too.
/// Throws Error{bad_program} for a text that is none.
std::unique_ptr<LayerFormula> layer_formula(const Material& material,
                                            std::vector<LayerQuantity> layer);

}  // namespace burnish::reference
