// Geometry in place of colours: numbers by hand in every format, and the same fragments as in the
// picture, whatever draws them.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <burnish/error.hpp>
#include <burnish/renderer.hpp>
#include <burnish/shapes.hpp>
#include <burnish/trace.hpp>
#include <cmath>
#include <cstring>
#include <set>
#include <string>
#include <vector>

#include "tests/scenes.hpp"
#include "tests/unit_scene.hpp"
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

Scene with_depths_of_all_draws(Scene scene) {
    for (Object& object : scene.objects) object.raster.depth_write = true;
    return scene;
}
/// The same picture, in which not every draw writes its depths.
Scene with_a_draw_of_no_depth(Scene scene) {
    Object outside = raw_scene({vertex(-9, 0, 0.5F), vertex(-8, 0, 0.5F), vertex(-8, 8, 0.5F)},
                               Topology::triangles)
                         .objects[0];
    outside.raster.depth_write = false;
    scene.objects.push_back(outside);
    return scene;
}

/// Row by row, drawn without colours.
std::vector<float> depths_of(const Scene& scene, const RendererOptions& options,
                             FrameStats* stats = nullptr) {
    std::vector<float> depths(static_cast<std::size_t>(scene.width * scene.height), -1.0F);
    Framebuffer frame(depths.data(), scene.width * std::ptrdiff_t{sizeof(float)}, scene.width,
                      scene.height, PixelFormat::depth32f);
    const FrameStats got = Renderer(options).render(scene, frame);
    if (stats != nullptr) *stats = got;
    return depths;
}
/// Red of the picture of depths that is made of fragments one by one.
std::vector<float> fragment_depths(const Scene& scene) {
    const Framebuffer frame = shown(with_a_draw_of_no_depth(scene), Aov::depth);
    std::vector<float> depths;
    for (int y = 0; y < scene.height; ++y)
        for (int x = 0; x < scene.width; ++x) depths.push_back(at<float>(frame, x, y)[0]);
    return depths;
}

TEST(AovTest, DepthsAloneAreThoseOfTheFragments) {
    for (const Scene& original : {scenes::layers(), scenes::near_plane(), scenes::machine()}) {
        const Scene scene = with_depths_of_all_draws(original);
        const std::vector<float> want = fragment_depths(scene);
        const bool tested =
            std::any_of(scene.objects.begin(), scene.objects.end(), [](const Object& object) {
                return object.material && object.material->alpha_test.pass != Comparison::always;
            });
        for (const IsaInfo& isa : instruction_sets()) {
            if (!isa.available) continue;
            for (const std::size_t cap : {std::size_t{1}, std::size_t{1} << 28}) {
                FrameStats stats;
                ASSERT_EQ(depths_of(scene, {2, std::string(isa.name), cap}, &stats), want)
                    << isa.name;
                EXPECT_EQ(stats.shaded_pixels > 0, tested);
            }
        }
    }
}

// Fragments that a texture shader drops, or whose depths it replaces.
TEST(AovTest, DepthsAloneAreThoseThatShadingLeaves) {
    int dropped = 0, moved = 0;
    for (unsigned seed = 0; seed < 300; ++seed) {
        Random random(seed);
        const UnitScene units(random, machine_profile("nv2a"));
        const std::vector<float> want = fragment_depths(units.scene);
        ASSERT_EQ(depths_of(units.scene, {.threads = 1}), want) << "seed " << seed;
        for (const float depth : want) {
            dropped += depth == 1.0F ? 1 : 0;
            moved += depth != 1.0F && depth != 0.5F ? 1 : 0;
        }
    }
    EXPECT_GT(dropped, 1000);
    EXPECT_GT(moved, 50);
}

TEST(AovTest, DepthPicturesAreTheSameWithoutFragments) {
    for (const PixelFormat format :
         {PixelFormat::rgba8, PixelFormat::rgba16, PixelFormat::rgba32f}) {
        const Scene scene = with_depths_of_all_draws(scenes::layers());
        const Framebuffer alone = shown(scene, Aov::depth, format),
                          fragments = shown(with_a_draw_of_no_depth(scene), Aov::depth, format);
        for (int y = 0; y < scene.height; ++y)
            ASSERT_EQ(std::memcmp(alone.row(y), fragments.row(y),
                                  static_cast<std::size_t>(scene.width) * pixel_size(format)),
                      0)
                << "row " << y;
    }
}

TEST(AovTest, DrawsThatWriteNoDepthLeaveNone) {
    Scene scene = raw_scene(
        {vertex(0, 0, 0.75F), vertex(16, 0, 0.75F), vertex(16, 8, 0.75F), vertex(0, 8, 0.75F)});
    Object glass = raw_scene({vertex(0, 0, 0.25F), vertex(16, 0, 0.25F), vertex(16, 4, 0.25F),
                              vertex(0, 4, 0.25F)})
                       .objects[0];
    glass.raster.depth_write = false;
    scene.objects.push_back(glass);
    EXPECT_EQ(depths_of(scene, {.threads = 1}), std::vector<float>(16 * 8, 0.75F));
    EXPECT_EQ(at<float>(shown(scene, Aov::depth), 3, 2)[0], 0.25F);
}

TEST(AovTest, FramesOfDepthsTakeNothingElse) {
    Scene scene = raw_scene({});
    Framebuffer frame(16, 8, PixelFormat::depth32f);
    Renderer renderer({.threads = 1});
    const auto message = [](const auto& draw) {
        try {
            draw();
        } catch (const Error& e) {
            EXPECT_EQ(e.code(), ErrorCode::bad_option);
            return std::string(e.what());
        }
        return std::string("no error");
    };
    EXPECT_EQ(message([&] { renderer.render(scene, frame, Aov::normal); }),
              "geometry into a frame of depths, which takes the depth buffer alone; expected a "
              "frame of colours");
    EXPECT_EQ(message([&] { renderer.render(scene, frame, ShownRegister{}); }),
              "a register into a frame of depths, which takes the depth buffer alone; expected a "
              "frame of colours");
    scene.machine = machine_profile("double");
    EXPECT_EQ(message([&] { renderer.render(scene, frame); }),
              "a frame of depths with profile double, which delivers colours only; expected one "
              "of the machines");
    scene = raw_scene({});
    scene.format = PixelFormat::depth32f;
    EXPECT_EQ(message([&] { (void)trace_pixel(scene, 3, 3); }),
              "a trace of a scene with format depth32f, expected a format of colours");
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
