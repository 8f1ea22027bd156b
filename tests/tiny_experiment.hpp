#pragma once

#include <burnish/error.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "lab/experiment/experiments.hpp"
#include "tests/tiny_experiment_files.hpp"

namespace burnish {

class ExperimentCommand : public TinyExperiment {
  protected:
    void SetUp() override {
        TinyExperiment::SetUp();
        write_tiny_experiment();
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
