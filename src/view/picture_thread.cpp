#include "view/picture_thread.hpp"

#include <burnish/error.hpp>

#include "view/complaint.hpp"

namespace burnish::view {

PictureThread::PictureThread(DrawSamples draw, double budget_ms, std::function<void()> ready)
    : m_maker(std::move(draw), budget_ms, [this] { return is_unwanted(); }),
      m_ready(std::move(ready)),
      m_thread([this] { run(); }) {}

PictureThread::~PictureThread() {
    m_wishes.close();
    m_thread.join();
}

bool PictureThread::is_unwanted() const {
    return m_wishes.is_closed() || (m_wishes.is_full() && !m_is_first);
}

void PictureThread::refine(const Wish& wish) {
    std::optional<Fineness> fineness = Fineness::within_budget;
    std::shared_ptr<const PixelTrace> trace;
    std::string trace_error;
    m_is_first = true;
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
        m_pictures.put(std::move(picture));
        m_ready();
        m_is_first = false;
        if (is_unwanted()) return;
    }
}

void PictureThread::fail(const Wish& wish, const std::exception& error) {
    Picture picture(1, 1);
    picture.id = wish.id;
    picture.is_last = true;
    PaneReport& report = picture.panes.emplace_back();
    report.machine = wish.scene->machine.name;
    report.error = complaint(error);
    m_pictures.put(std::move(picture));
    m_ready();
}

void PictureThread::run() {
    while (const std::optional<Wish> wish = m_wishes.wait()) {
        try {
            refine(*wish);
        } catch (const Error& error) {
            if (error.code() != ErrorCode::stopped) fail(*wish, error);
        } catch (const std::exception& error) {
            fail(*wish, error);
        }
    }
}

}  // namespace burnish::view
