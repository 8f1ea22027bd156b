#pragma once

#include <glm/glm.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "models/compile_model.hpp"

/// What the registers of a compiled model begin with, in words, for whoever shows a program.
namespace burnish {

struct ProgramInput {
    std::string name;   ///< "col0.rgb", "col1.a", "uv3", "half_scale"
    std::string value;  ///< in the words of `[materials.inputs]`
};

/// What interpolators carry but for a vertex's own colours and coordinates, colours first, then
/// coordinates of texture units; last what the half vector is multiplied by, where it is.
std::vector<ProgramInput> interpolated_inputs(const ProgramMaterial& program);

/// The texture unit that `quantity` is in; -1 of constants.
int unit_of(const LayerQuantity& quantity, const ProgramMaterial& program);

/// The channels of its unit that it is in: "rgb", "a" or, of a number, "r = g = b".
std::string_view channels_of(const LayerQuantity& quantity);

/// The one number that all components are, to six digits, or "(0.1, 0.2, 0.3)".
std::string numbers_text(const glm::dvec3& v);

}  // namespace burnish
