#pragma once

#include <array>
#include <burnish/texture.hpp>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

/// From the images of a texture to texels as they are stored: formats, border, mip levels.
namespace burnish {

/// Where a channel of a stored texel comes from: one of the image, or the same everywhere.
struct TexelChannel {
    enum class From : std::uint8_t { r, g, b, a, zero, one };
    From from;
    bool is_signed = false;
};
using TexelChannels = std::array<TexelChannel, 4>;  ///< hilo formats: the first two
[[nodiscard]] const TexelChannels& texel_channels(TexelFormat format) noexcept;

/// One level: all its faces or slices one after the other, rows packed, texels as stored.
struct TexelLevel {
    int width, height, layers;
    std::size_t texel_bytes;
    std::vector<std::uint8_t> bytes;

    TexelLevel(int w, int h, int n, std::size_t size_of_texel);
    [[nodiscard]] std::uint8_t* row(int layer, int y);
    [[nodiscard]] const std::uint8_t* row(int layer, int y) const;
};

/// `images` are of one size, their sides and byte counts checked.
[[nodiscard]] TexelLevel encode_texels(std::span<const Image8> images, TexelFormat format);
[[nodiscard]] TexelLevel encode_texels(std::span<const Image16> images, TexelFormat format);

/// A border colour as a stored texel.
[[nodiscard]] std::array<std::uint8_t, 8> border_texel(const std::array<float, 4>& color,
                                                       TexelFormat format);

/// The next mip level; `halve_layers` for slices.
[[nodiscard]] TexelLevel box_level(const TexelLevel& level, TexelFormat format, bool halve_layers);

}  // namespace burnish
