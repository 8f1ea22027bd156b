#include "models/generators/brushed.hpp"

#include <algorithm>
#include <array>
#include <burnish/error.hpp>
#include <burnish/materials.hpp>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "models/generators/field.hpp"
#include "models/generators/noise.hpp"
#include "models/generators/surface.hpp"

namespace burnish {
namespace {

using namespace generators;

/// Widths of the lobe along and across the marks, and how far they stray, relative.
constexpr double kAlphaAlong = 0.29;
constexpr double kAlphaAcross = 0.75;
constexpr double kAlongSpread = 0.12;
constexpr double kAcrossSpread = 0.25;

/// The even grain of the brush: heights in texels, long along u.
void add_grain(Field& height, std::uint32_t seed) {
    struct Octave {
        double along, across, amplitude;
    };
    // Slopes across the marks come out near 0.1: amplitude over half a cell.
    constexpr std::array<Octave, 3> kOctaves{
        {{70.0, 2.0, 0.07}, {140.0, 5.0, 0.16}, {260.0, 14.0, 0.3}}};
    for (std::size_t k = 0; k < kOctaves.size(); ++k) {
        const Octave& octave = kOctaves[k];
        const SurfaceNoise noise(mix(seed, static_cast<std::uint32_t>(k)), height.size(),
                                 octave.along, octave.across);
        for (int y = 0; y < height.size(); ++y) {
            for (int x = 0; x < height.size(); ++x)
                height.at(x, y) += octave.amplitude * noise.at(x, y);
        }
    }
}

/// One groove, nearly along u, that fades at both ends.
struct Scratch {
    double x, y;        ///< start, texels
    double length;      ///< along u, texels
    double slope;       ///< rows per column
    double half_width;  ///< texels
    double depth;       ///< texels
};

void cut(Field& height, const Scratch& scratch) {
    const int steps = static_cast<int>(scratch.length);
    const int reach = static_cast<int>(scratch.half_width) + 1;
    for (int i = 0; i < steps; ++i) {
        const double middle = scratch.y + scratch.slope * i;
        const double along = (i + 0.5) / steps;
        const double depth = scratch.depth * 4.0 * along * (1.0 - along);
        const int nearest = static_cast<int>(std::floor(middle + 0.5));
        for (int row = nearest - reach; row <= nearest + reach; ++row) {
            const double d = (row - middle) / scratch.half_width;
            if (d * d >= 1.0) continue;
            const double profile = (1.0 - d * d) * (1.0 - d * d);
            height.at(static_cast<int>(scratch.x) + i, row) -= depth * profile;
        }
    }
}

/// `per_million` scratches for every million texels, up to `deepest` texels deep.
void add_scratches(Field& height, std::uint32_t seed, double per_million, double deepest) {
    Random random(seed);
    const int size = height.size();
    const double scale = size / kDesignSize;
    const int count = static_cast<int>(per_million * 1e-6 * kDesignSize * kDesignSize + 0.5);
    for (int i = 0; i < count; ++i) {
        Scratch scratch{};
        scratch.x = random.next() * size;
        scratch.y = random.next() * size;
        scratch.length = random.between(0.04, 0.40) * size;
        scratch.slope = random.between(-0.05, 0.05);
        scratch.half_width = random.between(1.2, 2.2) * std::max(scale, 0.5);
        scratch.depth = random.between(0.3, 1.0) * deepest * scale;
        cut(height, scratch);
    }
}

std::uint8_t signed_code(double x) {
    return static_cast<std::uint8_t>(std::clamp(std::floor(127.5 * x + 128.0), 0.0, 255.0));
}

std::uint8_t unsigned_code(double x) {
    return static_cast<std::uint8_t>(std::clamp(std::floor(255.0 * x + 0.5), 0.0, 255.0));
}

void store_vector(Image8& image, int x, int y, const glm::dvec3& v, double scale) {
    std::uint8_t* texel = image.at(x, y);
    texel[0] = signed_code(v.x * scale);
    texel[1] = signed_code(v.y * scale);
    texel[2] = signed_code(v.z * scale);
    texel[3] = 255;
}

/// Largest of 1, 1/2, 1/4, 1/8 that does not exceed the narrowest lobe.
float scale_for(double narrowest) {
    float scale = 1.0F;
    while (scale > 0.125F && static_cast<double>(scale) > narrowest) scale *= 0.5F;
    return scale;
}

/// Everything that the maps say, texel by texel.
class BrushedSurface {
  public:
    BrushedSurface(std::uint32_t seed, int size)
        : m_height(size),
          m_along(mix(seed, 4), size, 128.0, 3.0),
          m_across(mix(seed, 5), size, 256.0, 24.0),
          m_shine(mix(seed, 6), size, 170.0, 2.0) {
        add_grain(m_height, mix(seed, 1));
        add_scratches(m_height, mix(seed, 2), 1200.0, 0.35);
        add_scratches(m_height, mix(seed, 3), 130.0, 1.1);
    }

