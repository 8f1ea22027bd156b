#pragma once

#include <filesystem>
#include <vector>

namespace burnish {

/// Behind files.hpp; the contract stands there.
std::vector<std::filesystem::path> find_input_files(const std::filesystem::path& path);

}  // namespace burnish
