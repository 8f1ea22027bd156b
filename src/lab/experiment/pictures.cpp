#include "lab/experiment/pictures.hpp"

#include <algorithm>
#include <burnish/files.hpp>
#include <burnish/texture.hpp>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <glm/glm.hpp>

namespace burnish::lab {
namespace {

glm::vec3 color_at(const Framebuffer& frame, int x, int y) {
    glm::vec4 value;
    std::memcpy(&value, frame.row(y) + static_cast<std::size_t>(x) * sizeof value, sizeof value);
    return glm::vec3(value);
}

void put(Image8& image, int x, int y, const glm::vec3& color) {
    std::uint8_t* at = image.at(x, y);
    for (int c = 0; c < 3; ++c) {
        const float value = color[c] >= 0.0F ? std::min(color[c], 1.0F) : 0.0F;
        at[c] = static_cast<std::uint8_t>(std::floor(value * 255.0F + 0.5F));
    }
    at[3] = 255;
}

Image8 shown(const Framebuffer& frame) {
    Image8 image(frame.width(), frame.height());
    for (int y = 0; y < frame.height(); ++y)
        for (int x = 0; x < frame.width(); ++x) put(image, x, y, color_at(frame, x, y));
    return image;
}

Image8 signed_error(const Framebuffer& test, const Framebuffer& reference, float gain) {
    constexpr glm::vec3 kBrighter{1.0F, 0.6F, 0.15F}, kDarker{0.2F, 0.55F, 1.0F};
    Image8 image(test.width(), test.height());
    for (int y = 0; y < test.height(); ++y) {
        for (int x = 0; x < test.width(); ++x) {
            const glm::vec3 difference = color_at(test, x, y) - color_at(reference, x, y);
            const float mean = gain * (difference.r + difference.g + difference.b) / 3.0F;
            put(image, x, y, std::abs(mean) * (mean > 0.0F ? kBrighter : kDarker));
        }
    }
    return image;
}

}  // namespace

void save_pictures(const Framebuffer& test, const Framebuffer& reference, float gain,
                   const PictureFiles& files) {
    save_image(test, files.exr("test"));
    save_image(reference, files.exr("reference"));
    save_image(shown(test), files.png("test"));
    save_image(shown(reference), files.png("reference"));
    save_image(signed_error(test, reference, gain), files.png("error"));
}

}  // namespace burnish::lab
