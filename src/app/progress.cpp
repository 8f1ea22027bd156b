#include "app/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

namespace burnish::app {
namespace {

using Seconds = std::chrono::duration<double>;

constexpr double kPatience = 1.0;  // s, before the first line
constexpr double kBetween = 0.1;   // s, from line to line

}  // namespace

Progress::Progress(bool quiet) : m_shown(!quiet && isatty(STDERR_FILENO) != 0) {
    if (m_shown) m_seconds = std::thread([this] { tell_seconds(); });
}

Progress::~Progress() {
    finish();
}

double Progress::seconds() const {
    return Seconds(std::chrono::steady_clock::now() - m_start).count();
}

void Progress::print(const std::string& line) {
    fmt::print(stderr, "\r{}\x1b[K", line);
    std::fflush(stderr);
    m_printed = seconds();
}

void Progress::done(std::size_t count, std::size_t total) {
    if (!m_shown || total < 2) return;
    const std::lock_guard lock(m_mutex);
    if (count <= m_count || m_finished) return;
    m_count = count;
    m_wake.notify_one();
    const double now = seconds();
    if (now < kPatience || (now - m_printed < kBetween && count < total)) return;
    constexpr std::size_t kWidth = 40;
    const double left = now * static_cast<double>(total - count) / static_cast<double>(count);
    print(fmt::format("[{:<{}}] {}/{}, {:.0f} s left", std::string(kWidth * count / total, '#'),
                      kWidth, count, total, left));
}

/// Until somebody says how far the work is.
void Progress::tell_seconds() {
    std::unique_lock lock(m_mutex);
    for (int next = 1; !m_finished && m_count == 0; ++next) {
        const auto when = m_start + std::chrono::seconds(next);
        m_wake.wait_until(lock, when, [this] { return m_finished || m_count > 0; });
        if (!m_finished && m_count == 0) print(fmt::format("{} s", next));
    }
}

void Progress::finish() {
    if (!m_shown) return;
    {
        const std::lock_guard lock(m_mutex);
        if (m_finished) return;
        m_finished = true;
        if (m_printed > 0.0) print("");
    }
    m_wake.notify_one();
    m_seconds.join();
}

}  // namespace burnish::app
