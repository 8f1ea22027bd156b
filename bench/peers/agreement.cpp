#include "bench/peers/agreement.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <glm/glm.hpp>

#include "metrics/frame_errors.hpp"

namespace burnish::peers {

namespace {

glm::vec4* row_of(Framebuffer& picture, int y) {
    return reinterpret_cast<glm::vec4*>(picture.row(y));
}

bool covered(const Framebuffer& picture, int x, int y) {
    return reinterpret_cast<const glm::vec4*>(picture.row(y))[x].a > 0.5F;
}

/// Some of the pixel's eight neighbours are covered otherwise than itself.
bool on_silhouette(const Framebuffer& picture, int x, int y) {
    const bool here = covered(picture, x, y);
    for (int j = std::max(y - 1, 0); j <= std::min(y + 1, picture.height() - 1); ++j)
        for (int i = std::max(x - 1, 0); i <= std::min(x + 1, picture.width() - 1); ++i)
            if (covered(picture, i, j) != here) return true;
    return false;
}

glm::vec4 depth_pixel(const std::byte* at) {
    float depth = 0.0F;
    std::memcpy(&depth, at, sizeof depth);
    return {glm::vec3(depth), depth < 1.0F ? 1.0F : 0.0F};
}

glm::vec4 color_pixel(const std::byte* at, bool has_background) {
    glm::vec4 color;
    for (int c = 0; c < 4; ++c) color[c] = static_cast<float>(std::to_integer<int>(at[c])) / 255.0F;
    color.a = !has_background || color.a > 0.0F ? 1.0F : 0.0F;
    return color;
}

}  // namespace

Framebuffer picture_of(const PeerScene& scene, const FrameBytes& bytes) {
    Framebuffer picture(scene.scene.width, scene.scene.height, PixelFormat::rgba32f);
    const std::byte* at = bytes.data();
    for (int y = 0; y < picture.height(); ++y) {
        for (int x = 0; x < picture.width(); ++x, at += 4) {
            row_of(picture, y)[x] = scene.shading == Shading::depth
                                        ? depth_pixel(at)
                                        : color_pixel(at, scene.shading != Shading::layer);
        }
    }
    return picture;
}

Agreement compare(const Framebuffer& first, const Framebuffer& second, const Framebuffer* truth) {
    Agreement agreement;
    for (int y = 0; y < first.height(); ++y) {
        for (int x = 0; x < first.width(); ++x) {
            const bool here = covered(first, x, y);
            if (here) ++agreement.covered;
            if (here && on_silhouette(first, x, y)) ++agreement.silhouette;
            if (here == covered(second, x, y)) continue;
            const bool edge = on_silhouette(first, x, y) && on_silhouette(second, x, y);
            ++(edge ? agreement.edge_pixels : agreement.stray_pixels);
        }
    }
    const metrics::FrameErrors errors = metrics::interior_errors(first, second);
    agreement.rmse = errors.rmse;
    agreement.bias = errors.bias;
    if (truth != nullptr) {
        agreement.first_rmse = metrics::interior_errors(first, *truth).rmse;
        agreement.second_rmse = metrics::interior_errors(second, *truth).rmse;
    }
    return agreement;
}

}  // namespace burnish::peers
