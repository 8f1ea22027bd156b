#pragma once

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cstddef>
#include <cstdio>
#include <string>

namespace burnish::app {

/// How far work is and how long the rest will take, on a terminal, once it takes longer than a
/// second.
class Progress {
  public:
    explicit Progress(bool quiet) : m_shown(!quiet && isatty(STDERR_FILENO) != 0) {}
    ~Progress() {
        if (m_printed) fmt::print(stderr, "\r\x1b[K");
    }
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// @param count  at least 1
    void done(std::size_t count, std::size_t total) {
        const double seconds =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - m_start).count();
        if (!m_shown || total < 2 || seconds < 1.0) return;
        constexpr std::size_t kWidth = 40;
        const double left =
            seconds * static_cast<double>(total - count) / static_cast<double>(count);
        fmt::print(stderr, "\r[{:<{}}] {}/{}, {:.0f} s left\x1b[K",
                   std::string(kWidth * count / total, '#'), kWidth, count, total, left);
        m_printed = true;
    }

  private:
    bool m_shown;
    bool m_printed = false;
    std::chrono::steady_clock::time_point m_start = std::chrono::steady_clock::now();
};

}  // namespace burnish::app
