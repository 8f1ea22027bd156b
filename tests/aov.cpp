// Geometry in place of colours: numbers by hand in every format, and the same fragments as in the
// picture, whatever draws them.
#include <gtest/gtest.h>

#include <array>
#include <burnish/renderer.hpp>
#include <burnish/shapes.hpp>
#include <cmath>
#include <cstring>
#include <set>
#include <string>
#include <vector>

#include "tests/scenes.hpp"
#include "tests/vertex_color.hpp"

namespace burnish {
namespace {

template <class Channel>
std::array<Channel, 4> at(const Framebuffer& frame, int x, int y) {
    std::array<Channel, 4> p{};
    std::memcpy(p.data(), frame.row(y) + static_cast<std::size_t>(x) * sizeof p, sizeof p);
    return p;
}
Framebuffer shown(const Scene& scene, Aov aov, PixelFormat format = PixelFormat::rgba32f) {
    Framebuffer frame(scene.width, scene.height, format);
    Renderer({.threads = 1}).render(scene, frame, aov);
    return frame;
}
using Floats = std::array<float, 4>;
using Bytes = std::array<std::uint8_t, 4>;
using Words = std::array<std::uint16_t, 4>;

RawVertex vertex(float x, float y, float z, glm::vec4 uv = {0.0F, 0.0F, 0.0F, 1.0F},
                 float alpha = 1.0F) {
    RawVertex v;
    v.position = {x, y, z, 1.0F};
    v.color0 = {1.0F, 1.0F, 1.0F, alpha};
    v.uv[0] = uv;
    return v;
}

Scene raw_scene(std::vector<RawVertex> vertices, Topology topology = Topology::quads) {
    Scene scene;
    scene.width = 16;
    scene.height = 8;
    scene.machine = machine_profile("nv2a");
    scene.objects.push_back({RawVertices{Space::window, topology, std::move(vertices)},
                             vertex_color(),
                             glm::mat4(1.0F),
                             {}});
    return scene;
}

// z = x / 16 over the left 8 pixels: at the centre of pixel 3 it is 3.5 / 16 = 0.21875, which is
// 55.8 of 255 and 14335.8 of 65535.
TEST(AovTest, DepthIsThatOfTheWindow) {
    const Scene scene =
        raw_scene({vertex(0, 0, 0), vertex(8, 0, 0.5F), vertex(8, 8, 0.5F), vertex(0, 8, 0)});
    const Framebuffer frame = shown(scene, Aov::depth);
    for (int x = 0; x < 8; ++x) {
        const float z = (static_cast<float>(x) + 0.5F) / 16.0F;
        EXPECT_EQ(at<float>(frame, x, 5), (Floats{z, z, z, 1.0F}));
    }
    EXPECT_EQ(at<float>(frame, 8, 5), (Floats{1.0F, 1.0F, 1.0F, 1.0F}));
    EXPECT_EQ(at<std::uint8_t>(shown(scene, Aov::depth, PixelFormat::rgba8), 3, 2),
              (Bytes{56, 56, 56, 255}));
    EXPECT_EQ(at<std::uint16_t>(shown(scene, Aov::depth, PixelFormat::rgba16), 3, 2),
              (Words{14336, 14336, 14336, 65535}));
}

TEST(AovTest, CoordinatesAreDividedByQ) {
    // s / q and t / q run from 0 to 4 and 0 to 2: at pixel (5, 1) 5.5 / 4 = 1.375 and 1.5 / 4 =
    // 0.375.
    const Scene scene =
        raw_scene({vertex(0, 0, 0.5F, {0, 0, 0, 2}), vertex(16, 0, 0.5F, {8, 0, 0, 2}),
                   vertex(16, 8, 0.5F, {8, 4, 0, 2}), vertex(0, 8, 0.5F, {0, 4, 0, 2})});
    const Floats p = at<float>(shown(scene, Aov::uv), 5, 1);
    EXPECT_FLOAT_EQ(p[0], 1.375F);
    EXPECT_FLOAT_EQ(p[1], 0.375F);
    EXPECT_EQ(p[2], 0.0F);
    // Bytes hold what is left of whole numbers: 0.375 * 255 = 95.6.
    EXPECT_EQ(at<std::uint8_t>(shown(scene, Aov::uv, PixelFormat::rgba8), 5, 1),
              (Bytes{96, 96, 0, 255}));
}

TEST(AovTest, TrianglesHaveTheirNumbers) {
    Scene scene =
        raw_scene({vertex(0, 0, 0.5F), vertex(4, 0, 0.5F), vertex(4, 8, 0.5F), vertex(0, 8, 0.5F),
                   vertex(4, 0, 0.5F), vertex(8, 0, 0.5F), vertex(8, 8, 0.5F), vertex(4, 8, 0.5F)});
    scene.objects.push_back(raw_scene({vertex(8, 0, 0.5F), vertex(12, 0, 0.5F), vertex(12, 8, 0.5F),
                                       vertex(8, 8, 0.5F)})
                                .objects[0]);
    const Framebuffer frame = shown(scene, Aov::triangle);
    // Quads are cut from the first to the third corner: the upper right half comes first.
    EXPECT_EQ(at<float>(frame, 3, 1), (Floats{0, 0, 0, 1}));
    EXPECT_EQ(at<float>(frame, 0, 6), (Floats{1, 0, 0, 1}));
    EXPECT_EQ(at<float>(frame, 7, 1), (Floats{2, 0, 0, 1}));
    EXPECT_EQ(at<float>(frame, 4, 6), (Floats{3, 0, 0, 1}));
    EXPECT_EQ(at<float>(frame, 11, 1), (Floats{0, 1, 0, 1}));
    EXPECT_EQ(at<float>(frame, 8, 6), (Floats{1, 1, 0, 1}));
    EXPECT_EQ(at<float>(frame, 14, 4), (Floats{0, 0, 0, 0}));
    const Framebuffer bytes = shown(scene, Aov::triangle, PixelFormat::rgba8);
    std::set<Bytes> colors;
    for (const auto& [x, y] : {std::pair{3, 1}, {0, 6}, {7, 1}, {4, 6}, {11, 1}, {8, 6}, {14, 4}})
        colors.insert(at<std::uint8_t>(bytes, x, y));
    EXPECT_EQ(colors.size(), 7U);
}

// Culled triangles count, and all pieces of a clipped one have its number.
TEST(AovTest, NumbersAreThoseOfTheMesh) {
    Scene scene;
    scene.width = scene.height = 64;
    MeshData data = shapes::plane(3, 3);
    scene.camera.position = {0.0F, 0.3F, 0.2F};
    scene.camera.focal_point = {0.0F, 0.0F, -1.0F};
    scene.objects.push_back({Mesh(data),
                             std::make_shared<Material>(),
                             placement({0.0F, 0.0F, 0.0F}, {1.0F, 0.0F, 0.0F}, -90.0F, 8.0F),
                             {}});
    const std::size_t count = std::get<Mesh>(scene.objects[0].geometry).triangle_count();
    const Framebuffer frame = shown(scene, Aov::triangle);
    std::set<float> numbers;
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x)
            if (at<float>(frame, x, y)[3] > 0.0F) numbers.insert(at<float>(frame, x, y)[0]);
    EXPECT_GE(numbers.size(), 4U);
    EXPECT_LT(*numbers.rbegin(), static_cast<float>(count));
    for (const float n : numbers) EXPECT_EQ(n, std::floor(n));
}

/// A plane that faces the camera, turned by `degrees` about the y axis.
Scene plane_scene(float degrees) {
    Scene scene;
    scene.width = scene.height = 32;
    scene.objects.push_back({Mesh(shapes::plane(2, 2)),
                             std::make_shared<Material>(),
                             placement({0.0F, 0.0F, 0.0F}, {0.0F, 1.0F, 0.0F}, degrees, 2.0F),
                             {}});
    return scene;
}

TEST(AovTest, VectorsAreThoseOfTheWorld) {
    const Floats normal = at<float>(shown(plane_scene(0.0F), Aov::normal), 16, 16);
    EXPECT_EQ(normal, (Floats{0, 0, 1, 1}));
    EXPECT_EQ(at<float>(shown(plane_scene(0.0F), Aov::tangent), 16, 16), (Floats{1, 0, 0, 1}));
    // x/2 + 1/2: 0 is 127.5, half up 128.
    EXPECT_EQ(at<std::uint8_t>(shown(plane_scene(0.0F), Aov::normal, PixelFormat::rgba8), 16, 16),
              (Bytes{128, 128, 255, 255}));
    // 30 degrees about y: (0, 0, 1) becomes (1/2, 0, sqrt(3)/2), (1, 0, 0) becomes (sqrt(3)/2, 0,
    // -1/2)
    const Floats turned = at<float>(shown(plane_scene(30.0F), Aov::normal), 16, 16);
    EXPECT_NEAR(turned[0], 0.5F, 1e-6F);
    EXPECT_NEAR(turned[1], 0.0F, 1e-6F);
    EXPECT_NEAR(turned[2], std::sqrt(0.75F), 1e-6F);
    const Floats tangent = at<float>(shown(plane_scene(30.0F), Aov::tangent), 16, 16);
    EXPECT_NEAR(tangent[0], std::sqrt(0.75F), 1e-6F);
    EXPECT_NEAR(tangent[2], -0.5F, 1e-6F);
}

TEST(AovTest, VectorsOfABallAreUnitLengthAndPointOutwards) {
    Scene scene;
    scene.width = scene.height = 64;
    scene.objects.push_back(
        {Mesh(shapes::sphere(32, 16)), std::make_shared<Material>(), glm::mat4(1.0F), {}});
    const Framebuffer normals = shown(scene, Aov::normal), tangents = shown(scene, Aov::tangent);
    for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 64; ++x) {
            const Floats n = at<float>(normals, x, y), t = at<float>(tangents, x, y);
            if (n[3] == 0.0F) continue;
            ASSERT_NEAR(n[0] * n[0] + n[1] * n[1] + n[2] * n[2], 1.0F, 1e-5F);
            ASSERT_NEAR(t[0] * t[0] + t[1] * t[1] + t[2] * t[2], 1.0F, 1e-5F);
            ASSERT_GT(n[2], -0.3F) << "what faces away is hidden";
            ASSERT_TRUE(n[0] <= 0.1F || x >= 32) << "right is right";
        }
    }
}

