#pragma once

#include <burnish/experiment.hpp>
#include <optional>
#include <string>
#include <vector>

#include "lab/stage_bits.hpp"

namespace burnish::lab {

/// What the settings "bits.half_vector", "bits.textures", "bits.filter", "bits.combiners",
/// "bits.table" and "bits.frame" say, each an integer or "exact", and "bits.rounding" = "nearest",
/// "truncate", "shift8" or "stochastic"; nothing if there is none of them.
/// Throws Error{bad_input} for anything else that begins with "bits.".
std::optional<StageBits> bits_of(const std::vector<ExperimentSetting>& settings);

}  // namespace burnish::lab
