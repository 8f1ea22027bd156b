#pragma once

#include <burnish/texture.hpp>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "models/layer.hpp"

namespace burnish::reference {

/// The quantities of the material layer at one point, by their names in it; vectors in the tangent
/// frame, numbers in all three components.
struct Surface {
    glm::dvec3 n{0.0}, t{0.0};
    glm::dvec3 X{0.0}, Y{0.0};  ///< t and b over the widths
    glm::dvec3 U{0.0}, V{0.0};  ///< t and b times the roots of the exponents
    glm::dvec3 P{0.0}, Q{0.0};  ///< t and b times the widths
    glm::dvec3 ks{0.0}, kd{0.0}, N{0.0};
    glm::dvec3 S{0.0};          ///< ks times the lobe's height
    glm::dvec3 A{0.0}, C{0.0};  ///< height times ks, which is F0, and 1 - ks
};

/// Texel of `size` that stands at place `index` of an endless row: -1 .. size, where -1 and `size`
/// are the border of clamp_to_border and occur with no other mode.
int wrapped_texel(int index, int size, Wrap wrap);

/// `components` channels of level 0 from `channel` on, each over its largest code, at `uv` in units
/// of the texture: the nearest texel, or the four around it weighted in double precision (texel
/// centres lie at (i + 1/2) / size). Which of the two is the sampler's choice for magnified
/// textures. Coordinates that are not finite count as 0.
glm::dvec3 sample_texture(const Texture& texture, const glm::dvec2& uv, int channel,
                          int components);

/// A material layer, ready to be looked up.
class LayerSampler {
  public:
    /// Throws Error{bad_program} if a quantity that `model` needs is missing.
    LayerSampler(Model model, std::span<const LayerQuantity> layer);

    [[nodiscard]] Surface at(const glm::dvec2& uv) const;

  private:
    struct Textured {
        glm::dvec3 Surface::*to;
        LayerQuantity quantity;
    };
    Surface m_constants;
    std::vector<Textured> m_textured;
};

}  // namespace burnish::reference
