#include <dlfcn.h>

#include <burnish/error.hpp>
#include <burnish/files.hpp>
#include <filesystem>
#include <string>

#include "core/file_library.hpp"
#include "core/within_memory.hpp"

namespace burnish {
namespace {

/// Path of the file library beside the library that this code is in; empty if that is unknown.
std::string beside_this_library() {
    static const char kHere = 0;
    Dl_info info{};
    if (dladdr(&kHere, &info) == 0 || info.dli_fname == nullptr) return {};
    return (std::filesystem::path(info.dli_fname).parent_path() / BURNISH_IO_LIBRARY).string();
}

const FileLibrary& open_library() {
    // Beside this library first, so that a build tree never picks up an installed version.
    const std::string beside = beside_this_library();
    void* handle = nullptr;
    std::error_code ignored;
    if (!beside.empty() && std::filesystem::exists(beside, ignored))
        handle = dlopen(beside.c_str(), RTLD_NOW | RTLD_LOCAL);
    else
        handle = dlopen(BURNISH_IO_LIBRARY, RTLD_NOW | RTLD_LOCAL);
    if (handle == nullptr)
        throw Error(ErrorCode::io, std::string("the file library does not load: ") + dlerror());
    const auto entry = reinterpret_cast<FileLibraryEntry>(dlsym(handle, kFileLibrarySymbol));
    if (entry == nullptr)
        throw Error(ErrorCode::io, std::string("the file library has no entry: ") + dlerror());
    return *entry();
}

/// Loaded once and never unloaded; a failed attempt is repeated at the next call.
const FileLibrary& library() {
    static const FileLibrary& loaded = open_library();
    return loaded;
}

/// What call(library) returns; `path` is what a shortage of memory is reported of, but for what
/// says more itself.
template <class Call>
decltype(auto) of_library(const std::filesystem::path& path, const Call& call) {
    const auto shortage = [&] { return path.string() + ": too large for the memory"; };
    return within_memory(shortage, [&] { return call(library()); });
}

}  // namespace

LoadedMesh load_mesh(const std::filesystem::path& path) {
    return of_library(path, [&](const FileLibrary& files) { return files.load_mesh(path); });
}

Image8 load_image(const std::filesystem::path& path) {
    return of_library(path, [&](const FileLibrary& files) { return files.load_image(path); });
}

Framebuffer load_frame(const std::filesystem::path& path) {
    return of_library(path, [&](const FileLibrary& files) { return files.load_frame(path); });
}

void save_image(const Framebuffer& frame, const std::filesystem::path& path) {
    of_library(path, [&](const FileLibrary& files) { files.save_frame(frame, path, {}); });
}

void save_image(const Framebuffer& frame, const std::filesystem::path& path,
                std::string_view description) {
    of_library(path, [&](const FileLibrary& files) { files.save_frame(frame, path, description); });
}

void save_image(const Image8& image, const std::filesystem::path& path) {
    of_library(path, [&](const FileLibrary& files) { files.save_image(image, path); });
}

void draw_text(Framebuffer& frame, int x, int y, std::string_view text, int size,
               const glm::vec4& color) {
    const auto shortage = [] { return "out of memory for a line of text"; };
    within_memory(shortage, [&] { library().draw_text(frame, x, y, text, size, color); });
}

void save_text(std::string_view text, const std::filesystem::path& path) {
    of_library(path, [&](const FileLibrary& files) { files.save_text(text, path); });
}

void save_mesh(const MeshData& mesh, const std::filesystem::path& path) {
    of_library(path, [&](const FileLibrary& files) { files.save_mesh(mesh, path); });
}

LoadedScene load_scene(const std::filesystem::path& path,
                       const std::vector<std::string>& overrides) {
    return of_library(path,
                      [&](const FileLibrary& files) { return files.load_scene(path, overrides); });
}

Material load_material(const std::filesystem::path& path) {
    return of_library(path, [&](const FileLibrary& files) { return files.load_material(path); });
}

Experiment load_experiment(const std::filesystem::path& path) {
    return of_library(path, [&](const FileLibrary& files) { return files.load_experiment(path); });
}

std::vector<std::filesystem::path> input_files(const std::filesystem::path& path) {
    return of_library(path, [&](const FileLibrary& files) { return files.input_files(path); });
}

ViewState load_view_state(const std::filesystem::path& path) {
    return of_library(path, [&](const FileLibrary& files) { return files.load_view_state(path); });
}

LoadedScene scene_for_mesh(const std::filesystem::path& path) {
    return of_library(path, [&](const FileLibrary& files) { return files.scene_for_mesh(path); });
}

}  // namespace burnish
