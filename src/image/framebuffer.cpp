#include <fmt/format.h>

#include <algorithm>
#include <burnish/error.hpp>
#include <burnish/framebuffer.hpp>
#include <cstdint>

#include "core/aligned.hpp"

namespace burnish {

namespace {

std::ptrdiff_t channel_size(PixelFormat format) {
    const std::size_t channels = format == PixelFormat::depth32f ? 1 : 4;
    return static_cast<std::ptrdiff_t>(pixel_size(format) / channels);
}

void check_size(int width, int height) {
    const auto fits = [](int side) { return side >= 1 && side <= Framebuffer::kMaxSize; };
    if (!fits(width) || !fits(height)) {
        throw Error(ErrorCode::bad_option,
                    fmt::format("frame size {}x{}, expected 1 .. {} both ways", width, height,
                                Framebuffer::kMaxSize));
    }
}

}  // namespace

std::size_t pixel_size(PixelFormat format) noexcept {
    switch (format) {
        case PixelFormat::rgba8:
        case PixelFormat::depth32f:
            return 4;
        case PixelFormat::rgba16:
            return 8;
        case PixelFormat::rgba32f:
            return 16;
    }
    return 0;
}

Framebuffer::Framebuffer(int width, int height, PixelFormat format)
    : m_width(width), m_height(height), m_format(format) {
    check_size(width, height);
    m_pitch = static_cast<std::ptrdiff_t>(pixel_size(format)) * width;
    // Whole cache lines, so that rows can be written past the caches.
    const auto bytes = static_cast<std::size_t>(m_pitch) * static_cast<std::size_t>(height);
    m_pixels = static_cast<std::byte*>(allocate_aligned(bytes));
    m_owned.reset(m_pixels, [bytes](std::byte* p) { free_aligned(p, bytes); });
    std::fill_n(m_pixels, bytes, std::byte{0});
}

Framebuffer::Framebuffer(void* pixels, std::ptrdiff_t pitch, int width, int height,
                         PixelFormat format)
    : m_pixels(static_cast<std::byte*>(pixels)),
      m_pitch(pitch),
      m_width(width),
      m_height(height),
      m_format(format) {
    check_size(width, height);
    const std::ptrdiff_t packed = static_cast<std::ptrdiff_t>(pixel_size(format)) * width;
    if (pitch < packed || pitch % channel_size(format) != 0) {
        throw Error(ErrorCode::bad_option,
                    fmt::format("row pitch {}, expected a multiple of {} and at least {}", pitch,
                                channel_size(format), packed));
    }
    if (pixels == nullptr || reinterpret_cast<std::uintptr_t>(pixels) %
                                     static_cast<std::uintptr_t>(channel_size(format)) !=
                                 0) {
        throw Error(ErrorCode::bad_option,
                    fmt::format("pixels at {}, expected an address that is a multiple of {}",
                                pixels, channel_size(format)));
    }
}

}  // namespace burnish
