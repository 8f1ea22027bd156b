#pragma once

#include <filesystem>
#include <string_view>

namespace burnish::lab {

/// Replaces what stands in a text file between the lines `<!-- begin NAME -->` and
/// `<!-- end NAME -->`, which stay. Throws Error{bad_input} if it does not have both, in this
/// order, Error{io} if it cannot be read or written.
void replace_section(const std::filesystem::path& file, std::string_view name,
                     std::string_view text);

}  // namespace burnish::lab
