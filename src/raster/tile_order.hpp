#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/work_order.hpp"
#include "raster/bin.hpp"

namespace burnish {

/// In what order the tiles of a frame are drawn, and by whom: heavy ones first, and where
/// neighbours mostly agree, each by the worker that binned most of its triangles, since cores fetch
/// what another one wrote from afar. Memory is kept for the next frame.
class TileOrder {
  public:
    /// @param columns, rows  of tiles
    /// @param workers        worker w of them binned its share of the chunks, in order
    const WorkOrder& plan(std::span<const std::unique_ptr<Chunk>> chunks, std::size_t columns,
                          std::size_t rows, int workers);

    /// What tile `i` was expected to cost: some 100 ns each.
    [[nodiscard]] std::uint32_t weight(std::size_t i) const { return m_outlook[i].weight; }

  private:
    bool neighbours_agree(std::size_t columns) const;

    std::vector<std::uint32_t> m_lengths;     ///< triangles of each tile
    std::vector<std::uint64_t> m_chunk_sums;  ///< of their chunks' numbers
    std::vector<PieceOutlook> m_outlook;
    WorkOrder m_order;
};

}  // namespace burnish
