#include "raster/tile_order.hpp"

#include <algorithm>

namespace burnish {

const WorkOrder& TileOrder::plan(std::span<const std::unique_ptr<Chunk>> chunks,
                                 std::size_t columns, std::size_t rows, int workers) {
    constexpr std::uint32_t kPixels =
        200;  // shading a whole tile takes as long as so many triangles
    const std::size_t count = columns * rows;
    m_lengths.assign(count, 0);
    m_chunk_sums.assign(count, 0);
    m_outlook.assign(count, {});
    for (std::size_t i = 0; i < chunks.size(); ++i)
        chunks[i]->for_each_list(columns, [&](std::size_t tile, std::uint32_t length) {
            m_lengths[tile] += length;
            m_chunk_sums[tile] += i * length;
        });
    for (std::size_t i = 0; i < count; ++i) {
        if (m_lengths[i] == 0) continue;
        const double middle = (static_cast<double>(m_chunk_sums[i]) / m_lengths[i] + 0.5) /
                              static_cast<double>(chunks.size());
        m_outlook[i] = {m_lengths[i] + kPixels,
                        static_cast<std::uint32_t>(middle * static_cast<double>(workers))};
    }
    if (!neighbours_agree(columns)) {
        const auto all = static_cast<std::uint64_t>(count);
        for (std::size_t i = 0; i < count; ++i)
            m_outlook[i].owner =
                static_cast<std::uint32_t>(i * static_cast<std::uint64_t>(workers) / all);
    }
    order_work(m_outlook, workers, m_order);
    return m_order;
}

/// Of the tiles side by side at most a quarter have different owners.
bool TileOrder::neighbours_agree(std::size_t columns) const {
    std::size_t pairs = 0, different = 0;
    for (std::size_t i = 1; i < m_outlook.size(); ++i) {
        if (i % columns == 0 || m_outlook[i].weight == 0 || m_outlook[i - 1].weight == 0) continue;
        ++pairs;
        different += m_outlook[i].owner != m_outlook[i - 1].owner ? 1 : 0;
    }
    return 4 * different <= pairs;
}

}  // namespace burnish
