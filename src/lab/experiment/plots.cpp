#include "lab/experiment/plots.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <burnish/error.hpp>
#include <burnish/files.hpp>
#include <cmath>
#include <map>

#include "core/read_text.hpp"
#include "lab/experiment/picture_plots.hpp"
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

bool can_be_drawn(double value, bool log) {
    return std::isfinite(value) && (!log || value > 0.0);
}

/// Curves with their names, in the order of their first cells.
std::vector<std::pair<std::string, Curve>> curves_of(const Results& results,
                                                     const ExperimentPlot& plot,
                                                     const std::string& panel) {
    const Experiment& experiment = results.experiment;
    const std::size_t x = axis_index(experiment, plot.x);
    std::vector<std::pair<std::string, Curve>> curves;
    for (std::size_t i = 0; i < results.cells.size(); ++i) {
        const Cell& cell = results.cells[i];
        if (!in_panel(experiment, cell, plot, panel)) continue;
        const std::optional<double> value = results.value(i, plot.y);
        if (!value || !can_be_drawn(*value, plot.log_y)) continue;
        const std::string name = curve_name(experiment, cell, plot);
        auto at = std::find_if(curves.begin(), curves.end(),
                               [&](const auto& curve) { return curve.first == name; });
        if (at == curves.end()) at = curves.insert(at, {name, {}});
        at->second[cell.values[x]] = *value;
    }
    return curves;
}

std::string scales(const ExperimentPlot& plot, bool log_x) {
    std::string text = fmt::format("set ylabel \"{}\"\nset grid\nset key outside right top\n",
                                   gnuplot_text(plot.y));
    if (log_x) text += "set logscale x\n";
    if (plot.log_y) text += "set logscale y\nset format y \"%.0e\"\n";
    return text;
}

/// Appends a curve, its data first.
void add_curve(std::string& data, std::string& drawn, const std::string& points,
               const std::string& name, const char* style) {
    const auto number = std::count(drawn.begin(), drawn.end(), '$');
    data += fmt::format("$curve{} << END\n{}END\n", number, points);
    drawn += fmt::format(
        "{}$curve{} {} {}", number == 0 ? "plot " : ", \\\n  ", number, style,
        name.empty() ? std::string("notitle") : fmt::format("title \"{}\"", gnuplot_text(name)));
}

std::optional<std::string> axis_curves(const Results& results, const ExperimentPlot& plot,
                                       const std::string& panel) {
    const auto curves = curves_of(results, plot, panel);
    if (curves.empty()) return std::nullopt;
    const HorizontalAxis x(results.experiment.axes[axis_index(results.experiment, plot.x)]);
    std::string data, drawn;
    for (const auto& [name, curve] : curves) {
        std::string points;
        for (const auto& [value, height] : curve)
            points += fmt::format("{} {}\n", x.place(value), height);
        add_curve(data, drawn, points, name, "with linespoints");
    }
    return data + scales(plot, plot.log_x && x.numeric()) +
           fmt::format("set xlabel \"{}\"\nset offsets graph 0.03, graph 0.03, 0, 0\n{}{}\n",
                       gnuplot_text(plot.x), x.ticks(), drawn);
}

std::optional<std::string> time_points(const Results& results, const ExperimentPlot& plot,
                                       const std::string& panel) {
    std::string data, drawn;
    for (std::size_t i = 0; i < results.cells.size(); ++i) {
        if (!in_panel(results.experiment, results.cells[i], plot, panel)) continue;
        const std::optional<double> value = results.value(i, plot.y);
        if (!value || !can_be_drawn(*value, plot.log_y)) continue;
        const CellResult& result = *results.found[i];
        add_curve(data, drawn,
                  fmt::format("{} {} {} {}\n", result.ms, *value, result.ms_low, result.ms_high),
                  curve_name(results.experiment, results.cells[i], plot),
                  "with xerrorbars ps 1.2 lw 1.5");
    }
    if (drawn.empty()) return std::nullopt;
    return data + scales(plot, plot.log_x) +
           "set xlabel \"milliseconds a frame, one thread: median, shortest and longest\"\n"
           "set offsets graph 0.05, graph 0.05, graph 0.05, graph 0.05\n" +
           drawn + "\n";
}

/// A plot as it is drawn: a name after the plot's own, and the cell or the label that it is of.
struct Panel {
    std::string name;
    std::size_t cell = 0;
};

