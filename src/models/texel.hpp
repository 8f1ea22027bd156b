#pragma once

#include <burnish/scene.hpp>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <vector>

namespace burnish {

namespace mips {
struct ParameterGrid;
}

/// The widths that lobes are kept within, whatever a map says.
inline constexpr double kLeastAlpha = 0.001;
inline constexpr double kMostAlpha = 1.0;

/// What a material says at one texel. Vectors are unit and orthonormal, but for what
/// MipMethod::box leaves of them, in the surface's tangent frame: x along u, y towards smaller
/// rows, z along the normal; b = n x t.
struct TexelParameters {
    glm::dvec3 n{0.0, 0.0, 1.0}, t{1.0, 0.0, 0.0}, b{0.0, 1.0, 0.0};
    double alpha_x = 1.0, alpha_y = 1.0;  ///< [kLeastAlpha, kMostAlpha]
    double exponent = 2.0;                ///< not negative
    glm::dvec3 kd{0.0}, ks{0.0};          ///< not negative
};

/// `v` made perpendicular to the unit vector n, and unit; where it has nothing left, the direction
/// that it tends to as n approaches it from the z axis.
[[nodiscard]] glm::dvec3 perpendicular(const glm::dvec3& v, const glm::dvec3& n);

/// The parameters of a material texel by texel, on the grid of its finest map: the one with the
/// most texels. Other maps are sampled at its texel centres with their own filter, vectors and
/// colours after decoding. In double, of + - * / and sqrt and core/dmath.hpp alone: the same bits
/// everywhere. Mip levels are those of Material::mipmaps; there are none without it.
///
/// The tangent is direction_map's, by default the u axis, made perpendicular to the normal. Where
/// tangent_map and bitangent_map are given, they say tangent and widths instead, and without a
/// normal_map the normal t x b.
class TexelSource {
  public:
    /// Keeps the maps alive. Throws Error{bad_program} for a map that is not two-dimensional and
    /// for one of tangent_map and bitangent_map alone, Error{stopped} if `stop`, which is asked for
    /// every row of mip levels, says so.
    explicit TexelSource(const Material& material, std::function<bool()> stop = {});

    /// 1 x 1 without maps.
    [[nodiscard]] int width(int level = 0) const;
    [[nodiscard]] int height(int level = 0) const;
    /// At least 1.
    [[nodiscard]] int levels() const;
    /// Of the finest map; with mipmaps one that blends levels, if the map's does not look at them,
    /// and one that does not look at them for MipMethod::none. Probes are the material's or the
    /// map's, whichever are more.
    [[nodiscard]] const Sampler& sampler() const { return m_sampler; }
    /// Whether what is made from texels is to be averaged itself: maps have mip levels, and the
    /// material does not say how.
    [[nodiscard]] bool averages_layer() const { return m_averages_layer; }
    /// Whether there is any map.
    [[nodiscard]] bool varies() const { return m_varies; }
    /// 0 <= x < width(), 0 <= y < height(); row 0 on top. Safe from several threads.
    [[nodiscard]] TexelParameters at(int x, int y) const;
    [[nodiscard]] TexelParameters at(int level, int x, int y) const;
    /// For whoever goes through all texels: throws Error{stopped} once nobody wants them.
    void require_wanted() const;

  private:
    void make_mips();
    [[nodiscard]] std::vector<mips::ParameterGrid> mips_of_maps() const;
    /// Of a level of the maps, in its grid.
    struct MapLevel {
        int level, width, height;
    };
    [[nodiscard]] TexelParameters read(const MapLevel& in, int x, int y) const;
    [[nodiscard]] double parameter(const ParameterMap& map, float constant, const MapLevel& in,
                                   int x, int y) const;
    [[nodiscard]] glm::dvec3 color(const TexturePtr& map, const glm::vec3& factor,
                                   const MapLevel& in, int x, int y) const;
    [[nodiscard]] glm::dvec3 vector(const TexturePtr& map, VectorEncoding encoding,
                                    const MapLevel& in, int x, int y) const;
    [[nodiscard]] glm::dvec3 normal(const MapLevel& in, int x, int y) const;

    Material m_material;
    std::function<bool()> m_stop;
    Sampler m_sampler;
    std::vector<TextureLevel> m_map_levels;  ///< of the finest map
    int m_width = 1, m_height = 1;
    bool m_varies = false, m_averages_layer = false;
    std::shared_ptr<const std::vector<mips::ParameterGrid>> m_mips;  ///< level 1 first
};

}  // namespace burnish
