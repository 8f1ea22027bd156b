#pragma once

#include <SDL.h>

#include <filesystem>
#include <optional>
#include <string>

#include "view/file_watch.hpp"
#include "view/frame_times.hpp"
#include "view/keys.hpp"
#include "view/load_thread.hpp"
#include "view/panels.hpp"
#include "view/picture_thread.hpp"
#include "view/session.hpp"
#include "view/view.hpp"
#include "view/window.hpp"

namespace burnish::view {

/// The loop: events to the session, the session's wishes to the picture thread, its pictures and
/// the panels to the window.
class Viewer {
  public:
    Viewer(const ViewRequest& request, Session session);
    /// The window is gone at once, a file that is being read is waited for.
    ~Viewer();
    Viewer(const Viewer&) = delete;
    Viewer& operator=(const Viewer&) = delete;
    /// Until the window is closed.
    void run();

  private:
    void wait_for_events();
    void handle(const SDL_Event& event);
    void handle_key(const SDL_KeyboardEvent& event);
    void handle_button(const SDL_MouseButtonEvent& event);
    void handle_motion(const SDL_MouseMotionEvent& event);
    void act(Action action);
    void look_at_files();
    void order(LoadOrder order);
    void read_again();
    void step_file(int direction);
    void take_loaded();
    void ask_for_picture();
    void take_picture();
    void draw();
    void save_screenshot();
    [[nodiscard]] bool is_moving() const;
    /// The picture is the last one of what was asked for last.
    [[nodiscard]] bool is_at_rest() const;
    [[nodiscard]] std::optional<std::size_t> line_at(int x) const;

    const ViewRequest& m_request;
    Session m_session;
    Window m_window;
    LoadThread m_loads;
    PictureThread m_pictures;
    FileWatch m_watch;
    FrameTimes m_times;
    OpenPanels m_open;
    std::optional<Picture> m_picture;

    /// What a wish is made from, but for the input's own contents.
    struct Asked {
        ViewState state;
        int threads;
        std::string isa;
        bool accounting, programs, moving;
        friend bool operator==(const Asked&, const Asked&) = default;
    };

    std::uint64_t m_wish = 0;      ///< number of the last wish
    std::optional<Asked> m_asked;  ///< what the last wish was about; nothing: ask again
    double m_looked_ms = 0.0;      ///< when files were looked at
    int m_draws = 0;               ///< frames until the panels have come to rest
    int m_focus_draws = 0;         ///< frames until they know where a click's keys go
    bool m_panels = true;
    bool m_running = true;
    bool m_wants_shot = false;  ///< as soon as the picture is at rest
    bool m_wants_window_shot = false;

    glm::ivec2 m_pressed{0, 0};         ///< where a button went down
    bool m_dragged = false;             ///< since then
    std::optional<std::size_t> m_line;  ///< of the split picture, in a hand
};

}  // namespace burnish::view
