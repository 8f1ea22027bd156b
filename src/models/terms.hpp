#pragma once

#include <vector>

#include "models/expression.hpp"

namespace burnish {

/// color * scalar: one summand of a model's value.
struct ModelTerm {
    glm::dvec3 factor{1.0};  ///< what is constant of the colour
    ExprPtr color;           ///< what varies from texel to texel; null: nothing
    ExprPtr scalar;          ///< of the pixel; null: 1
};

/// Names what is known at the texel: parameters keep their names, other subexpressions that nobody
/// named become "q0", "q1", ...
ExprPtr name_quantities(const ExprPtr& value, ExprBuilder& builder);

/// All quantities that a value needs, in the order in which they were made.
std::vector<const Expr*> quantities_of(const Expr& value);

/// `value` with constants in place of the quantities for which `constant` gives one.
ExprPtr with_constants(const ExprPtr& value, ExprBuilder& builder,
                       const std::vector<std::pair<const Expr*, glm::dvec3>>& constants);

/// A value as a sum. Scalar factors that terms have in common are one node.
/// Throws Error{bad_program} for what is no such sum: a colour below a root, say.
std::vector<ModelTerm> terms_of(const ExprPtr& value, ExprBuilder& builder);

}  // namespace burnish
