#pragma once

#include <string>

#include "app/options/option.hpp"

namespace burnish::app {

/// "burnish render [OPTION...] INPUT"
std::string usage(const VerbPath& path);

/// What `burnish VERB --help` prints, 80 columns wide.
std::string help(const VerbPath& path);

}  // namespace burnish::app
