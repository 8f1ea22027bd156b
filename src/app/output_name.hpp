#pragma once

#include <string>

namespace burnish::app {

/// Whether `pattern` holds {frame} or {frame:W}.
bool has_frame_number(const std::string& pattern);

/// Every {frame} becomes `frame`, every {frame:W} the same with zeros in front, W digits long
/// (1 .. 9). Throws Error{bad_option} for braces that hold anything else.
std::string numbered_name(const std::string& pattern, int frame);

}  // namespace burnish::app
