#pragma once

#include <burnish/scene.hpp>
#include <glm/glm.hpp>

#include "models/texel.hpp"

namespace burnish::reference {

/// The quantities of the material layer at one point, by their names in it; vectors in the tangent
/// frame, numbers in all three components.
struct Surface {
    glm::dvec3 n{0.0}, t{0.0};
    /// t and b over the widths; of blinn_phong t and b; of ggx t and b times sqrt(1 / width^2 - 1),
    /// since (h.t / ax)^2 + (h.b / ay)^2 + (h.n)^2 is 1 more than (h.X)^2 + (h.Y)^2 then
    glm::dvec3 X{0.0}, Y{0.0};
    glm::dvec3 U{0.0}, V{0.0};  ///< t and b times the roots of the exponents, sqrt(2) / width
    glm::dvec3 P{0.0}, Q{0.0};  ///< t and b times the widths
    glm::dvec3 ks{0.0}, kd{0.0}, N{0.0};
    glm::dvec3 S{0.0};  ///< ks times the lobe's height, with a Fresnel factor the height
    glm::dvec3 A{0.0};  ///< height times ks, which is F0
    /// Of lean, in the plane of slopes (x / z, y / z): mean and second moments of the lobe.
    glm::dvec3 Bx{0.0}, By{0.0}, Mxx{0.0}, Mxy{0.0}, Myy{0.0};
    glm::dvec3 E{0.0};  ///< ks / (8 pi n.z^3)
};

Surface operator*(const Surface& surface, double factor);
Surface operator+(const Surface& a, const Surface& b);

/// What `model` needs of them for a texel's parameters. The height that S and A have in them is
/// 1 / (4 pi alpha_x alpha_y) of Ward's family, 1 / (2 pi alpha_x alpha_y) of ggx and
/// sqrt((nu + 1) (nv + 1)) / (8 pi) of ashikhmin_shirley.
Surface surface_of(Model model, const TexelParameters& texel);

}  // namespace burnish::reference
