#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/options/option.hpp"

/// Options that several verbs share. What they fill must outlive them.
namespace burnish::app {

/// The groups of a verb that draws `picture`: its input, then `own`, then machine, camera and so
/// on.
std::vector<OptionGroup> with_picture_options(PictureOptions& picture,
                                              std::vector<OptionGroup> own);

OptionGroup camera_options(CameraOptions& camera);

/// --aov
Option shown_option(std::optional<Shown>& shown);

/// --samples, a square up to 1024, as its root.
Option samples_option(int& side);

/// --threads
Option threads_option(int& threads);

/// --json
Option json_option(bool& json);

/// --quiet
Option quiet_option(bool& quiet);

/// -o DIR, required.
Option directory_option(std::filesystem::path& output);

/// A generated set's seed and side in texels.
std::vector<Option> generator_options(std::uint32_t& seed, int& size, int largest,
                                      const std::string& needs);

}  // namespace burnish::app
