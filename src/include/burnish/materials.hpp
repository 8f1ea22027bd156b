#pragma once

#include <burnish/scene.hpp>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace burnish {

/// Brushed steel for the modified anisotropic Blinn-Phong model, with generated maps of 512 x 512
/// texels; the marks run along u. Another seed gives other scratches.
Material brushed_steel(std::uint32_t seed = 1);

/// The names that scene files give to the models.
std::vector<std::string_view> model_names();

/// The model with that name; nothing for an unknown one.
std::optional<Model> model_named(std::string_view name);

}  // namespace burnish
