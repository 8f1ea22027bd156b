#include "program/print_operand.hpp"

#include <fmt/format.h>

#include <burnish/program_text.hpp>
#include <string_view>

namespace burnish {
namespace {

std::string mapped(Mapping mapping, const std::string& reg) {
    switch (mapping) {
        case Mapping::unsigned_identity:
            return "unsigned(" + reg + ")";
        case Mapping::unsigned_invert:
            return "unsigned_invert(" + reg + ")";
        case Mapping::expand:
            return "expand(" + reg + ")";
        case Mapping::expand_negate:
            return "-expand(" + reg + ")";
        case Mapping::half_bias:
            return "half_bias(" + reg + ")";
        case Mapping::half_bias_negate:
            return "-half_bias(" + reg + ")";
        case Mapping::signed_identity:
            return reg;
        case Mapping::signed_negate:
            return "-" + reg;
    }
    return reg;
}

/// Behind the register's name; zero has none.
std::string_view component_suffix(const Input& input) {
    if (input.reg == Register::zero) return "";
    switch (input.component) {
        case Component::rgb:
            return ".rgb";
        case Component::alpha:
            return ".a";
        case Component::blue:
            return ".b";
    }
    return "";
}

}  // namespace

std::string print_input(const Input& input) {
    if (input.reg == Register::zero && input.mapping == Mapping::unsigned_invert) return "one";
    if (input.reg == Register::zero && input.mapping == Mapping::expand) return "-one";
    return mapped(input.mapping,
                  fmt::format("{}{}", register_name(input.reg), component_suffix(input)));
}

std::string print_operand(const Input& input, Place place) {
    Input shown = input;
    if (is_final(place) && shown.mapping == Mapping::unsigned_identity)
        shown.mapping = Mapping::signed_identity;
    const std::string text = print_input(shown);
    const std::string_view own = is_scalar(place) ? ".a" : ".rgb";
    const std::size_t at = text.find(own);
    return at == std::string::npos ? text : text.substr(0, at) + text.substr(at + own.size());
}

}  // namespace burnish
