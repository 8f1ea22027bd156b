#pragma once

#include <burnish/experiment.hpp>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/scene_io_section.hpp"

/// What an experiment varies, and how the rest of its file speaks of it.
namespace burnish {

/// A table of keys and values, "a.b.c" = value; empty for a missing key.
std::vector<ExperimentSetting> read_settings(const Section& section, std::string_view key);

/// Adds the axis "scene" from [[scenes]].
void read_scenes(const Section& root, const std::filesystem::path& directory,
                 Experiment& experiment);

/// Adds an axis for each of [[sweeps]].
void read_sweeps(const Section& root, Experiment& experiment);

/// Axes by name, for what refers to them. Errors name the nearest one.
class Axes {
  public:
    explicit Axes(std::span<const ExperimentAxis> axes) : m_axes(axes) {}

    [[nodiscard]] std::string required_axis(const Section& section, std::string_view key) const;
    /// { axis = label or [labels], ... }
    [[nodiscard]] ExperimentChoice read_choice(const Section& section, std::string_view key) const;

  private:
    [[nodiscard]] const ExperimentAxis& named(const Section& section, std::string_view key,
                                              std::string_view name) const;
    std::span<const ExperimentAxis> m_axes;
};

}  // namespace burnish
