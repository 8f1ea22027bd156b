#include "shade/texture_texels.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/covered.hpp"

namespace burnish {

namespace {

using From = TexelChannel::From;

constexpr TexelChannel kR{From::r}, kG{From::g}, kB{From::b}, kA{From::a}, kZero{From::zero},
    kOne{From::one};
constexpr TexelChannel kSignedR{From::r, true}, kSignedG{From::g, true}, kSignedB{From::b, true},
    kSignedA{From::a, true};

/// Signed bytes are stored plus 128, unsigned words minus 32768.
std::uint8_t stored_byte(std::uint8_t value, bool is_signed) {
    return is_signed ? value ^ 0x80U : value;
}
std::uint16_t stored_word(std::uint16_t value, bool is_signed) {
    return is_signed ? value : value ^ 0x8000U;
}

std::uint16_t word_of(std::uint16_t value, bool /*is_signed*/) {
    return value;
}
/// n * 256 of signed bytes, n * 257 of unsigned ones: the same fraction of the range.
std::uint16_t word_of(std::uint8_t value, bool is_signed) {
    return static_cast<std::uint16_t>(unsigned{value} * (is_signed ? 256U : 257U));
}

template <class Value>
Value taken(const Value* rgba, From from) {
    if (from == From::zero) return 0;
    if (from == From::one) return static_cast<Value>(~Value{0});
    return rgba[static_cast<std::size_t>(from)];
}

template <class Image>
void encode_words(const Image& image, const TexelChannels& channels, std::size_t count,
                  std::uint8_t* to) {
    for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
        for (std::size_t c = 0; c < count; ++c, to += 2) {
            const bool is_signed = channels[c].is_signed;
            const std::uint16_t word = stored_word(
                word_of(taken(image.rgba.data() + i, channels[c].from), is_signed), is_signed);
            std::memcpy(to, &word, sizeof word);
        }
    }
}

void encode_bytes(const Image8& image, const TexelChannels& channels, std::uint8_t* to) {
    for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
        for (const TexelChannel& channel : channels) {
            *to++ = stored_byte(taken(image.rgba.data() + i, channel.from), channel.is_signed);
        }
    }
}

/// A number of [0, 1] or [-1, 1] as the bits of an image's channel.
int quantised(float x, bool is_signed, int bits) {
    const float low = is_signed ? -1.0F : 0.0F;
    const float clamped = x > low ? std::min(x, 1.0F) : low;  // NaN gives `low`
    const int top = (1 << (is_signed ? bits - 1 : bits)) - 1;
    const auto scale = static_cast<float>(is_signed ? top + 1 : top);
    return std::min(static_cast<int>(std::floor(clamped * scale + 0.5F)), top);
}

template <class Channel>
void box_filter(const TexelLevel& from, TexelLevel& to) {
    const std::size_t channels = from.texel_bytes / sizeof(Channel);
    const std::int64_t whole =
        std::int64_t{from.width} * from.height * (to.layers < from.layers ? from.layers : 1);
    for (int z = 0; z < to.layers; ++z) {
        const Covered slices(from.layers, to.layers, z);
        for (int y = 0; y < to.height; ++y) {
            const Covered rows(from.height, to.height, y);
            for (int x = 0; x < to.width; ++x) {
                const Covered columns(from.width, to.width, x);
                std::int64_t sum[4] = {0, 0, 0, 0};
                for (int k = slices.first; k <= slices.last; ++k) {
                    const std::int64_t weight_z =
                        to.layers < from.layers ? slices.weight(k) : std::int64_t{1};
                    for (int j = rows.first; j <= rows.last; ++j) {
                        const std::int64_t weight_yz = weight_z * rows.weight(j);
                        for (int i = columns.first; i <= columns.last; ++i) {
                            const std::int64_t weight = weight_yz * columns.weight(i);
                            const std::uint8_t* texel =
                                from.row(k, j) + static_cast<std::size_t>(i) * from.texel_bytes;
                            for (std::size_t c = 0; c < channels; ++c) {
                                Channel value;
                                std::memcpy(&value, texel + c * sizeof value, sizeof value);
                                sum[c] += weight * value;
                            }
                        }
                    }
                }
                std::uint8_t* out = to.row(z, y) + static_cast<std::size_t>(x) * to.texel_bytes;
                for (std::size_t c = 0; c < channels; ++c) {
                    const std::int64_t twice = 2 * sum[c] + whole, by = 2 * whole;
                    const auto value = static_cast<Channel>(
                        twice >= 0 ? twice / by : -((-twice + by - 1) / by));  // floor
                    std::memcpy(out + c * sizeof value, &value, sizeof value);
                }
            }
        }
    }
}

}  // namespace

