#include <cmath>

#include "models/generators/field.hpp"
#include "models/generators/noise.hpp"
#include "models/generators/surface.hpp"

namespace burnish::generators {

Surface weave(std::uint32_t seed, int size) {
    return [seed, size](int x, int y) {
        constexpr int kYarns = 16;
        const double u = (x + 0.5) * kYarns / size, v = (y + 0.5) * kYarns / size;
        const auto column = static_cast<std::uint32_t>(u), row = static_cast<std::uint32_t>(v);
        const bool warp = (column + row) % 2 == 0;  // the yarn along v lies on top
        const double right = u - column - 0.5, up = 0.5 - (v - row);
        const double across = warp ? right : up, along = warp ? up : right;
        SurfaceTexel texel;
        texel.direction = warp ? glm::dvec2(0.0, 1.0) : glm::dvec2(1.0, 0.0);
        // Round across, and bent along, where it dives below its neighbours.
        const glm::dvec2 tilt =
            warp ? glm::dvec2(1.3 * across, 0.7 * along) : glm::dvec2(0.7 * along, 1.3 * across);
        texel.normal = unit(glm::dvec3(tilt, 1.0));
        const std::uint32_t yarn = mix(mix(seed, warp ? 1 : 2), warp ? column : row);
        const double tint = 0.85 + 0.15 * unit_interval(mix(yarn, 1));
        const double edge = 1.0 - ramp(0.36, 0.5, std::abs(across));  // dark between the yarns
        texel.alpha_x = 0.20;
        texel.alpha_y = 0.50 + 0.2 * unit_interval(mix(yarn, 2));
        texel.exponent = 8.0 + 4.0 * unit_interval(mix(yarn, 3));
        const glm::dvec3 color = warp ? glm::dvec3(0.10, 0.16, 0.42) : glm::dvec3(0.50, 0.33, 0.10);
        texel.kd = (0.25 + 0.75 * edge) * tint * color;
        texel.ks = (0.1 + 0.9 * edge) * tint * (0.25 * glm::dvec3(1.0) + 0.5 * color);
        return texel;
    };
}

}  // namespace burnish::generators
