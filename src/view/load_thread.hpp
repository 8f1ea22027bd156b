#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <thread>

#include "view/file_watch.hpp"
#include "view/mailbox.hpp"
#include "view/session.hpp"

namespace burnish::view {

/// Reads scenes and meshes beside the window's thread: what is there can be looked at meanwhile. Of
/// several orders the newest one counts; a file that is being read is read to its end.
class LoadThread {
  public:
    /// `load` is called from this object's thread, as is `ready` when there is something to take.
    LoadThread(LoadScene load, std::function<void()> ready);
    /// Waits for the file that is being read.
    ~LoadThread();
    LoadThread(const LoadThread&) = delete;
    LoadThread& operator=(const LoadThread&) = delete;

    void order(LoadOrder order) { m_orders.put(std::move(order)); }
    /// What came of the newest order, once.
    std::optional<Loaded> take() { return m_results.take(); }

  private:
    void run();

    LoadScene m_load;
    std::function<void()> m_ready;
    Mailbox<LoadOrder> m_orders;
    Mailbox<Loaded> m_results;
    std::thread m_thread;
};

/// What LoadThread does with an order. Never throws Error or std::bad_alloc: that is in the result.
Loaded loaded(const LoadScene& load, const LoadOrder& order);

}  // namespace burnish::view
