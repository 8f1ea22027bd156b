#pragma once

#include <burnish/texture.hpp>
#include <cstddef>
#include <cstdint>

namespace burnish {

/// Bits of channel c (0 .. 3: r, g, b, a; hilo: 0, 1) of a texel as images have them: signed ones
/// in two's complement. x and y may be one beyond the sides of the level, where a texture keeps the
/// neighbours of its last texels.
inline std::uint16_t texel_bits(const Texture& texture, int level, int layer, int x, int y, int c) {
    const int number = texture.texel(static_cast<std::size_t>(level), layer, x, y, c);
    return static_cast<std::uint16_t>(has_words(texture.format()) ? number : number & 255);
}

/// The number that the texel stands for.
inline double texel_value(const Texture& texture, int level, int layer, int x, int y, int c) {
    const bool words = has_words(texture.format());
    const double one = texture.is_signed(c) ? (words ? 32768.0 : 128.0) : (words ? 65535.0 : 255.0);
    return texture.texel(static_cast<std::size_t>(level), layer, x, y, c) / one;
}

}  // namespace burnish
