#pragma once

#include <burnish/machine.hpp>
#include <vector>

#include "models/plan.hpp"

namespace burnish {

/// Texels of a table of `function` over `args`, and how many, where its axes lie already: as many
/// as it takes until interpolation is as good as the numbers are, or as there can be, where they do
/// most.
/// @param domain  of each argument; texels beyond it repeat its ends
/// Throws Error{bad_program} where the function has no bound.
void fill_table(PlanTable& table, const Expr& function, const std::vector<const Expr*>& args,
                const std::vector<Interval>& domain, NumberModel numbers);

}  // namespace burnish
