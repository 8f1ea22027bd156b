#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "raster/bin.hpp"

namespace burnish {

/// Which chunks have triangles in which tile. Memory is kept for the next frame.
class TileChunks {
  public:
    /// @param columns, rows  of tiles
    void find(std::span<const std::unique_ptr<Chunk>> chunks, std::size_t columns,
              std::size_t rows);

    /// Of tile `i`, row by row: the numbers of its chunks, rising.
    [[nodiscard]] std::span<const std::uint32_t> of(std::size_t i) const {
        return {m_chunks.data() + m_first[i], m_first[i + 1] - m_first[i]};
    }

  private:
    std::vector<std::size_t> m_first;     ///< per tile, one more at the end
    std::vector<std::uint32_t> m_chunks;  ///< tile by tile
};

}  // namespace burnish
