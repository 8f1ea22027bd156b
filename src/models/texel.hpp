#pragma once

#include <burnish/scene.hpp>
#include <glm/glm.hpp>

namespace burnish {

/// The widths that lobes are kept within, whatever a map says.
inline constexpr double kLeastAlpha = 0.001;
inline constexpr double kMostAlpha = 1.0;

/// What a material says at one texel. Vectors are unit and orthonormal, in the surface's tangent
/// frame: x along u, y towards smaller rows, z along the normal; b = n x t.
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
/// everywhere.
///
/// The tangent is direction_map's, by default the u axis, made perpendicular to the normal. Where
/// tangent_map and bitangent_map are given, they say tangent and widths instead, and without a
/// normal_map the normal t x b.
class TexelSource {
  public:
    /// Keeps the maps alive. Throws Error{bad_program} for a map that is not two-dimensional and
    /// for one of tangent_map and bitangent_map alone.
    explicit TexelSource(const Material& material);

    /// 1 x 1 without maps.
    [[nodiscard]] int width() const { return m_width; }
    [[nodiscard]] int height() const { return m_height; }
    /// Of the finest map.
    [[nodiscard]] const Sampler& sampler() const { return m_sampler; }
    /// Whether any map has mip levels; what is made from texels has them then, too.
    [[nodiscard]] bool has_levels() const { return m_has_levels; }
    /// Whether there is any map.
    [[nodiscard]] bool varies() const { return m_varies; }
    /// 0 <= x < width(), 0 <= y < height(); row 0 on top. Safe from several threads.
    [[nodiscard]] TexelParameters at(int x, int y) const;

  private:
    [[nodiscard]] double parameter(const ParameterMap& map, float constant, int x, int y) const;
    [[nodiscard]] glm::dvec3 color(const TexturePtr& map, const glm::vec3& factor, int x,
                                   int y) const;
    [[nodiscard]] glm::dvec3 vector(const TexturePtr& map, VectorEncoding encoding, int x,
                                    int y) const;
    [[nodiscard]] glm::dvec3 normal(int x, int y) const;

    Material m_material;
    Sampler m_sampler;
    int m_width = 1, m_height = 1;
    bool m_varies = false, m_has_levels = false;
};

}  // namespace burnish
