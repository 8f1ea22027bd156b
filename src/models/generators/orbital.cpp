#include <algorithm>
#include <cmath>
#include <memory>

#include "core/dmath.hpp"
#include "models/generators/noise.hpp"
#include "models/generators/strokes.hpp"
#include "models/generators/surface.hpp"

namespace burnish::generators {

Surface orbital(std::uint32_t seed, int size) {
    const auto strokes = std::make_shared<Strokes>(size);
    const double scale = size / kDesignSize;
    Random random(mix(seed, 1));
    constexpr int kArcs = 5200;  // each texel is crossed by about seven
    for (std::uint32_t i = 1; i <= kArcs; ++i) {
        const glm::dvec2 centre = random.between(glm::dvec2(0.0), glm::dvec2(size));
        const double radius = random.between(0.02, 0.09) * size;
        const double start = random.between(0.0, 2.0 * dmath::kPi);
        const double sweep = random.between(1.0, 2.0 * dmath::kPi);
        const double half_width = std::max(random.between(1.1, 1.9) * scale, 0.75);
        const double depth = half_width * random.between(0.10, 0.36);
        const double step = 0.5 * half_width / radius;
        for (double done = 0.0; done < sweep; done += step) {
            const double c = dmath::cos(start + done), s = dmath::sin(start + done);
            strokes->dent({i, half_width, depth}, centre + radius * glm::dvec2(c, -s), {-s, c});
        }
    }
    return [strokes, seed](int x, int y) {
        const std::uint32_t state = mix(mix(seed, 2), strokes->number(x, y));
        SurfaceTexel texel;
        texel.direction = strokes->direction(x, y);
        texel.normal = strokes->normal(x, y);
        texel.alpha_x = 0.16;
        texel.alpha_y = 0.30 + 0.20 * unit_interval(mix(state, 1));
        texel.exponent = 6.0 * (1.0 + 3.0 * unit_interval(mix(state, 2)));
        texel.kd = glm::dvec3(0.05, 0.05, 0.05);
        texel.ks = glm::dvec3(0.93, 0.93, 0.94) * (0.7 + 0.3 * unit_interval(mix(state, 3)));
        return texel;
    };
}

}  // namespace burnish::generators
