#include "reference/footprint.hpp"

#include <algorithm>
#include <cmath>

namespace burnish::reference {

namespace {

/// index mod size, 0 .. size - 1.
int modulo(int index, int size) {
    const int rest = index % size;
    return rest < 0 ? rest + size : rest;
}

/// A coordinate in texels, kept where int can hold it.
double in_texels(double u, int size) {
    if (!std::isfinite(u)) return 0.0;
    return std::clamp(u * size, -1e9, 1e9);
}

}  // namespace

int wrapped_texel(int index, int size, Wrap wrap) {
    switch (wrap) {
        case Wrap::repeat:
            return modulo(index, size);
        case Wrap::clamp_to_edge:
            return std::clamp(index, 0, size - 1);
        case Wrap::clamp_to_border:
            return std::clamp(index, -1, size);
        case Wrap::mirrored_repeat: {
            const int place = modulo(index, 2 * size);
            return place < size ? place : 2 * size - 1 - place;
        }
    }
    return 0;
}

Footprint footprint(const glm::dvec2& uv, int width, int height, const Sampler& sampler,
                    bool linear) {
    const double shift = linear ? 0.5 : 0.0;
    const double u = in_texels(uv.x, width) - shift, v = in_texels(uv.y, height) - shift;
    const double left = std::floor(u), top = std::floor(v);
    const int x = static_cast<int>(left), y = static_cast<int>(top);
    const int next = linear ? 1 : 0;
    return {wrapped_texel(x, width, sampler.wrap_s),
            wrapped_texel(x + next, width, sampler.wrap_s),
            wrapped_texel(y, height, sampler.wrap_t),
            wrapped_texel(y + next, height, sampler.wrap_t),
            linear ? u - left : 0.0,
            linear ? v - top : 0.0};
}

std::array<WeightedPoint, 4> texel_centres(const glm::dvec2& uv, int width, int height,
                                           bool linear) {
    const glm::dvec2 size(width, height);
    const glm::dvec2 place = glm::dvec2(in_texels(uv.x, width), in_texels(uv.y, height)) -
                             glm::dvec2(linear ? 0.5 : 0.0);
    const glm::dvec2 first = glm::floor(place);
    const glm::dvec2 weight = linear ? place - first : glm::dvec2(0.0);
    std::array<WeightedPoint, 4> points;
    for (int k = 0; k < 4; ++k) {
        const glm::dvec2 second(linear ? k & 1 : 0, linear ? k >> 1 : 0);
        const glm::dvec2 centre = (first + second + 0.5) / size;
        const double across = (k & 1) != 0 ? weight.x : 1.0 - weight.x;
        const double down = (k >> 1) != 0 ? weight.y : 1.0 - weight.y;
        // A few ulps on: whoever counts texels in steps must not find the step before.
        points[static_cast<std::size_t>(k)] = {
            centre + 0x1p-50 * glm::max(glm::abs(centre), glm::dvec2(1.0)), across * down};
    }
    return points;
}

}  // namespace burnish::reference
