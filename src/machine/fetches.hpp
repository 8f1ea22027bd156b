#pragma once

#include <burnish/combiner.hpp>

namespace burnish {

/// Throws Error{bad_program} for a program that fetches between general stages, where nothing can
/// serve the fetches.
void require_no_fetches(const CombinerProgram& program);

}  // namespace burnish
