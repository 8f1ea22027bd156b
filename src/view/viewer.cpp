#include "view/viewer.hpp"

#include <backends/imgui_impl_sdl.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <burnish/error.hpp>
#include <burnish/files.hpp>
#include <burnish/materials.hpp>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "core/dmath.hpp"

namespace burnish::view {
namespace {

/// A picture smaller than the window looks worse than fifty frames a second.
constexpr double kBudgetMs = 20.0;
/// Files are looked at so often.
constexpr double kWatchMs = 250.0;
/// A hand that moved less has clicked.
constexpr int kClickPixels = 3;
constexpr int kLinePixels = 6;
/// Panels need a frame to take an event in and one to come to rest.
constexpr int kDrawsAfterEvent = 3;
/// After so many frames they know whether a click chose a text, for which keys behind it are.
constexpr int kFocusDraws = 2;
constexpr const char* kTitle = "burnish";

double now_ms() {
    return std::chrono::duration<double, std::milli>(
               std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

Uint32 wake_event() {
    static const Uint32 type = SDL_RegisterEvents(1);
    return type;
}

/// The window's thread, from another one.
void wake() {
    SDL_Event event{};
    event.type = wake_event();
    SDL_PushEvent(&event);
}

const char* fineness_name(Fineness fineness) {
    constexpr const char* kNames[] = {"within budget", "full", "4 samples", "16 samples"};
    return kNames[static_cast<int>(fineness)];
}

/// The first of "STEM-view-0001.png" ... that is not there.
std::filesystem::path free_name(const std::filesystem::path& input) {
    const std::string stem = input.stem().string();
    for (int number = 1; number < 10000; ++number) {
        const std::filesystem::path name = fmt::format("{}-view-{:04}.png", stem, number);
        std::error_code ignored;
        if (!std::filesystem::exists(name, ignored)) return name;
    }
    throw Error(ErrorCode::io, "screenshot: 9999 files are there already");
}

/// Nearer by a tenth with each notch of the wheel.
float zoom_of(float notches) {
    return static_cast<float>(dmath::pow(1.1, static_cast<double>(notches)));
}

/// As one that can be read from anywhere.
ViewState with_absolute_input(ViewState state) {
    std::error_code failure;
    const std::filesystem::path whole = std::filesystem::absolute(state.input, failure);
    if (!failure) state.input = whole.lexically_normal();
    return state;
}

}  // namespace

Viewer::Viewer(const ViewRequest& request, Session session)
    : m_request(request),
      m_session(std::move(session)),
      m_window(kTitle, {m_session.state.width, m_session.state.height}),
      m_loads(request.load, wake),
      m_pictures(request.draw, kBudgetMs, wake) {
    m_watch.watch_input(m_session.state.input);
    m_session.renderer = request.renderer;
}

Viewer::~Viewer() {
    m_window.hide();
}

bool Viewer::is_moving() const {
    return m_dragged || (ImGui::IsAnyItemActive() && !ImGui::GetIO().WantTextInput);
}

bool Viewer::is_at_rest() const {
    return m_picture && m_picture->is_last && m_picture->id == m_wish && !m_loads.pending() &&
           !is_moving();
}

std::optional<std::size_t> Viewer::line_at(int x) const {
    if (!m_session.state.split) return std::nullopt;
    const std::array<float, 3>& lines = m_session.state.lines;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const float at = lines[i] * static_cast<float>(m_session.state.width);
        if (std::abs(at - static_cast<float>(x)) <= kLinePixels) return i;
    }
    return std::nullopt;
}

void Viewer::act(Action action) {
    ViewState& state = m_session.state;
    switch (action) {
        case Action::view_front:
            return m_session.look_from(Side::front);
        case Action::view_right:
            return m_session.look_from(Side::right);
        case Action::view_top:
            return m_session.look_from(Side::top);
        case Action::view_isometric:
            return m_session.look_from(Side::isometric);
        case Action::reset_camera:
            return m_session.reset_camera();
        case Action::key_list:
            m_open.key_list = !m_open.key_list;
            return;
        case Action::screenshot:
            m_wants_shot = true;
            return;
        case Action::screenshot_window:
            m_wants_window_shot = true;
            return;
        case Action::next_file:
            return step_file(1);
        case Action::previous_file:
            return step_file(-1);
        case Action::reload:
            return read_again();
        case Action::split:
            state.split = !state.split;
            return;
        case Action::heat_map:
            state.heat_map = !state.heat_map;
            return;
        case Action::next_machine: {
            const std::vector<std::string_view> names = machine_profile_names();
            const std::string shown =
                state.machine.empty() ? m_session.loaded().machine.name : state.machine;
            const auto here = std::find(names.begin(), names.end(), shown);
            const bool last = here == names.end() || here + 1 == names.end();
            state.machine = last ? names.front() : *(here + 1);
            return;
        }
        case Action::panels:
            m_panels = !m_panels;
            return;
        case Action::program:
            m_open.program = !m_open.program;
            return;
        case Action::frame_graph:
            m_open.frame_graph = !m_open.frame_graph;
            return;
        case Action::forget_pixel:
            state.pixel.reset();
            return;
        case Action::quit:
            m_running = false;
            return;
    }
}

void Viewer::handle_key(const SDL_KeyboardEvent& event) {
    const std::optional<Action> action = action_of(event);
    if (!action) return;
    // Other keys write where there is a text.
    const bool always = action == Action::screenshot || action == Action::screenshot_window;
    if (always || !ImGui::GetIO().WantTextInput) act(*action);
}

void Viewer::handle_button(const SDL_MouseButtonEvent& event) {
    if (event.type == SDL_MOUSEBUTTONDOWN) {
        m_pressed = {event.x, event.y};
        m_dragged = false;
        m_line.reset();
        if (event.button == SDL_BUTTON_LEFT) m_line = line_at(event.x);
        return;
    }
    const bool clicked = !m_dragged && !m_line && event.button == SDL_BUTTON_LEFT;
    if (clicked && !ImGui::GetIO().WantCaptureMouse) m_session.state.pixel = {event.x, event.y};
    if (m_dragged) m_asked.reset();  // what was drawn in haste is drawn again
    m_dragged = false;
    m_line.reset();
}

void Viewer::handle_motion(const SDL_MouseMotionEvent& event) {
    if (event.state == 0) return;
    const glm::ivec2 way = glm::ivec2(event.x, event.y) - m_pressed;
    if (!m_dragged && std::abs(way.x) < kClickPixels && std::abs(way.y) < kClickPixels) return;
    m_dragged = true;
    const auto height = static_cast<float>(m_session.state.height);
    const float right = static_cast<float>(event.xrel) / height;
    const float down = static_cast<float>(event.yrel) / height;
    const bool shift = (SDL_GetModState() & KMOD_SHIFT) != 0;
    if (m_line) {
        std::array<float, 3>& lines = m_session.state.lines;
        const float low = *m_line == 0 ? 0.0F : lines[*m_line - 1];
        const float high = *m_line == 2 ? 1.0F : lines[*m_line + 1];
        const float at = static_cast<float>(event.x) / static_cast<float>(m_session.state.width);
        lines[*m_line] = std::clamp(at, low, high);
    } else if (SDL_GetKeyboardState(nullptr)[SDL_SCANCODE_L] != 0) {
        m_session.turn_light(right, down);
    } else if ((event.state & SDL_BUTTON_MMASK) != 0 || shift) {
        m_session.pan(right, down);
    } else if ((event.state & SDL_BUTTON_RMASK) != 0) {
        m_session.zoom(zoom_of(-30.0F * down));
    } else {
        m_session.orbit(right, down);
    }
}

void Viewer::handle(const SDL_Event& event) {
    ImGui_ImplSDL2_ProcessEvent(&event);
    const ImGuiIO& io = ImGui::GetIO();
    switch (event.type) {
        case SDL_QUIT:
            m_running = false;
            break;
        case SDL_KEYDOWN:
            handle_key(event.key);
            break;
        case SDL_MOUSEBUTTONDOWN:
        case SDL_MOUSEBUTTONUP:
            if (!io.WantCaptureMouse || event.type == SDL_MOUSEBUTTONUP)
                handle_button(event.button);
            break;
        case SDL_MOUSEMOTION:
            if (!io.WantCaptureMouse) handle_motion(event.motion);
            break;
        case SDL_MOUSEWHEEL:
            if (!io.WantCaptureMouse) m_session.zoom(zoom_of(static_cast<float>(event.wheel.y)));
            break;
        case SDL_DROPFILE:
            order({event.drop.file});
            SDL_free(event.drop.file);
            break;
        default:
            break;
    }
    if (event.type != wake_event()) m_draws = kDrawsAfterEvent;
}

void Viewer::wait_for_events() {
    SDL_Event event;
    const int patience = m_draws > 0 ? 1 : static_cast<int>(kWatchMs);
    if (SDL_WaitEventTimeout(&event, patience) == 0) return;
    do {
        // Whose click it is depends on what lies under the mouse, which panels find out as they
        // are made.
        const bool is_button = event.type == SDL_MOUSEBUTTONDOWN || event.type == SDL_MOUSEBUTTONUP;
        if (is_button) draw();
        const bool is_key = event.type == SDL_KEYDOWN || event.type == SDL_KEYUP;
        while (is_key && m_focus_draws > 0) draw();
        handle(event);
        if (is_button) m_focus_draws = kFocusDraws;
        // Dear ImGui sees what is pressed as it makes panels: a key that came and went between two
        // frames would be lost.
        if (is_key && ImGui::GetIO().WantTextInput) draw();
    } while (SDL_PollEvent(&event) != 0);
}

void Viewer::look_at_files() {
    // A change is not forgotten: it is seen when what is being read is there, or cannot be.
    if (m_loads.pending()) return;
    const double now = now_ms();
    if (now - m_looked_ms < kWatchMs) return;
    m_looked_ms = now;
    if (m_watch.changed()) read_again();
}

void Viewer::order(LoadOrder order) {
    m_window.set_title(fmt::format("burnish: reading {}", order.input.filename().string()));
    m_loads.order(std::move(order));
}

void Viewer::read_again() {
    const LoadOrder again{m_session.state.input, LoadOrder::Purpose::again};
    order(m_loads.pending().value_or(again));
}

void Viewer::step_file(int direction) {
    const std::optional<LoadOrder>& pending = m_loads.pending();
    const auto next = neighbour(pending ? pending->input : m_session.state.input, direction);
    if (next) order({*next, LoadOrder::Purpose::step});
}

void Viewer::take_loaded() {
    std::optional<Loaded> loaded = m_loads.take();
    if (!loaded) return;
    m_window.set_title(kTitle);
    const std::filesystem::path input = loaded->order.input;
    FileWatch files = std::move(loaded->files);
    m_session.take(std::move(*loaded));
    if (m_session.state.input == input) m_watch = std::move(files);
    m_asked.reset();
    m_draws = kDrawsAfterEvent;
}

void Viewer::ask_for_picture() {
    const glm::ivec2 size = m_window.size();
    m_session.state.width = size.x;
    m_session.state.height = size.y;
    const bool moving = is_moving();
    m_session.shows_programs = m_open.program && m_panels;
    m_session.renderer.accounting = m_open.frame_graph && m_panels;
    Asked asked{m_session.state,          m_session.renderer.threads,
                m_session.renderer.isa,   m_session.renderer.accounting,
                m_session.shows_programs, moving};
    if (asked == m_asked) return;
    m_asked = std::move(asked);
    m_draws = kDrawsAfterEvent;
    std::optional<Wish> wish = m_session.wish(moving);
    if (!wish) return;
    m_wish = wish->id;
    m_pictures.wish(std::move(*wish));
}

void Viewer::take_picture() {
    std::optional<Picture> picture = m_pictures.take();
    if (!picture) return;
    m_picture = std::move(picture);
    m_draws = std::max(m_draws, m_picture->is_last ? kDrawsAfterEvent : 1);
    if (m_picture->fineness == Fineness::within_budget)
        m_times.shown(*m_picture, now_ms());
    else
        m_times.rest();
    if (!m_request.report || !is_at_rest()) return;
    fmt::print("{}: {} x {}, {}", m_session.state.input.string(), m_picture->frame.width(),
               m_picture->frame.height(), fineness_name(m_picture->fineness));
    for (const PaneReport& pane : m_picture->panes)
        fmt::print(", {} {:.2f} ms{}", pane.machine, pane.ms,
                   pane.error.empty() ? "" : ": " + pane.error);
    fmt::print("\n");
    std::fflush(stdout);
}

void Viewer::save_screenshot() {
    try {
        const std::filesystem::path name = free_name(m_session.state.input);
        const std::string text = view_state_text(with_absolute_input(m_session.state));
        if (m_wants_window_shot)
            save_image(m_window.shot(), name, text);
        else
            save_image(m_picture->frame, name, text);
        if (!m_request.quiet) fmt::print("{}\n", name.string());
        std::fflush(stdout);
        m_session.shot_message.clear();
    } catch (const Error& error) {
        m_session.shot_message = error.what();
    }
    m_draws = kDrawsAfterEvent;  // the message, or that there is none
    m_wants_shot = false;
    m_wants_window_shot = false;
}

void Viewer::draw() {
    if (m_focus_draws > 0) --m_focus_draws;
    m_window.begin_panels();
    const Picture* picture = m_picture ? &*m_picture : nullptr;
    picture_overlay(m_session, picture);
    if (m_panels) {
        if (m_open.controls) controls_panel(m_session, picture);
        trace_panel(m_session, picture);
        if (m_open.program) program_panel(m_session, picture);
        if (m_open.frame_graph) frame_graph_panel(m_times, picture);
    }
    if (m_open.key_list) key_list_panel(m_open);
    m_window.show(m_picture ? &m_picture->frame : nullptr);
}

void Viewer::run() {
    while (m_running) {
        wait_for_events();
        look_at_files();
        take_loaded();
        ask_for_picture();
        take_picture();
        if (m_draws > 0) {
            draw();
            --m_draws;
        }
        if ((m_wants_shot || m_wants_window_shot) && m_draws == 0 && is_at_rest())
            save_screenshot();
    }
    if (!m_request.save_state.empty())
        save_text(view_state_text(with_absolute_input(m_session.state)), m_request.save_state);
    if (m_request.report) fmt::print("{}\n", m_times.json());
}

}  // namespace burnish::view
