#pragma once

#include <span>
#include <string_view>

#include "kernels/kernel_table.hpp"

namespace burnish {

/// Kernel tables that this CPU *and* operating system can run, best first; the reference is last.
std::span<const KernelTable* const> available_tables();

/// The table called `name`; if `name` is empty, the one named by the environment variable
/// BURNISH_ISA; if that is empty too, the best available one.
/// Throws Error{bad_option} for a name that is unknown or not available here.
const KernelTable& select_table(std::string_view name);

}  // namespace burnish
