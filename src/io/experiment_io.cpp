#include "io/experiment_io.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <burnish/error.hpp>
#include <cmath>
#include <set>
#include <string_view>
#include <vector>

#include "core/nearest.hpp"
#include "io/experiment_io_axes.hpp"
#include "io/input_files.hpp"
#include "io/scene_io_parts.hpp"

namespace burnish {
namespace {

constexpr std::array<std::pair<std::string_view, ExperimentMeasure>, 6> kMeasures{
    {{"value", ExperimentMeasure::value},
     {"ratio", ExperimentMeasure::ratio},
     {"slope", ExperimentMeasure::slope},
     {"halving", ExperimentMeasure::halving},
     {"argmin", ExperimentMeasure::argmin},
     {"argmax", ExperimentMeasure::argmax}}};

constexpr std::array<std::pair<std::string_view, ExperimentPlotKind>, 5> kPlotKinds{
    {{"curves", ExperimentPlotKind::curves},
     {"pareto", ExperimentPlotKind::pareto},
     {"codes", ExperimentPlotKind::codes},
     {"polar", ExperimentPlotKind::polar},
     {"waterfall", ExperimentPlotKind::waterfall}}};

constexpr int kMostSamples = 1024;
constexpr int kMostRepeats = 1000;

int read_samples(const Section& section, int otherwise) {
    const int samples = section.integer("samples", 1, kMostSamples).value_or(otherwise);
    int side = 1;
    while (side * side < samples) ++side;
    if (side * side != samples)
        section.fail("samples", fmt::format("'samples' = {} in {}, expected a square of 1 .. {}",
                                            samples, section.label(), kMostSamples));
    return samples;
}

void read_sides(const Section& root, Experiment& experiment) {
    if (const toml::table* table = root.table("test")) {
        const Section section(*table, "[test]", {"samples", "set"});
        experiment.test_samples = read_samples(section, experiment.test_samples);
        experiment.test = read_settings(section, "set");
    }
    if (const toml::table* table = root.table("reference")) {
        const Section section(*table, "[reference]", {"samples", "set"});
        experiment.reference_samples = read_samples(section, experiment.reference_samples);
        experiment.reference = read_settings(section, "set");
    }
    experiment.quick_samples = std::min(experiment.quick_samples, experiment.reference_samples);
    if (const toml::table* table = root.table("quick")) {
        const Section section(*table, "[quick]", {"samples", "set"});
        experiment.quick_samples = read_samples(section, experiment.quick_samples);
        experiment.quick = read_settings(section, "set");
    }
}

ExperimentPan read_pan(const toml::table& table) {
    constexpr int kMostFrames = 1024;
    const Section section(table, "[pan]", {"frames", "quick_frames", "samples", "pixels"});
    ExperimentPan pan;
    pan.frames = section.integer("frames", 2, kMostFrames).value_or(32);
    pan.quick_frames = section.integer("quick_frames", 2, kMostFrames).value_or(8);
    pan.samples = read_samples(section, pan.samples);
    if (const auto way = section.numbers("pixels", 2, 2)) pan.pixels = {(*way)[0], (*way)[1]};
    return pan;
}

ExperimentPlot read_plot(const toml::table& table, const Axes& axes) {
    const Section section(table, "[[plots]]",
                          {"kind", "title", "x", "y", "panels", "where", "log", "pixel"});
    ExperimentPlot plot;
    plot.kind =
        section.choice<ExperimentPlotKind>("kind", kPlotKinds).value_or(ExperimentPlotKind::curves);
    using enum ExperimentPlotKind;
    const auto refuse_unless = [&](const char* key, bool has_it) {
        if (section.has(key) && !has_it)
            section.fail(key, fmt::format("'{}' in [[plots]] is not of this kind of plot", key));
    };
    const bool has_axes = plot.kind == curves || plot.kind == pareto;
    refuse_unless("x", plot.kind == curves);
    refuse_unless("y", has_axes);
    refuse_unless("log", has_axes);
    refuse_unless("panels", has_axes || plot.kind == polar);
    refuse_unless("pixel", plot.kind == waterfall);
    plot.title = section.required_text("title");
    if (plot.kind == curves) plot.x = axes.required_axis(section, "x");
    if (has_axes) plot.y = section.required_text("y");
    if (section.has("panels")) plot.panels = axes.required_axis(section, "panels");
    plot.where = axes.read_choice(section, "where");
    if (plot.kind == waterfall) {
        const auto pixel = section.numbers("pixel", 2, 2);
        if (!pixel) section.fail("pixel", "[[plots]] of a waterfall needs 'pixel'");
        for (std::size_t i = 0; i < 2; ++i) {
            const float value = (*pixel)[i];
            if (!(value >= 0.0F && value <= 16383.0F) || value != std::floor(value))
                section.fail("pixel",
                             "'pixel' in [[plots]], expected two whole numbers of a "
                             "frame");
            plot.pixel.at(i) = static_cast<int>(value);
        }
    }
    const std::vector<std::string> log = section.texts("log").value_or(std::vector<std::string>{});
    for (const std::string& axis : log) {
        if (axis != "x" && axis != "y")
            section.fail("log", fmt::format("'log' in [[plots]] has '{}', expected x, y", axis));
        (axis == "x" ? plot.log_x : plot.log_y) = true;
    }
    return plot;
}

ExperimentSheet read_sheet(const toml::table& table, const Axes& axes) {
    const Section section(table, "[[sheets]]", {"title", "where", "gain"});
    ExperimentSheet sheet;
    sheet.title = section.required_text("title");
    sheet.where = axes.read_choice(section, "where");
    sheet.gain = section.number("gain", kPositive).value_or(sheet.gain);
    return sheet;
}

ExperimentExpectation read_expectation(const toml::table& table, const Axes& axes) {
    const Section section(table, "[[expect]]",
                          {"text", "predicted", "metric", "measure", "along", "where", "versus",
                           "at_least", "at_most"});
    ExperimentExpectation expectation;
    expectation.text = section.required_text("text");
    expectation.predicted = section.text("predicted").value_or("");
    expectation.metric = section.required_text("metric");
    expectation.measure =
        section.choice<ExperimentMeasure>("measure", kMeasures).value_or(ExperimentMeasure::value);
    expectation.where = axes.read_choice(section, "where");
    const bool is_ratio = expectation.measure == ExperimentMeasure::ratio;
    if (is_ratio != section.has("versus"))
        section.fail("versus", "'versus' in [[expect]] goes with measure = \"ratio\"");
    expectation.versus = axes.read_choice(section, "versus");
    for (const auto& [axis, labels] : expectation.versus) {
        if (labels.size() != 1)
            section.fail("versus", fmt::format("'versus' in [[expect]] has {} values of '{}', "
                                               "expected one",
                                               labels.size(), axis));
    }
    const bool has_axis = !is_ratio && expectation.measure != ExperimentMeasure::value;
    if (has_axis != section.has("along"))
        section.fail("along",
                     "'along' in [[expect]] goes with the measures slope, halving, argmin "
                     "and argmax");
    if (has_axis) expectation.along = axes.required_axis(section, "along");
    expectation.at_least = section.exact_number("at_least");
    expectation.at_most = section.exact_number("at_most");
    if (!expectation.at_least && !expectation.at_most)
        section.fail("at_least", "[[expect]] needs 'at_least', 'at_most' or both");
    return expectation;
}

Experiment interpret(const toml::table& table, const std::filesystem::path& path) {
    const Section root(
        table, "the experiment",
        {"schema", "title", "hypothesis", "scenes", "sweeps", "set", "test", "reference", "quick",
         "expose", "pan", "repeats", "metrics", "plots", "sheets", "expect"});
    require_schema(root);
    Experiment experiment;
    experiment.name = path.stem().string();
    experiment.file = path;
    experiment.title = root.required_text("title");
    experiment.hypothesis = root.required_text("hypothesis");
    experiment.common = read_settings(root, "set");
    read_sides(root, experiment);
    experiment.expose =
        root.number("expose", {.low = 0.0, .high = 1.0, .open_low = true}).value_or(0.0F);
    if (const toml::table* pan = root.table("pan")) experiment.pan = read_pan(*pan);
    experiment.repeats = root.integer("repeats", 1, kMostRepeats).value_or(1);
    read_scenes(root, path.parent_path(), experiment);
    read_sweeps(root, experiment);
    const Axes axes(experiment.axes);
    experiment.metrics = root.texts("metrics").value_or(std::vector<std::string>{});
    for (const toml::table* plot : root.tables("plots"))
        experiment.plots.push_back(read_plot(*plot, axes));
    for (const toml::table* sheet : root.tables("sheets"))
        experiment.sheets.push_back(read_sheet(*sheet, axes));
    for (const toml::table* each : root.tables("expect"))
        experiment.expectations.push_back(read_expectation(*each, axes));
    return experiment;
}

}  // namespace

Experiment read_experiment_file(const std::filesystem::path& path) {
    const toml::table table = parse_scene(path, {});
    Experiment experiment = interpret(table, path);
    experiment.inputs = find_input_files(path);
    return experiment;
}

}  // namespace burnish
