#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>

#include "view/picture.hpp"

namespace burnish::view {

/// Draws beside the window's thread, so that a long picture never holds up a hand. Of several
/// wishes the newest one counts; a picture that is at rest gets finer until there is a newer wish,
/// which ends it at once. The first picture of a wish is finished in any case, or a moving hand
/// would see none.
class PictureThread {
  public:
    /// `draw` and `budget_ms` as PictureMaker takes them; `ready` is called from this object's
    /// thread when there is a picture to take.
    PictureThread(DrawSamples draw, double budget_ms, std::function<void()> ready);
    /// Ends the picture that is being drawn.
    ~PictureThread();
    PictureThread(const PictureThread&) = delete;
    PictureThread& operator=(const PictureThread&) = delete;

    void wish(Wish wish);
    /// The newest picture, once; nothing if there is none that was not taken yet.
    std::optional<Picture> take();

  private:
    void run();
    /// Waits for a wish; nothing when the window was closed.
    std::optional<Wish> next_wish();
    void refine(const Wish& wish);
    void deliver(Picture picture);
    /// The picture that is being drawn is not wanted. Any thread calls.
    [[nodiscard]] bool is_unwanted() const;

    PictureMaker m_maker;
    std::function<void()> m_ready;
    std::mutex m_mutex;
    std::condition_variable m_changed;
    std::optional<Wish> m_wish;
    std::optional<Picture> m_picture;
    // Written under the mutex, read by all workers without.
    std::atomic<bool> m_has_newer{false};  ///< a wish, than what is being drawn
    std::atomic<bool> m_is_first{true};    ///< of its wish: what is being drawn
    std::atomic<bool> m_stop{false};
    std::thread m_thread;
};

}  // namespace burnish::view
