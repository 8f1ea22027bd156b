#pragma once

#include <SDL.h>

#include <optional>
#include <span>

namespace burnish::view {

/// What a key does.
enum class Action {
    view_front,
    view_right,
    view_top,
    view_isometric,
    reset_camera,
    key_list,
    screenshot,
    screenshot_window,
    next_file,
    previous_file,
    reload,
    split,
    heat_map,
    next_machine,
    panels,
    program,
    frame_graph,
    forget_pixel,
    quit,
};

struct KeyBinding {
    SDL_Keycode key;
    bool shift;
    Action action;
    const char* name;  ///< of the key
    const char* text;  ///< what it does, for the list
};

/// All keys, in the order of the list.
std::span<const KeyBinding> key_bindings();

std::optional<Action> action_of(const SDL_KeyboardEvent& event);

/// What the mouse does, for the same list: name and text.
struct MouseHint {
    const char* name;
    const char* text;
};
std::span<const MouseHint> mouse_hints();

}  // namespace burnish::view
