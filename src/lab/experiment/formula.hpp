#pragma once

#include <map>
#include <string>
#include <string_view>

namespace burnish::lab {

/// A number from a text such as "0.1 * sqrt(($N + 4) / 2)": numbers, + - * / ^, brackets, sqrt,
/// sin, cos, log2, round, min, pi, and $NAME for each of `variables`. Angles are in degrees. Throws
/// Error{bad_input} for what is none, or has no finite value.
double evaluate_formula(std::string_view text, const std::map<std::string, double>& variables);

/// TOML text in which every string that begins with "=" is replaced by the number that its rest
/// comes to.
std::string with_formulas(const std::string& value, const std::map<std::string, double>& variables);

}  // namespace burnish::lab
