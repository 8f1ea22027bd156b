#include "trace/pixel.hpp"

#include <cmath>
#include <cstring>

#include "core/aligned.hpp"
#include "shade/output.hpp"

namespace burnish {

namespace {

/// Channels of the tile's first pixel as numbers.
std::array<double, 4> first_pixel(const TileImage& image) {
    std::array<double, 4> result{};
    const auto read = [&]<class Channel>(Channel) {
        Channel values[4];
        std::memcpy(values, image.pixels(), sizeof values);
        for (std::size_t c = 0; c < 4; ++c) result[c] = static_cast<double>(values[c]);
    };
    switch (image.format()) {
        case PixelFormat::rgba8:
            read(std::uint8_t{});
            break;
        case PixelFormat::rgba16:
            read(std::uint16_t{});
            break;
        case PixelFormat::rgba32f:
            read(float{});
            break;
        case PixelFormat::depth32f:  // refused by trace_pixel
            break;
    }
    return result;
}

double one_of(PixelFormat format) {
    return format == PixelFormat::rgba8 ? 255.0 : format == PixelFormat::rgba16 ? 65535.0 : 1.0;
}

/// A factor of channel c, in the frame's numbers; a difference from 1 is rounded in floats.
double factor_value(BlendFactor factor, std::size_t c, const TracedBlend& b, double one,
                    const std::array<double, 4>& constant) {
    const auto inverted = [&](double x) {
        return static_cast<double>(static_cast<float>(one - x));
    };
    switch (factor) {
        case BlendFactor::zero:
            return 0.0;
        case BlendFactor::one:
            return one;
        case BlendFactor::src_color:
            return b.source[c];
        case BlendFactor::one_minus_src_color:
            return inverted(b.source[c]);
        case BlendFactor::src_alpha:
            return b.source[3];
        case BlendFactor::one_minus_src_alpha:
            return inverted(b.source[3]);
        case BlendFactor::dst_color:
            return b.destination[c];
        case BlendFactor::one_minus_dst_color:
            return inverted(b.destination[c]);
        case BlendFactor::dst_alpha:
            return b.destination[3];
        case BlendFactor::one_minus_dst_alpha:
            return inverted(b.destination[3]);
        case BlendFactor::constant_color:
            return constant[c];
        case BlendFactor::one_minus_constant_color:
            return inverted(constant[c]);
    }
    return 0.0;
}

}  // namespace

TracedPixel::TracedPixel(const Scene& scene)
    : m_numbers(scene.machine.numbers), m_image(scene.format) {
    m_image.set_background(scene.background);
    m_image.clear();
}

std::array<double, 4> TracedPixel::channels() const {
    return first_pixel(m_image);
}

void TracedPixel::write(const TracedFragment& fragment, const std::optional<Blend>& blend,
                        TileImage& image) const {
    AlignedVector<std::int16_t> planes(4 * kPacketSize);
    for (std::size_t c = 0; c < 4; ++c) {
        planes[c * kPacketSize] = static_cast<std::int16_t>(fragment.codes[c]);
    }
    const std::uint16_t pixel = 0;
    Packet packet{1, &pixel, nullptr, planes.data(), nullptr, nullptr, nullptr};
    const OutputTile tile{static_cast<StoreFormat>(image.format()), image.pixels(), nullptr,
                          nullptr};
    write_pixels({0, 1, 2, 3}, m_numbers, blend, table_reference(), tile, packet);
}

void TracedPixel::take(TracedFragment& fragment, const std::optional<Blend>& blend) {
    const std::array<double, 4> before = channels();
    write(fragment, blend, m_image);
    if (!blend) return;
    TracedBlend traced{.blend = *blend};
    TileImage alone(m_image.format());
    write(fragment, std::nullopt, alone);
    traced.source = first_pixel(alone);
    traced.destination = before;
    traced.result = channels();
    alone.set_background(blend->constant);
    alone.clear();
    const std::array<double, 4> constant = first_pixel(alone);
    const double one = one_of(m_image.format());
    for (std::size_t c = 0; c < 4; ++c) {
        traced.source_factor[c] = factor_value(blend->src, c, traced, one, constant);
        traced.destination_factor[c] = factor_value(blend->dst, c, traced, one, constant);
    }
    fragment.blend = traced;
}

}  // namespace burnish
