#pragma once

#include <burnish/scene.hpp>
#include <vector>

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
    int pass_unit = -1;                     ///< brings the third vector, without a texture
};

/// Lists stages greedily, longest chains first, on a machine with room enough (with_room of
/// burnish/multipass.hpp). Throws Error{bad_program} that names what is short, and by how much.
Schedule schedule(const Plan& plan, const Machine& machine);

}  // namespace burnish
