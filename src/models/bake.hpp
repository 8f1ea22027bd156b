#pragma once

#include <burnish/machine.hpp>

#include "models/layer.hpp"
#include "models/plan.hpp"
#include "models/schedule.hpp"
#include "models/texel_quantities.hpp"

namespace burnish {

/// What the texels of a compiled model are.
enum class TexelCoding {
    bytes,  ///< for nine-bit machines
    words,  ///< for wide ones: the 14 bits of their registers
    fine,   ///< words of 16 bits, n / 65535, for programs that are run in double precision
};
TexelCoding texel_coding(NumberModel numbers);

/// The textures of a scheduled plan: the material layer, coded as the program wants it, and tables.
/// Bits do not depend on the C library.
struct BakedTextures {
    std::vector<TexturePtr> units;     ///< null where a unit has none
    std::vector<LayerQuantity> layer;  ///< of the plan's quantities, in their order
};
/// @param texels  with all of the plan's quantities
/// @param machine  says how tables are filtered: with mip levels or sums, where it needs them
BakedTextures bake(const Plan& plan, const Schedule& schedule, TexelQuantities& texels,
                   TexelCoding coding, const Machine& machine);

}  // namespace burnish
