#include "lab/experiment/plots.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <burnish/files.hpp>
#include <cmath>
#include <map>

#include "core/read_text.hpp"
#include "lab/gnuplot.hpp"

namespace burnish::lab {
namespace {

/// Where the values of the x axis lie: at their numbers, or side by side with their names below.
class HorizontalAxis {
  public:
    explicit HorizontalAxis(const ExperimentAxis& axis) : m_axis(axis) {
        m_numeric = std::all_of(axis.values.begin(), axis.values.end(), [](const auto& value) {
            return label_number(value.label).has_value();
        });
    }
    [[nodiscard]] double place(std::size_t value) const {
        return m_numeric ? *label_number(m_axis.values[value].label) : static_cast<double>(value);
    }
    /// Ticks at every value if they have names or there are few.
    [[nodiscard]] std::string ticks() const {
        constexpr std::size_t kMostTicks = 12;
        if (m_axis.values.size() > kMostTicks && m_numeric) return "";
        std::string text;
        for (std::size_t i = 0; i < m_axis.values.size(); ++i)
            text += fmt::format("{}\"{}\" {}", i == 0 ? "" : ", ",
                                gnuplot_text(m_axis.values[i].label), place(i));
        return fmt::format("set xtics {}({})\n", m_numeric ? "" : "rotate by -25 ", text);
    }
    [[nodiscard]] bool numeric() const { return m_numeric; }

  private:
    const ExperimentAxis& m_axis;
    bool m_numeric;
};

using Curve = std::map<std::size_t, double>;  ///< by value of the x axis

/// Curves with their names, in the order of their first cells.
std::vector<std::pair<std::string, Curve>> curves_of(const Results& results,
                                                     const ExperimentPlot& plot,
                                                     const std::string& panel) {
    const Experiment& experiment = results.experiment;
    const std::size_t x = axis_index(experiment, plot.x);
    std::vector<std::pair<std::string, Curve>> curves;
    for (std::size_t i = 0; i < results.cells.size(); ++i) {
        const Cell& cell = results.cells[i];
        if (!matches(experiment, cell, plot.where)) continue;
        if (!plot.panels.empty() && label_of(experiment, cell, plot.panels) != panel) continue;
        const std::optional<double> value = results.value(i, plot.y);
        if (!value || !std::isfinite(*value) || (plot.log_y && !(*value > 0.0))) continue;
        std::string name;
        for (std::size_t axis = 0; axis < experiment.axes.size(); ++axis) {
            const ExperimentAxis& of = experiment.axes[axis];
            if (axis == x || of.name == plot.panels || of.values.size() == 1) continue;
            const bool fixed = std::any_of(
                plot.where.begin(), plot.where.end(),
                [&](const auto& c) { return c.first == of.name && c.second.size() == 1; });
            if (fixed) continue;
            name += (name.empty() ? "" : ", ") + of.values[cell.values[axis]].label;
        }
        auto at = std::find_if(curves.begin(), curves.end(),
                               [&](const auto& curve) { return curve.first == name; });
        if (at == curves.end()) at = curves.insert(at, {name, {}});
        at->second[cell.values[x]] = *value;
    }
    return curves;
}

}  // namespace

std::optional<std::string> plot_script(const Results& results, const ExperimentPlot& plot,
                                       const std::string& panel,
                                       const std::filesystem::path& output) {
    const auto curves = curves_of(results, plot, panel);
    if (curves.empty()) return std::nullopt;
    const HorizontalAxis x(results.experiment.axes[axis_index(results.experiment, plot.x)]);
    std::string script = fmt::format(
        "set terminal svg size 620,400 noenhanced font \"sans,11\" background rgb \"white\"\n"
        "set output \"{}\"\nset title \"{}{}{}\"\nset xlabel \"{}\"\nset ylabel \"{}\"\n"
        "set grid\nset key outside right top\nset offsets graph 0.03, graph 0.03, 0, 0\n{}",
        gnuplot_text(output.string()), gnuplot_text(plot.title), panel.empty() ? "" : ": ",
        gnuplot_text(panel), gnuplot_text(plot.x), gnuplot_text(plot.y), x.ticks());
    if (plot.log_x && x.numeric()) script += "set logscale x\n";
    if (plot.log_y) script += "set logscale y\nset format y \"%.0e\"\n";
    std::string drawn;
    for (std::size_t i = 0; i < curves.size(); ++i) {
        script += fmt::format("$curve{} << END\n", i);
        for (const auto& [value, height] : curves[i].second)
            script += fmt::format("{} {}\n", x.place(value), height);
        script += "END\n";
        drawn += fmt::format("{}$curve{} with linespoints {}", i == 0 ? "" : ", \\\n  ", i,
                             curves[i].first.empty()
                                 ? std::string("notitle")
                                 : fmt::format("title \"{}\"", gnuplot_text(curves[i].first)));
    }
    return script + "plot " + drawn + "\n";
}

DrawnPlots draw_plots(const Results& results, const std::filesystem::path& directory) {
    DrawnPlots drawn;
    std::filesystem::create_directories(directory);
    for (std::size_t i = 0; i < results.experiment.plots.size(); ++i) {
        const ExperimentPlot& plot = results.experiment.plots[i];
        drawn.svgs.emplace_back();
        std::vector<std::string> panels{""};
        if (!plot.panels.empty()) {
            panels.clear();
            for (const auto& value :
                 results.experiment.axes[axis_index(results.experiment, plot.panels)].values)
                panels.push_back(value.label);
        }
        for (std::size_t k = 0; k < panels.size(); ++k) {
            const std::string stem = fmt::format("plot-{}-{}", i + 1, k + 1);
            const std::filesystem::path svg = directory / (stem + ".svg");
            const auto script = plot_script(results, plot, panels[k], svg);
            if (!script || !drawn.problem.empty()) continue;
            save_text(*script, directory / (stem + ".gnuplot"));
            drawn.problem = run_gnuplot(directory / (stem + ".gnuplot"));
            if (drawn.problem.empty()) drawn.svgs.back().push_back(read_text(svg));
        }
    }
    return drawn;
}

}  // namespace burnish::lab
