#include "core/tile_watch.hpp"

#include <burnish/error.hpp>

namespace burnish {

namespace {

[[noreturn]] void give_up() {
    throw Error(ErrorCode::stopped, "the frame was stopped by its caller");
}

}  // namespace

void require_wanted(const std::function<bool()>& stop) {
    if (stop && stop()) give_up();
}

void TileWatch::begin_round(std::size_t before, std::size_t parts, std::size_t all) {
    m_before = before;
    m_parts = parts;
    m_all = all;
    m_done = 0;
}

bool TileWatch::go_on() {
    if (!m_hooks.stop) return true;
    if (!m_stopped.load(std::memory_order_relaxed) && m_hooks.stop())
        m_stopped.store(true, std::memory_order_relaxed);
    return !m_stopped.load(std::memory_order_relaxed);
}

void TileWatch::tile_done() {
    if (!m_hooks.progress) return;
    const std::size_t done = m_done.fetch_add(1, std::memory_order_relaxed) + 1;
    m_hooks.progress((m_before * m_tiles + m_parts * done) / m_all, m_tiles);
}

void TileWatch::require_wanted() {
    if (!go_on()) give_up();
}

}  // namespace burnish
