#pragma once

#include <vector>

#include "app/options/option.hpp"

namespace burnish::app {

/// --threshold NAME=VALUE, several.
Option threshold_option(std::vector<Threshold>& thresholds);

/// --reference-threshold, several: NAME=VALUE, or a number alone for rmse.
Option reference_threshold_option(std::vector<Threshold>& limits);

}  // namespace burnish::app
