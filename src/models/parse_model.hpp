#pragma once

#include <burnish/program_text.hpp>
#include <string_view>

#include "models/expression.hpp"

namespace burnish {

/// A model's text: lines `name = expression`, and one expression, the last, that is what a light of
/// unit colour makes of the surface. docs/models.md says what may stand in it.
/// Names of what is known at the texel become quantities of the material layer.
/// Any bytes are safe: the result is an expression or an error, in time proportional to the text.
Parsed<ExprPtr> parse_model(std::string_view text, ExprBuilder& builder);

}  // namespace burnish
