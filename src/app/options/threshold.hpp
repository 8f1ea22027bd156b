#pragma once

#include <vector>

#include "app/options/option.hpp"

namespace burnish::app {

/// --threshold NAME=VALUE, several.
Option threshold_option(std::vector<Threshold>& thresholds);

}  // namespace burnish::app
