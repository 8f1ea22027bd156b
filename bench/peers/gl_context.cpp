#include "bench/peers/gl_context.hpp"

#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <fmt/format.h>

#include <cstdlib>
#include <stdexcept>

namespace burnish::peers {

namespace {

constexpr const char* kExpected =
    "expected OpenGL 4.5 from Mesa (packages libegl1, libgl1-mesa-dri)";

std::string gl_string(GLenum name) {
    return reinterpret_cast<const char*>(glGetString(name));
}

void require(bool holds, const char* what) {
    if (holds) return;
    throw std::runtime_error(
        fmt::format("{}: EGL error 0x{:x}, {}", what, eglGetError(), kExpected));
}

}  // namespace

GlContext::GlContext(int threads) {
    setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
    setenv("GALLIUM_DRIVER", "llvmpipe", 1);
    setenv("LP_NUM_THREADS", std::to_string(threads).c_str(), 1);
    for (const char* extension : {"EGL_EXT_platform_base", "EGL_MESA_platform_surfaceless"}) {
        if (epoxy_has_egl_extension(EGL_NO_DISPLAY, extension)) continue;
        throw std::runtime_error(fmt::format("no {}, {}", extension, kExpected));
    }
    m_display =
        eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    require(m_display != EGL_NO_DISPLAY, "eglGetPlatformDisplayEXT");
    require(eglInitialize(m_display, nullptr, nullptr) == EGL_TRUE, "eglInitialize");
    require(eglBindAPI(EGL_OPENGL_API) == EGL_TRUE, "eglBindAPI");
    constexpr EGLint kAttributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                                      4,
                                      EGL_CONTEXT_MINOR_VERSION,
                                      5,
                                      EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                      EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                      EGL_NONE};
    m_context = eglCreateContext(m_display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, kAttributes);
    require(m_context != EGL_NO_CONTEXT, "eglCreateContext");
    require(eglMakeCurrent(m_display, EGL_NO_SURFACE, EGL_NO_SURFACE, m_context) == EGL_TRUE,
            "eglMakeCurrent");
    const std::string renderer = gl_string(GL_RENDERER);
    if (renderer.rfind("llvmpipe", 0) != 0) {
        throw std::runtime_error(fmt::format("OpenGL renderer '{}', expected llvmpipe", renderer));
    }
}

GlContext::~GlContext() {
    eglMakeCurrent(m_display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(m_display, m_context);
    eglTerminate(m_display);
}

std::string GlContext::description() const {
    return fmt::format("{}, {}", gl_string(GL_RENDERER), gl_string(GL_VERSION));
}

}  // namespace burnish::peers
