#pragma once

#include <cstdint>

#include "kernels/kernel_table.hpp"

namespace burnish {

/// Whether instructions can be counted here: on x86-64, by the processor's single-step trap, which
/// knows every instruction set that it can run.
bool can_count_instructions();

/// The kernels of `table`, each of them counted; of vertices or triangles they get at most 128. One
/// table at a time.
KernelTable counted_kernels(const KernelTable& table);

/// Of the last call of a counted kernel, that call included.
std::uint64_t counted_instructions();

}  // namespace burnish
