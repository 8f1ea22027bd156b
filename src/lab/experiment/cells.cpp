#include "lab/experiment/cells.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <burnish/error.hpp>
#include <cctype>
#include <charconv>
#include <cmath>
#include <map>
#include <set>

#include "lab/experiment/formula.hpp"

namespace burnish::lab {
namespace {

constexpr std::size_t kMostCells = 100000;
constexpr int kMostSamples = 1024;

bool is_of_test(const ExperimentSetting& setting) {
    return setting.key.starts_with("machine.") || setting.key.starts_with("bits.");
}

int read_samples(const Experiment& experiment, const std::string& text) {
    int samples = 0;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), samples);
    int side = 1;
    while (side < 32 && side * side < samples) ++side;
    if (failure != std::errc() || end != text.data() + text.size() || side * side != samples)
        throw Error(ErrorCode::bad_input,
                    fmt::format("{}: 'samples' = {}, expected a square of 1 .. {}",
                                experiment.file.string(), text, kMostSamples));
    return samples;
}

/// Later settings of a key replace earlier ones in their place.
void add(const Experiment& experiment, const ExperimentSetting& setting, PictureSettings& picture) {
    if (setting.key == "samples") {
        picture.samples = read_samples(experiment, setting.value);
        return;
    }
    const auto same = std::find_if(picture.settings.begin(), picture.settings.end(),
                                   [&](const auto& other) { return other.key == setting.key; });
    if (same != picture.settings.end())
        same->value = setting.value;
    else
        picture.settings.push_back(setting);
}

/// A label as part of a file name.
std::string file_part(const std::string& label) {
    std::string part;
    for (const char c : label) {
        const bool kept = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '.' || c == '_';
        part += kept ? c : '_';
    }
    return part;
}

/// The labels of a cell that are numbers, by axis.
std::map<std::string, double> numbers_of(const Experiment& experiment,
                                         const std::vector<std::size_t>& values) {
    std::map<std::string, double> numbers;
    for (std::size_t axis = 0; axis < values.size(); ++axis) {
        const ExperimentAxis& of = experiment.axes[axis];
        if (const auto number = label_number(of.values[values[axis]].label))
            numbers.emplace(of.name, *number);
    }
    return numbers;
}

std::string formula_value(const Experiment& experiment, const ExperimentSetting& setting,
                          const std::map<std::string, double>& variables) {
    try {
        return with_formulas(setting.value, variables);
    } catch (const Error& error) {
        throw Error(error.code(),
                    fmt::format("{}: {}: {}", experiment.file.string(), setting.key, error.what()));
    }
}

Cell make_cell(const Experiment& experiment, const std::vector<std::size_t>& values, bool quick) {
    Cell cell;
    cell.values = values;
    cell.test.scene = cell.reference.scene = values.front();
    cell.test.samples = experiment.test_samples;
    cell.reference.samples = quick ? experiment.quick_samples : experiment.reference_samples;
    const auto add_to_both = [&](const std::vector<ExperimentSetting>& settings) {
        for (const ExperimentSetting& setting : settings) {
            add(experiment, setting, cell.test);
            add(experiment, setting, cell.reference);
        }
    };
    add_to_both(experiment.common);
    if (quick) add_to_both(experiment.quick);
    for (std::size_t axis = 0; axis < values.size(); ++axis) {
        const ExperimentAxis& of = experiment.axes[axis];
        const ExperimentVariant& value = of.values[values[axis]];
        for (const ExperimentSetting& setting : value.settings) {
            add(experiment, setting, cell.test);
            if (!of.test_only && !is_of_test(setting)) add(experiment, setting, cell.reference);
        }
        if (axis > 0) cell.name += "-";
        cell.name += file_part(value.label);
    }
    for (const ExperimentSetting& setting : experiment.test) add(experiment, setting, cell.test);
    for (const ExperimentSetting& setting : experiment.reference)
        add(experiment, setting, cell.reference);
    const std::map<std::string, double> variables = numbers_of(experiment, values);
    for (PictureSettings* picture : {&cell.test, &cell.reference})
        for (ExperimentSetting& setting : picture->settings)
            setting.value = formula_value(experiment, setting, variables);
    return cell;
}

/// The values of an axis that take part.
std::vector<std::size_t> chosen(const ExperimentAxis& axis, bool quick) {
    std::vector<std::size_t> result;
    for (std::size_t i = 0; i < axis.values.size(); ++i)
        if (!quick || axis.values[i].quick) result.push_back(i);
    return result;
}

/// Names that two cells share, as of labels "a/b" and "a b", get numbers.
void make_names_differ(std::vector<Cell>& cells) {
    std::set<std::string> seen;
    for (std::size_t i = 0; i < cells.size(); ++i)
        while (!seen.insert(cells[i].name).second) cells[i].name += fmt::format("-{}", i);
}

}  // namespace

std::vector<Cell> make_cells(const Experiment& experiment, bool quick) {
    std::vector<std::vector<std::size_t>> axes;
    std::size_t count = 1;
    for (const ExperimentAxis& axis : experiment.axes) {
        axes.push_back(chosen(axis, quick));
        count *= axes.back().size();
        if (count > kMostCells)
            throw Error(ErrorCode::limit, fmt::format("{}: more than {} cells",
                                                      experiment.file.string(), kMostCells));
    }
    std::vector<Cell> cells;
    cells.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        std::vector<std::size_t> values(axes.size());
        std::size_t rest = i;
        for (std::size_t axis = axes.size(); axis-- > 0;) {
            values[axis] = axes[axis][rest % axes[axis].size()];
            rest /= axes[axis].size();
        }
        cells.push_back(make_cell(experiment, values, quick));
    }
    make_names_differ(cells);
    return cells;
}

std::optional<double> label_number(const std::string& label) {
    double value = 0.0;
    const char* const end = label.data() + label.size();
    const auto [stop, failure] = std::from_chars(label.data(), end, value);
    if (failure != std::errc() || stop != end || !std::isfinite(value)) return std::nullopt;
    return value;
}

std::size_t axis_index(const Experiment& experiment, const std::string& name) {
    const auto at = std::find_if(experiment.axes.begin(), experiment.axes.end(),
                                 [&](const ExperimentAxis& axis) { return axis.name == name; });
    return static_cast<std::size_t>(at - experiment.axes.begin());
}

const std::string& label_of(const Experiment& experiment, const Cell& cell,
                            const std::string& axis) {
    const std::size_t index = axis_index(experiment, axis);
    return experiment.axes[index].values[cell.values[index]].label;
}

bool matches(const Experiment& experiment, const Cell& cell, const ExperimentChoice& choice) {
    return std::all_of(choice.begin(), choice.end(), [&](const auto& entry) {
        const std::string& label = label_of(experiment, cell, entry.first);
        return std::find(entry.second.begin(), entry.second.end(), label) != entry.second.end();
    });
}

}  // namespace burnish::lab
