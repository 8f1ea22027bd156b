#pragma once

#include <burnish/machine.hpp>
#include <burnish/scene.hpp>

namespace burnish {

/// How far a compiled model's numbers are from its formula's, of the 0 .. 1 of a frame, under a
/// light that makes the peak 0.9.
struct ErrorEstimate {
    double rms = 0.0;      ///< root of the mean square
    double largest = 0.0;  ///< what 99 of 100 differences stay within
};

/// Throws what compile_model throws.
ErrorEstimate estimate_error(const Material& material, const Machine& machine);

}  // namespace burnish
