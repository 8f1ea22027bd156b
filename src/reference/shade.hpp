#pragma once

#include <burnish/scene.hpp>
#include <glm/glm.hpp>

#include "reference/power_filter.hpp"
#include "reference/surface.hpp"

namespace burnish::reference {

/// Directions at one point, in the interpolated tangent frame: components by dot products with it.
/// It is not normalised, so they may be a little shorter than 1.
struct Directions {
    glm::dvec3 l, v, h;
    double h_l;  ///< h.l in object space
};

/// 1 - (h.X)^2 - (h.Y)^2, of which the lobes of the Blinn-Phong family are powers.
double lobe_coordinate(const Surface& surface, const Directions& to);

/// What a light of colour 1 adds: specular and diffuse part with the cosine. Every lobe is clamped
/// at 0, and n.v is taken as at least 1/32 where a model divides by it (docs/models.md).
/// @param filter  of the powers of lobe_coordinate
glm::dvec3 reflected(Model model, const Surface& surface, const Directions& to,
                     const PowerFilter& filter = {});

}  // namespace burnish::reference
