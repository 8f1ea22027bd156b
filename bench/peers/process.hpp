#pragma once

#include <string>
#include <vector>

namespace burnish::peers {

/// What a program wrote to its standard output, line by line, once it has ended.
/// Throws std::runtime_error with its name if it cannot be started or fails.
std::vector<std::string> output_of(const std::vector<std::string>& arguments);

/// Whether it can be started and succeeds; what it writes is dropped.
bool succeeds(const std::vector<std::string>& arguments);

}  // namespace burnish::peers
