#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

namespace burnish {

/// What a frame stores per pixel, channels in the order R, G, B, A, native byte order.
enum class PixelFormat {
    rgba8,     ///< unsigned 8 bits, 255 = 1
    rgba16,    ///< unsigned 16 bits, 65535 = 1
    rgba32f,   ///< float
    depth32f,  ///< one float and no colour: what draws leave in the depth buffer, 1 at first
};

/// Bytes per pixel: 4, 8, 16 or 4.
[[nodiscard]] std::size_t pixel_size(PixelFormat format) noexcept;

/// Where a picture goes: row 0 on top, no transfer function. Owns its memory or borrows the
/// caller's.
class Framebuffer {
  public:
    /// Largest width and height.
    static constexpr int kMaxSize = 16384;

    /// Owns its memory, rows packed. Throws Error{bad_option} unless both sides are 1 .. kMaxSize.
    Framebuffer(int width, int height, PixelFormat format = PixelFormat::rgba8);

    /// Draws into memory of the caller, which must outlive this object. `pitch` is the distance of
    /// rows in bytes, at least width * pixel_size(format); `pixels` is aligned to a channel.
    /// Throws Error{bad_option} for a size, pitch or alignment that does not fit.
    Framebuffer(void* pixels, std::ptrdiff_t pitch, int width, int height,
                PixelFormat format = PixelFormat::rgba8);

    [[nodiscard]] int width() const noexcept { return m_width; }
    [[nodiscard]] int height() const noexcept { return m_height; }
    [[nodiscard]] PixelFormat format() const noexcept { return m_format; }
    [[nodiscard]] std::ptrdiff_t pitch() const noexcept { return m_pitch; }
    [[nodiscard]] std::byte* pixels() noexcept { return m_pixels; }
    [[nodiscard]] const std::byte* pixels() const noexcept { return m_pixels; }
    /// First byte of row y, 0 <= y < height().
    [[nodiscard]] std::byte* row(int y) noexcept { return m_pixels + y * m_pitch; }
    [[nodiscard]] const std::byte* row(int y) const noexcept { return m_pixels + y * m_pitch; }

    Framebuffer(Framebuffer&&) noexcept = default;
    Framebuffer& operator=(Framebuffer&&) noexcept = default;
    Framebuffer(const Framebuffer&) = delete;
    Framebuffer& operator=(const Framebuffer&) = delete;

  private:
    std::shared_ptr<std::byte> m_owned;  ///< by this object alone
    std::byte* m_pixels;
    std::ptrdiff_t m_pitch;
    int m_width;
    int m_height;
    PixelFormat m_format;
};

}  // namespace burnish
