#pragma once

#include <optional>
#include <string>

#include "lab/experiment/run.hpp"

/// Plots of the pictures that cells have in a store, as commands for gnuplot (gnuplot.hpp).
namespace burnish::lab {

/// How many pixels have which code of 0 .. 255, to the nearest, in the highlight: where the
/// reference is above half of its peak, in the peak's channel. Test as bars, reference as steps.
/// Nothing if the cell has no pictures.
std::optional<std::string> codes_commands(const Results& results, std::size_t cell,
                                          const Store& store);

/// The lobes of pictures whose centre is the lobe's axis: the mean of r, g and b along the ray
/// from the centre to the nearest side, over the ray's angle. One curve for every cell that the
/// plot and its panel choose, and one for the first one's reference. Nothing if there is no cell.
std::optional<std::string> polar_commands(const Results& results, const ExperimentPlot& plot,
                                          const std::string& panel, const Store& store);

/// One pixel, stage by stage, as attribution.hpp and waterfall.hpp have it: the text of an SVG
/// file. Throws what these do.
std::string pixel_waterfall(const Results& results, std::size_t cell, const ExperimentPlot& plot);

}  // namespace burnish::lab
