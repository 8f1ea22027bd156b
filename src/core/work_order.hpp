#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace burnish {

/// In what order pieces of work are handed out.
struct WorkOrder {
    std::vector<std::uint32_t> pieces;  ///< each once
    /// The first ones are taken by whoever is free. The others are divided evenly, in this order:
    /// each worker takes its own part one by one, then what is left of the next workers' parts.
    std::size_t shared = 0;
};

/// Heavy pieces first and heaviest first, so that none of them begins when the others are done; the
/// rest as it comes, since neighbours share what is in a cache. A piece is heavy if a worker that
/// begins it last could be late by more than a sixteenth of its share of the whole.
/// @param weight  of each piece, any unit
void order_work(std::span<const std::uint32_t> weight, int workers, WorkOrder& order);

/// When the last worker is done, if every piece takes its cost and the next one is taken at once.
double finishing_time(std::span<const double> cost, const WorkOrder& order, int workers);

}  // namespace burnish
