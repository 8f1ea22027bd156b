#pragma once

#include "app/options/option.hpp"

/// The verbs of burnish, one file each. Options go where the verb's own data is, made anew by each
/// call and kept by what it returns.
namespace burnish::app {

Verb render_verb();
Verb view_verb();
Verb trace_verb();
Verb bench_verb();
Verb compare_verb();
Verb compile_verb();
Verb experiment_verb();
Verb bake_verb();
Verb info_verb();
Verb completion_verb();
Verb man_verb();

/// The command itself, with all of them.
Verb burnish_command();

}  // namespace burnish::app
