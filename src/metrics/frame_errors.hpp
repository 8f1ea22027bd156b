#pragma once

#include <burnish/framebuffer.hpp>
#include <cstddef>

#include "metrics/selection.hpp"

namespace burnish::metrics {

/// How far a picture is from another one, in numbers of the frame (0 .. 1 is the usual range), over
/// all three channels of the selected pixels. All 0 if there are none.
struct FrameErrors {
    std::size_t pixels = 0;  ///< that were compared
    double rmse = 0.0;
    double p99 = 0.0;      ///< 99 of 100 absolute differences are at most this large
    double largest = 0.0;  ///< absolute difference
    double bias = 0.0;     ///< mean difference, positive where `test` is brighter
    double test_sum = 0.0;
    double reference_sum = 0.0;
    /// Largest |test_i - test_j| - |reference_i - reference_j| of two pixels side by side or one
    /// above the other: an edge that the reference does not have. Negative if there is none at all;
    /// -1 without two neighbours.
    double step_excess = 0.0;
};

/// Sums row by row, then over the rows: the same numbers with any number of workers. Both frames
/// are rgba32f and of the selection's size.
FrameErrors frame_errors(const Framebuffer& test, const Framebuffer& reference,
                         const Selection& selection, WorkerPool& pool);

/// The same over the interior pixels, by one worker.
FrameErrors interior_errors(const Framebuffer& test, const Framebuffer& reference);

/// Largest r, g or b of the selected pixels of an rgba32f frame, and its channel; 0 if there are
/// none or none is positive.
struct Peak {
    double value = 0.0;
    int channel = 0;
};
Peak peak(const Framebuffer& frame, const Selection& selection);

/// Value of the peak of the interior pixels.
double interior_peak(const Framebuffer& frame);

/// How finely a picture resolves the highlight: how many values its pixels have where the reference
/// is above half of its peak, in the channel of that peak. `reference` counts its own there.
struct Levels {
    std::size_t test = 0;
    std::size_t reference = 0;
};
Levels highlight_levels(const Framebuffer& test, const Framebuffer& reference,
                        const Selection& selection);

}  // namespace burnish::metrics
