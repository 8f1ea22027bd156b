#pragma once

#include "metrics/filter_bank.hpp"

namespace burnish::metrics {

/// Results of the bank, for the first picture; those of the second one follow.
enum class FlipResult {
    y,          ///< Y as the eye's contrast sensitivity lets it through
    cx,         ///< Cx
    cz_narrow,  ///< Cz is the sum of two
    cz_wide,
    edge_x,  ///< first derivatives of (Y + 16) / 116
    edge_y,
    point_x,  ///< second ones
    point_y,
    count
};

/// Planes Y, Cx, Cz of the test, then of the reference (HPG 2020, sections 4.1.1 and 4.2).
FilterBank flip_bank(double pixels_per_degree);

}  // namespace burnish::metrics
