#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

/// An experiment as its file describes it (docs/experiments.md): plain data, made by
/// `load_experiment`.
namespace burnish {

/// A key of a scene and its new value as TOML text: what load_scene takes as "key=value". Keys that
/// begin with "bits." choose the quantisers of an evaluation in double instead of the renderer, the
/// key "samples" the samples per pixel.
struct ExperimentSetting {
    std::string key;
    std::string value;

    friend bool operator==(const ExperimentSetting&, const ExperimentSetting&) = default;
};

/// One value of an axis.
struct ExperimentVariant {
    std::string label;
    std::vector<ExperimentSetting> settings;
    bool quick = false;  ///< part of the quick form
};

/// What is varied. The first axis of every experiment is "scene".
struct ExperimentAxis {
    std::string name;
    bool test_only = false;  ///< the reference does not see it
    std::vector<ExperimentVariant> values;
};

/// Values of some axes, all others free: a choice of cells.
using ExperimentChoice = std::vector<std::pair<std::string, std::vector<std::string>>>;

/// What a plot shows.
enum class ExperimentPlotKind {
    curves,  ///< a metric over an axis, one curve for every combination of the other axes
    pareto,  ///< a metric over the time that a picture takes, a point for every cell
    codes,   ///< how many pixels of the highlight have which of 256 values; a plot for every cell
    polar,   ///< a lobe's picture as its mean along rays from the centre, over their angle
    waterfall,  ///< one pixel, its stages rounded one after the other; a plot for every cell
};

struct ExperimentPlot {
    ExperimentPlotKind kind = ExperimentPlotKind::curves;
    std::string title;
    std::string x;       ///< an axis; of curves
    std::string y;       ///< a metric; of curves and pareto
    std::string panels;  ///< an axis: a plot for each of its values; empty: one plot
    ExperimentChoice where;
    bool log_x = false, log_y = false;
    std::array<int, 2> pixel{};  ///< of waterfall

    /// Whether it is made from the pictures of its cells.
    [[nodiscard]] bool shows_pictures() const {
        return kind == ExperimentPlotKind::codes || kind == ExperimentPlotKind::polar;
    }
};

/// Rows of pictures: test, reference, signed error and FLIP map of each cell.
struct ExperimentSheet {
    std::string title;
    ExperimentChoice where;
    float gain = 4.0F;  ///< the signed error is shown times this
};

/// What an expectation looks at in each group of cells that differ along one axis only, or in each
/// cell.
enum class ExperimentMeasure {
    value,    ///< the metric of each cell
    ratio,    ///< the metric over that of the cell that differs by what `versus` says
    slope,    ///< of log(metric) over log(label), by least squares along the axis `along`
    halving,  ///< the factor by which the metric falls per unit of the label, by least squares
    argmin,   ///< the label of the smallest metric along the axis `along`
    argmax,
};

/// A number that was predicted, as a test: all measures lie within [at_least, at_most].
struct ExperimentExpectation {
    std::string text;       ///< the prediction in words
    std::string predicted;  ///< the number as it was predicted, for the table; may be empty
    std::string metric;
    ExperimentMeasure measure = ExperimentMeasure::value;
    std::string along;  ///< an axis; of slope, halving, argmin and argmax
    ExperimentChoice where;
    ExperimentChoice versus;  ///< of ratio: one value each of some axes
    std::optional<double> at_least, at_most;
};

/// A series of frames, the picture moved on by a part of a pixel each time: what flicker is
/// measured on.
struct ExperimentPan {
    int frames = 0;  ///< 0: no series
    int quick_frames = 0;
    int samples = 16;                        ///< per pixel, of the reference's frames
    std::array<double, 2> pixels{1.0, 0.4};  ///< the whole way, in x and y
};

struct Experiment {
    std::string name;  ///< of the file, without extension
    std::string title;
    std::string hypothesis;
    std::filesystem::path file;
    std::vector<std::filesystem::path> scenes;  ///< of the axis "scene", value by value
    std::vector<std::filesystem::path> inputs;  ///< every file that is read, this one first
    std::vector<ExperimentAxis> axes;           ///< "scene", then the sweeps in file order
    std::vector<ExperimentSetting> common, test, reference, quick;  ///< of all cells
    int test_samples = 1, reference_samples = 256, quick_samples = 16;
    float expose = 0.0F;  ///< what the reference's largest channel is made by the light; 0: nothing
    ExperimentPan pan;
    int repeats = 1;  ///< how often a test's picture is timed; more than once: after a first one
    std::vector<std::string> metrics;  ///< in the order of the columns
    std::vector<ExperimentPlot> plots;
    std::vector<ExperimentSheet> sheets;
    std::vector<ExperimentExpectation> expectations;
};

}  // namespace burnish
