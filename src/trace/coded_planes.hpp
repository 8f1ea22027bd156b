#pragma once

#include <vector>

#include "machine/interpreter.hpp"
#include "shade/shading.hpp"

namespace burnish {

/// Register planes that hold x/2 + 1/2, since `program` or a texture unit expands them.
std::vector<bool> coded_planes(const LightShading& shading, const CombinerProgram& program);

}  // namespace burnish
