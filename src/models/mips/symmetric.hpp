#pragma once

#include <cmath>
#include <glm/glm.hpp>

namespace burnish::mips {

/// A symmetric matrix of 2 x 2.
struct Symmetric {
    double xx = 0.0, xy = 0.0, yy = 0.0;

    static Symmetric outer(const glm::dvec2& v) { return {v.x * v.x, v.x * v.y, v.y * v.y}; }

    friend Symmetric operator+(const Symmetric& a, const Symmetric& b) {
        return {a.xx + b.xx, a.xy + b.xy, a.yy + b.yy};
    }
    friend Symmetric operator-(const Symmetric& a, const Symmetric& b) {
        return {a.xx - b.xx, a.xy - b.xy, a.yy - b.yy};
    }
    friend Symmetric operator*(const Symmetric& a, double f) {
        return {a.xx * f, a.xy * f, a.yy * f};
    }
    [[nodiscard]] double along(const glm::dvec2& v) const {
        return xx * v.x * v.x + 2.0 * xy * v.x * v.y + yy * v.y * v.y;
    }
};

/// m s m^T.
inline Symmetric transformed(const Symmetric& s, const glm::dmat2& m) {
    const auto row = [&](int i) { return glm::dvec2(m[0][i], m[1][i]); };
    const auto product = [&](const glm::dvec2& a, const glm::dvec2& b) {
        return a.x * (s.xx * b.x + s.xy * b.y) + a.y * (s.xy * b.x + s.yy * b.y);
    };
    return {product(row(0), row(0)), product(row(0), row(1)), product(row(1), row(1))};
}

/// Eigenvalues, the larger one first, and the unit vector of the larger one: (1, 0) where they are
/// the same within 1e-9 of their mean.
struct Eigen {
    double major, minor;
    glm::dvec2 axis;
};

inline Eigen eigen(const Symmetric& s) {
    const double middle = 0.5 * (s.xx + s.yy), half = 0.5 * (s.xx - s.yy);
    const double radius = std::sqrt(half * half + s.xy * s.xy);
    Eigen e{middle + radius, middle - radius, {1.0, 0.0}};
    if (radius <= 1e-9 * std::abs(middle)) return e;
    // Of the two forms of the vector the one without cancellation.
    const glm::dvec2 v =
        half >= 0.0 ? glm::dvec2(half + radius, s.xy) : glm::dvec2(s.xy, radius - half);
    e.axis = v / std::sqrt(glm::dot(v, v));
    return e;
}

/// `s` with eigenvalues of at least `least`.
inline Symmetric at_least(const Symmetric& s, double least) {
    const Eigen e = eigen(s);
    if (e.minor >= least) return s;
    const Symmetric major = Symmetric::outer(e.axis);
    const Symmetric minor{major.yy, -major.xy, major.xx};
    return major * std::fmax(e.major, least) + minor * least;
}

}  // namespace burnish::mips
