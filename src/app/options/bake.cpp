#include "app/options/bake.hpp"

#include "app/options/verbs.hpp"

namespace burnish::app {

Verb bake_verb() {
    return {.name = "bake",
            .text = "Material maps and test meshes as files",
            .verbs = {bake_brushed_verb(), bake_material_verb(), bake_mips_verb(),
                      bake_anisotropy_verb(), bake_mesh_verb()}};
}

}  // namespace burnish::app
