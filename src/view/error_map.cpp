#include "view/error_map.hpp"

#include <algorithm>
#include <burnish/texture.hpp>
#include <cmath>
#include <cstring>

#include "metrics/heat_map.hpp"

namespace burnish::view {
namespace {

metrics::Plane difference(const Framebuffer& test, const Framebuffer& truth, double gain) {
    metrics::Plane plane(test.width(), test.height());
    for (int y = 0; y < test.height(); ++y) {
        const auto* left = reinterpret_cast<const float*>(test.row(y));
        const auto* right = reinterpret_cast<const float*>(truth.row(y));
        double* out = plane.row(y);
        for (int x = 0; x < test.width(); ++x, left += 4, right += 4) {
            double sum = 0.0;
            // Double precision has numbers beyond what a frame shows.
            for (int c = 0; c < 3; ++c)
                sum += std::abs(static_cast<double>(std::min(left[c], 1.0F)) -
                                static_cast<double>(std::min(right[c], 1.0F)));
            out[x] = gain * sum / 3.0;
        }
    }
    return plane;
}

}  // namespace

Framebuffer error_map(const Framebuffer& test, const Framebuffer& truth, double gain) {
    const Image8 colors = metrics::heat_map(difference(test, truth, gain));
    Framebuffer frame(colors.width, colors.height);
    std::memcpy(frame.pixels(), colors.rgba.data(), colors.rgba.size());
    return frame;
}

}  // namespace burnish::view
