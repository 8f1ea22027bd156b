#pragma once

#include <burnish/framebuffer.hpp>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/parallel.hpp"

namespace burnish::metrics {

/// Which pixels of a pair of pictures count. Coverage is what the reference's alpha says.
enum class Region : std::uint8_t {
    all,
    covered,   ///< alpha of at least 1/2
    interior,  ///< covered, and so are all eight neighbours: no pixel on the border of the picture
};

/// The pixels of a region that are numbers: where r, g or b of either picture is NaN or infinite,
/// the pixel is counted and left out.
class Selection {
  public:
    /// Two rgba32f frames of one size; throws Error{bad_option} otherwise.
    Selection(const Framebuffer& test, const Framebuffer& reference, Region region,
              WorkerPool& pool);

    [[nodiscard]] bool contains(int x, int y) const {
        return m_inside[static_cast<std::size_t>(y) * static_cast<std::size_t>(m_width) +
                        static_cast<std::size_t>(x)] != 0;
    }
    [[nodiscard]] int width() const { return m_width; }
    [[nodiscard]] int height() const { return m_height; }
    [[nodiscard]] std::size_t count() const { return m_count; }
    /// Pixels left out of the region because they are no numbers.
    [[nodiscard]] std::size_t nonfinite() const { return m_nonfinite; }

  private:
    int m_width;
    int m_height;
    std::size_t m_count = 0;
    std::size_t m_nonfinite = 0;
    std::vector<std::uint8_t> m_inside;
};

}  // namespace burnish::metrics
