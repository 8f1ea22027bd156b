#include <algorithm>
#include <cmath>
#include <memory>

#include "core/dmath.hpp"
#include "models/generators/noise.hpp"
#include "models/generators/strokes.hpp"
#include "models/generators/surface.hpp"

namespace burnish::generators {

Surface cross_hatch(std::uint32_t seed, int size) {
    const auto strokes = std::make_shared<Strokes>(size);
    const double scale = size / kDesignSize;
    Random random(mix(seed, 1));
    constexpr int kStrokes = 4200;  // each texel is crossed by about seven
    for (std::uint32_t i = 1; i <= kStrokes; ++i) {
        glm::dvec2 at = random.between(glm::dvec2(0.0), glm::dvec2(size));
        const double angle = random.between(32.0, 38.0) * dmath::kPi / 180.0;
        const double sign = i % 2 == 0 ? 1.0 : -1.0;
        const glm::dvec2 direction(dmath::cos(angle), sign * dmath::sin(angle));
        const double length = random.between(0.1, 0.4) * size;
        const double half_width = std::max(random.between(1.2, 2.2) * scale, 0.75);
        const double depth = half_width * random.between(0.12, 0.4);
        const double step = 0.5 * half_width;
        for (double done = 0.0; done < length; done += step) {
            strokes->dent({i, half_width, depth}, at, direction);
            at += step * glm::dvec2(direction.x, -direction.y);
        }
    }
    return [strokes, seed](int x, int y) {
        const std::uint32_t state = mix(mix(seed, 2), strokes->number(x, y));
        SurfaceTexel texel;
        texel.direction = strokes->direction(x, y);
        texel.normal = strokes->normal(x, y);
        texel.alpha_x = 0.15;
        texel.alpha_y = 0.35 + 0.15 * unit_interval(mix(state, 1));
        texel.exponent = 8.0 * (1.0 + 2.0 * unit_interval(mix(state, 2)));
        texel.kd = glm::dvec3(0.06, 0.06, 0.06);
        texel.ks = glm::dvec3(0.90, 0.88, 0.84) * (0.75 + 0.25 * unit_interval(mix(state, 3)));
        return texel;
    };
}

}  // namespace burnish::generators
