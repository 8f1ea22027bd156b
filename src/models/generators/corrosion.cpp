#include <cmath>
#include <memory>
#include <vector>

#include "models/generators/field.hpp"
#include "models/generators/noise.hpp"
#include "models/generators/surface.hpp"

namespace burnish::generators {
namespace {

/// How far the rust has come: fractal noise, about -1 .. 1.
Field rust_field(std::uint32_t seed, int size) {
    Field field(size);
    double amplitude = 0.5;
    for (std::uint32_t octave = 0; octave < 6; ++octave) {
        const double cell = 128.0 / (1U << octave);
        const SurfaceNoise noise(mix(seed, octave), size, cell, cell);
        for (int y = 0; y < size; ++y) {
            for (int x = 0; x < size; ++x) field.at(x, y) += amplitude * noise.at(x, y);
        }
        amplitude *= 0.6;
    }
    return field;
}

}  // namespace

Surface corrosion(std::uint32_t seed, int size) {
    struct State {
        Field rust, height;
        SurfaceNoise grain, fine, shine;
    };
    const SurfaceNoise marks(mix(seed, 2), size, 140.0, 2.5);
    const SurfaceNoise pits(mix(seed, 3), size, 3.0, 3.0);
    const auto state = std::make_shared<State>(State{
        rust_field(mix(seed, 1), size), Field(size), SurfaceNoise(mix(seed, 4), size, 6.0, 6.0),
        SurfaceNoise(mix(seed, 5), size, 2.0, 2.0), SurfaceNoise(mix(seed, 6), size, 160.0, 3.0)});
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            // Rust swells: it stands above the metal, and is rough.
            const double swell = ramp(0.06, 0.30, state->rust.at(x, y));
            const double metal = 0.10 * marks.at(x, y);
            const double oxide = 1.2 + 0.7 * pits.at(x, y);
            state->height.at(x, y) = metal + swell * (oxide - metal);
        }
    }
    return [state](int x, int y) {
        const double rust = state->rust.at(x, y);
        SurfaceTexel texel;
        texel.normal = normal_at(state->height, x, y);
        if (rust > 0.10) {
            const double age = ramp(0.10, 0.45, rust);  // from the orange rim to the dark middle
            const double grain = 0.85 + 0.15 * state->grain.at(x, y);
            texel.alpha_x = texel.alpha_y = 0.40 + 0.08 * state->fine.at(x, y);
            texel.exponent = 4.0;
            texel.kd = grain * (glm::dvec3(0.52, 0.22, 0.07) * (1.0 - age) +
                                glm::dvec3(0.24, 0.10, 0.05) * age);
            texel.ks = glm::dvec3(0.05, 0.045, 0.04);
            return texel;
        }
        // A dull band lies around the rust.
        const double tarnish = ramp(0.0, 0.10, rust);
        texel.alpha_x = 0.15 + 0.10 * tarnish;
        texel.alpha_y = 0.45;
        texel.exponent = 32.0 - 22.0 * tarnish;
        texel.kd = glm::dvec3(0.05, 0.05, 0.05) + tarnish * glm::dvec3(0.10, 0.06, 0.03);
        texel.ks = (0.85 + 0.10 * state->shine.at(x, y)) * (1.0 - 0.5 * tarnish) *
                   glm::dvec3(0.95, 0.95, 0.95);
        return texel;
    };
}

}  // namespace burnish::generators
