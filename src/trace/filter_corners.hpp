#pragma once

#include <burnish/trace.hpp>
#include <span>

namespace burnish {

/// What the filter after combining makes of the colours of four corners, or of eight in two levels:
/// sets codes and color, light_codes and light_color of `out`.
void filter_corners(NumberModel numbers, std::span<const TracedFragment> corners,
                    TracedFragment& out);

}  // namespace burnish
