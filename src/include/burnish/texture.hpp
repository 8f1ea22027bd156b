#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace burnish {

/// Pixels as they come from a file or a generator: RGBA, 8 bits each, row 0 on top, rows packed.
struct Image8 {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> rgba;  ///< 4 * width * height bytes

    Image8() = default;
    Image8(int w, int h)
        : width(w),
          height(h),
          rgba(4 * static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}
    [[nodiscard]] std::uint8_t* at(int x, int y) {
        return rgba.data() + 4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                                  static_cast<std::size_t>(x));
    }
    [[nodiscard]] const std::uint8_t* at(int x, int y) const {
        return const_cast<Image8*>(this)->at(x, y);
    }
};

enum class Filter { nearest, linear };
enum class Wrap { repeat, clamp_to_edge };

/// How coordinates reach texels. Texel row 0 lies at t = 0; linear filtering samples at u*W - 1/2.
struct Sampler {
    Filter filter = Filter::linear;
    Wrap wrap_s = Wrap::repeat;
    Wrap wrap_t = Wrap::repeat;
};

/// What the bytes of a texel mean.
enum class TexelFormat {
    rgba8,         ///< n / 255
    signed_rgba8,  ///< two's complement, n / 128; filtered as signed numbers
};

/// A texture in the layout that the fetch kernels read. Immutable.
///
/// Each row is followed by one extra column (the first texel again, or the last one when clamping),
/// so that a horizontal pair is one 64-bit load, and the last row by one extra row likewise, so
/// that the lower pair is one pitch further. The row pitch is an odd number of cache lines, so that
/// the rows of a block spread over the sets.
class Texture {
  public:
    /// Largest width and height.
    static constexpr int kMaxSize = 16384;

    /// Throws Error{bad_input} if the image is empty or its byte count does not fit its size,
    /// Error{limit} if a side exceeds kMaxSize.
    Texture(const Image8& image, const Sampler& sampler, TexelFormat format = TexelFormat::rgba8);
    Texture(Texture&&) noexcept = default;
    Texture& operator=(Texture&&) noexcept = default;
    Texture(const Texture&) = delete;
    Texture& operator=(const Texture&) = delete;
    ~Texture() = default;

    [[nodiscard]] int width() const noexcept { return m_width; }
    [[nodiscard]] int height() const noexcept { return m_height; }
    [[nodiscard]] const Sampler& sampler() const noexcept { return m_sampler; }
    [[nodiscard]] TexelFormat format() const noexcept { return m_format; }
    /// Bytes from one row to the next.
    [[nodiscard]] std::int32_t pitch() const noexcept { return m_pitch; }
    /// Texel (0, 0): r, g, b, a; of signed formats each value + 128.
    [[nodiscard]] const std::uint8_t* texels() const noexcept { return m_texels; }

  private:
    int m_width;
    int m_height;
    std::int32_t m_pitch;
    Sampler m_sampler;
    TexelFormat m_format;
    std::vector<std::uint8_t> m_storage;
    const std::uint8_t* m_texels;
};

using TexturePtr = std::shared_ptr<const Texture>;

}  // namespace burnish
