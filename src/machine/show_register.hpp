#pragma once

#include <burnish/framebuffer.hpp>
#include <burnish/renderer.hpp>

#include "machine/bind.hpp"

namespace burnish {

/// Throws Error{bad_option} for a register that `machine` does not have or nobody can read.
void require_showable(Register reg, const Machine& machine);

/// Cuts `program` so that its end shows a register, and says what is then wanted of it.
Wanted show_register(CombinerProgram& program, const ShownRegister& shown, PixelFormat format);

}  // namespace burnish
