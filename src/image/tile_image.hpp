#pragma once

#include <burnish/framebuffer.hpp>
#include <cstdint>
#include <glm/glm.hpp>

#include "core/aligned.hpp"

namespace burnish {

/// Pixels of one tile, in the order of kernels/packet.hpp and in the frame's format: a worker's
/// scratch between the store stage and the frame. What is written to the frame is seen by other
/// threads after `stream_fence`.
class TileImage {
  public:
    explicit TileImage(PixelFormat format);

    /// Sets all pixels to the background.
    void clear();
    void set_background(const glm::vec4& color);
    /// Takes the tile at (left, top) from the frame, and writes it there; cut to the frame.
    void load(const Framebuffer& frame, std::int32_t left, std::int32_t top);
    /// An empty tile: background straight to the frame.
    void resolve_empty(Framebuffer& frame, std::int32_t left, std::int32_t top) const;
    void resolve(Framebuffer& frame, std::int32_t left, std::int32_t top) const;
    /// The tile's depths (kTilePixels) in place of its pixels; to a frame of colours in r, g and b
    /// with alpha 1. True: they all are 1 afterwards; otherwise they are as they were.
    bool resolve_depths(float* depths, Framebuffer& frame, std::int32_t left, std::int32_t top);

    [[nodiscard]] std::byte* pixels() { return m_pixels.data(); }
    [[nodiscard]] const std::byte* pixels() const { return m_pixels.data(); }
    [[nodiscard]] PixelFormat format() const { return m_format; }

  private:
    PixelFormat m_format;
    std::size_t m_pixel_size;
    AlignedVector<std::byte> m_pixels;
    AlignedVector<std::byte> m_background;  ///< one row of the tile
};

}  // namespace burnish
