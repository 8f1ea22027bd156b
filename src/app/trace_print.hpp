#pragma once

#include <array>
#include <burnish/trace.hpp>
#include <string>
#include <vector>

/// A traced pixel as text for people and for programs.
namespace burnish::app {

/// Aligned tables, about 140 columns wide.
std::string trace_text(const PixelTrace& trace, const Scene& scene);
/// One object, one line; numbers that are not finite become null.
std::string trace_json(const PixelTrace& trace, const Scene& scene);

/// A pixel that is the mean of several samples, which are pixels of a larger picture
/// (app/supersample.hpp).
struct TracedSamples {
    int x, y;                         ///< of the pixel
    int side;                         ///< samples per pixel: its square
    std::vector<PixelTrace> samples;  ///< row by row
    std::array<double, 4> stored;     ///< their mean, as the frame holds it
};

/// A table of the samples, then each as `trace_text` has it.
std::string samples_text(const TracedSamples& traced, const Scene& scene, const Scene& large);
/// One object, one line: each sample as `trace_json` has it.
std::string samples_json(const TracedSamples& traced, const Scene& scene, const Scene& large);

/// As in scene files.
const char* blend_factor_name(BlendFactor factor);
const char* blend_equation_name(BlendEquation equation);

/// "rgba8", "rgba16" or "rgba32f", as in scene files.
const char* format_name(PixelFormat format);
/// As in scene files.
const char* filter_name(Filter filter);

}  // namespace burnish::app
