#include "app/options/verbs.hpp"

namespace burnish::app {

Verb burnish_command() {
    return {.name = "burnish",
            .text =
                "Draws meshes through an emulated register-combiner machine, and measures what "
                "few bits do to the picture",
            .verbs = {render_verb(), view_verb(), trace_verb(), bake_verb(), bench_verb(),
                      compare_verb(), compile_verb(), experiment_verb(), info_verb(),
                      completion_verb(), man_verb()},
            .examples = {{"The demonstration picture", "burnish render meshes/brushed.toml"},
                         {"Why the middle pixel looks as it does",
                          "burnish trace meshes/brushed.toml --pixel 640,360"},
                         {"What a model costs on a machine of 2000",
                          "burnish compile --model abp_modified --machine geforce256"},
                         {"What this build can do", "burnish info"}}};
}

}  // namespace burnish::app
