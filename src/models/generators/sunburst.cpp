#include <algorithm>
#include <cmath>

#include "core/dmath.hpp"
#include "models/generators/field.hpp"
#include "models/generators/noise.hpp"
#include "models/generators/surface.hpp"

namespace burnish::generators {

Surface sunburst(std::uint32_t seed, int size) {
    return [seed, size](int x, int y) {
        const glm::dvec2 p = from_centre(x, y, size);
        const double r = std::sqrt(p.x * p.x + p.y * p.y);
        SurfaceTexel texel;
        if (r == 0.0) return texel;
        const glm::dvec2 outward = p / r;
        texel.direction = outward;
        const double turn = dmath::atan2(p.y, p.x) / (2.0 * dmath::kPi) + 0.5;
        // Marks of `cells` around; they fade towards the centre, where they get as narrow as
        // texels.
        const auto marks = [&](std::uint32_t k, int cells) {
            const double width = 2.0 * dmath::kPi * r / cells;
            return ramp(0.5, 2.0, width) * line_noise(mix(seed, k), turn * cells, cells);
        };
        const double tilt = 0.10 * marks(1, 640) + 0.06 * marks(2, 240) + 0.03 * marks(3, 72);
        const glm::dvec2 around(-outward.y, outward.x);
        texel.normal = unit(glm::dvec3(around * tilt, 1.0));
        texel.alpha_x = 0.15 * (1.0 + 0.10 * marks(4, 160));
        texel.alpha_y = 0.50 * (1.0 + 0.20 * marks(5, 48));
        texel.exponent = dmath::exp2(4.0 + marks(6, 36));
        texel.kd = glm::dvec3(0.02, 0.03, 0.06);
        texel.ks = glm::dvec3(0.62, 0.74, 0.95) * (0.88 + 0.12 * marks(7, 320));
        return texel;
    };
}

}  // namespace burnish::generators