std::vector<Panel> panels_of(const Results& results, const ExperimentPlot& plot) {
    const Experiment& experiment = results.experiment;
    std::vector<Panel> panels;
    if (plot.kind == ExperimentPlotKind::codes || plot.kind == ExperimentPlotKind::waterfall) {
        for (std::size_t i = 0; i < results.cells.size(); ++i)
            if (results.found[i] && results.found[i]->refusal.empty() &&
                in_panel(experiment, results.cells[i], plot, ""))
                panels.push_back({curve_name(experiment, results.cells[i], plot), i});
        return panels;
    }
    if (plot.panels.empty()) return {{}};
    for (const auto& value : experiment.axes[axis_index(experiment, plot.panels)].values)
        panels.push_back({value.label});
    return panels;
}

std::optional<std::string> commands_of(const Results& results, const ExperimentPlot& plot,
                                       const Panel& panel, const Store& store) {
    if (plot.kind == ExperimentPlotKind::codes) return codes_commands(results, panel.cell, store);
    if (plot.kind == ExperimentPlotKind::polar)
        return polar_commands(results, plot, panel.name, store);
    return curves_commands(results, plot, panel.name);
}

/// The text of an SVG file, written with its script beside it; nothing if there is nothing to draw.
std::optional<std::string> draw_panel(const Results& results, const ExperimentPlot& plot,
                                      const Panel& panel, const Store& store,
                                      const std::filesystem::path& stem) {
    const std::filesystem::path svg = stem.string() + ".svg";
    if (plot.kind == ExperimentPlotKind::waterfall) {
        std::string text = pixel_waterfall(results, panel.cell, plot);
        save_text(text, svg);
        return text;
    }
    const std::optional<std::string> commands = commands_of(results, plot, panel, store);
    if (!commands) return std::nullopt;
    const std::filesystem::path script = stem.string() + ".gnuplot";
    save_text(
        fmt::format("set terminal svg size 620,400 noenhanced font \"sans,11\" background rgb "
                    "\"white\"\nset output \"{}\"\nset title \"{}{}{}\"\n{}",
                    gnuplot_text(svg.string()), gnuplot_text(plot.title),
                    panel.name.empty() ? "" : ": ", gnuplot_text(panel.name), *commands),
        script);
    if (const std::string problem = run_gnuplot(script); !problem.empty())
        throw Error(ErrorCode::io, problem);
    return read_text(svg);
}

}  // namespace

bool in_panel(const Experiment& experiment, const Cell& cell, const ExperimentPlot& plot,
              const std::string& panel) {
    return matches(experiment, cell, plot.where) &&
           (plot.panels.empty() || label_of(experiment, cell, plot.panels) == panel);
}

std::string curve_name(const Experiment& experiment, const Cell& cell, const ExperimentPlot& plot) {
    std::string name;
    for (std::size_t axis = 0; axis < experiment.axes.size(); ++axis) {
        const ExperimentAxis& of = experiment.axes[axis];
        if (of.name == plot.x || of.name == plot.panels || of.values.size() == 1) continue;
        const bool fixed = std::any_of(plot.where.begin(), plot.where.end(), [&](const auto& c) {
            return c.first == of.name && c.second.size() == 1;
        });
        if (!fixed) name += (name.empty() ? "" : ", ") + of.values[cell.values[axis]].label;
    }
    return name;
}

std::optional<std::string> curves_commands(const Results& results, const ExperimentPlot& plot,
                                           const std::string& panel) {
    if (plot.kind == ExperimentPlotKind::pareto) return time_points(results, plot, panel);
    return axis_curves(results, plot, panel);
}

DrawnPlots draw_plots(const Results& results, const Store& store,
                      const std::filesystem::path& directory) {
    DrawnPlots drawn;
    std::filesystem::create_directories(directory);
    for (std::size_t i = 0; i < results.experiment.plots.size(); ++i) {
        const ExperimentPlot& plot = results.experiment.plots[i];
        drawn.svgs.emplace_back();
        const std::vector<Panel> panels = panels_of(results, plot);
        for (std::size_t k = 0; k < panels.size(); ++k) {
            try {
                const auto svg = draw_panel(results, plot, panels[k], store,
                                            directory / fmt::format("plot-{}-{}", i + 1, k + 1));
                if (svg) drawn.svgs.back().push_back(*svg);
            } catch (const Error& error) {
                if (drawn.problem.empty()) drawn.problem = error.what();
            }
        }
    }
    return drawn;
}

}  // namespace burnish::lab
