#pragma once

#include <burnish/combiner.hpp>
#include <string>

#include "program/operand.hpp"

namespace burnish {

/// `input` as take_operand reads it at `place`, without what is the default there.
std::string print_operand(const Input& input, Place place);

}  // namespace burnish
