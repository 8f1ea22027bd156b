#include "lab/experiment/experiments.hpp"

#include <fmt/format.h>

#include <cstdio>

#include "app/progress.hpp"
#include "app/verbs.hpp"

namespace burnish::app {
namespace {

void report(const lab::ExperimentOutcome& outcome) {
    fmt::print("{}: {} cells", outcome.report.string(), outcome.cells);
    if (outcome.refused > 0) fmt::print(", {} refused by their machines", outcome.refused);
    if (outcome.missing > 0)
        fmt::print(", {} missing\n", outcome.missing);
    else
        fmt::print(", {}\n", outcome.verdict);
}

}  // namespace

void run(const ExperimentOptions& options) {
    Progress progress(options.quiet);
    lab::ExperimentOutcome outcome;
    if (options.experiment.empty()) {
        outcome = lab::merge_experiments(options.merged, options.output);
    } else {
        const lab::RunOptions how{options.quick, options.threads, options.shard, options.shards};
        outcome = lab::run_experiment(
            options.experiment, options.output, how,
            [&](std::size_t done, std::size_t total) { progress.done(done, total); });
    }
    progress.finish();
    if (!outcome.problem.empty()) fmt::print(stderr, "burnish: {}\n", outcome.problem);
    if (!options.quiet) report(outcome);
}

}  // namespace burnish::app