TEST(AovTest, RawVerticesHaveNoVectors) {
    const Scene scene = raw_scene(
        {vertex(0, 0, 0.5F), vertex(16, 0, 0.5F), vertex(16, 8, 0.5F), vertex(0, 8, 0.5F)});
    EXPECT_EQ(at<float>(shown(scene, Aov::normal), 3, 3), (Floats{0, 0, 0, 1}));
    EXPECT_EQ(at<std::uint8_t>(shown(scene, Aov::tangent, PixelFormat::rgba8), 3, 3),
              (Bytes{128, 128, 128, 255}));
}

// The left half of the sheet in front fails the alpha test; the blended one shows itself alone.
TEST(AovTest, ShowsTheFragmentsOfThePicture) {
    Scene scene = raw_scene(
        {vertex(0, 0, 0.75F), vertex(16, 0, 0.75F), vertex(16, 8, 0.75F), vertex(0, 8, 0.75F)});
    Object holes = raw_scene({vertex(0, 0, 0.5F, {}, 0.0F), vertex(16, 0, 0.5F, {}, 1.0F),
                              vertex(16, 8, 0.5F, {}, 1.0F), vertex(0, 8, 0.5F, {}, 0.0F)})
                       .objects[0];
    auto tested = vertex_color();
    tested->alpha_test = {Comparison::gequal, 0.5F};
    holes.material = tested;
    Object glass = raw_scene({vertex(0, 0, 0.25F), vertex(16, 0, 0.25F), vertex(16, 4, 0.25F),
                              vertex(0, 4, 0.25F)})
                       .objects[0];
    glass.raster.blend = Blend::alpha();
    scene.objects.push_back(holes);
    scene.objects.push_back(glass);
    const Framebuffer depth = shown(scene, Aov::depth);
    EXPECT_EQ(at<float>(depth, 3, 6)[0], 0.75F);
    EXPECT_EQ(at<float>(depth, 12, 6)[0], 0.5F);
    EXPECT_EQ(at<float>(depth, 3, 2), (Floats{0.25F, 0.25F, 0.25F, 1.0F}));
    EXPECT_EQ(at<float>(shown(scene, Aov::triangle), 12, 6)[1], 1.0F);
}

