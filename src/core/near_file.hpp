#pragma once

#include <filesystem>
#include <string>

namespace burnish {

/// End of a message that there is no file at `path`: ", did you mean 'meshes/knot.obj'?" where its
/// directory has a name as near as nearest_name() wants it; empty where it has none, where the file
/// is there after all, or the directory holds more than 10000 names.
std::string near_file(const std::filesystem::path& path);

}  // namespace burnish
