#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace burnish {

/// In what order pieces of work are handed out.
struct WorkOrder {
    std::vector<std::uint32_t> pieces;  ///< each once
    /// The first ones are taken by whoever is free. The others are parts, one for each worker: who
    /// is done with its own begins one that nobody has, then helps with the others.
    std::size_t shared = 0;
    std::vector<std::size_t> ends;  ///< of the parts in `pieces`
};

/// How many pieces of a part of which `left` > 0 are left are taken at once: to take some makes a
/// core wait until all that it wrote past its caches is in memory. Few enough that a part of which
/// all workers take has some for each to the end.
constexpr std::size_t handful(std::size_t left, std::size_t workers) {
    return std::max<std::size_t>(left / (8 * workers), 1);
}

/// What is known of a piece before it is done.
struct PieceOutlook {
    std::uint32_t weight = 0;  ///< any unit
    std::uint32_t owner = 0;  ///< worker that has most of what it reads in its cache, if weight > 0
};

/// Heavy pieces first and heaviest first, so that none of them begins when the others are done. The
/// rest as it comes, by owners: neighbours share what is in a cache. Pieces without weight are
/// divided evenly. A piece is heavy if a worker that begins it last could be late by more than a
/// sixteenth of its share of the whole.
void order_work(std::span<const PieceOutlook> outlook, int workers, WorkOrder& order);

/// When the last worker is done, if all begin at once, every piece takes its cost and the next one
/// or the next handful is taken without delay.
double finishing_time(std::span<const double> cost, const WorkOrder& order);

}  // namespace burnish
