#include "raster/tile_chunks.hpp"

namespace burnish {

void TileChunks::find(std::span<const std::unique_ptr<Chunk>> chunks, std::size_t columns,
                      std::size_t rows) {
    // A counting sort: m_first[i + 1] first counts those of tile i, then runs through them.
    m_first.assign(columns * rows + 1, 0);
    for (const auto& chunk : chunks)
        chunk->for_each_list(columns,
                             [&](std::size_t tile, std::uint32_t) { ++m_first[tile + 1]; });
    std::size_t sum = 0;
    for (std::size_t& first : m_first) {
        sum += first;
        first = sum - first;
    }
    m_chunks.resize(sum);
    for (std::uint32_t i = 0; i < chunks.size(); ++i)
        chunks[i]->for_each_list(
            columns, [&](std::size_t tile, std::uint32_t) { m_chunks[m_first[tile + 1]++] = i; });
}

}  // namespace burnish
