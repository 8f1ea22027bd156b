#pragma once

#include <burnish/files.hpp>
#include <filesystem>
#include <string>
#include <vector>

/// Scenes behind files.hpp; the contracts stand there.
namespace burnish {

LoadedScene read_scene_file(const std::filesystem::path& path,
                            const std::vector<std::string>& overrides);
Material read_material_file(const std::filesystem::path& path);
LoadedScene scene_for_mesh_file(const std::filesystem::path& path);

}  // namespace burnish
