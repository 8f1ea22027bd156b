#pragma once

#include <filesystem>

namespace burnish {

/// Throws Error{bad_input} for a PNG file whose chunks do not add up: cut short, or a checksum that
/// does not match. Files of other formats pass.
///
/// libpng would find the same, but reports it on standard error, which is not the library's to use.
void require_sound_png(const std::filesystem::path& path);

}  // namespace burnish
