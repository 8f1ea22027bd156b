#pragma once

#include <burnish/machine.hpp>

#include "models/layer.hpp"
#include "models/plan.hpp"
#include "models/schedule.hpp"
#include "models/texel.hpp"

namespace burnish {

/// The textures of a scheduled plan: the material layer, coded as the program wants it, and tables.
/// Bytes on nine-bit machines, words on wide ones; bits do not depend on the C library.
struct BakedTextures {
    std::vector<TexturePtr> units;     ///< null where a unit has none
    std::vector<LayerQuantity> layer;  ///< of the plan's quantities, in their order
};
BakedTextures bake(const Plan& plan, const Schedule& schedule, const TexelSource& source,
                   NumberModel numbers);

/// The values of `quantities` at a texel, for leaves that TexelParameters has.
class TexelTape {
  public:
    explicit TexelTape(const std::vector<const Expr*>& quantities);
    void run(const TexelParameters& texel, glm::dvec3* values);

  private:
    std::vector<const Expr*> m_leaves;
    Tape m_tape;
};

}  // namespace burnish