    [[nodiscard]] glm::dvec3 normal(int x, int y) const { return normal_at(m_height, x, y); }
    [[nodiscard]] double alpha_x(int x, int y) const {
        return kAlphaAlong * (1.0 + kAlongSpread * m_along.at(x, y));
    }
    [[nodiscard]] double alpha_y(int x, int y) const {
        return kAlphaAcross * (1.0 + kAcrossSpread * m_across.at(x, y));
    }
    [[nodiscard]] double grey_ks(int x, int y) const { return 0.82 + 0.18 * m_shine.at(x, y); }

  private:
    Field m_height;
    SurfaceNoise m_along, m_across, m_shine;
};

/// Steel is a trace warmer than grey.
constexpr glm::dvec3 kSteelTint(1.0, 0.975, 0.94);
constexpr glm::dvec3 kSteelKd(0.26, 0.26, 0.27);
constexpr double kSteelKs = 0.95;

}  // namespace

BrushedMaps brushed_maps(std::uint32_t seed, int size) {
    if (size < 1 || size > 4096)
        throw Error(ErrorCode::bad_option,
                    "brushed maps of side " + std::to_string(size) + ", expected 1 .. 4096");
    const BrushedSurface surface(seed, size);
    BrushedMaps maps{Image8(size, size), Image8(size, size), Image8(size, size), Image8(size, size),
                     scale_for(kAlphaAlong * (1.0 - kAlongSpread))};
    const auto m = static_cast<double>(maps.map_scale);
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            const glm::dvec3 n = surface.normal(x, y);
            const glm::dvec3 t = unit(glm::dvec3(1.0 - n.x * n.x, -n.x * n.y, -n.x * n.z));
            store_vector(maps.normal, x, y, n, 1.0);
            store_vector(maps.tangent, x, y, t, m / surface.alpha_x(x, y));
            store_vector(maps.bitangent, x, y, glm::cross(n, t), m / surface.alpha_y(x, y));
            const double ks = surface.grey_ks(x, y);
            maps.tangent.at(x, y)[3] = unsigned_code(ks);
            std::uint8_t* specular = maps.specular.at(x, y);
            for (int c = 0; c < 3; ++c) specular[c] = unsigned_code(kSteelTint[c] * ks);
            specular[3] = unsigned_code(ks);
        }
    }
    return maps;
}

generators::Surface generators::brushed(std::uint32_t seed, int size) {
    const auto surface = std::make_shared<const BrushedSurface>(seed, size);
    return [surface](int x, int y) {
        SurfaceTexel texel;
        texel.normal = surface->normal(x, y);
        texel.alpha_x = surface->alpha_x(x, y);
        texel.alpha_y = surface->alpha_y(x, y);
        texel.exponent = 2.0;
        texel.kd = kSteelKd;
        texel.ks = kSteelKs * surface->grey_ks(x, y) * kSteelTint;
        return texel;
    };
}

Material brushed_steel(std::uint32_t seed) {
    constexpr int kSize = 512;
    const BrushedMaps maps = brushed_maps(seed, kSize);
    const Sampler sampler;
    Material steel;
    steel.name = "brushed-steel";
    steel.kd = glm::vec3(kSteelKd);
    steel.ks = glm::vec3(static_cast<float>(kSteelKs));
    steel.alpha_x = static_cast<float>(kAlphaAlong);
    steel.alpha_y = static_cast<float>(kAlphaAcross);
    steel.normal_map = std::make_shared<const Texture>(maps.normal, sampler);
    steel.tangent_map = std::make_shared<const Texture>(maps.tangent, sampler);
    steel.bitangent_map = std::make_shared<const Texture>(maps.bitangent, sampler);
    steel.map_scale = maps.map_scale;
    steel.specular_map = std::make_shared<const Texture>(maps.specular, sampler);
    return steel;
}

}  // namespace burnish
