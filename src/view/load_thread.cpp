#include "view/load_thread.hpp"

#include <burnish/error.hpp>

#include "view/complaint.hpp"

namespace burnish::view {

Loaded loaded(const LoadScene& load, const LoadOrder& order) {
    Loaded result{.order = order, .scene = {}, .error = {}, .files = {}};
    try {
        // Before they are read, so that what is written meanwhile is seen.
        result.files.watch_input(order.input);
        result.scene = load(order.input);
    } catch (const Error& error) {
        result.error = error.what();
    } catch (const std::exception& error) {
        result.error = order.input.string() + ": " + complaint(error);
    }
    return result;
}

LoadThread::LoadThread(LoadScene load, std::function<void()> ready)
    : m_load(std::move(load)), m_ready(std::move(ready)), m_thread([this] { run(); }) {}

LoadThread::~LoadThread() {
    m_orders.close();
    m_thread.join();
}

void LoadThread::order(LoadOrder order) {
    m_pending = order;
    m_orders.put({++m_number, std::move(order)});
}

std::optional<Loaded> LoadThread::take() {
    std::optional<Result> result = m_results.take();
    if (!result || result->number != m_number) return std::nullopt;
    m_pending.reset();
    return std::move(result->loaded);
}

void LoadThread::run() {
    while (const std::optional<Numbered> order = m_orders.wait()) {
        Result result{order->number, loaded(m_load, order->order)};
        if (m_orders.is_full()) continue;  // nobody waits for it any more
        m_results.put(std::move(result));
        m_ready();
    }
}

}  // namespace burnish::view
