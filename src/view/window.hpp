#pragma once

#include <SDL.h>

#include <burnish/framebuffer.hpp>
#include <glm/glm.hpp>
#include <memory>
#include <string>

namespace burnish::view {

/// A window of pixels in memory and the panels over them: no GPU, no OpenGL.
class Window {
  public:
    /// Throws Error{io} where there is no display.
    Window(const std::string& title, const glm::ivec2& size);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    [[nodiscard]] glm::ivec2 size() const;
    void set_title(const std::string& title);
    void hide();

    /// Begins a frame of Dear ImGui; panels are made between this and `show`.
    void begin_panels();
    /// The picture (rgba8; what is missing of the window stays dark) under the panels.
    void show(const Framebuffer* picture);
    /// The last picture that was shown, panels and all, rgba8 and opaque.
    [[nodiscard]] Framebuffer shot();

  private:
    struct Handles;
    void follow_surface();

    std::unique_ptr<Handles> m_handles;
};

}  // namespace burnish::view
