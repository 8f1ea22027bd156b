#include "app/options/verbs.hpp"

namespace burnish::app {

std::vector<Verb> all_verbs() {
    return {render_verb(),  trace_verb(),   bake_verb(),       bench_verb(),
            compare_verb(), compile_verb(), experiment_verb(), info_verb()};
}

}  // namespace burnish::app
