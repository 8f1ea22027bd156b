#pragma once

#include <burnish/texture.hpp>

namespace burnish {

enum class TextureTarget { one_d, two_d, rectangle, cube, three_d };

enum class FormatClass {
    unsigned_rgba,
    signed_rgba,
    mixed,
    hilo,
    signed_hilo,
    dsdt,
    dsdt_mag,
    dsdt_mag_intensity,
};

inline FormatClass format_class(TexelFormat format) {
    return format == TexelFormat::signed_rgba8 ? FormatClass::signed_rgba
                                               : FormatClass::unsigned_rgba;
}

inline TextureTarget target_of(const Texture& /*texture*/) {
    return TextureTarget::two_d;
}

}  // namespace burnish
