#pragma once

#include <burnish/materials.hpp>
#include <span>
#include <string>
#include <string_view>

#include "app/options/option.hpp"

/// Words in options. Where one is unknown, Error{bad_option} names the nearest.
namespace burnish::app {

/// `word`, one of `known`.
std::string known_word(const std::string& option, const std::string& word,
                       std::span<const std::string_view> known);

/// METHOD or METHOD:BITS.
MaterialMipmaps parse_mipmaps(const std::string& option, const std::string& text);

/// Methods that filter parameters.
std::vector<std::string_view> filtering_mip_methods();

/// Every value into `target`, as it is; `target` must outlive what is returned.
template <class Target>
Set text_to(Target& target) {
    return [&target](const std::string&, const std::string& text) { target = text; };
}

/// A flag that was given.
inline Set flag_to(bool& target) {
    return [&target](const std::string&, const std::string&) { target = true; };
}

}  // namespace burnish::app
