// The double-precision renderer: where its samples lie and what they see, by geometry; what it
// stores and refuses.
#include <gtest/gtest.h>

#include <array>
#include <burnish/error.hpp>
#include <burnish/trace.hpp>
#include <cstring>
#include <random>
#include <string>

#include "tests/double_scenes.hpp"

namespace burnish {
namespace {

using reference::DoubleScene;
using reference::FrameSize;
using reference::SamplePattern;

// ---- geometry

/// Where the ray of a pixel's centre meets the plane z = 0 of an object, by intersection.
struct PlaneHit {
    glm::dvec2 at;
    bool in_front;
    double distance;  ///< along the line of sight
};
PlaneHit hit_plane(const DoubleScene& scene, FrameSize size, int x, int y) {
    const glm::dmat4 object_from_clip =
        glm::inverse(scene.view.clip_from_world * scene.objects[0].world_from_object);
    const glm::dvec4 ndc((x + 0.5) / size.width * 2.0 - 1.0, 1.0 - (y + 0.5) / size.height * 2.0,
                         0.0, 1.0);
    const glm::dvec4 through = object_from_clip * ndc;
    const glm::dvec3 eye(glm::inverse(scene.objects[0].world_from_object) *
                         glm::dvec4(scene.view.eye, 1.0));
    const glm::dvec3 to = glm::dvec3(through) / through.w - eye;
    const double distance = -eye.z / to.z;
    const glm::dvec3 at = eye + to * distance;
    const glm::dvec4 clip =
        scene.view.clip_from_world * scene.objects[0].world_from_object * glm::dvec4(at, 1.0);
    return {glm::dvec2(at), distance > 0.0, clip.w};
}

/// A floor seen from close above it, that reaches far behind the eye.
Scene floor_scene() {
    Scene scene = lit_scene(64, 48);
    scene.camera.position = {0.1F, 0.5F, 0.3F};
    scene.camera.focal_point = {0.0F, 0.0F, -2.0F};
    scene.camera.near = 1.0F;
    scene.camera.far = 5.0F;
    scene.objects.push_back({Mesh(shapes::plane(2, 2)),
                             material_of(Model::abp),
                             placement({0.0F, 0.0F, 0.0F}, {1.0F, 0.0F, 0.0F}, -90.0F, 40.0F),
                             {.depth_test = DepthTest::always}});
    return scene;
}

TEST(DoubleRendererTest, CoordinatesAreThoseOfTheRay) {
    const DoubleScene scene = doubled(floor_scene());
    const FrameSize size{64, 48};
    const auto pixels = pixels_of(scene, size);
    reference::ProjectionCounts counts;
    const auto triangles = reference::project(scene, size, counts);
    EXPECT_EQ(counts.submitted, 8U);
    int inside = 0;
    for (int y = 0; y < size.height; ++y) {
        for (int x = 0; x < size.width; ++x) {
            const PlaneHit hit = hit_plane(scene, size, x, y);
            const bool expected = hit.in_front && largest({hit.at, 0.0, 0.0}) <= 0.5;
            const glm::dvec3 p(x + 0.5, y + 0.5, 1.0);
            int hits = 0;
            for (const reference::ProjectedTriangle& t : triangles) {
                if (!reference::covers(t, p)) continue;
                ++hits;
                const glm::dvec3 w = reference::weights(t, p);
                glm::dvec2 uv(0.0);
                for (int i = 0; i < 3; ++i)
                    uv += w[i] *
                          scene.objects[0]
                              .vertices[scene.objects[0]
                                            .indices[3 * t.number + static_cast<std::uint32_t>(i)]]
                              .uv;
                EXPECT_NEAR(uv.x, hit.at.x + 0.5, 1e-11);
                EXPECT_NEAR(uv.y, 0.5 - hit.at.y, 1e-11);  // v downward
            }
            EXPECT_EQ(hits, expected ? 1 : 0) << x << "," << y;
            const bool background =
                pixels[static_cast<std::size_t>(y * size.width + x)] == scene.background;
            const bool in_range = hit.distance > 1.0 && hit.distance < 5.0;
            EXPECT_EQ(background, !(expected && in_range)) << x << "," << y;
            inside += hits;
        }
    }
    EXPECT_GT(inside, 64 * 48 / 2);
}

// The plane fills pixels 8 .. 23 of 32 exactly: its edges and, along its diagonal, the centres of
// 16 pixels lie on edges of triangles.
TEST(DoubleRendererTest, EdgesBelongToOneTriangle) {
    Scene scene = lit_scene(32, 32);
    scene.camera.view = glm::mat4(1.0F);
    scene.camera.projection = glm::mat4(1.0F);
    scene.objects.push_back(
        {Mesh(shapes::plane(1, 1)), material_of(Model::abp), glm::mat4(1.0F), {}});
    reference::ProjectionCounts counts;
    const auto shifted = [&](double by) {
        DoubleScene moved = doubled(scene);
        for (auto& v : moved.objects[0].vertices)
            v.position += glm::dvec3(by / 16.0, -by / 16.0, 0.0);
        const auto triangles = reference::project(moved, {32, 32}, counts);
        std::array<int, 4> box{32, 32, -1, -1};
        for (int y = 0; y < 32; ++y) {
            for (int x = 0; x < 32; ++x) {
                int hits = 0;
                for (const auto& t : triangles)
                    hits += reference::covers(t, {x + 0.5, y + 0.5, 1.0}) ? 1 : 0;
                EXPECT_LE(hits, 1);
                if (hits == 0) continue;
                box = {std::min(box[0], x), std::min(box[1], y), std::max(box[2], x),
                       std::max(box[3], y)};
            }
        }
        return box;
    };
    EXPECT_EQ(shifted(0.0), (std::array<int, 4>{8, 8, 23, 23}));
    // Half a pixel right and down, the left and upper edges run through centres and have them.
    EXPECT_EQ(shifted(0.5), (std::array<int, 4>{8, 8, 23, 23}));
}

/// The scene after `rotation` of everything in it; what is in front of the eye stays the same.
DoubleScene rotated(DoubleScene scene, const glm::dmat3& rotation, bool vertices) {
    const glm::dmat4 whole(rotation);
    scene.view.clip_from_world = scene.view.clip_from_world * glm::transpose(whole);
    scene.view.eye = rotation * scene.view.eye;
    scene.view.back = rotation * scene.view.back;
    for (auto& light : scene.lights) light.position = rotation * light.position;
    for (auto& object : scene.objects) {
        if (!vertices) {
            object.world_from_object = whole * object.world_from_object;
            continue;
        }
        for (auto& v : object.vertices) {
            v.position = rotation * v.position;
            v.tangent = rotation * v.tangent;
            v.bitangent = rotation * v.bitangent;
            v.normal = rotation * v.normal;
        }
    }
    return scene;
}

TEST(DoubleRendererTest, TurningMeshLightAndCameraTogetherChangesNothing) {
    const glm::dvec3 n = glm::normalize(glm::dvec3(0.3, -0.5, 0.8));
    const glm::dvec3 t = glm::normalize(glm::cross(n, glm::dvec3(0.9, 0.1, 0.2)));
    const glm::dmat3 rotation(t, glm::cross(n, t), n);
    for (const Model model : kModels) {
        const DoubleScene scene = doubled(sphere_scene(model, 64, 64));
        const auto before = pixels_of(scene, {64, 64});
        for (const bool vertices : {false, true}) {
            const auto after = pixels_of(rotated(scene, rotation, vertices), {64, 64});
            int flipped = 0;
            for (std::size_t i = 0; i < before.size(); ++i)
                flipped += largest(after[i] - before[i]) < 1e-9 ? 0 : 1;
            EXPECT_LT(flipped, 10) << "model " << static_cast<int>(model);
        }
    }
}

Scene two_planes(DepthTest test, float second = 0.5F) {
    Scene scene = lit_scene(8, 8);
    scene.lights.clear();
    for (const auto& [z, depth_test] : {std::pair(0.0F, DepthTest::less), std::pair(second, test)})
        scene.objects.push_back({Mesh(shapes::plane(1, 1)),
                                 material_of(Model::banks),
                                 placement({0.0F, 0.0F, z}, {0.0F, 1.0F, 0.0F}, 0.0F, 2.0F),
                                 {.depth_test = depth_test}});
    return scene;
}

/// Number of the object that shades the pixel in the middle.
int object_seen(Scene scene) {
    scene.lights = {{.position = {0.0F, 0.0F, 1.0F}}};
    scene.background = glm::vec4(0.0F);
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        auto material = std::make_shared<Material>(*scene.objects[i].material);
        material->ks = glm::vec3(0.0F);
        material->kd = i == 0 ? glm::vec3(1.0F, 0.0F, 0.0F) : glm::vec3(0.0F, 1.0F, 0.0F);
        scene.objects[i].material = material;
    }
    const glm::dvec4 color = pixels_of(scene)[36];
    EXPECT_NEAR(color.x + color.y, 1.0, 1e-12);
    return color.x > 0.5 ? 0 : 1;
}

// Object 1 is nearer.
TEST(DoubleRendererTest, DepthTestsCompareWithWhatWasDrawnBefore) {
    const std::array<std::pair<DepthTest, int>, 8> seen{{{DepthTest::never, 0},
                                                         {DepthTest::less, 1},
                                                         {DepthTest::equal, 0},
                                                         {DepthTest::lequal, 1},
                                                         {DepthTest::greater, 0},
                                                         {DepthTest::notequal, 1},
                                                         {DepthTest::gequal, 0},
                                                         {DepthTest::always, 1}}};
    for (const auto& [test, object] : seen)
        EXPECT_EQ(object_seen(two_planes(test)), object) << static_cast<int>(test);
    Scene reversed = two_planes(DepthTest::less);
    std::swap(reversed.objects[0], reversed.objects[1]);
    EXPECT_EQ(object_seen(reversed), 0);
    EXPECT_EQ(object_seen(two_planes(DepthTest::less, 0.0F)), 0);
    EXPECT_EQ(object_seen(two_planes(DepthTest::lequal, 0.0F)), 1);
    EXPECT_EQ(object_seen(two_planes(DepthTest::equal, 0.0F)), 1);
    // Nothing written by the near one, which comes first.
    reversed.objects[0].raster.depth_write = false;
    EXPECT_EQ(object_seen(reversed), 1);
    Scene empty = lit_scene(8, 8);
    EXPECT_EQ(pixels_of(empty)[36], glm::dvec4(empty.background));
}

TEST(DoubleRendererTest, CullingSeesTheWinding) {
    Scene scene = sphere_scene(Model::abp, 32, 32);
    const auto whole = pixels_of(scene);
    scene.objects[0].raster.cull = Cull::back;
    EXPECT_EQ(pixels_of(scene), whole);
    scene.objects[0].raster.cull = Cull::front;
    EXPECT_NE(pixels_of(scene), whole);
    scene.objects[0].raster.cull = Cull::back;
    scene.camera.position = {0.0F, 0.0F, 0.0F};  // inside
    scene.camera.focal_point = {0.0F, 0.0F, -1.0F};
    for (const glm::dvec4& pixel : pixels_of(scene)) EXPECT_EQ(pixel, glm::dvec4(scene.background));
}

TEST(DoubleRendererTest, NothingBeyondNearAndFarIsSeen) {
    Scene scene = sphere_scene(Model::abp, 16, 16);
    const auto background = [&] {
        const auto pixels = pixels_of(scene);
        return std::all_of(pixels.begin(), pixels.end(),
                           [&](const glm::dvec4& p) { return p == glm::dvec4(scene.background); });
    };
    EXPECT_FALSE(background());
    scene.camera.near = 4.1F;  // the sphere is 2 .. 4 away
    EXPECT_TRUE(background());
    scene.camera.near = 0.1F;
    scene.camera.far = 1.9F;
    EXPECT_TRUE(background());
    // Between, the near plane takes the cap off, and behind it the far side shows its back.
    scene.camera.far = 10.0F;
    scene.camera.near = 2.1F;
    scene.objects[0].raster.cull = Cull::back;
    EXPECT_EQ(pixels_of(scene)[8 * 16 + 8], glm::dvec4(scene.background));
    EXPECT_FALSE(background());
}

TEST(DoubleRendererTest, TrianglesWithoutAFinitePlaceAreLeftOut) {
    MeshData data = shapes::sphere(8, 4);
    data.positions[0].x = std::numeric_limits<float>::quiet_NaN();
    Scene scene = sphere_scene(Model::abp, 16, 16);
    scene.objects[0].geometry = Mesh(data);
    Framebuffer frame(16, 16);
    const FrameStats stats = Renderer({.threads = 1}).render(scene, frame);
    EXPECT_EQ(stats.triangles, 2U * 8U * 3U);
    EXPECT_GT(stats.nonfinite_triangles, 0U);
}

// ---- samples

TEST(DoubleRendererTest, OneSampleLiesAtTheCentreSeveralInTheirCells) {
    EXPECT_EQ(SamplePattern(1).position(5, 7, 0), glm::dvec2(5.5, 7.5));
    const SamplePattern pattern(4);
    glm::dvec2 sum(0.0);
    for (int x = 0; x < 200; ++x) {
        for (int s = 0; s < pattern.count(); ++s) {
            const glm::dvec2 at =
                (pattern.position(x, 3, s) - glm::dvec2(x, 3)) * 4.0 - glm::dvec2(s % 4, s / 4);
            EXPECT_TRUE(at.x >= 0.0 && at.x < 1.0 && at.y >= 0.0 && at.y < 1.0);
            sum += at;
        }
    }
    // 3200 numbers of variance 1/12 have a mean that is off by 0.0051; five times that.
    EXPECT_NEAR(sum.x / 3200.0, 0.5, 0.026);
    EXPECT_NEAR(sum.y / 3200.0, 0.5, 0.026);
    EXPECT_NE(pattern.position(0, 0, 0), pattern.position(1, 0, 0) - glm::dvec2(1.0, 0.0));
    EXPECT_NE(pattern.position(0, 0, 0), SamplePattern(4, 2).position(0, 0, 0));
    EXPECT_EQ(pattern.position(9, 8, 7), SamplePattern(4).position(9, 8, 7));
}

TEST(DoubleRendererTest, WorkersMakeNoDifference) {
    const Scene scene = sphere_scene(Model::ward, 70, 50);
    const auto one = pixels_of(scene, 2, 1);
    EXPECT_EQ(pixels_of(scene, 2, 2), one);
    EXPECT_EQ(pixels_of(scene, 2, 5), one);
}

// Independent samples would halve the error when their number is fourfold; stratified ones do
// better.
TEST(DoubleRendererTest, SupersamplingConverges) {
    Scene scene = sphere_scene(Model::abp, 40, 30);
    scene.background = {0.9F, 0.9F, 0.9F, 1.0F};
    const auto truth = pixels_of(scene, 32, 2);
    const double one = root_mean_square(pixels_of(scene, 1), truth),
                 four = root_mean_square(pixels_of(scene, 2), truth),
                 sixteen = root_mean_square(pixels_of(scene, 4), truth),
                 many = root_mean_square(pixels_of(scene, 8), truth);
    EXPECT_LT(four, 0.6 * one);
    EXPECT_LT(sixteen, 0.5 * four);
    EXPECT_LT(many, 0.5 * sixteen);
    // About 100 pixels of 1200 have an edge of contrast 1.5; with 10 of 64 samples undecided, each
    // of variance 1/6, that is sqrt(100 / 1200) 1.5 sqrt(10 / 6) / 64 = 0.0087.
    EXPECT_LT(many, 0.012);
}

// ---- the renderer's door

template <class Channel>
std::array<Channel, 4> stored(const Scene& scene, PixelFormat format, int samples = 1) {
    Framebuffer frame(scene.width, scene.height, format);
    Renderer({.threads = 1, .double_samples = samples}).render(scene, frame);
    std::array<Channel, 4> pixel;
    std::memcpy(pixel.data(), frame.row(0), sizeof pixel);
    return pixel;
}

// Ambient light alone: 0.5 is 127.5 and 32767.5, rounded up; 1.5 exceeds what codes can say.
TEST(DoubleRendererTest, FramesGetTheNearestCodeAndFloatsWhatItIs) {
    Scene scene = one_pixel(Model::abp);
    scene.lights.clear();
    scene.ambient = {0.5F, 1.5F, 0.0F};
    for (const int samples : {1, 9}) {
        EXPECT_EQ(stored<std::uint8_t>(scene, PixelFormat::rgba8, samples),
                  (std::array<std::uint8_t, 4>{128, 255, 0, 255}));
        EXPECT_EQ(stored<std::uint16_t>(scene, PixelFormat::rgba16, samples),
                  (std::array<std::uint16_t, 4>{32768, 65535, 0, 65535}));
        EXPECT_EQ(stored<float>(scene, PixelFormat::rgba32f, samples),
                  (std::array<float, 4>{0.5F, 1.5F, 0.0F, 1.0F}));
    }
}

// The machine codes vectors in 16 bits at most; with widths of 1 nothing magnifies them.
TEST(DoubleRendererTest, SeesWhatTheIdealMachineSees) {
    Scene scene = sphere_scene(Model::abp_modified, 64, 64);
    auto material = std::make_shared<Material>(*scene.objects[0].material);
    material->alpha_x = material->alpha_y = 1.0F;
    scene.objects[0].material = material;
    const auto doubles = pixels_of(scene);
    scene.machine = machine_profile("ideal");
    Framebuffer frame(64, 64, PixelFormat::rgba32f);
    Renderer({.threads = 1}).render(scene, frame);
    int different = 0;
    for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 64; ++x) {
            glm::vec4 pixel;
            std::memcpy(&pixel, frame.row(y) + 16 * x, sizeof pixel);
            const glm::dvec4 off =
                glm::dvec4(pixel) - doubles[static_cast<std::size_t>(64 * y + x)];
            different += largest(off) < 0.01 ? 0 : 1;
        }
    }
    EXPECT_LE(different, 4);  // snapped to 1/256 pixel, an edge may pass a centre
}

