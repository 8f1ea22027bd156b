#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "shade/sample.hpp"

namespace burnish {

struct Shading;

/// How FilterOrder::after shades: all lights at each of four texel centres of the finest map, then
/// the filter over their colours; between two levels so twice, and a blend.
struct CornerShading {
    SampledCorners map;
    TexelCornerCtx corner{};               ///< of the upper left one, in the lower of two levels
    std::vector<InputOp> level{};          ///< what finds the pixel's level of detail, once for all
    std::array<std::int16_t, 4> colors{};  ///< planes where the lights leave r, g, b, a
    FilterCtx filter{};
    BlendLevelsCtx blend{};  ///< of the filtered colours with those of the level above

    /// Whether packets may lie between two levels.
    [[nodiscard]] bool blends_levels() const { return corner.choice == LevelChoice::floor; }
};

/// Planes of shading.corners, whose map is set, behind those of the programs, which are planned;
/// shading.result becomes what the filter leaves. Throws Error{bad_program} for fragments that
/// bring depths of their own: nothing filters them.
void plan_corners(Shading& shading);

}  // namespace burnish
