#pragma once

#include <burnish/texture.hpp>
#include <vector>

#include "shade/input_op.hpp"

namespace burnish {

/// Coordinates as attribute planes, -1 where there is none; q divides s, t (and r of 3D) first.
struct SampleCoordinates {
    int s = -1, t = -1, r = -1, q = -1;
    bool interpolated = false;  ///< planes of the interpolator
};

/// Where texels go.
struct SampleTarget {
    int registers = -1;  ///< first of four register planes
    int values = -1;     ///< first of two attribute planes
};

/// What sampling takes for itself.
struct SamplePlan {
    int next_attribute = 0;
    int next_register = 0;
    bool has_last = false;
    AddressCtx last{};
};

void plan_sample(const Texture& texture, const SampleCoordinates& at, const SampleTarget& target,
                 SamplePlan& plan, std::vector<InputOp>& ops);

}  // namespace burnish
