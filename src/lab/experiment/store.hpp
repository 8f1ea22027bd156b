#pragma once

#include <burnish/experiment.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "lab/experiment/cells.hpp"
#include "lab/experiment/measures.hpp"

namespace burnish::lab {

struct CellResult {
    std::vector<Measured> values;  ///< empty if refused
    std::string refusal;           ///< why the machine cannot; one line
    double ms = 0.0;               ///< of the test's picture, on one thread: the median of repeats
    double ms_low = 0.0, ms_high = 0.0;  ///< the shortest and the longest
};

/// All that a cell's results depend on, as text: build, files, settings, metrics; `inputs` is the
/// fingerprint of the files, `gain` that of the signed error where pictures are kept. How often the
/// picture is timed is no part of it.
std::string describe(const Experiment& experiment, const Cell& cell, bool quick,
                     const std::string& inputs, std::optional<float> gain);

/// Finished cells as files, named after the fingerprints of their descriptions, which they hold: a
/// file whose description is another one, or that is damaged, counts as missing.
class Store {
  public:
    /// DIRECTORY/cells and DIRECTORY/images are made. Throws Error{io} if they cannot be.
    explicit Store(std::filesystem::path directory);

    [[nodiscard]] std::optional<CellResult> find(const std::string& description) const;
    void keep(const std::string& description, const CellResult& result) const;
    /// Takes over all files of cells and images that `other` has and this one lacks.
    void take(const Store& other) const;

    [[nodiscard]] const std::filesystem::path& directory() const { return m_directory; }
    [[nodiscard]] std::filesystem::path images() const { return m_directory / "images"; }

  private:
    [[nodiscard]] std::filesystem::path file_of(const std::string& description) const;
    std::filesystem::path m_directory;
};

}  // namespace burnish::lab
