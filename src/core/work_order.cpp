#include "core/work_order.hpp"

#include <algorithm>
#include <functional>
#include <numeric>
#include <queue>
#include <utility>

namespace burnish {

void order_work(std::span<const std::uint32_t> weight, int workers, WorkOrder& order) {
    constexpr std::uint64_t kPartsOfShare = 16;
    const std::uint64_t total = std::accumulate(weight.begin(), weight.end(), std::uint64_t{0});
    const std::uint64_t heavy = total / (kPartsOfShare * static_cast<std::uint64_t>(workers));
    order.pieces.resize(weight.size());
    std::iota(order.pieces.begin(), order.pieces.end(), 0U);
    order.shared = 0;
    if (workers == 1) return;
    const auto light =
        std::stable_partition(order.pieces.begin(), order.pieces.end(),
                              [&](std::uint32_t piece) { return weight[piece] > heavy; });
    std::stable_sort(order.pieces.begin(), light,
                     [&](std::uint32_t a, std::uint32_t b) { return weight[a] > weight[b]; });
    order.shared = static_cast<std::size_t>(light - order.pieces.begin());
}

double finishing_time(std::span<const double> cost, const WorkOrder& order, int workers) {
    const auto count = static_cast<std::size_t>(workers);
    const std::size_t divided = order.pieces.size() - order.shared;
    std::vector<std::size_t> next(count);
    const auto begin_of = [&](std::size_t part) { return order.shared + divided * part / count; };
    for (std::size_t i = 0; i < count; ++i) next[i] = begin_of(i);
    std::size_t next_shared = 0;
    const auto take = [&](std::size_t worker) -> const std::uint32_t* {
        if (next_shared < order.shared) return &order.pieces[next_shared++];
        for (std::size_t k = 0; k < count; ++k) {
            const std::size_t part = (worker + k) % count;
            if (next[part] < begin_of(part + 1)) return &order.pieces[next[part]++];
        }
        return nullptr;
    };
    using Free = std::pair<double, std::size_t>;  // when, who
    std::priority_queue<Free, std::vector<Free>, std::greater<>> free;
    for (std::size_t i = 0; i < count; ++i) free.emplace(0.0, i);
    double last = 0.0;
    while (!free.empty()) {
        const auto [time, worker] = free.top();
        free.pop();
        last = time;
        if (const std::uint32_t* piece = take(worker)) free.emplace(time + cost[*piece], worker);
    }
    return last;
}

}  // namespace burnish
