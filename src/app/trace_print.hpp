#pragma once

#include <burnish/trace.hpp>
#include <string>

/// A traced pixel as text for people and for programs.
namespace burnish::app {

/// Aligned tables, about 140 columns wide.
std::string trace_text(const PixelTrace& trace, const Scene& scene);
/// One object, one line; numbers that are not finite become null.
std::string trace_json(const PixelTrace& trace, const Scene& scene);

/// As in scene files.
const char* blend_factor_name(BlendFactor factor);
const char* blend_equation_name(BlendEquation equation);

/// "rgba8", "rgba16" or "rgba32f", as in scene files.
const char* format_name(PixelFormat format);
/// As in scene files.
const char* filter_name(Filter filter);

}  // namespace burnish::app
