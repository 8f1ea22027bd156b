#pragma once

#include <burnish/scene.hpp>
#include <string_view>

#include "models/expression.hpp"

namespace burnish {

/// The model in the language of parse_model: what one light of colour 1 makes of the surface.
/// Empty for Model::text, whose text the material has. Formulas and sources:
/// burnish/reflectance.hpp.
std::string_view model_text(Model model);

/// The model of a material, be it built in or its own text, as an expression of named quantities
/// and values of the pixel, in nodes of `builder`. Throws Error{bad_program} for what is wrong in a
/// text, with line and column.
ExprPtr model_expression(const Material& material, ExprBuilder& builder);

}  // namespace burnish
