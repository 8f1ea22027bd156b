#pragma once

#include <atomic>
#include <cstddef>
#include <functional>

namespace burnish {

/// What the caller of a frame gave to follow it and to end it early: RendererOptions' two of the
/// same names.
struct FrameHooks {
    std::function<void(std::size_t done, std::size_t total)> progress = {};
    std::function<bool()> stop = {};
};

/// Throws Error{stopped} once `stop`, where there is one, says so.
void require_wanted(const std::function<bool()>& stop);

/// The tiles of a frame under the eyes of its caller. What is drawn does not depend on it.
class TileWatch {
  public:
    /// `hooks` outlive this object.
    TileWatch(const FrameHooks& hooks, std::size_t tiles) : m_hooks(hooks), m_tiles(tiles) {}

    /// All tiles are drawn once more, with `parts` of the frame's `all` > 0 parts; `before` were
    /// there already. Without a call they are drawn once, with everything. One thread calls.
    void begin_round(std::size_t before, std::size_t parts, std::size_t all);

    /// Before a piece of work, from any thread: false once the caller wants no more. The rest is
    /// then to be passed over.
    bool go_on();
    /// A tile is done, as far as this round goes. Any thread calls.
    void tile_done();
    /// Throws Error{stopped} once the caller wants no more, and asks whether that is so.
    void require_wanted();

  private:
    const FrameHooks& m_hooks;
    std::size_t m_tiles;
    std::size_t m_before = 0, m_parts = 1, m_all = 1;  ///< parts of the frame
    std::atomic<std::size_t> m_done{0};                ///< tiles of the round
    std::atomic<bool> m_stopped{false};
};

}  // namespace burnish
