#pragma once

#include <burnish/trace.hpp>

#include "draw.hpp"
#include "machine/interpreter.hpp"
#include "trace/visible.hpp"

namespace burnish {

/// What the program of a fragment starts from.
struct FragmentInputs {
    RegisterFile codes;
    RealRegisters exact;
    Registers<bool> filled;  ///< false: an input that nothing reads and hence nothing feeds
    // Fetches between stages: to be asked in the order of the program, once; they refer to the
    // draw.
    FetchCodes fetch;
    FetchReals fetch_exactly;
};

/// Which of the texels around the sample point a program runs at, with FilterOrder::after.
struct CornerChoice {
    bool above = false;  ///< of the upper one of two levels
    bool right = false, below = false;
};

/// Interpolates at pixel (x, y) of the window and feeds the registers: by the scalar kernels, and
/// exactly. `draw` was prepared with Wanted::everything. Sets barycentrics, interpolants and
/// fetches of `out`, and its corner where the draw has corners, `at` one of them.
FragmentInputs trace_inputs(const Draw& draw, const SetupTriangle& triangle, std::int32_t x,
                            std::int32_t y, const CornerChoice* at, TracedFragment& out);

}  // namespace burnish
