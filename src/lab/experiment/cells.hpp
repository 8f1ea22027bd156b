#pragma once

#include <burnish/experiment.hpp>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace burnish::lab {

/// What a picture is made of: a scene file, keys in the order in which they are applied, samples.
struct PictureSettings {
    std::size_t scene = 0;  ///< of Experiment::scenes
    std::vector<ExperimentSetting> settings;
    int samples = 1;

    friend bool operator==(const PictureSettings&, const PictureSettings&) = default;
};

/// One place of the product of all axes: a test beside its reference.
struct Cell {
    std::vector<std::size_t> values;  ///< of each axis, an index
    PictureSettings test, reference;
    std::string name;  ///< of its files: labels with '-' between them
};

/// Axes multiplied out, the last one running fastest; with `quick` only quick values, and what
/// Experiment::quick says. What a sweep says of keys that begin with "machine." or "bits." is for
/// the test alone, so is all of a sweep with `test_only`. The key "samples" sets the samples.
/// Formulas (formula.hpp) know the labels that are numbers by the names of their axes.
/// Throws Error{limit} beyond 100 000 cells, Error{bad_input} for samples that are no square and
/// for bad formulas.
std::vector<Cell> make_cells(const Experiment& experiment, bool quick);

/// The label of a cell on an axis of that name.
const std::string& label_of(const Experiment& experiment, const Cell& cell,
                            const std::string& axis);

/// A label that is a finite number.
std::optional<double> label_number(const std::string& label);

/// Whether a cell has the values that `choice` lists.
bool matches(const Experiment& experiment, const Cell& cell, const ExperimentChoice& choice);

/// The index of an axis. Names were checked when the file was read.
std::size_t axis_index(const Experiment& experiment, const std::string& name);

}  // namespace burnish::lab
