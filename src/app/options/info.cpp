#include <memory>

#include "app/options/groups.hpp"
#include "app/options/verbs.hpp"

namespace burnish::app {

Verb info_verb() {
    const auto options = std::make_shared<InfoOptions>();
    return {.name = "info",
            .text = "Version, instruction sets, profiles, formats",
            .groups = {{"Output", {json_option(options->json)}}},
            .examples = {{"What this build and this CPU can do", "burnish info"},
                         {"The same for a script", "burnish info --json"},
                         {"The names of the reflectance models", "burnish info | grep models"},
                         {"What is used when another instruction set is asked for",
                          "BURNISH_ISA=reference burnish info"}},
            .command = [options] { return *options; }};
}

}  // namespace burnish::app
