#pragma once

#include <burnish/scene.hpp>
#include <vector>

#include "models/model_needs.hpp"
#include "models/plan.hpp"

namespace burnish {

/// Where a quantity of the layer is: a texture unit, and rgb or alpha of it.
struct QuantityPlace {
    int unit = -1;
    bool alpha = false;
};

/// A plan with stages and registers. Textures are still to be made: `material.units` has room for
/// them.
struct Schedule {
    ProgramMaterial material;
    std::vector<QuantityPlace> quantities;  ///< of the plan's
    std::vector<int> tables;                ///< their units
    ModelNeeds needs;
    int pass_unit = -1;  ///< brings the third vector, without a texture
};

/// Vectors and colours of the layer take one each and have an alpha for a number; other numbers
/// share one by twos; tables take one each, so does a third vector of the pixel.
int texture_units_of(const Plan& plan);

/// Lists stages greedily, longest chains first. `machine` may have more room than the one that the
/// program is for (with_room of burnish/multipass.hpp): results go to registers that `target` has,
/// and if that one has no fetches between stages, a fetch waits for the next stage where it needs
/// what another one brings. Throws Shortage for what `machine` has too little of.
Schedule schedule(const Plan& plan, const Machine& machine, const Machine& target);

}  // namespace burnish
