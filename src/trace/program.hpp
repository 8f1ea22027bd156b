#pragma once

#include <burnish/trace.hpp>

#include "trace/fragment.hpp"

namespace burnish {

/// Runs `program` on both kinds of numbers. Sets stages, codes and color of `out`.
void trace_program(const ProgramMaterial& program, const Machine& machine,
                   const FragmentInputs& inputs, TracedFragment& out);

}  // namespace burnish
