#include <memory>

#include "app/options/bake.hpp"
#include "app/options/groups.hpp"
#include "app/options/words.hpp"

namespace burnish::app {

Verb bake_brushed_verb() {
    constexpr int kLargest = 4096;
    const auto options = std::make_shared<BakeBrushedOptions>();
    return {.name = "brushed",
            .text = "Maps of brushed steel as PNG",
            .groups = {{"Maps", generator_options(options->seed, options->size, kLargest, "")},
                       {"Output",
                        {{.names = "-o,--output",
                          .value = "DIR-OR-PREFIX",
                          .text = "Directory, or what the names of the four PNG files begin with",
                          .files = "/",
                          .required = true,
                          .set = text_to(options->output)}}}},
            .examples = {{"Four maps in a directory that is there",
                          "mkdir -p steel && burnish bake brushed -o steel"},
                         {"Files that begin with a name: fine-normal.png ...",
                          "burnish bake brushed --seed 7 -o fine"},
                         {"Smaller maps", "burnish bake brushed --size 128 -o small"},
                         {"Larger ones with other scratches",
                          "burnish bake brushed --size 1024 --seed 3 -o large"}},
            .command = [options] { return *options; }};
}

}  // namespace burnish::app
