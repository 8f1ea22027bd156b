#pragma once

#include <burnish/framebuffer.hpp>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <glm/glm.hpp>

namespace burnish::metrics {

/// r, g, b, a of an rgba32f frame.
inline glm::dvec4 pixel(const Framebuffer& frame, int x, int y) {
    glm::vec4 value;
    std::memcpy(&value, frame.row(y) + static_cast<std::size_t>(x) * sizeof value, sizeof value);
    return value;
}

inline bool finite(const glm::dvec4& p) {
    return std::isfinite(p.r) && std::isfinite(p.g) && std::isfinite(p.b);
}

/// r, g, b at one place of two pictures; both black where one is not finite, so that a window
/// around it has a number.
struct PixelPair {
    glm::dvec3 test, reference;
};
inline PixelPair pixel_pair(const Framebuffer& test, const Framebuffer& reference, int x, int y) {
    const glm::dvec4 got = pixel(test, x, y);
    const glm::dvec4 want = pixel(reference, x, y);
    if (!finite(got) || !finite(want)) return {glm::dvec3(0.0), glm::dvec3(0.0)};
    return {glm::dvec3(got), glm::dvec3(want)};
}

}  // namespace burnish::metrics
