#include "core/work_order.hpp"

#include <algorithm>
#include <functional>
#include <numeric>
#include <queue>
#include <utility>

namespace burnish {

void order_work(std::span<const PieceOutlook> outlook, int workers, WorkOrder& order) {
    constexpr std::uint64_t kPartsOfShare = 16;
    const auto count = static_cast<std::size_t>(workers);
    std::uint64_t total = 0, weightless = 0;
    for (const PieceOutlook& piece : outlook) {
        total += piece.weight;
        weightless += piece.weight == 0 ? 1 : 0;
    }
    const std::uint64_t heavy =
        workers == 1 ? total : total / (kPartsOfShare * static_cast<std::uint64_t>(workers));
    // By counting: the shared ones, then of each part those with weight and those without.
    const auto place_of = [&](const PieceOutlook& piece, std::uint64_t& seen_weightless) {
        if (piece.weight == 0) return 2 * (seen_weightless++ * count / weightless) + 2;
        return piece.weight > heavy ? 0 : 2 * static_cast<std::size_t>(piece.owner) + 1;
    };
    std::vector<std::size_t> begin(2 * count + 2, 0);
    std::uint64_t seen = 0;
    for (const PieceOutlook& piece : outlook) ++begin[place_of(piece, seen) + 1];
    for (std::size_t i = 1; i < begin.size(); ++i) begin[i] += begin[i - 1];
    order.shared = begin[1];
    order.ends.clear();
    for (std::size_t i = 0; i < count; ++i) order.ends.push_back(begin[2 * i + 3]);
    order.pieces.resize(outlook.size());
    seen = 0;
    for (std::size_t i = 0; i < outlook.size(); ++i)
        order.pieces[begin[place_of(outlook[i], seen)]++] = static_cast<std::uint32_t>(i);
    std::stable_sort(
        order.pieces.begin(), order.pieces.begin() + static_cast<std::ptrdiff_t>(order.shared),
        [&](std::uint32_t a, std::uint32_t b) { return outlook[a].weight > outlook[b].weight; });
}

double finishing_time(std::span<const double> cost, const WorkOrder& order) {
    const std::size_t workers = order.ends.size();
    std::vector<std::size_t> next(workers, order.shared);
    for (std::size_t i = 1; i < workers; ++i) next[i] = order.ends[i - 1];
    std::size_t next_shared = 0;
    const std::span<const std::uint32_t> pieces(order.pieces);
    const auto take = [&](std::size_t worker) -> std::span<const std::uint32_t> {
        if (next_shared < order.shared) return pieces.subspan(next_shared++, 1);
        for (std::size_t k = 0; k < workers; ++k) {
            const std::size_t part = (worker + k) % workers, first = next[part];
            if (first >= order.ends[part]) continue;
            next[part] += handful(order.ends[part] - first, workers);
            return pieces.subspan(first, next[part] - first);
        }
        return {};
    };
    using Free = std::pair<double, std::size_t>;  // when, who
    std::priority_queue<Free, std::vector<Free>, std::greater<>> free;
    for (std::size_t i = 0; i < workers; ++i) free.emplace(0.0, i);
    double last = 0.0;
    while (!free.empty()) {
        const auto [time, worker] = free.top();
        free.pop();
        last = time;
        const std::span<const std::uint32_t> taken = take(worker);
        if (taken.empty()) continue;
        free.emplace(std::accumulate(taken.begin(), taken.end(), time,
                                     [&](double t, std::uint32_t i) { return t + cost[i]; }),
                     worker);
    }
    return last;
}

}  // namespace burnish
