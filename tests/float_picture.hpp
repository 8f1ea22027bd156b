#pragma once

#include <burnish/framebuffer.hpp>
#include <cstdint>
#include <cstring>
#include <glm/glm.hpp>

namespace burnish {

inline void set(Framebuffer& frame, int x, int y, const glm::vec4& value) {
    std::memcpy(frame.row(y) + static_cast<std::size_t>(x) * sizeof value, &value, sizeof value);
}

inline glm::vec4 get(const Framebuffer& frame, int x, int y) {
    glm::vec4 value;
    std::memcpy(&value, frame.row(y) + static_cast<std::size_t>(x) * sizeof value, sizeof value);
    return value;
}

/// An rgba32f frame of one colour, alpha 1.
inline Framebuffer plain(int width, int height, const glm::vec3& color) {
    Framebuffer frame(width, height, PixelFormat::rgba32f);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) set(frame, x, y, glm::vec4(color, 1.0F));
    return frame;
}
inline Framebuffer plain(int width, int height, float grey) {
    return plain(width, height, glm::vec3(grey));
}

/// Noise of 0 .. 1 in all three channels, alpha 1.
inline Framebuffer noise(int width, int height, std::uint32_t seed) {
    Framebuffer frame(width, height, PixelFormat::rgba32f);
    std::uint32_t state = seed * 747796405U + 2891336453U;
    const auto next = [&state] {
        state = state * 1664525U + 1013904223U;
        return static_cast<float>(state >> 8) / 16777216.0F;
    };
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const float r = next(), g = next(), b = next();
            set(frame, x, y, {r, g, b, 1.0F});
        }
    return frame;
}

}  // namespace burnish
