#pragma once

#include <burnish/multipass.hpp>
#include <burnish/scene.hpp>
#include <vector>

namespace burnish {

/// Whether one pass of `machine` has the stages, units and constants that the material asks for.
bool has_room_for(const Machine& machine, const ProgramMaterial& material);

/// Whether a unit of the shader works with what another one has.
bool refers_to_units(const TextureShader& shader);

/// What split_into_passes makes of a material. Throws what that throws.
std::vector<ProgramPass> passes_of(const ProgramMaterial& material, const Machine& machine);

}  // namespace burnish
