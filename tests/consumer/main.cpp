#include <algorithm>
#include <burnish/files.hpp>
#include <burnish/renderer.hpp>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <vector>

namespace {

constexpr int kWidth = 96;
constexpr int kHeight = 64;

/// The main path of the library: mesh, material, light, and the picture into `target`.
void draw(const char* mesh_file, burnish::Framebuffer& target) {
    burnish::Material brass;
    brass.kd = {0.25F, 0.125F, 0.0625F};
    brass.ks = {0.75F, 0.5F, 0.25F};
    brass.alpha_x = 0.25F;
    brass.alpha_y = 0.5F;

    burnish::Scene scene;
    scene.lights.push_back({.position = {0.5F, 0.5F, 1.0F}});
    scene.objects.push_back({.geometry = burnish::load_mesh(mesh_file).mesh,
                             .material = std::make_shared<burnish::Material>(brass)});
    burnish::Renderer().render(scene, target);
}

bool same_rows(const burnish::Framebuffer& frame, const std::uint8_t* rgba) {
    for (int y = 0; y < kHeight; ++y) {
        const auto* row = reinterpret_cast<const std::uint8_t*>(frame.row(y));
        if (!std::equal(row, row + 4 * kWidth, rgba + 4 * kWidth * y)) return false;
    }
    return true;
}

int failed(const char* what) {
    std::fprintf(stderr, "consumer: %s\n", what);
    return 1;
}

}  // namespace

/// consumer MESH PICTURE: draws MESH twice, into memory of its own and into memory of the caller,
/// and compares both with PICTURE, which the installed command drew from the same scene.
int main(int argc, char** argv) {
    if (argc != 3) return failed("usage: consumer MESH PICTURE");

    burnish::Framebuffer owned(kWidth, kHeight);
    draw(argv[1], owned);

    constexpr int kPitch = 4 * kWidth + 52;
    constexpr std::uint8_t kGuard = 0xa5;
    std::vector<std::uint8_t> memory(static_cast<std::size_t>(kPitch) * kHeight, kGuard);
    burnish::Framebuffer borrowed(memory.data(), kPitch, kWidth, kHeight);
    draw(argv[1], borrowed);

    const burnish::Image8 picture = burnish::load_image(argv[2]);
    if (picture.width != kWidth || picture.height != kHeight) return failed("size of the picture");
    if (!same_rows(owned, picture.rgba.data()))
        return failed("own memory differs from the command");
    if (!same_rows(borrowed, picture.rgba.data())) return failed("caller's memory differs");
    for (int y = 0; y < kHeight; ++y) {
        const auto gap = memory.begin() + y * kPitch + 4 * kWidth;
        if (!std::all_of(gap, gap + kPitch - 4 * kWidth, [](auto b) { return b == kGuard; })) {
            return failed("bytes between the rows were written");
        }
    }
    if (std::equal(picture.at(0, 0), picture.at(0, 0) + 4, picture.at(kWidth / 2, kHeight / 2))) {
        return failed("nothing was drawn on the background");
    }
    return 0;
}
