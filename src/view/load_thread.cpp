#include "view/load_thread.hpp"

#include <burnish/error.hpp>
#include <new>

namespace burnish::view {

Loaded loaded(const LoadScene& load, const LoadOrder& order) {
    Loaded result{.order = order, .scene = {}, .error = {}, .files = {}};
    try {
        // Before they are read, so that what is written meanwhile is seen.
        result.files.watch_input(order.input);
        result.scene = load(order.input);
    } catch (const Error& error) {
        result.error = error.what();
    } catch (const std::bad_alloc&) {
        result.error = order.input.string() + ": out of memory";
    }
    return result;
}

LoadThread::LoadThread(LoadScene load, std::function<void()> ready)
    : m_load(std::move(load)), m_ready(std::move(ready)), m_thread([this] { run(); }) {}

LoadThread::~LoadThread() {
    m_orders.close();
    m_thread.join();
}

void LoadThread::run() {
    while (const std::optional<LoadOrder> order = m_orders.wait()) {
        Loaded result = loaded(m_load, *order);
        if (m_orders.is_full()) continue;  // nobody waits for it any more
        m_results.put(std::move(result));
        m_ready();
    }
}

}  // namespace burnish::view
