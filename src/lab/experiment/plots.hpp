#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "lab/experiment/run.hpp"

/// Plots of results, drawn by gnuplot (Debian package gnuplot-nox), which is started as a program.
namespace burnish::lab {

/// Whether a plot shows a cell in the panel of that label; of a plot without panels all.
bool in_panel(const Experiment& experiment, const Cell& cell, const ExperimentPlot& plot,
              const std::string& panel);

/// The labels of a cell that neither the x axis, nor the panel, nor the plot's choice has fixed.
std::string curve_name(const Experiment& experiment, const Cell& cell, const ExperimentPlot& plot);

/// What gnuplot draws of curves and pareto: a metric over an axis or over milliseconds, the latter
/// with the shortest and the longest time. Nothing if no cell of it has a number.
std::optional<std::string> curves_commands(const Results& results, const ExperimentPlot& plot,
                                           const std::string& panel);

struct DrawnPlots {
    std::vector<std::vector<std::string>> svgs;  ///< of each plot the panels' files as text
    std::string problem;                         ///< one line, if gnuplot is missing or fails
};

/// Draws all plots of an experiment to files plot-N-PANEL.svg, with their scripts beside them (of
/// all but waterfalls), in `directory`, which is made. Pictures are those that `store` has.
DrawnPlots draw_plots(const Results& results, const Store& store,
                      const std::filesystem::path& directory);

}  // namespace burnish::lab
