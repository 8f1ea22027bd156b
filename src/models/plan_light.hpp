#pragma once

#include <functional>

#include "models/make_plan.hpp"
#include "models/plan_builder.hpp"

namespace burnish {

/// The end of a plan: every term with its light and colour, summed, the last products in the final
/// combiner; light of vertices as one input.
/// @param lower  makes the values of an expression
void plan_light(const PlanTask& task, Plan& plan, PlanBuilder& values,
                const std::function<PlanOperand(const Expr&)>& lower);

}  // namespace burnish
