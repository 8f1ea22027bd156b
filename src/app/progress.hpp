#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <string>
#include <thread>

namespace burnish::app {

/// How far work is and how long the rest will take, on a terminal, once it takes longer than a
/// second; seconds alone while nobody says how far it is. One line on standard error, gone when the
/// work is done. Any thread may call.
class Progress {
  public:
    explicit Progress(bool quiet);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// `count` of `total` parts are done; the larger count stands if parts overtake one another.
    void done(std::size_t count, std::size_t total);

    /// Takes the line away for good, so that results can be printed.
    void finish();

  private:
    void tell_seconds();
    void print(const std::string& line);
    [[nodiscard]] double seconds() const;

    const bool m_shown;
    const std::chrono::steady_clock::time_point m_start = std::chrono::steady_clock::now();
    std::mutex m_mutex;
    std::condition_variable m_wake;
    std::size_t m_count = 0;  ///< 0: nobody said
    double m_printed = 0.0;   ///< seconds, of the last line
    bool m_finished = false;
    std::thread m_seconds;  ///< where they are told
};

}  // namespace burnish::app
