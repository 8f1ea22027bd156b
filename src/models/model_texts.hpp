#pragma once

#include <burnish/scene.hpp>
#include <string_view>

namespace burnish {

/// The model in the language of parse_model: what one light of colour 1 makes of the surface.
/// Empty for Model::text, whose text the material has. Formulas and sources:
/// burnish/reflectance.hpp.
std::string_view model_text(Model model);

}  // namespace burnish
