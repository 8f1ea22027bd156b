#pragma once

#include <burnish/scene.hpp>
#include <glm/glm.hpp>

#include "models/texel.hpp"

namespace burnish::mips {

/// How wide a model's lobe is and how much light is in it, over (h.t, h.b) near the normal, and how
/// its parameters have to be for a width.
///
/// The variance along an axis is alpha^2 / (N + 4) and the energy ks alpha_x alpha_y 2 pi / (N + 2)
/// of max(0, 1 - q)^(N/2) (docs/models.md), of blinn_phong the same with widths of 1: it has N
/// alone to say how wide it is. Ward's family, ashikhmin_shirley and ggx count as Gaussians of
/// variance alpha^2 / 2 whose energy is ks, since their heights fall as they widen, but that of
/// lean, in slopes, is ks / n.z^3, n being set before the energy is; the tails of ggx have no
/// variance of their own. A text counts as `abp` if it reads N, else as `ward`. Lobes of fibres are
/// bands across the fibre: no shape.
class LobeShape {
  public:
    explicit LobeShape(const Material& material);

    [[nodiscard]] bool is_fibre() const { return m_kind == Kind::fibre; }

    /// Along t and b.
    [[nodiscard]] glm::dvec2 variance(const TexelParameters& p) const;
    [[nodiscard]] double energy_per_ks(const TexelParameters& p) const;
    /// Exponents s of the isotropic lobes cos^s that are as wide along t and b.
    [[nodiscard]] glm::dvec2 phong_exponents(const TexelParameters& p) const;

    /// Parameters for these variances, within the widths that are allowed; N stays where there are
    /// widths. ks stays.
    void set_variance(TexelParameters& p, const glm::dvec2& variance) const;
    /// The other way round, for exponents above 0.
    void set_phong_exponents(TexelParameters& p, const glm::dvec2& s) const;
    /// The height of the lobe times `factor`, unless it follows from the widths.
    void scale_height(TexelParameters& p, double factor) const;
    /// ks for this energy.
    void set_energy(TexelParameters& p, const glm::dvec3& energy) const;

  private:
    enum class Kind { power, round, gaussian, slopes, fibre };
    /// N, or what the model has in its place.
    [[nodiscard]] double exponent(const TexelParameters& p) const;

    Kind m_kind;
    double m_fixed_exponent = 0.0;  ///< 0: the texel's
};

}  // namespace burnish::mips
