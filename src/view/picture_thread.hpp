#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <exception>
#include <functional>
#include <optional>
#include <thread>

#include "view/mailbox.hpp"
#include "view/picture.hpp"

namespace burnish::view {

/// Draws beside the window's thread, so that a long picture never holds up a hand. Of several
/// wishes the newest one counts; a picture that is at rest gets finer until there is a newer wish,
/// which ends it at once. The first picture of a wish is finished, or a moving hand would see none;
/// but what takes longer than `patience` ends where the newest wish has no use for it: its
/// materials or machines are others, so mip levels and programs that are being made are not its
/// own.
class PictureThread {
  public:
    static constexpr std::chrono::milliseconds kPatience{500};

    /// `draw` and `budget_ms` as PictureMaker takes them; `ready` is called from this object's
    /// thread when there is a picture to take.
    PictureThread(DrawSamples draw, double budget_ms, std::function<void()> ready,
                  std::chrono::milliseconds patience = kPatience);
    /// Ends the picture that is being drawn.
    ~PictureThread();
    PictureThread(const PictureThread&) = delete;
    PictureThread& operator=(const PictureThread&) = delete;

    /// One thread wishes.
    void wish(Wish wish);
    /// The newest picture, once; nothing if there is none that was not taken yet.
    std::optional<Picture> take() { return m_pictures.take(); }

  private:
    /// A wish and how many others, compiled otherwise, were before.
    struct Numbered {
        std::uint64_t compiled;
        Wish wish;
    };
    void run();
    void refine(const Numbered& wish);
    /// A picture of one pixel that says why there is none.
    void fail(const Wish& wish, const std::exception& error);
    /// The picture that is being drawn is not wanted. Any thread calls.
    [[nodiscard]] bool is_unwanted() const;

    std::optional<Wish> m_newest;  ///< of the thread that wishes
    Mailbox<Numbered> m_wishes;
    Mailbox<Picture> m_pictures;
    std::atomic<bool> m_is_first{true};  ///< of its wish: the picture that is being drawn
    std::atomic<std::uint64_t> m_newest_compiled{0}, m_drawn_compiled{0};
    std::atomic<std::chrono::steady_clock::time_point> m_begun{};  ///< the picture
    std::chrono::milliseconds m_patience;
    PictureMaker m_maker;
    std::function<void()> m_ready;
    std::thread m_thread;
};

}  // namespace burnish::view
