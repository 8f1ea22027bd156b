#pragma once

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cstddef>
#include <cstdio>
#include <string>

namespace burnish::app {

/// How far work is, on a terminal, once it takes longer than a second.
class Progress {
  public:
    explicit Progress(bool quiet) : m_shown(!quiet && isatty(STDERR_FILENO) != 0) {}
    ~Progress() {
        if (m_printed) fmt::print(stderr, "\r\x1b[K");
    }
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    void done(std::size_t count, std::size_t total) {
        const auto time = std::chrono::steady_clock::now() - m_start;
        if (!m_shown || total < 2 || time < std::chrono::seconds(1)) return;
        constexpr std::size_t kWidth = 40;
        fmt::print(stderr, "\r[{:<{}}] {}/{}", std::string(kWidth * count / total, '#'), kWidth,
                   count, total);
        m_printed = true;
    }

  private:
    bool m_shown;
    bool m_printed = false;
    std::chrono::steady_clock::time_point m_start = std::chrono::steady_clock::now();
};

}  // namespace burnish::app
