#pragma once

#include <filesystem>
#include <string>

namespace burnish::lab {

/// Text within gnuplot's double quotes, shown as it is.
std::string gnuplot_text(const std::string& text);

/// Runs gnuplot (Debian package gnuplot-nox) on a script; a line about what went wrong, or nothing.
std::string run_gnuplot(const std::filesystem::path& script);

/// The picture that plotting commands draw, as the text of an SVG file. Throws Error{io} where
/// gnuplot is not there or fails.
std::string svg_by_gnuplot(const std::string& commands, int width, int height);

}  // namespace burnish::lab
