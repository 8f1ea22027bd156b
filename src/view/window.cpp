#include "view/window.hpp"

#include <backends/imgui_impl_sdl.h>
#include <imgui.h>

#include <algorithm>
#include <burnish/error.hpp>
#include <cstdint>
#include <cstdlib>
#include <cstring>

#include "view/gui_draw.hpp"

namespace burnish::view {
namespace {

[[noreturn]] void fail(const std::string& what) {
    throw Error(ErrorCode::io, "view: " + what + ": " + SDL_GetError());
}

/// The one that the environment speaks of: left alone, SDL tries them all, and ends with one that
/// shows nothing to anybody. Throws Error{io} where there is none.
void choose_driver() {
    if (std::getenv("SDL_VIDEODRIVER") != nullptr) return;
    const char* driver = std::getenv("DISPLAY") != nullptr           ? "x11"
                         : std::getenv("WAYLAND_DISPLAY") != nullptr ? "wayland"
                                                                     : nullptr;
    if (driver == nullptr)
        throw Error(ErrorCode::io,
                    "view: no display, expected DISPLAY or WAYLAND_DISPLAY in the environment");
    SDL_SetHint(SDL_HINT_VIDEODRIVER, driver);
}

/// Bytes r, g, b, a to the screen's 0xXXRRGGBB.
void put_row(const std::byte* source, int width, std::uint32_t* target) {
    for (int x = 0; x < width; ++x, source += 4) {
        std::uint32_t rgba;
        std::memcpy(&rgba, source, sizeof rgba);
        target[x] = (rgba & 0xff00U) | (rgba & 0xffU) << 16 | (rgba >> 16 & 0xffU);
    }
}

/// Flat panels without anti-aliased borders: rectangles are what SDL draws fast without a GPU.
void choose_style() {
    ImGui::StyleColorsDark();
    ImGuiStyle& style = ImGui::GetStyle();
    style.AntiAliasedLines = false;
    style.AntiAliasedLinesUseTex = false;
    style.AntiAliasedFill = false;
    style.WindowRounding = 0.0F;
    style.FrameRounding = 0.0F;
    style.Colors[ImGuiCol_WindowBg].w = 0.88F;
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.ConfigFlags |= ImGuiConfigFlags_NoMouseCursorChange;
}

}  // namespace

struct Window::Handles {
    SDL_Window* window = nullptr;
    SDL_Surface* surface = nullptr;    ///< the window's own; a new one after each change of size
    glm::ivec2 drawn{0, 0};            ///< its size
    SDL_Renderer* renderer = nullptr;  ///< of the panels, into `surface`
    SDL_Texture* font = nullptr;
    bool has_video = false;

    ~Handles() {
        if (ImGui::GetCurrentContext() != nullptr) {
            if (window != nullptr) ImGui_ImplSDL2_Shutdown();
            ImGui::DestroyContext();
        }
        drop_renderer();
        if (window != nullptr) SDL_DestroyWindow(window);
        if (has_video) SDL_Quit();
    }
    void drop_renderer() {
        if (font != nullptr) SDL_DestroyTexture(font);
        if (renderer != nullptr) SDL_DestroyRenderer(renderer);
        font = nullptr;
        renderer = nullptr;
    }
};

Window::Window(const std::string& title, const glm::ivec2& size)
    : m_handles(std::make_unique<Handles>()) {
    SDL_SetHint(SDL_HINT_FRAMEBUFFER_ACCELERATION, "0");
    SDL_SetHint(SDL_HINT_VIDEO_ALLOW_SCREENSAVER, "1");
    choose_driver();
    if (SDL_Init(SDL_INIT_VIDEO) != 0) fail("no display");
    m_handles->has_video = true;
    m_handles->window =
        SDL_CreateWindow(title.c_str(), SDL_WINDOWPOS_UNDEFINED, SDL_WINDOWPOS_UNDEFINED, size.x,
                         size.y, SDL_WINDOW_RESIZABLE);
    if (m_handles->window == nullptr) fail("no window");
    SDL_SetWindowMinimumSize(m_handles->window, 64, 64);
    ImGui::CreateContext();
    choose_style();
    if (!ImGui_ImplSDL2_InitForSDLRenderer(m_handles->window)) fail("no panels");
    SDL_EventState(SDL_DROPFILE, SDL_ENABLE);
    follow_surface();
}

Window::~Window() = default;

glm::ivec2 Window::size() const {
    glm::ivec2 size{0, 0};
    SDL_GetWindowSize(m_handles->window, &size.x, &size.y);
    return glm::max(size, glm::ivec2(1));
}

void Window::set_title(const std::string& title) {
    SDL_SetWindowTitle(m_handles->window, title.c_str());
}

void Window::hide() {
    SDL_HideWindow(m_handles->window);
}

void Window::follow_surface() {
    SDL_Surface* surface = SDL_GetWindowSurface(m_handles->window);
    if (surface == nullptr) fail("no pixels");
    const glm::ivec2 drawn(surface->w, surface->h);
    if (surface == m_handles->surface && m_handles->drawn == drawn) return;
    m_handles->drop_renderer();
    m_handles->surface = surface;
    m_handles->drawn = drawn;
    m_handles->renderer = SDL_CreateSoftwareRenderer(surface);
    if (m_handles->renderer == nullptr) fail("no panels");
    m_handles->font = make_font_texture(m_handles->renderer);
}

void Window::begin_panels() {
    follow_surface();
    ImGui_ImplSDL2_NewFrame();
    ImGui::NewFrame();
}

void Window::show(const Framebuffer* picture) {
    ImGui::Render();
    SDL_Surface& surface = *m_handles->surface;
    const int width = picture == nullptr ? 0 : std::min(surface.w, picture->width());
    const int height = picture == nullptr ? 0 : std::min(surface.h, picture->height());
    if (width < surface.w || height < surface.h) SDL_FillRect(&surface, nullptr, 0);
    if (surface.format->format == SDL_PIXELFORMAT_RGB888 ||
        surface.format->format == SDL_PIXELFORMAT_ARGB8888) {
        for (int y = 0; y < height; ++y)
            put_row(
                picture->row(y), width,
                reinterpret_cast<std::uint32_t*>(static_cast<std::byte*>(surface.pixels) +
                                                 static_cast<std::ptrdiff_t>(y) * surface.pitch));
    } else if (width > 0) {
        SDL_ConvertPixels(width, height, SDL_PIXELFORMAT_ABGR8888, picture->pixels(),
                          static_cast<int>(picture->pitch()), surface.format->format,
                          surface.pixels, surface.pitch);
    }
    draw_gui(*ImGui::GetDrawData(), m_handles->renderer);
    SDL_RenderFlush(m_handles->renderer);
    SDL_UpdateWindowSurface(m_handles->window);
}

Framebuffer Window::shot() {
    SDL_Surface& surface = *m_handles->surface;
    Framebuffer frame(surface.w, surface.h);
    SDL_ConvertPixels(surface.w, surface.h, surface.format->format, surface.pixels, surface.pitch,
                      SDL_PIXELFORMAT_ABGR8888, frame.pixels(), static_cast<int>(frame.pitch()));
    return frame;
}

}  // namespace burnish::view