TEST(DoubleRendererTest, WhatItCannotDrawIsRefused) {
    Framebuffer frame(8, 8);
    Renderer renderer({.threads = 1});
    const auto code_of = [&](const Scene& scene) {
        try {
            renderer.render(scene, frame);
        } catch (const Error& error) {
            EXPECT_NE(std::string(error.what()).find("double"), std::string::npos) << error.what();
            return error.code();
        }
        ADD_FAILURE() << "expected an error";
        return ErrorCode::io;
    };
    const auto changed = [](auto&& change) {
        Scene scene = sphere_scene(Model::abp, 8, 8);
        auto material = std::make_shared<Material>(*scene.objects[0].material);
        change(scene, *material);
        scene.objects[0].material = material;
        return scene;
    };
    EXPECT_EQ(code_of(changed([](Scene& s, Material&) { s.objects[0].geometry = RawVertices{}; })),
              ErrorCode::bad_program);
    EXPECT_EQ(code_of(changed([](Scene&, Material& m) { m.program.emplace(); })),
              ErrorCode::bad_program);
    EXPECT_EQ(code_of(changed([](Scene&, Material& m) { m.alpha_test.pass = Comparison::less; })),
              ErrorCode::bad_program);
    EXPECT_EQ(
        code_of(changed([](Scene& s, Material&) { s.objects[0].raster.blend = Blend::add(); })),
        ErrorCode::bad_program);
    EXPECT_EQ(
        code_of(changed([](Scene& s, Material&) { s.machine.half_vector = HalfVector::vertex; })),
        ErrorCode::bad_option);
    const Scene scene = sphere_scene(Model::abp, 8, 8);
    EXPECT_THROW(renderer.render(scene, frame, Aov::depth), Error);
    EXPECT_THROW(renderer.render(scene, frame, ShownRegister{}), Error);
    EXPECT_THROW(trace_pixel(scene, 3, 3), Error);
    for (const int samples : {0, 2, -4, 1025, 1089})
        EXPECT_THROW(Renderer({.threads = 1, .double_samples = samples}).render(scene, frame),
                     Error);
    EXPECT_NO_THROW(Renderer({.threads = 1, .double_samples = 1024}).render(scene, frame));
}

}  // namespace
}  // namespace burnish
