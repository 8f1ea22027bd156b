#include "lab/experiment/pictures.hpp"

#include <algorithm>
#include <burnish/files.hpp>
#include <burnish/texture.hpp>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>

#include "metrics/heat_map.hpp"
#include "metrics/pixel.hpp"

namespace burnish::lab {

Image8 shown(const Framebuffer& frame) {
    Image8 image(frame.width(), frame.height());
    for (int y = 0; y < frame.height(); ++y) {
        for (int x = 0; x < frame.width(); ++x) {
            const glm::dvec4 color = metrics::pixel(frame, x, y);
            std::uint8_t* at = image.at(x, y);
            for (int c = 0; c < 3; ++c) {
                const double value = color[c] >= 0.0 ? std::min(color[c], 1.0) : 0.0;
                at[c] = static_cast<std::uint8_t>(std::floor(value * 255.0 + 0.5));
            }
            at[3] = 255;
        }
    }
    return image;
}

void save_pictures(const Framebuffer& test, const Framebuffer& reference,
                   const metrics::Plane& flip, float gain, const PictureFiles& files) {
    save_image(test, files.exr("test"));
    save_image(reference, files.exr("reference"));
    save_image(shown(test), files.png("test"));
    save_image(shown(reference), files.png("reference"));
    save_image(metrics::difference_image(test, reference, static_cast<double>(gain),
                                         metrics::DifferenceSign::shown),
               files.png("error"));
    save_image(metrics::heat_map(flip), files.png("flip"));
}

}  // namespace burnish::lab
