#pragma once

#include <burnish/framebuffer.hpp>

#include "metrics/selection.hpp"

namespace burnish::lab {

/// What became of the highlight: the selected pixels above half of the reference's peak, in the
/// peak's channel.
struct HighlightChange {
    double area_ratio;        ///< how many of the test's, over how many of the reference's
    double shift_x, shift_y;  ///< from the reference's centre of gravity to the test's, in pixels,
                              ///< pixels weighted with what they are above half; NaN without any
};

/// Both frames are rgba32f and of the selection's size.
HighlightChange highlight_change(const Framebuffer& test, const Framebuffer& reference,
                                 const metrics::Selection& selection);

}  // namespace burnish::lab
