#pragma once

#include <cstddef>
#include <deque>
#include <string>

#include "view/picture.hpp"

namespace burnish::view {

/// When pictures came to the screen and what they took, of the last ones and of all.
class FrameTimes {
  public:
    /// A new picture was shown at `now_ms`, of a clock that only goes forward.
    void shown(const Picture& picture, double now_ms);
    /// Nothing moved for a while: the time until the next picture is no frame's.
    void rest() { m_last_ms = -1.0; }

    struct Frame {
        double interval_ms = 0.0;  ///< since the picture before
        double draw_ms = 0.0;
        double geometry_ms = 0.0, tiles_ms = 0.0;  ///< of one pane
        std::uint64_t pixels = 0, triangles = 0;   ///< shaded; submitted
        double divisor = 1.0;                      ///< of the sides of a pane
    };
    /// The last ones, oldest first, at most kKept.
    [[nodiscard]] const std::deque<Frame>& last() const { return m_frames; }
    static constexpr std::size_t kKept = 240;

    [[nodiscard]] std::size_t count() const { return m_intervals.size(); }
    /// The interval that `share` of all do not exceed, (0, 1]; 0 without frames.
    [[nodiscard]] double quantile(double share) const;
    /// All frames per second of the time that they took; 0 without frames.
    [[nodiscard]] double per_second() const;
    /// One object, one line.
    [[nodiscard]] std::string json() const;

  private:
    std::deque<Frame> m_frames;
    std::deque<float> m_intervals;  ///< of the last quarter of a million
    double m_last_ms = -1.0;
};

/// Bytes of memory that the process has in RAM; 0 where the system does not tell.
std::size_t resident_bytes();

}  // namespace burnish::view
