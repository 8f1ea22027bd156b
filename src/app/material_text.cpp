#include "app/material_text.hpp"

#include <fmt/format.h>

namespace burnish::app {

std::string texture_text(std::string_view name, std::string_view file, bool tiles) {
    const std::string_view wrap = tiles ? "repeat" : "clamp_to_edge";
    return fmt::format("[[textures]]\nname = \"{}\"\nfile = \"{}\"\nwrap = [\"{}\", \"{}\"]\n\n",
                       name, file, wrap, wrap);
}

std::string parameter_text(std::string_view key, std::string_view map, char channel,
                           const CodedRange& range) {
    if (range.low == range.high) return fmt::format("{} = {}\n", key, range.low);
    return fmt::format("{} = {{ map = \"{}\", channel = \"{}\", low = {}, high = {} }}\n", key, map,
                       channel, range.low, range.high);
}

std::string color_text(std::string_view key, std::string_view map, float scale) {
    return fmt::format("{0} = {{ map = \"{1}\", color = [{2}, {2}, {2}] }}\n", key, map, scale);
}

std::string color_text(std::string_view key, const glm::vec3& color) {
    return fmt::format("{} = [{}, {}, {}]\n", key, color.r, color.g, color.b);
}

}  // namespace burnish::app
