#include "metrics/heat_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <glm/glm.hpp>

#include "metrics/pixel.hpp"

namespace burnish::metrics {
namespace {

/// Magma at i / 16, of 0 .. 255; straight lines between are at most 2.6 away from the original.
constexpr std::array<std::array<std::uint8_t, 3>, 17> kMagma{{{0, 0, 4},
                                                              {10, 8, 34},
                                                              {29, 17, 71},
                                                              {54, 16, 107},
                                                              {81, 18, 124},
                                                              {106, 28, 129},
                                                              {131, 38, 129},
                                                              {156, 46, 127},
                                                              {183, 55, 121},
                                                              {207, 64, 112},
                                                              {229, 80, 100},
                                                              {244, 105, 92},
                                                              {251, 135, 97},
                                                              {254, 165, 113},
                                                              {254, 194, 135},
                                                              {253, 224, 161},
                                                              {252, 253, 191}}};

std::uint8_t byte(double value) {
    return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 255.0)));
}

void put_magma(double value, std::uint8_t* rgba) {
    const double at = 16.0 * (value > 0.0 ? std::min(value, 1.0) : 0.0);
    const auto below = std::min<std::size_t>(static_cast<std::size_t>(at), 15);
    const double weight = at - static_cast<double>(below);
    for (std::size_t c = 0; c < 3; ++c)
        rgba[c] = byte(kMagma[below][c] + weight * (kMagma[below + 1][c] - kMagma[below][c]));
    rgba[3] = 255;
}

glm::dvec3 difference(const Framebuffer& test, const Framebuffer& reference, int x, int y) {
    return glm::dvec3(pixel(test, x, y)) - glm::dvec3(pixel(reference, x, y));
}

}  // namespace

Image8 heat_map(const Plane& map) {
    Image8 image(map.width, map.height);
    for (int y = 0; y < map.height; ++y)
        for (int x = 0; x < map.width; ++x) put_magma(map.row(y)[x], image.at(x, y));
    return image;
}

Framebuffer map_frame(const Plane& map) {
    Framebuffer frame(map.width, map.height, PixelFormat::depth32f);
    for (int y = 0; y < map.height; ++y) {
        auto* const row = reinterpret_cast<float*>(frame.row(y));
        for (int x = 0; x < map.width; ++x) row[x] = static_cast<float>(map.row(y)[x]);
    }
    return frame;
}

Framebuffer difference_frame(const Framebuffer& test, const Framebuffer& reference,
                             DifferenceSign sign) {
    Framebuffer frame(reference.width(), reference.height(), PixelFormat::rgba32f);
    for (int y = 0; y < frame.height(); ++y) {
        auto* const row = reinterpret_cast<glm::vec4*>(frame.row(y));
        for (int x = 0; x < frame.width(); ++x) {
            const glm::dvec3 d = difference(test, reference, x, y);
            row[x] = glm::vec4(glm::vec3(sign == DifferenceSign::shown ? d : glm::abs(d)), 1.0F);
        }
    }
    return frame;
}

Image8 difference_image(const Framebuffer& test, const Framebuffer& reference, double gain,
                        DifferenceSign sign) {
    Image8 image(reference.width(), reference.height());
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            const glm::dvec3 d = gain * difference(test, reference, x, y);
            for (int c = 0; c < 3; ++c) {
                const double value = std::isnan(d[c]) ? 0.0 : std::clamp(d[c], -1.0, 1.0);
                image.at(x, y)[c] = byte(sign == DifferenceSign::shown ? 128.0 + 127.0 * value
                                                                       : 255.0 * std::abs(value));
            }
            image.at(x, y)[3] = 255;
        }
    }
    return image;
}

}  // namespace burnish::metrics
