#include "view/keys.hpp"

#include <array>

namespace burnish::view {
namespace {

constexpr std::array kBindings{
    KeyBinding{SDLK_1, false, Action::view_front, "1", "from the front"},
    KeyBinding{SDLK_3, false, Action::view_right, "3", "from the right"},
    KeyBinding{SDLK_7, false, Action::view_top, "7", "from above"},
    KeyBinding{SDLK_9, false, Action::view_isometric, "9", "from a corner"},
    KeyBinding{SDLK_RETURN, false, Action::reset_camera, "Enter", "camera and light as loaded"},
    KeyBinding{SDLK_m, false, Action::next_machine, "M", "the next machine"},
    KeyBinding{SDLK_s, false, Action::split, "S", "all machines side by side"},
    KeyBinding{SDLK_e, false, Action::heat_map, "E", "error against double precision"},
    KeyBinding{SDLK_t, false, Action::forget_pixel, "T", "close the trace of a pixel"},
    KeyBinding{SDLK_p, false, Action::program, "P", "the program of a material"},
    KeyBinding{SDLK_g, false, Action::frame_graph, "G", "times of frames and stages"},
    KeyBinding{SDLK_TAB, false, Action::panels, "Tab", "panels on and off"},
    KeyBinding{SDLK_RIGHT, false, Action::next_file, "Right", "next file of the directory"},
    KeyBinding{SDLK_LEFT, false, Action::previous_file, "Left", "previous file"},
    KeyBinding{SDLK_r, false, Action::reload, "R", "read the file again"},
    KeyBinding{SDLK_F12, false, Action::screenshot, "F12",
               "save the picture, with the state in it"},
    KeyBinding{SDLK_F12, true, Action::screenshot_window, "Shift F12",
               "save the window, panels too"},
    KeyBinding{SDLK_h, false, Action::key_list, "H", "this list"},
    KeyBinding{SDLK_ESCAPE, false, Action::quit, "Esc", "quit"},
};

constexpr std::array kHints{
    MouseHint{"left drag", "orbit; on a line of the split picture: move it"},
    MouseHint{"click", "trace the pixel"},
    MouseHint{"wheel, right drag", "zoom"},
    MouseHint{"middle or Shift drag", "pan"},
    MouseHint{"L + drag", "turn the light"},
    MouseHint{"drop a file", "look at it"},
};

}  // namespace

std::span<const KeyBinding> key_bindings() {
    return kBindings;
}

std::span<const MouseHint> mouse_hints() {
    return kHints;
}

std::optional<Action> action_of(const SDL_KeyboardEvent& event) {
    const bool shift = (event.keysym.mod & KMOD_SHIFT) != 0;
    SDL_Keycode key = event.keysym.sym;
    if (key == SDLK_KP_ENTER) key = SDLK_RETURN;
    if (key >= SDLK_KP_1 && key <= SDLK_KP_9) key = SDLK_1 + (key - SDLK_KP_1);
    for (const KeyBinding& binding : kBindings) {
        const bool shift_counts = binding.key == SDLK_F12;
        if (binding.key == key && (!shift_counts || binding.shift == shift)) return binding.action;
    }
    return std::nullopt;
}

}  // namespace burnish::view
