#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "lab/experiment/run.hpp"

/// Plots of results, drawn by gnuplot (Debian package gnuplot-nox), which is started as a program.
namespace burnish::lab {

/// A script for gnuplot that writes `output`, an SVG: one value of the plot's panel axis, or of a
/// plot without panels all. Nothing if no cell of it has a number.
std::optional<std::string> plot_script(const Results& results, const ExperimentPlot& plot,
                                       const std::string& panel,
                                       const std::filesystem::path& output);

struct DrawnPlots {
    std::vector<std::vector<std::string>> svgs;  ///< of each plot the panels' files as text
    std::string problem;                         ///< one line, if gnuplot is missing or fails
};

/// Draws all plots of an experiment to files plot-N[-PANEL].svg, with their scripts beside them, in
/// `directory`, which is made.
DrawnPlots draw_plots(const Results& results, const std::filesystem::path& directory);

}  // namespace burnish::lab
