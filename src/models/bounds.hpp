#pragma once

#include <string>
#include <vector>

#include "models/cover.hpp"
#include "models/expression.hpp"

namespace burnish {

/// Throws Error{bad_program} for a value without bounds, which no register and no table can hold:
/// with the material's name, line and column of the first operation that loses them, and what
/// would give it one.
void require_bounds(const std::vector<const Expr*>& values, Ranges& ranges,
                    const std::string& material);

}  // namespace burnish
