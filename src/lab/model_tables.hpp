#pragma once

#include <span>
#include <string>

#include "lab/measure_model.hpp"

/// Measurements as documents; the same text for the same numbers.
namespace burnish::lab {

/// Tables in Markdown, with columns for `parameters`: what every model needs of every machine, its
/// errors under the first constant and the set "corrosion"; then per machine all parameters; then
/// how far estimates lie above what they bound, and what machines refuse, and why.
std::string model_tables(std::span<const ModelMeasurement> measurements,
                         std::span<const ModelParameters> parameters);

/// One object per measurement, in a list.
std::string model_json(std::span<const ModelMeasurement> measurements);

}  // namespace burnish::lab
