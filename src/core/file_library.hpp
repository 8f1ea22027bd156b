#pragma once

#include <burnish/files.hpp>

namespace burnish {

/// What burnish_io offers to burnish: one function per call of files.hpp, same contract. It stands
/// between the two so that OpenImageIO's 260 shared libraries load with the first file, not with
/// the process.
struct FileLibrary {
    LoadedMesh (*load_mesh)(const std::filesystem::path&);
    Image8 (*load_image)(const std::filesystem::path&);
    Framebuffer (*load_frame)(const std::filesystem::path&);
    void (*save_frame)(const Framebuffer&, const std::filesystem::path&,
                       std::string_view description);
    void (*save_image)(const Image8&, const std::filesystem::path&);
    void (*draw_text)(Framebuffer&, int, int, std::string_view, int, const glm::vec4&);
    void (*save_text)(std::string_view, const std::filesystem::path&);
    void (*save_mesh)(const MeshData&, const std::filesystem::path&);
    LoadedScene (*load_scene)(const std::filesystem::path&, const std::vector<std::string>&);
    Material (*load_material)(const std::filesystem::path&);
    Experiment (*load_experiment)(const std::filesystem::path&);
    std::vector<std::filesystem::path> (*input_files)(const std::filesystem::path&);
    ViewState (*load_view_state)(const std::filesystem::path&);
    LoadedScene (*scene_for_mesh)(const std::filesystem::path&);
};

/// The one symbol that burnish looks up in burnish_io.
inline constexpr const char* kFileLibrarySymbol = "burnish_file_library";
using FileLibraryEntry = const FileLibrary* (*)();

}  // namespace burnish
