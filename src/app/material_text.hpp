#pragma once

#include <burnish/materials.hpp>
#include <string>
#include <string_view>

namespace burnish::app {

/// A [[textures]] table of a material file.
std::string texture_text(std::string_view name, std::string_view file, bool tiles);

/// A parameter's line: a number where it does not vary, else a channel of the texture `map`.
std::string parameter_text(std::string_view key, std::string_view map, char channel,
                           const CodedRange& range);

/// A colour's line: the texture `map` times a number.
std::string color_text(std::string_view key, std::string_view map, float scale);
/// The same of a colour that does not vary.
std::string color_text(std::string_view key, const glm::vec3& color);

}  // namespace burnish::app
