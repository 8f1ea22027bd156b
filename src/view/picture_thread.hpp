#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>

#include "view/picture.hpp"

namespace burnish::view {

/// Draws beside the window's thread, so that a long picture never holds up a hand. Of several
/// wishes the newest one counts; a picture that is at rest gets finer until there is a newer wish.
class PictureThread {
  public:
    /// `ready` is called from this object's thread when there is a picture to take.
    PictureThread(PictureMaker maker, std::function<void()> ready);
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
    void deliver(Picture picture);
    bool has_newer();

    PictureMaker m_maker;
    std::function<void()> m_ready;
    std::mutex m_mutex;
    std::condition_variable m_changed;
    std::optional<Wish> m_wish;
    std::optional<Picture> m_picture;
    bool m_stop = false;
    std::thread m_thread;
};

}  // namespace burnish::view
