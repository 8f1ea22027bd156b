#include <fmt/format.h>

#include <burnish/materials.hpp>
#include <memory>

#include "app/options/bake.hpp"
#include "app/options/groups.hpp"
#include "app/options/words.hpp"

namespace burnish::app {

Verb bake_material_verb() {
    const auto options = std::make_shared<BakeMaterialOptions>();
    return {.name = "material",
            .text = "A generated material: maps, material file, true parameters",
            .groups = {{"Maps",
                        {{.names = "MATERIAL",
                          .text = fmt::format("{}", fmt::join(generated_set_names(), ", ")),
                          .words = generated_set_names(),
                          .required = true,
                          .set = text_to(options->set)}}},
                       {"Generator",
                        generator_options(options->seed, options->size, kMaxGeneratedSize, "")},
                       {"Output", {directory_option(options->output)}}},
            .examples = {{"A lathed surface: maps, material file, true numbers",
                          "burnish bake material lathe -o lathe"},
                         {"Smaller maps", "burnish bake material weave --size 128 -o weave"},
                         {"The same material with other marks",
                          "burnish bake material corrosion --seed 2 --size 256 -o corrosion"},
                         {"A material of one's own on a mesh",
                          "burnish bake material orbital --size 256 -o orbital && burnish render "
                          "meshes/sphere.ply --material orbital/material.toml -o orbital.png"}},
            .command = [options] { return *options; }};
}

}  // namespace burnish::app
