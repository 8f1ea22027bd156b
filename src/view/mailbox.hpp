#pragma once

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <utility>

namespace burnish::view {

/// Holds the newest of what one thread sends another; what was not taken by then is dropped. Any
/// thread may call.
template <class T>
class Mailbox {
  public:
    void put(T value) {
        {
            const std::scoped_lock lock(m_mutex);
            m_value = std::move(value);
            m_full = true;
        }
        m_changed.notify_one();
    }
    /// Nothing that has not been taken yet: nothing.
    std::optional<T> take() {
        const std::scoped_lock lock(m_mutex);
        return take_locked();
    }
    /// The same, but waits for it; nothing once the box is closed.
    std::optional<T> wait() {
        std::unique_lock lock(m_mutex);
        m_changed.wait(lock, [this] { return m_closed || m_full; });
        if (m_closed) return std::nullopt;
        return take_locked();
    }
    void close() {
        {
            const std::scoped_lock lock(m_mutex);
            m_closed = true;
        }
        m_changed.notify_all();
    }

    // Without the lock, for whoever asks often.
    [[nodiscard]] bool is_full() const { return m_full.load(std::memory_order_relaxed); }
    [[nodiscard]] bool is_closed() const { return m_closed.load(std::memory_order_relaxed); }

  private:
    std::optional<T> take_locked() {
        m_full = false;
        return std::exchange(m_value, std::nullopt);
    }

    std::mutex m_mutex;
    std::condition_variable m_changed;
    std::optional<T> m_value;
    std::atomic<bool> m_full{false}, m_closed{false};  ///< written under the mutex
};

}  // namespace burnish::view
