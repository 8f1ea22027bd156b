#pragma once

#include "shade/shading.hpp"

namespace burnish {

/// `shading.inputs` as packets run them: where they begin with lighting and a quartet of many bytes
/// follows, its addresses come first and its texels are asked for, so that they arrive while
/// lighting waits for divisions and roots. Channels of quartets that the program never reads are
/// left out.
std::vector<InputOp> plan_packet_inputs(const Shading& shading);

}  // namespace burnish
