#pragma once

#include <burnish/framebuffer.hpp>

namespace burnish::view {

/// Mean over r, g, b of |test - truth| times `gain`, in the colours of metrics/heat_map.hpp, rgba8.
/// Both are rgba32f and of one size; of the truth what is more than 1 is 1, as machines have it.
Framebuffer error_map(const Framebuffer& test, const Framebuffer& truth, double gain);

}  // namespace burnish::view
