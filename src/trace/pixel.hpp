#pragma once

#include <array>
#include <burnish/trace.hpp>
#include <optional>

#include "image/tile_image.hpp"

namespace burnish {

/// One pixel of the frame while fragments come to it.
class TracedPixel {
  public:
    /// Holds the background.
    explicit TracedPixel(const Scene& scene);

    /// Stores or blends the fragment's codes; sets its `blend`.
    void take(TracedFragment& fragment, const std::optional<Blend>& blend);

    /// As the frame holds them: bytes, words or floats.
    [[nodiscard]] std::array<double, 4> channels() const;

  private:
    void write(const TracedFragment& fragment, const std::optional<Blend>& blend,
               TileImage& image) const;

    NumberModel m_numbers;
    TileImage m_image;  ///< its first pixel
};

}  // namespace burnish
