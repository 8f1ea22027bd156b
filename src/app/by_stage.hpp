#pragma once

#include "app/command_line.hpp"

namespace burnish::app {

/// `burnish trace --by-stage`: where the error of a picture, or of one pixel, comes from.
void trace_by_stage(const TraceOptions& options);

}  // namespace burnish::app
