#include "machine/material_passes.hpp"

#include <algorithm>
#include <burnish/error.hpp>

namespace burnish {

namespace {

std::vector<UnitTexels> unit_texels(const ProgramMaterial& material) {
    std::vector<UnitTexels> kinds(16, UnitTexels::none);
    for (std::size_t i = 0; i < material.units.size(); ++i) {
        if (!material.units[i]) continue;
        const bool is_unsigned =
            format_class(material.units[i]->format()) == TexelClass::unsigned_rgba;
        kinds[i] = is_unsigned ? UnitTexels::unsigned_texels : UnitTexels::signed_texels;
    }
    // Units of a shader may have colours without a texture, and no alpha without a colour.
    for (std::size_t i = 0; material.texture_shader && i < material.texture_shader->units.size();
         ++i) {
        if (kinds[i] == UnitTexels::none) kinds[i] = UnitTexels::unsigned_texels;
    }
    return kinds;
}

}  // namespace

bool has_room_for(const Machine& machine, const ProgramMaterial& material) {
    if (material.units.size() > static_cast<std::size_t>(machine.texture_units)) return false;
    try {
        material.combiners.validate(machine);
    } catch (const Error&) {
        return false;
    }
    return true;
}

bool refers_to_units(const TextureShader& shader) {
    return std::any_of(shader.units.begin(), shader.units.end(), [](const TextureUnit& unit) {
        return unit.operation != TextureOperation::none &&
               unit.operation != TextureOperation::texture_2d &&
               unit.operation != TextureOperation::pass_through;
    });
}

std::vector<ProgramPass> passes_of(const ProgramMaterial& material, const Machine& machine) {
    return split_into_passes(material.combiners, machine, unit_texels(material),
                             material.texture_shader && refers_to_units(*material.texture_shader));
}

}  // namespace burnish
