#include <algorithm>
#include <burnish/anisotropy.hpp>
#include <burnish/error.hpp>
#include <cmath>
#include <glm/glm.hpp>
#include <string>
#include <utility>
#include <vector>

#include "core/dmath.hpp"
#include "models/texel.hpp"
#include "models/vector_encoding.hpp"

namespace burnish {
namespace {

std::uint8_t unsigned_code(double x) {
    return static_cast<std::uint8_t>(std::floor(255.0 * std::clamp(x, 0.0, 1.0) + 0.5));
}

std::uint8_t vector_code(VectorEncoding encoding, double x) {
    return static_cast<std::uint8_t>(encode_vector_code(encoding, x, 8));
}

/// A texel of anisotropyTexture as a unit direction before the rotation.
glm::dvec2 gltf_direction(const std::uint8_t* texel) {
    const glm::dvec2 d(decode_vector_code(VectorEncoding::a, texel[0], 8),
                       decode_vector_code(VectorEncoding::a, texel[1], 8));
    const double length = std::sqrt(d.x * d.x + d.y * d.y);
    // The codes next to zero stand for none at all.
    return length > 0.01 ? d / length : glm::dvec2(1.0, 0.0);
}

/// Largest and smallest number of a list, and the code of one in between.
CodedRange range_of(const std::vector<double>& values) {
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    return {static_cast<float>(*low), static_cast<float>(*high)};
}

std::uint8_t code_in(const CodedRange& range, double x) {
    const auto low = static_cast<double>(range.low), high = static_cast<double>(range.high);
    return high > low ? unsigned_code((x - low) / (high - low)) : std::uint8_t{0};
}

}  // namespace

LobeWidths widths_from_gltf(const GltfAnisotropy& anisotropy) {
    const double alpha = anisotropy.roughness * anisotropy.roughness;
    const double share = anisotropy.strength * anisotropy.strength;
    return {alpha * (1.0 - share) + share, alpha, anisotropy.rotation};
}

GltfAnisotropy gltf_from_widths(const LobeWidths& widths) {
    const double wide = std::max(widths.alpha_x, widths.alpha_y);
    const double narrow = std::min(widths.alpha_x, widths.alpha_y);
    GltfAnisotropy result{std::sqrt(narrow), 0.0, 0.0};
    if (wide == narrow) return result;
    result.strength = std::sqrt((wide - narrow) / (1.0 - narrow));
    double turn = widths.direction / dmath::kPi + (widths.alpha_x < widths.alpha_y ? 0.5 : 0.0);
    turn -= std::ceil(turn - 0.5);
    result.rotation = turn * dmath::kPi;
    return result;
}

AnisotropyMaps anisotropy_maps_from_gltf(const Image8& anisotropy, const Image8& roughness,
                                         const GltfAnisotropy& factors) {
    const int width = anisotropy.width, height = anisotropy.height;
    const bool has_roughness = !roughness.rgba.empty();
    if (width < 1 || height < 1 ||
        (has_roughness && (roughness.width != width || roughness.height != height)))
        throw Error(ErrorCode::bad_input,
                    "an anisotropy texture of " + std::to_string(width) + " x " +
                        std::to_string(height) + " and a roughness texture of " +
                        std::to_string(roughness.width) + " x " + std::to_string(roughness.height) +
                        ", expected one size");
    AnisotropyMaps maps{Image8(width, height), Image8(width, height), {}, {}};
    const double c = dmath::cos(factors.rotation), s = dmath::sin(factors.rotation);
    const std::size_t count = anisotropy.rgba.size() / 4;
    std::vector<double> alpha_x(count), alpha_y(count);
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint8_t* texel = anisotropy.rgba.data() + 4 * i;
        GltfAnisotropy here = factors;
        here.strength *= texel[2] / 255.0;
        if (has_roughness) here.roughness *= roughness.rgba[4 * i + 1] / 255.0;
        const LobeWidths widths = widths_from_gltf(here);
        alpha_x[i] = widths.alpha_x;
        alpha_y[i] = widths.alpha_y;
        const glm::dvec2 d = gltf_direction(texel);
        std::uint8_t* direction = maps.direction.rgba.data() + 4 * i;
        direction[0] = vector_code(VectorEncoding::d, c * d.x - s * d.y);
        direction[1] = vector_code(VectorEncoding::d, s * d.x + c * d.y);
        direction[2] = vector_code(VectorEncoding::d, 0.0);
        direction[3] = 255;
    }
    maps.alpha_x_range = range_of(alpha_x);
    maps.alpha_y_range = range_of(alpha_y);
    for (std::size_t i = 0; i < count; ++i) {
        std::uint8_t* alpha = maps.alpha.rgba.data() + 4 * i;
        alpha[0] = code_in(maps.alpha_x_range, alpha_x[i]);
        alpha[1] = code_in(maps.alpha_y_range, alpha_y[i]);
        alpha[3] = 255;
    }
    return maps;
}

GltfAnisotropyMaps gltf_anisotropy_maps(const Material& material) {
    const TexelSource source(material);
    GltfAnisotropyMaps maps{Image8(source.width(), source.height()),
                            Image8(source.width(), source.height())};
    for (int y = 0; y < source.height(); ++y) {
        for (int x = 0; x < source.width(); ++x) {
            const TexelParameters p = source.at(x, y);
            const GltfAnisotropy g =
                gltf_from_widths({p.alpha_x, p.alpha_y, dmath::atan2(p.t.y, p.t.x)});
            std::uint8_t* anisotropy = maps.anisotropy.at(x, y);
            anisotropy[0] = vector_code(VectorEncoding::a, dmath::cos(g.rotation));
            anisotropy[1] = vector_code(VectorEncoding::a, dmath::sin(g.rotation));
            anisotropy[2] = unsigned_code(g.strength);
            anisotropy[3] = 255;
            std::uint8_t* roughness = maps.roughness.at(x, y);
            roughness[0] = roughness[2] = roughness[3] = 255;
            roughness[1] = unsigned_code(g.roughness);
        }
    }
    return maps;
}

}  // namespace burnish
