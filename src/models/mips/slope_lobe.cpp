#include "models/mips/slope_lobe.hpp"

#include <algorithm>
#include <cmath>

namespace burnish::mips {

glm::dvec2 slope_of(const glm::dvec3& n) {
    return glm::dvec2(n) / std::max(n.z, kLeastNormalZ);
}

glm::dvec3 normal_of(const glm::dvec2& slope) {
    const glm::dvec3 n(slope, 1.0);
    return n / std::sqrt(glm::dot(n, n));
}

glm::dmat2 slope_jacobian(const TexelParameters& frame) {
    const double z = std::max(frame.n.z, kLeastNormalZ);
    return glm::dmat2(frame.b.y, -frame.b.x, -frame.t.y, frame.t.x) / (z * z);
}

Symmetric slope_covariance(const TexelParameters& frame, const glm::dvec2& variance) {
    return transformed({variance.x, 0.0, variance.y}, slope_jacobian(frame));
}

glm::dvec2 turn_to_axes(TexelParameters& frame, const Symmetric& slopes, const glm::dvec3& axis,
                        const glm::dvec3& sense) {
    frame.t = perpendicular(axis, frame.n);
    frame.b = glm::cross(frame.n, frame.t);
    const Symmetric own = transformed(slopes, glm::inverse(slope_jacobian(frame)));
    const Eigen e = eigen(own);
    // The given axis is (1, 0) here: of the two the one within 45 degrees.
    glm::dvec2 first =
        std::abs(e.axis.x) >= std::abs(e.axis.y) ? e.axis : glm::dvec2(e.axis.y, -e.axis.x);
    if (first.x < 0.0) first = -first;
    const glm::dvec2 variance(std::max(own.along(first), 0.0),
                              std::max(own.along({-first.y, first.x}), 0.0));
    frame.t = frame.t * first.x + frame.b * first.y;
    if (glm::dot(frame.t, sense) < 0.0) frame.t = -frame.t;
    frame.b = glm::cross(frame.n, frame.t);
    return variance;
}

}  // namespace burnish::mips
