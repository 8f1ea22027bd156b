#pragma once

#include <burnish/texture.hpp>
#include <cstddef>
#include <cstdint>

namespace burnish {

/// The image's byte of channel c (0 .. 3: r, g, b, a) of the texel in column x and row y; x may be
/// width() and y height(), where a texture keeps the right and the lower neighbours of its last
/// texels.
inline std::uint8_t texel_byte(const Texture& texture, int x, int y, int c) {
    const std::ptrdiff_t offset = static_cast<std::ptrdiff_t>(y) * texture.pitch() + 4 * x + c;
    const std::uint8_t stored = texture.texels()[offset];
    return texture.format() == TexelFormat::signed_rgba8 ? stored ^ 0x80U : stored;
}

/// The number that it stands for.
inline double texel_value(const Texture& texture, int x, int y, int c) {
    const std::uint8_t byte = texel_byte(texture, x, y, c);
    if (texture.format() == TexelFormat::rgba8) return byte / 255.0;
    return static_cast<std::int8_t>(byte) / 128.0;
}

}  // namespace burnish
