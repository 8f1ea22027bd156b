#pragma once

#include <burnish/scene.hpp>

#include "models/mips/lobe_shape.hpp"
#include "models/mips/texel_moments.hpp"
#include "models/texel.hpp"

namespace burnish::mips {

/// The parameters that stand for a texel of a mip level.
///
/// `box` leaves vectors as short as their mean; everybody else has them unit and orthonormal. From
/// `mag` on kd is multiplied by |mean n|, which is what n.l loses.
///
/// @param least_variance  in slopes, of methods that have moments
[[nodiscard]] TexelParameters filtered_texel(const TexelMoments& moments, const LobeShape& shape,
                                             MipMethod method, double least_variance);

}  // namespace burnish::mips
