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
            .command = [options] { return *options; }};
}

}  // namespace burnish::app
