#pragma once

#include <atomic>
#include <exception>
#include <functional>
#include <optional>
#include <thread>

#include "view/mailbox.hpp"
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

    void wish(Wish wish) { m_wishes.put(std::move(wish)); }
    /// The newest picture, once; nothing if there is none that was not taken yet.
    std::optional<Picture> take() { return m_pictures.take(); }

  private:
    void run();
    void refine(const Wish& wish);
    /// A picture of one pixel that says why there is none.
    void fail(const Wish& wish, const std::exception& error);
    /// The picture that is being drawn is not wanted. Any thread calls.
    [[nodiscard]] bool is_unwanted() const;

    Mailbox<Wish> m_wishes;
    Mailbox<Picture> m_pictures;
    std::atomic<bool> m_is_first{true};  ///< of its wish: the picture that is being drawn
    PictureMaker m_maker;
    std::function<void()> m_ready;
    std::thread m_thread;
};

}  // namespace burnish::view
