#pragma once

#include <sched.h>

#include <vector>

namespace burnish::peers {

/// The numbers of the cores that this thread may run on, rising.
std::vector<int> allowed_cores();

/// From now on a thread runs on one core alone. 0 is the caller's.
void pin_thread(pid_t thread, int core);

/// Each thread of this process on a core of its own, in the order in which they began and round
/// again; none if `workers` are more than there are cores.
void spread_threads(int workers);

/// Nanoseconds until one core reads what another one wrote, between the first two allowed ones: the
/// least of several series. 0 where there is only one.
double line_transfer();

/// Cores that share a cache pass a line on in some 30 ns, others take 100 and more.
inline constexpr double kFarApart = 80.0;

}  // namespace burnish::peers
