#pragma once

#include <burnish/experiment.hpp>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "lab/experiment/cells.hpp"
#include "lab/experiment/store.hpp"

namespace burnish::lab {

struct RunOptions {
    bool quick = false;
    int threads = 0;            ///< 0: one per core
    int shard = 1, shards = 1;  ///< the first of one: all cells
};

/// An experiment with what is known of its cells.
struct Results {
    Experiment experiment;
    bool quick = false;
    std::vector<Cell> cells;
    std::vector<std::string> descriptions;         ///< cell by cell
    std::vector<std::optional<CellResult>> found;  ///< likewise

    [[nodiscard]] std::size_t missing() const;
    /// A metric of a cell; nothing if it is missing, refused or has no meaning there.
    [[nodiscard]] std::optional<double> value(std::size_t cell, const std::string& metric) const;
    /// Of a cell whose pictures are kept, for a sheet or a plot: the gain of its signed error, as
    /// the first sheet that shows it has it.
    [[nodiscard]] std::optional<float> pictures_of(std::size_t cell) const;
};

/// An experiment's file, its metrics checked: an empty list becomes all that it can have. Throws
/// what load_experiment does, and Error{bad_input} for an unknown metric.
Experiment open_experiment(const std::filesystem::path& file);

/// The cells of an experiment, without results.
Results make_results(Experiment experiment, bool quick);

/// Adds the results that `store` has.
void find_results(Results& results, const Store& store);

/// Called after each finished cell with how many there are and were to do; from any worker, one at
/// a time.
using ProgressSink = std::function<void(std::size_t done, std::size_t total)>;

/// Computes what the shard lacks and keeps it in `store`; the result does not depend on `threads`.
/// Cells that share a reference follow each other, and it is drawn once. Throws Error for a scene
/// that cannot be read or a reference that cannot be drawn, naming the cell.
void run_cells(Results& results, const Store& store, const RunOptions& options,
               const ProgressSink& progress);

}  // namespace burnish::lab
