#pragma once

#include <burnish/experiment.hpp>
#include <optional>
#include <string>
#include <vector>

#include "lab/stage_bits.hpp"

namespace burnish::lab {

/// What the settings "bits.KEY" say, of set_stage_bits' keys and values; nothing if there is none.
/// Throws Error{bad_input} for anything else that begins with "bits.".
std::optional<StageBits> bits_of(const std::vector<ExperimentSetting>& settings);

}  // namespace burnish::lab
