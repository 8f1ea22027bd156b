#pragma once

#include <burnish/texture.hpp>
#include <cstddef>
#include <cstdint>

namespace burnish {

/// Channel c (0 .. 3: r, g, b, a) of the texel in column x and row y; x may be width() and y
/// height(), where a texture keeps the right and the lower neighbours of its last texels.
inline std::uint8_t texel_byte(const Texture& texture, int x, int y, int c) {
    const std::ptrdiff_t offset = static_cast<std::ptrdiff_t>(y) * texture.pitch() + 4 * x + c;
    return texture.texels()[offset];
}

}  // namespace burnish
