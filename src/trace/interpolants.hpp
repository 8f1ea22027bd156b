#pragma once

#include <string>
#include <vector>

#include "shade/shading.hpp"

namespace burnish {

/// Attribute planes that belong together.
struct InterpolantPlanes {
    std::string name;
    std::string components;   ///< a letter for each plane
    std::vector<int> planes;  ///< attribute planes
};

/// Everything that a shading interpolates or that its lighting stage adds, in the order of planes.
std::vector<InterpolantPlanes> interpolant_planes(const Shading& shading);

}  // namespace burnish
