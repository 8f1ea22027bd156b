#include <memory>

#include "app/options/groups.hpp"
#include "app/options/verbs.hpp"

namespace burnish::app {

Verb info_verb() {
    const auto options = std::make_shared<InfoOptions>();
    return {.name = "info",
            .text = "Version, instruction sets, profiles, formats",
            .groups = {{"Output", {json_option(options->json)}}},
            .command = [options] { return *options; }};
}

}  // namespace burnish::app
