#pragma once

#include <burnish/scene.hpp>
#include <glm/glm.hpp>

#include "reference/surface.hpp"

namespace burnish::reference {

/// Directions at one point, in the interpolated tangent frame: components by dot products with it.
/// It is not normalised, so they may be a little shorter than 1.
struct Directions {
    glm::dvec3 l, v, h;
    double h_l;  ///< h.l in object space
};

/// What a light of colour 1 adds: specular and diffuse part with the cosine. Every lobe is clamped
/// at 0, and n.v is taken as at least 1/32 where a model divides by it (docs/models.md).
glm::dvec3 reflected(Model model, const Surface& surface, const Directions& to);

}  // namespace burnish::reference
