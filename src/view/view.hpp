#pragma once

#include <burnish/renderer.hpp>
#include <burnish/scene.hpp>
#include <filesystem>
#include <functional>
#include <glm/glm.hpp>
#include <optional>

/// The window of `burnish view`. The library burnish_view (SDL2, Dear ImGui) is loaded by the
/// command when it is asked for a window.
namespace burnish::view {

struct ViewRequest {
    std::filesystem::path input;  ///< empty with `load_state`
    /// Reads a scene or mesh with the command's other options applied. Throws Error. One thread at
    /// a time calls, not always the same.
    std::function<Scene(const std::filesystem::path&)> load;
    /// Renders with that many samples per pixel, squared (view/picture.hpp). Throws Error. Called
    /// from a thread of its own.
    std::function<FrameStats(Renderer&, const Scene&, int side, Framebuffer&)> draw;
    std::optional<glm::ivec2> size;    ///< of the window; else the scene's or the state's
    RendererOptions renderer;          ///< threads and instruction set to begin with
    std::filesystem::path load_state;  ///< shown first; empty: the input as it is
    std::filesystem::path save_state;  ///< written when the window closes; empty: nowhere
    bool quiet = false;                ///< names of screenshots are not printed, nor what is
                                       ///< wrong with a state's materials
    bool report = false;  ///< a line on standard output for every picture that came to rest, and
                          ///< the times of all pictures at the end
};

/// Opens the window and returns when it is closed. Throws Error{io} where there is no display,
/// and what load and load_view_state throw for the first input.
void view(const ViewRequest& request);

inline constexpr const char* kViewSymbol = "burnish_view";
using ViewEntry = void (*)(const ViewRequest&);

}  // namespace burnish::view
