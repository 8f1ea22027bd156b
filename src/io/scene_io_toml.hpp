#pragma once

// One set of toml++ options for every file that includes it.
#define TOML_ENABLE_FORMATTERS 0
#include <toml++/toml.h>

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace burnish {

/// Parses a scene file and applies "key.path=value" overrides to it. Arrays of tables are indexed
/// by number or by the `name` of their elements; a value that is not TOML counts as a string.
/// Throws Error{io} for a file that cannot be read, Error{limit} above 32 MiB, Error{bad_input} for
/// a syntax error, Error{bad_option} for an override that leads nowhere.
toml::table parse_scene(const std::filesystem::path& path,
                        const std::vector<std::string>& overrides);

/// A text that stands in the file `path` in some other way.
toml::table parse_scene_text(std::string_view text, const std::filesystem::path& path);

}  // namespace burnish
