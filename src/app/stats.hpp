#pragma once

#include <burnish/renderer.hpp>
#include <string>

/// Counts and times of frames as text for people and for programs.
namespace burnish::app {

/// One object, one line.
std::string stats_json(const FrameStats& stats, const Renderer& renderer, double frame_ms);
/// Lines of "name value".
std::string stats_text(const FrameStats& stats, const Renderer& renderer, double frame_ms);

/// A line for each stage, if the frame was accounted for.
std::string stages_text(const FrameStats& stats);

/// `text` between double quotes, with whatever JSON wants escaped.
std::string json_string(const std::string& text);

}  // namespace burnish::app
