#pragma once

#include <burnish/renderer.hpp>
#include <vector>

#include "core/stage_clock.hpp"

namespace burnish {

/// Where the time of a frame goes, worker by worker. Kernels are timed by running a table of the
/// same kernels with a look at the clock before and after each, so nothing else knows of it.
class FrameAccount {
  public:
    FrameAccount(const KernelTable& kernels, int workers);

    /// The kernels to draw with; they may be called where a thread has a clock.
    [[nodiscard]] const KernelTable& timed() const { return m_timed; }
    [[nodiscard]] StageClock& clock(int worker) {
        return m_clocks[static_cast<std::size_t>(worker)];
    }

    /// Forgets the last frame; `tiles` will come.
    void start(std::size_t tiles);
    /// Tile `i` of weight `weight` took so many ticks more, and its fragments.
    void add_tile(std::size_t i, std::uint64_t ticks, std::uint32_t weight,
                  std::uint64_t fragments);
    /// Writes what was found since `start` into `stats`.
    void finish(FrameStats& stats) const;

  private:
    KernelTable m_timed;
    std::vector<StageClock> m_clocks;
    struct Tile {
        std::uint64_t ticks = 0, fragments = 0;
        std::uint32_t weight = 0;
    };
    std::vector<Tile> m_tiles;
    std::uint64_t m_start_ticks = 0;
    std::chrono::steady_clock::time_point m_start;
};

}  // namespace burnish
