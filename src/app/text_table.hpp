#pragma once

#include <string>
#include <vector>

namespace burnish::app {

using TableRow = std::vector<std::string>;

/// Rows as lines, each column as wide as its widest cell, two blanks between columns, `indent` in
/// front of each line, none at its end.
std::string text_table(const std::vector<TableRow>& rows, int indent);

}  // namespace burnish::app
