#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "io/scene_io_toml.hpp"

namespace burnish {

/// "FILE:LINE:COLUMN" of byte `offset` of a string's value, whatever quotes, escapes and line ends
/// its file says it with; columns from 1, in bytes. Nothing for a string that stands in no file (an
/// override), or whose file has changed since it was read.
std::optional<std::string> place_in_string(const toml::node& string, std::size_t offset);

}  // namespace burnish
