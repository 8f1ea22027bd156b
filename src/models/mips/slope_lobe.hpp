#pragma once

#include <glm/glm.hpp>

#include "models/mips/symmetric.hpp"
#include "models/texel.hpp"

namespace burnish::mips {

/// The slopes of half vectors h, (h.x / h.z, h.y / h.z), are a plane that all texels share; each
/// one's (h.t, h.b) are its own. Near a texel's normal they are related by `slope_jacobian`.

/// Normals are taken as if they rose at least this much, so that slopes stay finite.
inline constexpr double kLeastNormalZ = 1.0 / 64.0;

[[nodiscard]] glm::dvec2 slope_of(const glm::dvec3& n);
/// (slope, 1) made unit.
[[nodiscard]] glm::dvec3 normal_of(const glm::dvec2& slope);

/// Derivative of the slope of h by (h.t, h.b) at h = n, for t, b, n unit and orthonormal:
/// 1 / nz^2 [[by, -ty], [-bx, tx]], whose determinant is 1 / nz^3.
[[nodiscard]] glm::dmat2 slope_jacobian(const TexelParameters& frame);

/// Covariance in slopes of a lobe of `variance` along t and b.
[[nodiscard]] Symmetric slope_covariance(const TexelParameters& frame, const glm::dvec2& variance);

/// Variances along t and b of a lobe in slopes, once t and b of `frame`, whose n is unit, have been
/// turned around n to its axes.
///
/// A lobe has two axes, each with two senses. `axis`, a direction in the surface, says which one
/// comes to be t: the nearest; t's sense is the one that is nearer to `sense`.
[[nodiscard]] glm::dvec2 turn_to_axes(TexelParameters& frame, const Symmetric& slopes,
                                      const glm::dvec3& axis, const glm::dvec3& sense);

}  // namespace burnish::mips
