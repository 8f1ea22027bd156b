#pragma once

#include <burnish/machine.hpp>

#include "models/layer.hpp"
#include "models/plan.hpp"
#include "models/schedule.hpp"
#include "models/texel_quantities.hpp"

namespace burnish {

/// The textures of a scheduled plan: the material layer, coded as the program wants it, and tables.
/// Bytes on nine-bit machines, words on wide ones; bits do not depend on the C library.
struct BakedTextures {
    std::vector<TexturePtr> units;     ///< null where a unit has none
    std::vector<LayerQuantity> layer;  ///< of the plan's quantities, in their order
};
/// @param texels  with all of the plan's quantities
BakedTextures bake(const Plan& plan, const Schedule& schedule, TexelQuantities& texels,
                   NumberModel numbers);

}  // namespace burnish
