#include <algorithm>
#include <cmath>

#include "core/dmath.hpp"
#include "models/generators/field.hpp"
#include "models/generators/noise.hpp"
#include "models/generators/surface.hpp"

namespace burnish::generators {

Surface lathe(std::uint32_t seed, int size) {
    return [seed, size](int x, int y) {
        const glm::dvec2 p = from_centre(x, y, size);
        const double r = std::sqrt(p.x * p.x + p.y * p.y);
        SurfaceTexel texel;
        if (r == 0.0) return texel;
        const glm::dvec2 outward = p / r;
        texel.direction = {-outward.y, outward.x};
        // Cells of the turning marks in texels at the design size; none below two real ones.
        const double design = kDesignSize / size;
        const auto marks = [&](std::uint32_t k, double cell) {
            return line_noise(mix(seed, k), r * design / std::max(cell, 2.0 * design));
        };
        const double tilt = 0.09 * marks(1, 2.5) + 0.06 * marks(2, 7.0) + 0.03 * marks(3, 40.0);
        texel.normal = unit(glm::dvec3(outward * tilt, 1.0));
        texel.alpha_x = 0.15 * (1.0 + 0.15 * marks(4, 12.0));
        texel.alpha_y = 0.45 * (1.0 + 0.25 * marks(5, 30.0));
        texel.exponent = dmath::exp2(4.0 + marks(6, 48.0));
        texel.kd = glm::dvec3(0.05, 0.05, 0.05);
        texel.ks = glm::dvec3(0.95, 0.95, 0.97) * (0.85 + 0.15 * marks(7, 5.0));
        return texel;
    };
}

}  // namespace burnish::generators
