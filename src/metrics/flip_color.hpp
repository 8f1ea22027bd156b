#pragma once

#include <glm/glm.hpp>

/// The colour spaces of FLIP (HPG 2020, section 4.1), under the white D65.
namespace burnish::metrics {

/// IEC 61966-2-1: what light a screen makes of a number of 0 .. 1.
double srgb_to_linear(double value);

/// Y, Cx, Cz, the opponent space that is linear in light, of linear r, g, b; and back.
glm::dvec3 opponent_from_linear(const glm::dvec3& rgb);
glm::dvec3 linear_from_opponent(const glm::dvec3& ycxcz);

/// CIE L*, a*, b* with a*, b* less where it is dark (Hunt effect): times L* / 100.
glm::dvec3 hunt_lab_from_linear(const glm::dvec3& rgb);

/// |difference in lightness| + distance in the plane of hues (Abasi et al. 2020).
double hyab(const glm::dvec3& a, const glm::dvec3& b);

}  // namespace burnish::metrics
