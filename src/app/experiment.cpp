#include "lab/experiment/experiments.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>

#include "app/verbs.hpp"

namespace burnish::app {
namespace {

/// A line on a terminal: how many cells are done and how long the others will take.
class ProgressLine {
  public:
    explicit ProgressLine(bool quiet) : m_shown(!quiet && isatty(STDERR_FILENO) != 0) {}
    ~ProgressLine() {
        if (m_printed) fmt::print(stderr, "\r\x1b[K");
    }
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;

    void done(std::size_t count, std::size_t total) {
        if (!m_shown) return;
        constexpr std::size_t kWidth = 40;
        const double seconds =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - m_start).count();
        const double left =
            seconds * static_cast<double>(total - count) / static_cast<double>(count);
        fmt::print(stderr, "\r[{:<{}}] {} of {} cells, {:.0f} s left\x1b[K",
                   std::string(kWidth * count / total, '#'), kWidth, count, total, left);
        m_printed = true;
    }

  private:
    bool m_shown;
    bool m_printed = false;
    std::chrono::steady_clock::time_point m_start = std::chrono::steady_clock::now();
};

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
    ProgressLine line(options.quiet);
    lab::ExperimentOutcome outcome;
    if (options.experiment.empty()) {
        outcome = lab::merge_experiments(options.merged, options.output);
    } else {
        const lab::RunOptions how{options.quick, options.threads, options.shard, options.shards};
        outcome = lab::run_experiment(
            options.experiment, options.output, how,
            [&](std::size_t done, std::size_t total) { line.done(done, total); });
    }
    if (!outcome.problem.empty()) fmt::print(stderr, "burnish: {}\n", outcome.problem);
    if (!options.quiet) report(outcome);
}

}  // namespace burnish::app
