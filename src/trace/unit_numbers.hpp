#pragma once

#include <burnish/trace.hpp>
#include <functional>
#include <optional>
#include <string>

#include "shade/shading.hpp"

namespace burnish {

/// The units of a texture shader with what they do; their numbers are still missing.
std::vector<TracedUnit> traced_units(const ProgramMaterial& program, const Machine& machine);

/// What an operation of a texture unit computed: planes that belong together.
struct UnitNumbers {
    std::string name;
    std::string components;   ///< a letter for each plane
    std::vector<int> planes;  ///< attribute planes
};

/// Nothing for operations that compute no coordinates, such as fetches.
std::optional<UnitNumbers> unit_numbers(const InputOp& op, const Shading& shading);

/// Unit to which operation `op` of shading.inputs belongs, -1 in front of the first one's.
int unit_of_operation(const Shading& shading, std::size_t op);

}  // namespace burnish
