#include "view/picture_thread.hpp"

#include <burnish/error.hpp>

namespace burnish::view {

PictureThread::PictureThread(DrawSamples draw, double budget_ms, std::function<void()> ready)
    : m_maker(std::move(draw), budget_ms, [this] { return is_unwanted(); }),
      m_ready(std::move(ready)),
      m_thread([this] { run(); }) {}

PictureThread::~PictureThread() {
    {
        const std::scoped_lock lock(m_mutex);
        m_stop = true;
    }
    m_changed.notify_one();
    m_thread.join();
}

void PictureThread::wish(Wish wish) {
    {
        const std::scoped_lock lock(m_mutex);
        m_wish = std::move(wish);
        m_has_newer = true;
    }
    m_changed.notify_one();
}

std::optional<Picture> PictureThread::take() {
    const std::scoped_lock lock(m_mutex);
    std::optional<Picture> picture = std::move(m_picture);
    m_picture.reset();
    return picture;
}

std::optional<Wish> PictureThread::next_wish() {
    std::unique_lock lock(m_mutex);
    m_changed.wait(lock, [this] { return m_stop || m_wish; });
    if (m_stop) return std::nullopt;
    std::optional<Wish> wish = std::move(m_wish);
    m_wish.reset();
    m_has_newer = false;
    m_is_first = true;
    return wish;
}

bool PictureThread::is_unwanted() const {
    return m_stop || (m_has_newer && !m_is_first);
}

void PictureThread::deliver(Picture picture) {
    {
        const std::scoped_lock lock(m_mutex);
        m_picture = std::move(picture);
    }
    m_ready();
}

void PictureThread::refine(const Wish& wish) {
    std::optional<Fineness> fineness = Fineness::within_budget;
    std::shared_ptr<const PixelTrace> trace;
    std::string trace_error;
    while (fineness) {
        Picture picture = m_maker.make(wish, *fineness);
        // Kept here: a finer picture may come before the window took the one with the trace.
        if (*fineness == Fineness::full) {
            trace = picture.trace;
            trace_error = picture.trace_error;
        } else if (*fineness > Fineness::full) {
            picture.trace = trace;
            picture.trace_error = trace_error;
        }
        fineness = finer(wish, picture);
        picture.is_last = !fineness;
        deliver(std::move(picture));
        m_is_first = false;
        if (is_unwanted()) return;
    }
}

void PictureThread::run() {
    while (std::optional<Wish> wish = next_wish()) {
        try {
            refine(*wish);
        } catch (const Error& error) {
            if (error.code() != ErrorCode::stopped) throw;
        }
    }
}

}  // namespace burnish::view
