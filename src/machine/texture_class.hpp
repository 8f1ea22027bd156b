#pragma once

#include <burnish/texture.hpp>

namespace burnish {

enum class TextureTarget { one_d, two_d, rectangle, cube, three_d };

enum class TexelClass {
    unsigned_rgba,
    signed_rgba,
    mixed,
    hilo,
    signed_hilo,
    dsdt,
    dsdt_mag,
    dsdt_mag_intensity,
};

inline TexelClass format_class(TexelFormat format) {
    return format == TexelFormat::signed_rgba8 ? TexelClass::signed_rgba
                                               : TexelClass::unsigned_rgba;
}

inline TextureTarget target_of(const Texture& /*texture*/) {
    return TextureTarget::two_d;
}

}  // namespace burnish