const TexelChannels& texel_channels(TexelFormat format) noexcept {
    static constexpr TexelChannels kTable[] = {
        {kR, kG, kB, kA},                          // rgba8
        {kR, kG, kB, kOne},                        // rgb8
        {kR, kR, kR, kOne},                        // luminance8
        {kR, kR, kR, kA},                          // luminance8_alpha8
        {kR, kR, kR, kR},                          // intensity8
        {kZero, kZero, kZero, kA},                 // alpha8
        {kR, kZero, kZero, kOne},                  // r8
        {kSignedR, kSignedG, kSignedB, kSignedA},  // signed_rgba8
        {kSignedR, kSignedG, kSignedB, kOne},      // signed_rgb8
        {kSignedR, kSignedG, kSignedB, kA},        // signed_rgb8_unsigned_alpha8
        {kSignedR, kSignedR, kSignedR, kOne},      // signed_luminance8
        {kSignedR, kSignedR, kSignedR, kSignedA},  // signed_luminance8_alpha8
        {kSignedR, kSignedR, kSignedR, kSignedR},  // signed_intensity8
        {kZero, kZero, kZero, kSignedA},           // signed_alpha8
        {kR, kG, kZero, kZero},                    // hilo16
        {kSignedR, kSignedG, kZero, kZero},        // signed_hilo16
        {kR, kG, kZero, kZero},                    // hilo8
        {kSignedR, kSignedG, kZero, kZero},        // signed_hilo8
        {kSignedR, kSignedG, kZero, kZero},        // dsdt8
        {kSignedR, kSignedG, kB, kZero},           // dsdt8_mag8
        {kSignedR, kSignedG, kB, kA},              // dsdt8_mag8_intensity8
        {kR, kG, kB, kA},                          // rgba16
    };
    return kTable[static_cast<std::size_t>(format)];
}

TexelClass format_class(TexelFormat format) noexcept {
    switch (format) {
        case TexelFormat::rgba8:
        case TexelFormat::rgb8:
        case TexelFormat::luminance8:
        case TexelFormat::luminance8_alpha8:
        case TexelFormat::intensity8:
        case TexelFormat::alpha8:
        case TexelFormat::r8:
        case TexelFormat::rgba16:
            return TexelClass::unsigned_rgba;
        case TexelFormat::signed_rgba8:
        case TexelFormat::signed_rgb8:
        case TexelFormat::signed_luminance8:
        case TexelFormat::signed_luminance8_alpha8:
        case TexelFormat::signed_intensity8:
        case TexelFormat::signed_alpha8:
            return TexelClass::signed_rgba;
        case TexelFormat::signed_rgb8_unsigned_alpha8:
            return TexelClass::mixed;
        case TexelFormat::hilo16:
        case TexelFormat::hilo8:
            return TexelClass::hilo;
        case TexelFormat::signed_hilo16:
        case TexelFormat::signed_hilo8:
            return TexelClass::signed_hilo;
        case TexelFormat::dsdt8:
            return TexelClass::dsdt;
        case TexelFormat::dsdt8_mag8:
            return TexelClass::dsdt_mag;
        case TexelFormat::dsdt8_mag8_intensity8:
            return TexelClass::dsdt_mag_intensity;
    }
    return TexelClass::unsigned_rgba;
}

