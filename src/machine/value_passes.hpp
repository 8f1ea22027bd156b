#pragma once

#include <burnish/multipass.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace burnish {

/// Passes that each compute what is wanted from the start, without what it does not need, and with
/// frames of earlier passes in place of what it would take too many units or stages to compute
/// again. Values with a sign are computed again wherever they are needed. Fetches between stages
/// become dependent reads. (The cuts of multipass.cpp keep everything that is alive at a cut
/// instead, and need no room for computing it twice.)
/// Nothing, and why in `obstacle`, where there is no such split.
std::optional<std::vector<ProgramPass>> passes_by_value(const CombinerProgram& program,
                                                        const Machine& machine,
                                                        std::span<const UnitTexels> units,
                                                        std::string& obstacle);

}  // namespace burnish
