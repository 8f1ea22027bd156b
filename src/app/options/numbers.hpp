#pragma once

#include <fmt/format.h>

#include <burnish/error.hpp>
#include <charconv>
#include <cmath>
#include <glm/glm.hpp>
#include <string>
#include <type_traits>
#include <vector>

#include "app/options/option.hpp"

/// Numbers in options. Where a text is none, Error{bad_option} "OPTION TEXT, expected ...".
namespace burnish::app {

/// `text` was given for `option`, `expected` should have been.
[[noreturn]] void refuse(const std::string& option, const std::string& text,
                         const std::string& expected);

/// `least` .. `most` finite numbers with commas between them.
template <class Number = float>
std::vector<Number> parse_numbers(const std::string& option, const std::string& text,
                                  std::size_t least, std::size_t most) {
    std::vector<Number> values;
    const char* at = text.data();
    const char* const end = at + text.size();
    while (true) {
        Number value = 0;
        const auto [stop, failure] = std::from_chars(at, end, value);
        const bool separated = stop == end || *stop == ',';
        if (failure != std::errc() || !separated || !std::isfinite(value)) break;
        values.push_back(value);
        if (stop == end) {
            if (values.size() < least || values.size() > most) break;
            return values;
        }
        at = stop + 1;
    }
    refuse(option, text,
           fmt::format(
               "{} numbers with commas between them",
               least == most ? fmt::format("{}", least) : fmt::format("{} to {}", least, most)));
}

glm::vec3 parse_vec3(const std::string& option, const std::string& text);

/// Two whole numbers, not negative, with `separator` between them; false if `text` is not that.
bool parse_pair(const std::string& text, char separator, glm::ivec2& pair);

/// One number of `least` .. `most` into `target`, a Number or an optional one, which must outlive
/// what is returned.
template <class Number, class Target>
Set number_to(Target& target, Number least, Number most) {
    return [&target, least, most](const std::string& option, const std::string& text) {
        const char* const end = text.data() + text.size();
        const char* const begin = text.data() + (text.starts_with('+') ? 1 : 0);
        Number value = 0;
        const auto [stop, failure] = std::from_chars(begin, end, value);
        // NaN is in no range.
        if (failure != std::errc() || stop != end || !(value >= least && value <= most))
            refuse(option, text,
                   fmt::format("a {}number of {} .. {}", std::is_integral_v<Number> ? "whole " : "",
                               least, most));
        target = value;
    };
}

}  // namespace burnish::app
