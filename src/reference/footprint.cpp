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

}  // namespace burnish::reference
