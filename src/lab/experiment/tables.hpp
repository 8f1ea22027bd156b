#pragma once

#include <string>
#include <vector>

#include "lab/experiment/run.hpp"
#include "lab/experiment/verdicts.hpp"

/// Results as documents; the same text for the same numbers, but for times.
namespace burnish::lab {

/// A line per cell: its labels, its metrics, why it was refused; numbers as short as they can be
/// without losing a bit, nothing where there is none. RFC 4180.
std::string results_csv(const Results& results);

/// The same with times and verdicts.
std::string results_json(const Results& results, const std::vector<Judgement>& judgements);

/// Version, build, inputs and all settings of all cells: what it takes to repeat the run.
std::string manifest_json(const Results& results);

}  // namespace burnish::lab
