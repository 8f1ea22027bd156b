// Traces of FilterOrder::after: the program at four texels, or at eight, and the filter.
#include <gtest/gtest.h>

#include <array>
#include <burnish/materials.hpp>
#include <burnish/renderer.hpp>
#include <burnish/trace.hpp>
#include <cmath>

#include "lab/measure_model.hpp"
#include "tests/textured_quad.hpp"

namespace burnish {
namespace {

/// The square of a texel's red, at s of a row of texels.
Scene squares(const std::vector<int>& row, float s, const char* machine) {
    Scene scene = textured_scene(make_texture({row_image(row)}, {}), 1, 1,
                                 everywhere({s, 0.5F, 0.0F, 1.0F}), machine);
    Material material = *scene.objects.front().material;
    Portion& rgb = material.program->combiners.stages.front().rgb;
    rgb.b = rgb.a;
    scene.objects.front().material = std::make_shared<const Material>(material);
    scene.machine.filter_order = FilterOrder::after;
    return scene;
}

// Between texels 0 and 1 of 4 at a quarter: 0^2 and (102/255)^2, not (102/255/4)^2.
TEST(TraceCorners, TheSquaresOfTwoTexelsByHand) {
    for (const char* machine : {"nv2a", "ideal"}) {
        const PixelTrace trace = trace_pixel(squares({0, 102, 51, 255}, 0.1875F, machine), 0, 0);
        const TracedFragment& f = trace.fragment.value();
        ASSERT_EQ(f.corners.size(), 4U);
        for (const std::size_t k : {0U, 2U}) {
            const TracedFragment &left = f.corners[k], &right = f.corners[k + 1];
            EXPECT_FALSE(left.corner->right);
            EXPECT_TRUE(right.corner->right);
            EXPECT_EQ(left.corner->below, k == 2);
            EXPECT_EQ(left.codes[0], 0);
            EXPECT_NEAR(right.color[0].value, 0.16, 1.0 / trace.one);
            EXPECT_NEAR(right.color[0].exact, 0.16, 1e-6);
            EXPECT_NEAR(left.corner->u.value, 0.125, 0.001);
            EXPECT_NEAR(right.corner->u.exact, 0.375, 1e-6);
            EXPECT_EQ(right.fetches.front().taps.front()[0], 102);
        }
        EXPECT_DOUBLE_EQ(f.corners[0].corner->weight_x.value, 0.25);
        EXPECT_DOUBLE_EQ(f.corners[0].corner->weight_x.exact, 0.25);
        EXPECT_FALSE(f.corners[0].corner->level_weight);
        EXPECT_NEAR(f.color[0].exact, 0.04, 1e-6);
        EXPECT_NEAR(f.color[0].value, 0.04, 1.0 / trace.one);
        EXPECT_TRUE(f.stages.empty());
    }
}

/// What the frame has there, drawn as a whole.
std::array<double, 4> drawn(const Scene& scene, int x, int y) {
    Framebuffer frame(scene.width, scene.height);
    Renderer({.threads = 1}).render(scene, frame);
    const Bytes bytes = bytes_at(frame, x, y);
    std::array<double, 4> result{};
    for (std::size_t c = 0; c < 4; ++c) result[c] = bytes[c];
    return result;
}

// Maps, a table, two lights, and levels: traces end where the picture does, and their exact colours
// are near where a machine is wide.
TEST(TraceCorners, EndWhereThePictureDoes) {
    for (const char* machine : {"nv2a", "ideal"}) {
        for (const MipMethod mipmaps : {MipMethod::none, MipMethod::moments}) {
            Material material = generated_material("orbital", 1, 128);
            material.model = Model::abp;
            material.mipmaps = MaterialMipmaps{.method = mipmaps};
            Scene scene = lab::measured_scene(material, machine);
            scene.machine.filter_order = FilterOrder::after;
            scene.width = scene.height = 32;
            scene.lights.push_back({.position = {-0.6F, 0.2F, 0.7F}, .intensity = 0.3F});
            std::size_t eights = 0;
            for (const auto& [x, y] : {std::pair{16, 16}, {13, 20}, {21, 10}}) {
                const PixelTrace trace = trace_pixel(scene, x, y);
                EXPECT_EQ(trace.stored, drawn(scene, x, y)) << machine << ' ' << x << ' ' << y;
                const TracedFragment& f = trace.fragment.value();
                eights += f.corners.size() == 8 ? 1 : 0;
                EXPECT_EQ(f.corners.front().further_lights.size(), 1U);
                if (trace.one > 255) {
                    EXPECT_NEAR(f.color[0].value, f.color[0].exact, 0.01);
                }
            }
            EXPECT_EQ(eights > 0, mipmaps == MipMethod::moments);
        }
    }
}

}  // namespace
}  // namespace burnish
