#pragma once

#include <burnish/framebuffer.hpp>
#include <cstddef>

namespace burnish::lab {

/// How far a picture is from another one, in numbers of 0 .. 1, over all three channels.
struct FrameErrors {
    std::size_t pixels = 0;  ///< that were compared
    double rmse = 0.0;
    double p99 = 0.0;      ///< 99 of 100 absolute differences are at most this large
    double largest = 0.0;  ///< absolute difference
    double bias = 0.0;     ///< mean difference, positive where `got` is brighter
    /// Largest |got_i - got_j| - |want_i - want_j| of two pixels side by side or one above the
    /// other: an edge that the other picture does not have. Negative if there is none at all.
    double step_excess = 0.0;
};

/// Of the interior pixels: those that, like all of their eight neighbours, have an alpha of at
/// least 1/2 in `want`. Both frames are rgba32f and of one size; all errors are 0 without interior.
FrameErrors frame_errors(const Framebuffer& got, const Framebuffer& want);

/// Largest r, g or b of the interior pixels of an rgba32f frame; 0 without interior.
double interior_peak(const Framebuffer& frame);

}  // namespace burnish::lab
