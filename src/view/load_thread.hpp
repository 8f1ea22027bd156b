#pragma once

#include <cstdint>
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

    // One thread gives orders and takes what comes of them.
    void order(LoadOrder order);
    /// What came of the newest order, once; never of one before.
    std::optional<Loaded> take();
    /// The newest order, until what came of it was taken.
    [[nodiscard]] const std::optional<LoadOrder>& pending() const { return m_pending; }

  private:
    struct Numbered {
        std::uint64_t number;
        LoadOrder order;
    };
    struct Result {
        std::uint64_t number;  ///< of its order
        Loaded loaded;
    };
    void run();

    LoadScene m_load;
    std::function<void()> m_ready;
    std::optional<LoadOrder> m_pending;
    std::uint64_t m_number = 0;  ///< of the newest order
    Mailbox<Numbered> m_orders;
    Mailbox<Result> m_results;
    std::thread m_thread;
};

/// What LoadThread does with an order. What is thrown is in the result.
Loaded loaded(const LoadScene& load, const LoadOrder& order);

}  // namespace burnish::view
