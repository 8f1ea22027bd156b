#pragma once

#include <burnish/scene.hpp>
#include <glm/glm.hpp>

#include "models/mips/lobe_shape.hpp"
#include "models/mips/symmetric.hpp"
#include "models/texel.hpp"

namespace burnish::mips {

/// What is averaged over the texels that a texel of a mip level stands for. Means of means are
/// means: a level is made from the one before.
struct TexelMoments {
    glm::dvec3 n{0.0}, b{0.0};
    glm::dvec3 kd{0.0}, ks{0.0};
    double alpha_x = 0.0, alpha_y = 0.0;
    glm::dvec3 energy{0.0};  ///< of the lobe

    /// From here on what MipMethod::moments weights by the luminance of the energy.
    glm::dvec3 t{0.0};
    /// (cos 2a, sin 2a) of the angle a from u to the direction that, made perpendicular to n, is t:
    /// the mean of lines, which have no sense.
    glm::dvec2 doubled{0.0};
    double exponent = 0.0;
    glm::dvec2 slope{0.0};  ///< of the normal
    Symmetric second;  ///< slope slope^T; for the two methods of moments plus the lobe's covariance
};

/// Of one texel.
[[nodiscard]] TexelMoments moments_of(const TexelParameters& texel, const LobeShape& shape,
                                      MipMethod method);

/// The unit vector of TexelMoments::doubled, in the plane: along u where texels have no direction
/// in common.
[[nodiscard]] glm::dvec3 common_axis(const TexelMoments& moments);

/// Weighted mean. Where nothing has any energy, weights are those of the area.
class MomentSum {
  public:
    explicit MomentSum(MipMethod method) : m_by_energy(method == MipMethod::moments) {}
    /// `weight`: of the area.
    void add(const TexelMoments& m, double weight);
    [[nodiscard]] TexelMoments mean() const;

  private:
    bool m_by_energy;
    double m_weight = 0.0, m_energy_weight = 0.0;
    TexelMoments m_sum;     ///< by area
    TexelMoments m_energy;  ///< by energy; what is not weighted by it stays 0
};

/// Moments as they are after they have been stored in so many bits: slopes as signed numbers, 0
/// among them, second moments' squares and energies as unsigned ones, each scaled to its largest
/// value in level 0.
class MomentStorage {
  public:
    explicit MomentStorage(int bits) : m_bits(bits) {}
    [[nodiscard]] bool is_exact() const { return m_bits == 0; }
    /// Of every texel of level 0, before the first call of stored().
    void include(const TexelMoments& m);
    [[nodiscard]] TexelMoments stored(const TexelMoments& m) const;
    /// Variances in slopes below this are rounding errors.
    [[nodiscard]] double least_variance() const;

  private:
    int m_bits;
    double m_slope = 0.0, m_second = 0.0;
    glm::dvec3 m_energy{0.0};
};

}  // namespace burnish::mips
