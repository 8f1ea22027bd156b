#include "bench/peers/peer_textures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <burnish/error.hpp>
#include <cmath>
#include <numbers>
#include <span>
#include <string_view>
#include <vector>

#include "models/layer.hpp"

namespace burnish::peers {

namespace {

std::uint8_t byte_of(double x) {
    return static_cast<std::uint8_t>(std::floor(std::clamp(x, 0.0, 255.0) + 0.5));
}

TexturePtr texture_of(const Image8& image) {
    return std::make_shared<const Texture>(image, Sampler{});
}

/// A quantity of the layer at every texel, row after row.
struct LayerValues {
    int width = 0, height = 0;
    std::vector<glm::dvec3> values;
};

LayerValues layer_values(const Material& material, std::string_view name) {
    const std::vector<LayerQuantity> layer = material_layer(material, machine_profile("ideal"));
    const auto found = std::ranges::find_if(
        layer, [&](const LayerQuantity& quantity) { return quantity.name == name; });
    if (found == layer.end() || !found->texture) {
        throw Error(ErrorCode::bad_program,
                    fmt::format("material '{}': no map of {} in its layer", material.name, name));
    }
    const Texture& texture = *found->texture;
    const double one = has_words(texture.format()) ? 65535.0 : 255.0;
    LayerValues layer_values{texture.width(), texture.height(), {}};
    for (int y = 0; y < texture.height(); ++y) {
        for (int x = 0; x < texture.width(); ++x) {
            glm::dvec3 code(0.0);
            for (int c = 0; c < found->components; ++c)
                code[c] = texture.texel(0, 0, x, y, found->channel + c) / one;
            layer_values.values.push_back(found->decoded(code));
        }
    }
    return layer_values;
}

TexturePtr coded(const LayerValues& layer, double factor, double offset) {
    Image8 image(layer.width, layer.height);
    for (std::size_t i = 0; i < layer.values.size(); ++i) {
        for (int c = 0; c < 3; ++c)
            image.rgba[4 * i + static_cast<std::size_t>(c)] =
                byte_of(factor * layer.values[i][c] + offset);
        image.rgba[4 * i + 3] = 255;
    }
    return texture_of(image);
}

}  // namespace

Image8 texels_of(const Texture& texture, std::size_t level) {
    const TextureLevel& sides = texture.levels()[level];
    Image8 image(sides.width, sides.height);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            for (int c = 0; c < 4; ++c)
                image.at(x, y)[c] = static_cast<std::uint8_t>(texture.texel(level, 0, x, y, c));
    return image;
}

TexturePtr brightened(const Texture& texture) {
    Image8 image = texels_of(texture);
    int largest = 1;
    for (std::size_t i = 0; i < image.rgba.size(); ++i)
        if (i % 4 != 3) largest = std::max<int>(largest, image.rgba[i]);
    for (std::size_t i = 0; i < image.rgba.size(); ++i)
        if (i % 4 != 3) image.rgba[i] = byte_of(255.0 * image.rgba[i] / largest);
    return texture_of(image);
}

TexturePtr opaque(const Texture& texture) {
    Image8 image = texels_of(texture);
    for (std::size_t i = 3; i < image.rgba.size(); i += 4) image.rgba[i] = 255;
    return texture_of(image);
}

TexturePtr with_mipmaps(const Texture& texture) {
    const Image8 image = texels_of(texture);
    TextureDescription description;
    description.sampler.filter = Filter::linear_mipmap_linear;
    description.box_mipmaps = true;
    return std::make_shared<const Texture>(std::span(&image, 1), description);
}

TexturePtr with_alpha_waves(const Texture& texture) {
    Image8 image = texels_of(texture);
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            const double turns =
                static_cast<double>(x) / image.width + static_cast<double>(y) / image.height;
            image.at(x, y)[3] = byte_of(127.5 + 127.5 * std::sin(2.0 * std::numbers::pi * turns));
        }
    }
    return texture_of(image);
}

TexturePtr stripes_with_alpha() {
    Image8 image(512, 512);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            for (int c = 0; c < 4; ++c)
                image.at(x, y)[c] = static_cast<std::uint8_t>(x * (c + 3) + y * 7 + x * y / 16);
    return texture_of(image);
}

TexturePtr power_table(float low, float high) {
    constexpr int kSize = 256;
    Image8 image(kSize, kSize);
    for (int y = 0; y < kSize; ++y) {
        for (int x = 0; x < kSize; ++x) {
            const double exponent = low + (high - low) * (y / 255.0);
            const std::uint8_t value = byte_of(255.0 * std::pow(x / 255.0, 0.5 * exponent));
            std::fill_n(image.at(x, y), 4, value);
        }
    }
    const Sampler clamped{.wrap_s = Wrap::clamp_to_edge, .wrap_t = Wrap::clamp_to_edge};
    return std::make_shared<const Texture>(image, clamped);
}

TexturePtr tangent_bytes(const Material& material) {
    return coded(layer_values(material, "t"), 127.5, 128.0);
}

std::pair<TexturePtr, float> specular_bytes(const Material& material) {
    const LayerValues layer = layer_values(material, "S");
    double largest = 0.0;
    for (const glm::dvec3& value : layer.values)
        largest = std::max({largest, value.r, value.g, value.b});
    return {coded(layer, 255.0 / largest, 0.0), static_cast<float>(largest)};
}

}  // namespace burnish::peers
