#pragma once

#include <burnish/experiment.hpp>
#include <filesystem>

namespace burnish {

/// load_experiment of files.hpp; the contract stands there.
Experiment read_experiment_file(const std::filesystem::path& path);

}  // namespace burnish
