#pragma once

#include <optional>
#include <string>

#include "view/frame_times.hpp"
#include "view/picture.hpp"
#include "view/session.hpp"

/// The panels over the picture. Each is made anew for every frame, as Dear ImGui has it.
namespace burnish::view {

/// Which of them are open.
struct OpenPanels {
    bool controls = true;
    bool program = false;
    bool frame_graph = false;
    bool key_list = false;
};

/// File, machine, filter, mip method, threads, materials.
void controls_panel(Session& session, const Picture* picture);
/// Model and parameters of the scene's materials, inside the panel before.
void material_controls(Session& session, const Picture* picture);
/// A header that opens: the material's name, bright and opened where a pixel of it is traced.
bool material_header(const Material& material, bool open, const Picture* picture);
/// Every register after every stage at the traced pixel.
void trace_panel(Session& session, const Picture* picture);
/// The program of a material as text that may be edited, with what is wrong at its line.
void program_panel(Session& session, const Picture* picture);
/// How wide it is at first, at the right side of the window.
float program_panel_width();
/// Times of the last frames; a button copies them as JSON.
void frame_graph_panel(const FrameTimes& times, const Picture* picture);
void key_list_panel(OpenPanels& open);
/// Lines between the machines of a split picture and their names; what went wrong.
void picture_overlay(const Session& session, const Picture* picture);

/// A list of words to choose from, the first one being `none` where that is not empty. Returns
/// whether another one was chosen.
bool choose_word(const char* label, const std::vector<std::string_view>& words,
                 const std::string& none, std::string& chosen);

}  // namespace burnish::view
