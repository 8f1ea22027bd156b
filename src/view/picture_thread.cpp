#include "view/picture_thread.hpp"

#include <burnish/error.hpp>

#include "view/complaint.hpp"

namespace burnish::view {

PictureThread::PictureThread(DrawSamples draw, double budget_ms, std::function<void()> ready,
                             std::chrono::milliseconds patience)
    : m_patience(patience),
      m_maker(std::move(draw), budget_ms, [this] { return is_unwanted(); }),
      m_ready(std::move(ready)),
      m_thread([this] { run(); }) {}

PictureThread::~PictureThread() {
    m_wishes.close();
    m_thread.join();
}

void PictureThread::wish(Wish wish) {
    if (m_newest && !are_compiled_alike(*m_newest, wish)) ++m_newest_compiled;
    m_newest = wish;
    m_wishes.put({m_newest_compiled, std::move(wish)});
}

bool PictureThread::is_unwanted() const {
    if (m_wishes.is_closed()) return true;
    if (!m_wishes.is_full()) return false;
    if (!m_is_first) return true;
    return m_newest_compiled != m_drawn_compiled &&
           std::chrono::steady_clock::now() - m_begun.load() > m_patience;
}

void PictureThread::refine(const Numbered& numbered) {
    const Wish& wish = numbered.wish;
    std::optional<Fineness> fineness = Fineness::within_budget;
    std::shared_ptr<const PixelTrace> trace;
    std::string trace_error;
    m_drawn_compiled = numbered.compiled;
    m_begun = std::chrono::steady_clock::now();
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
    while (const std::optional<Numbered> numbered = m_wishes.wait()) {
        try {
            refine(*numbered);
        } catch (const Error& error) {
            if (error.code() != ErrorCode::stopped) fail(numbered->wish, error);
        } catch (const std::exception& error) {
            fail(numbered->wish, error);
        }
    }
}

}  // namespace burnish::view
