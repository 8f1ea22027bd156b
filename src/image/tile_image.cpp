#include "image/tile_image.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <type_traits>

#include "image/stream.hpp"
#include "kernels/packet.hpp"

namespace burnish {

namespace {

struct EncodedPixel {
    std::byte bytes[16];
};

/// A colour as the frame stores it, each channel to the nearest code; as a depth red alone.
EncodedPixel encode_pixel(const glm::vec4& color, PixelFormat format) {
    EncodedPixel pixel{};
    if (format == PixelFormat::depth32f) {
        std::memcpy(pixel.bytes, &color.r, sizeof color.r);
        return pixel;
    }
    for (int c = 0; c < 4; ++c) {
        const float x = color[c] > 0.0F ? std::min(color[c], 1.0F) : 0.0F;
        const auto code = [&](float one) {
            return static_cast<std::uint32_t>(std::floor(x * one + 0.5F));
        };
        std::byte* to = pixel.bytes + static_cast<std::size_t>(c) * (pixel_size(format) / 4);
        if (format == PixelFormat::rgba8) {
            *to = static_cast<std::byte>(code(255.0F));
        } else if (format == PixelFormat::rgba16) {
            const auto value = static_cast<std::uint16_t>(code(65535.0F));
            std::memcpy(to, &value, sizeof value);
        } else {
            std::memcpy(to, &x, sizeof x);
        }
    }
    return pixel;
}

/// Calls f(bytes in the tile, bytes in the frame, size) for the parts of a tile that lie in a row
/// of a block and in the frame. PixelSize is a constant so that the copies are plain moves.
template <std::size_t PixelSize, class F>
void for_each_row(int width, int height, std::int32_t left, std::int32_t top, F&& f) {
    const std::int32_t rows = std::min(kTileSize, height - top),
                       columns = std::min(kTileSize, width - left);
    for (std::int32_t y = 0; y < rows; ++y) {
        for (std::int32_t x = 0; x < columns; x += kBlockSize) {
            const std::int32_t index =
                (y / kBlockSize * kBlockSize + x / kBlockSize) * kBlockPixels +
                y % kBlockSize * kBlockSize;
            const std::size_t in_tile = static_cast<std::size_t>(index) * PixelSize;
            const std::size_t in_row = static_cast<std::size_t>(left + x) * PixelSize;
            if (columns - x >= kBlockSize) {
                f(in_tile, top + y, in_row,
                  std::integral_constant<std::size_t, kBlockSize * PixelSize>{});
            } else {
                f(in_tile, top + y, in_row, static_cast<std::size_t>(columns - x) * PixelSize);
            }
        }
    }
}

template <class F>
void for_each_row(const Framebuffer& frame, std::int32_t left, std::int32_t top, F&& f) {
    switch (frame.format()) {
        case PixelFormat::rgba8:
        case PixelFormat::depth32f:
            return for_each_row<4>(frame.width(), frame.height(), left, top, f);
        case PixelFormat::rgba16:
            return for_each_row<8>(frame.width(), frame.height(), left, top, f);
        case PixelFormat::rgba32f:
            return for_each_row<16>(frame.width(), frame.height(), left, top, f);
    }
}

/// Depths as opaque grey.
template <class Channel, class Code>
void write_greys(const float* depths, std::byte* pixels, Channel one, Code&& code) {
    for (int i = 0; i < kTilePixels; ++i) {
        const auto grey = static_cast<Channel>(code(depths[i]));
        const Channel pixel[4] = {grey, grey, grey, one};
        std::memcpy(pixels + static_cast<std::size_t>(i) * sizeof pixel, pixel, sizeof pixel);
    }
}

/// A tile that lies in the frame with all of its rows; can_stream() has been asked. Rows of blocks
/// that are on their way are given to `behind`.
template <std::size_t PixelSize, class Byte, class Behind>
void stream_tile(Byte* pixels, std::byte* to, std::ptrdiff_t stride, Behind&& behind) {
    constexpr std::size_t kRow = kBlockSize * PixelSize, kBlock = kBlockPixels * PixelSize;
    constexpr std::size_t kBlocks = kTileSize / kBlockSize;
    for (std::size_t y = 0; y < kTileSize; ++y) {
        Byte* const from = pixels + y / kBlockSize * kBlocks * kBlock + y % kBlockSize * kRow;
        for (std::size_t x = 0; x < kBlocks; ++x) {
            stream_aligned<kRow>(to + x * kRow, from + x * kBlock);
            behind(from + x * kBlock);
        }
        to += stride;
    }
}
void stream_tile(const std::byte* pixels, std::size_t pixel_size, std::byte* to,
                 std::ptrdiff_t stride) {
    const auto keep = [](const std::byte*) {};
    switch (pixel_size) {
        case 4:
            return stream_tile<4>(pixels, to, stride, keep);
        case 8:
            return stream_tile<8>(pixels, to, stride, keep);
        default:
            return stream_tile<16>(pixels, to, stride, keep);
    }
}

/// Where a tile goes that lies in the frame with all of its rows and may be streamed there.
struct StreamTarget {
    StreamTarget(const std::byte* pixels, Framebuffer& frame, std::int32_t left, std::int32_t top) {
        if (left + kTileSize > frame.width() || top + kTileSize > frame.height()) return;
        std::byte* const first =
            frame.row(top) + static_cast<std::size_t>(left) * pixel_size(frame.format());
        stride = frame.row(top + 1) - frame.row(top);
        if (can_stream(first, pixels, static_cast<std::size_t>(stride))) to = first;
    }
    std::byte* to = nullptr;  ///< null: not there
    std::ptrdiff_t stride = 0;
};

void resolve_pixels(const std::byte* pixels, Framebuffer& frame, std::int32_t left,
                    std::int32_t top) {
    const StreamTarget target(pixels, frame, left, top);
    if (target.to != nullptr) {
        stream_tile(pixels, pixel_size(frame.format()), target.to, target.stride);
    } else {
        for_each_row(frame, left, top,
                     [&](std::size_t in_tile, std::int32_t y, std::size_t in_row, auto n) {
                         stream_copy(frame.row(y) + in_row, pixels + in_tile, n);
                     });
    }
}

/// Depths to a frame of depths. A store that clears waits for those before it, which are on their
/// way to the frame; between them it waits the least.
bool resolve_and_clear(float* depths, Framebuffer& frame, std::int32_t left, std::int32_t top) {
    auto* const pixels = reinterpret_cast<std::byte*>(depths);
    const StreamTarget target(pixels, frame, left, top);
    if (target.to == nullptr) {
        resolve_pixels(pixels, frame, left, top);
        return false;
    }
    static constexpr std::array<float, kBlockSize> kFar{1, 1, 1, 1, 1, 1, 1, 1};
    stream_tile<sizeof(float)>(pixels, target.to, target.stride,
                               [](std::byte* row) { std::memcpy(row, kFar.data(), sizeof kFar); });
    return true;
}

}  // namespace

TileImage::TileImage(PixelFormat format)
    : m_format(format),
      m_pixel_size(pixel_size(format)),
      m_pixels((kTilePixels + 1) * m_pixel_size),  // kNoPixel, too
      m_background(kTileSize * m_pixel_size) {}

void TileImage::set_background(const glm::vec4& color) {
    const EncodedPixel pixel = encode_pixel(color, m_format);
    for (std::size_t at = 0; at < m_background.size(); at += m_pixel_size) {
        std::memcpy(m_background.data() + at, pixel.bytes, m_pixel_size);
    }
}

void TileImage::clear() {
    for (auto to = m_pixels.begin();
         to != m_pixels.end() - static_cast<std::ptrdiff_t>(m_pixel_size);) {
        to = std::copy(m_background.begin(), m_background.end(), to);
    }
}

void TileImage::load(const Framebuffer& frame, std::int32_t left, std::int32_t top) {
    for_each_row(frame, left, top,
                 [&](std::size_t in_tile, std::int32_t y, std::size_t in_row, auto n) {
                     std::memcpy(m_pixels.data() + in_tile, frame.row(y) + in_row, n);
                 });
}

void TileImage::resolve(Framebuffer& frame, std::int32_t left, std::int32_t top) const {
    resolve_pixels(m_pixels.data(), frame, left, top);
}

bool TileImage::resolve_depths(float* depths, Framebuffer& frame, std::int32_t left,
                               std::int32_t top) {
    const auto nearest = [](float one) {
        return [one](float depth) {
            const float x = depth > 0.0F ? std::min(depth, 1.0F) : 0.0F;
            return static_cast<std::int32_t>(x * one + 0.5F);
        };
    };
    switch (m_format) {
        case PixelFormat::depth32f:
            return resolve_and_clear(depths, frame, left, top);
        case PixelFormat::rgba8:
            write_greys<std::uint8_t>(depths, m_pixels.data(), 255, nearest(255.0F));
            break;
        case PixelFormat::rgba16:
            write_greys<std::uint16_t>(depths, m_pixels.data(), 65535, nearest(65535.0F));
            break;
        case PixelFormat::rgba32f:
            write_greys<float>(depths, m_pixels.data(), 1.0F, [](float depth) { return depth; });
            break;
    }
    resolve(frame, left, top);
    return false;
}

void TileImage::resolve_empty(Framebuffer& frame, std::int32_t left, std::int32_t top) const {
    const std::int32_t rows = std::min(kTileSize, frame.height() - top);
    const auto columns = static_cast<std::size_t>(std::min(kTileSize, frame.width() - left));
    for (std::int32_t y = top; y < top + rows; ++y) {
        stream_copy(frame.row(y) + static_cast<std::size_t>(left) * m_pixel_size,
                    m_background.data(), columns * m_pixel_size);
    }
}

}  // namespace burnish
