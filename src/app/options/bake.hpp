#pragma once

#include "app/options/option.hpp"

/// What `burnish bake` can make.
namespace burnish::app {

Verb bake_brushed_verb();
Verb bake_material_verb();
Verb bake_mips_verb();
Verb bake_anisotropy_verb();
Verb bake_mesh_verb();

}  // namespace burnish::app
