#pragma once

#include <string>

#include "lab/attribution.hpp"

/// Error by stage as a picture: bars from what the error was before a stage to what it is with it.
/// Both return the text of an SVG file and throw what svg_by_gnuplot throws.
namespace burnish::lab {

/// RMSE from the exact picture, the machine's own picture last; points: what each stage does alone,
/// and what is left without it.
std::string waterfall(const Attribution& attribution, const std::string& title);

/// Of one pixel: changes of red, green and blue, in codes of 255.
std::string waterfall(const PixelAttribution& attribution, const std::string& title);

}  // namespace burnish::lab
