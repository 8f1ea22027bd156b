#pragma once

#include <string>

#include "app/options/option.hpp"

/// Completion of words by shells: verbs, options, the words of options, files by extension.
namespace burnish::app {

/// A script for bash 4 or later, without the package bash-completion: for `source`, or as
/// share/bash-completion/completions/burnish.
std::string bash_completion(const Verb& root);

/// A function for zsh's compsys: for `source` after compinit, or as _burnish in $fpath.
std::string zsh_completion(const Verb& root);

}  // namespace burnish::app
