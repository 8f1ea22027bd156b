#include "view/view.hpp"

#include <dlfcn.h>

#include <burnish/error.hpp>
#include <filesystem>

#include "app/picture.hpp"
#include "app/supersample.hpp"
#include "app/verbs.hpp"

namespace burnish::app {
namespace {

/// The window's library in `lib` beside the command's directory, or wherever the system has it.
view::ViewEntry load_viewer() {
    std::error_code failure;
    const std::filesystem::path command = std::filesystem::read_symlink("/proc/self/exe", failure);
    void* handle = nullptr;
    for (const char* directory : {BURNISH_VIEW_DIRECTORY, "../lib"}) {
        const std::filesystem::path file = command.parent_path() / directory / BURNISH_VIEW_LIBRARY;
        if (handle == nullptr && std::filesystem::exists(file, failure))
            handle = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
    }
    if (handle == nullptr) handle = dlopen(BURNISH_VIEW_LIBRARY, RTLD_NOW | RTLD_LOCAL);
    if (handle == nullptr)
        throw Error(ErrorCode::io, std::string("view: the window's library does not load, it is "
                                               "built with -DBURNISH_VIEW=ON: ") +
                                       dlerror());
    const auto entry = reinterpret_cast<view::ViewEntry>(dlsym(handle, view::kViewSymbol));
    if (entry == nullptr)
        throw Error(ErrorCode::io,
                    std::string("view: the window's library has no entry: ") + dlerror());
    return entry;
}

}  // namespace

void run(const ViewOptions& options) {
    if (options.picture.input.empty() == options.load_state.empty())
        throw Error(ErrorCode::bad_option, "view: expected INPUT or --load-state FILE");
    view::ViewRequest request;
    request.input = options.picture.input;
    request.load = [&options](const std::filesystem::path& input) {
        PictureOptions picture = options.picture;
        picture.input = input;
        return load_picture(picture);
    };
    request.draw = [](Renderer& renderer, const Scene& scene, int side, Framebuffer& target) {
        return draw_supersampled(renderer, scene, side, target);
    };
    request.size = options.picture.size;
    request.renderer.threads = options.picture.threads;
    request.renderer.isa = options.picture.isa;
    request.load_state = options.load_state;
    request.save_state = options.save_state;
    request.quiet = options.picture.quiet;
    request.report = options.picture.verbose;
    load_viewer()(request);
}

}  // namespace burnish::app
