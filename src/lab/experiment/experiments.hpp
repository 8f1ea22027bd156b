#pragma once

#include <burnish/experiment.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "lab/experiment/run.hpp"

/// Whole experiments: what `burnish experiment` does.
namespace burnish::lab {

/// The experiments that the program carries: "e1", "e2", ...
std::vector<std::string> experiment_names();

struct ExperimentOutcome {
    std::filesystem::path report;
    std::size_t cells = 0, missing = 0, refused = 0;
    std::string verdict;
    std::string problem;  ///< what could not be drawn, one line, or nothing
};

/// Runs the experiment of that name, or that of a file, into `directory`, which is made: what it
/// lacks is computed, then all documents are written. Files of the program's own experiments are
/// put there, into "inputs". A shard leaves the cells of others missing.
/// Throws Error{bad_option} for a name that is neither.
ExperimentOutcome run_experiment(const std::string& name_or_file,
                                 const std::filesystem::path& directory, const RunOptions& options,
                                 const ProgressSink& progress);

/// Joins the directories of shards into `directory`. Throws Error{bad_input} if they are not of one
/// experiment in one form, or if cells are missing.
ExperimentOutcome merge_experiments(const std::vector<std::filesystem::path>& shards,
                                    const std::filesystem::path& directory);

}  // namespace burnish::lab