TEST(AovTest, TheSameBitsEverywhere) {
    for (const Scene& scene : {scenes::layers(), scenes::near_plane(), scenes::machine()}) {
        for (const Aov aov : {Aov::depth, Aov::normal, Aov::tangent, Aov::bitangent, Aov::stripes,
                              Aov::uv, Aov::triangle}) {
            for (const PixelFormat format :
                 {PixelFormat::rgba8, PixelFormat::rgba16, PixelFormat::rgba32f}) {
                Framebuffer want(scene.width, scene.height, format);
                Renderer({.threads = 1, .isa = "reference"}).render(scene, want, aov);
                for (const IsaInfo& isa : instruction_sets()) {
                    if (!isa.available) continue;
                    for (const std::size_t cap : {std::size_t{1}, std::size_t{1} << 28}) {
                        Framebuffer got(scene.width, scene.height, format);
                        Renderer({.threads = 2, .isa = std::string(isa.name), .memory_cap = cap})
                            .render(scene, got, aov);
                        for (int y = 0; y < scene.height; ++y)
                            ASSERT_EQ(std::memcmp(got.row(y), want.row(y),
                                                  static_cast<std::size_t>(scene.width) *
                                                      pixel_size(format)),
                                      0)
                                << isa.name << ", aov " << static_cast<int>(aov) << ", row " << y;
                    }
                }
            }
        }
    }
}

}  // namespace
}  // namespace burnish
