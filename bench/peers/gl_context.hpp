#pragma once

#include <string>

namespace burnish::peers {

/// An OpenGL 4.5 core context of Mesa's llvmpipe without window or display
/// (EGL_MESA_platform_surfaceless), current on this thread as long as it lives.
class GlContext {
  public:
    /// @param threads  that rasterize; 0: the thread that calls OpenGL. The program's environment
    /// is set accordingly. Throws std::runtime_error if another renderer answers.
    explicit GlContext(int threads);
    ~GlContext();
    GlContext(const GlContext&) = delete;
    GlContext& operator=(const GlContext&) = delete;

    /// GL_RENDERER and GL_VERSION.
    [[nodiscard]] std::string description() const;

  private:
    void* m_display = nullptr;
    void* m_context = nullptr;
};

}  // namespace burnish::peers