bool is_hilo(TexelFormat format) noexcept {
    const TexelClass kind = format_class(format);
    return kind == TexelClass::hilo || kind == TexelClass::signed_hilo;
}

bool has_words(TexelFormat format) noexcept {
    return is_hilo(format) || format == TexelFormat::rgba16;
}

TexelLevel::TexelLevel(int w, int h, int n, std::size_t size_of_texel)
    : width(w),
      height(h),
      layers(n),
      texel_bytes(size_of_texel),
      bytes(static_cast<std::size_t>(w) * static_cast<std::size_t>(h) *
            static_cast<std::size_t>(n) * size_of_texel) {}

std::uint8_t* TexelLevel::row(int layer, int y) {
    const std::size_t rows = static_cast<std::size_t>(layer) * static_cast<std::size_t>(height) +
                             static_cast<std::size_t>(y);
    return bytes.data() + rows * static_cast<std::size_t>(width) * texel_bytes;
}
const std::uint8_t* TexelLevel::row(int layer, int y) const {
    return const_cast<TexelLevel*>(this)->row(layer, y);
}

namespace {

template <class Image>
TexelLevel empty_level(std::span<const Image> images, TexelFormat format) {
    return {images.front().width, images.front().height, static_cast<int>(images.size()),
            format == TexelFormat::rgba16 ? std::size_t{8} : std::size_t{4}};
}

template <class Image>
TexelLevel level_of_words(std::span<const Image> images, TexelFormat format) {
    TexelLevel level = empty_level(images, format);
    for (std::size_t k = 0; k < images.size(); ++k) {
        encode_words(images[k], texel_channels(format), level.texel_bytes / 2,
                     level.row(static_cast<int>(k), 0));
    }
    return level;
}

}  // namespace

TexelLevel encode_texels(std::span<const Image8> images, TexelFormat format) {
    if (has_words(format)) return level_of_words(images, format);
    TexelLevel level = empty_level(images, format);
    for (std::size_t k = 0; k < images.size(); ++k) {
        encode_bytes(images[k], texel_channels(format), level.row(static_cast<int>(k), 0));
    }
    return level;
}

TexelLevel encode_texels(std::span<const Image16> images, TexelFormat format) {
    return level_of_words(images, format);
}

std::array<std::uint8_t, 8> border_texel(const std::array<float, 4>& color, TexelFormat format) {
    const TexelChannels& channels = texel_channels(format);
    std::array<std::uint8_t, 8> texel{};
    const auto value = [&](std::size_t c, int bits) {
        const auto [from, is_signed] = channels[c];
        if (from == From::zero) return 0;
        if (from == From::one) return (1 << bits) - 1;
        return quantised(color[static_cast<std::size_t>(from)], is_signed, bits);
    };
    if (!has_words(format)) {
        for (std::size_t c = 0; c < 4; ++c) {
            texel[c] = stored_byte(static_cast<std::uint8_t>(value(c, 8)), channels[c].is_signed);
        }
        return texel;
    }
    for (std::size_t c = 0; c < 4; ++c) {
        const std::uint16_t word =
            stored_word(static_cast<std::uint16_t>(value(c, 16)), channels[c].is_signed);
        std::memcpy(texel.data() + 2 * c, &word, sizeof word);
    }
    return texel;
}

TexelLevel box_level(const TexelLevel& level, TexelFormat format, bool halve_layers) {
    const auto half = [](int side) { return std::max(side / 2, 1); };
    TexelLevel next(half(level.width), half(level.height),
                    halve_layers ? half(level.layers) : level.layers, level.texel_bytes);
    if (has_words(format)) {
        box_filter<std::int16_t>(level, next);
    } else {
        box_filter<std::uint8_t>(level, next);
    }
    return next;
}

}  // namespace burnish
