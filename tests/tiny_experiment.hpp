#pragma once

#include <burnish/error.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "lab/experiment/experiments.hpp"
#include "tests/run_command.hpp"

namespace burnish {

/// 2 x 2 cells of 40 x 30 pixels, a sphere each.
class ExperimentCommand : public Command {
  protected:
    void SetUp() override {
        Command::SetUp();
        std::filesystem::create_directory(path("scenes"));
        write_scene("scenes/ball.toml", "material = \"metal\"\n[[materials]]\nname = \"metal\"\n");
        write_experiment("");
    }

    void write_experiment(const std::string& more, const std::string& file = "scenes/ball.toml") {
        write(path("tiny.toml"), R"(schema = 1
title = "Tiny & small"
hypothesis = "A machine is not exact."
metrics = ["rmse", "bias", "flicker"]
[[scenes]]
name = "ball"
file = ")" + file + R"("
[[sweeps]]
name = "machine"
key = "machine.profile"
values = ["nv2a", "ideal"]
quick = ["ideal"]
[[sweeps]]
name = "width"
variants = [
  { label = 0.3, set = { "materials.metal.alpha_x" = 0.3 } },
  { label = 0.6, set = { "materials.metal.alpha_x" = 0.6 } },
]
[pan]
frames = 3
samples = 4
[reference]
samples = 1
set = { "machine.profile" = "double" }
[[plots]]
title = "errors"
x = "width"
y = "rmse"
[[sheets]]
title = "pictures"
where = { machine = "nv2a", width = 0.3 }
[[expect]]
text = "nine bits are worse"
metric = "rmse"
measure = "ratio"
where = { machine = "nv2a" }
versus = { machine = "ideal" }
at_least = 1
)" + more);
    }

    /// In this process, as most tests do: the command loads the libraries of files every time.
    lab::ExperimentOutcome compute(const std::string& directory, lab::RunOptions options = {}) {
        return lab::run_experiment(path("tiny.toml").string(), path(directory), options, {});
    }
    lab::ExperimentOutcome merge(const std::vector<std::string>& shards, const std::string& to) {
        std::vector<std::filesystem::path> directories;
        for (const std::string& shard : shards) directories.push_back(path(shard));
        return lab::merge_experiments(directories, path(to));
    }
    std::string csv(const std::string& directory) { return read(path(directory) / "results.csv"); }

    /// That `action` throws an Error that says `part` and writes no file.
    template <class Action>
    void expect_error(const std::string& part, const Action& action) {
        const std::vector<std::string> before = entries();
        try {
            action();
            ADD_FAILURE() << "no error: " << part;
        } catch (const Error& error) {
            EXPECT_SAYS(std::string(error.what()), part);
        }
        EXPECT_EQ(entries(), before) << part;
    }

    void expect_bad_file(const std::string& more, const std::string& part) {
        write_experiment(more);
        expect_error(part, [&] { compute("out"); });
    }
};

}  // namespace burnish
