// The renderer at the edges of what it is given: nothing to draw, incomplete primitives, every
// format of the background, numbers that are none, cameras that see nothing.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <burnish/error.hpp>
#include <burnish/renderer.hpp>
#include <burnish/shapes.hpp>
#include <cstdint>
#include <cstring>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "tests/vertex_color.hpp"

namespace burnish {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

Scene black_scene(const char* machine = "nv2a") {
    Scene scene;
    scene.machine = machine_profile(machine);
    scene.background = glm::vec4(0.0F);
    return scene;
}

RawVertex white_at(float x, float y) {
    RawVertex v;
    v.position = {x, y, 0.5F, 1.0F};
    v.color0 = glm::vec4(1.0F);
    return v;
}

/// Pixels that are not black, of a frame of 40 x 30.
int lit_pixels(const Scene& scene, FrameStats* stats = nullptr) {
    Framebuffer frame(40, 30);
    const FrameStats got = Renderer({.threads = 2}).render(scene, frame);
    if (stats != nullptr) *stats = got;
    int count = 0;
    for (int y = 0; y < 30; ++y) {
        for (int x = 0; x < 40; ++x) count += frame.row(y)[4 * x] != std::byte{0} ? 1 : 0;
    }
    EXPECT_EQ(got.shaded_pixels, static_cast<std::uint64_t>(count));
    return count;
}

Object raw_object(Topology topology, std::vector<RawVertex> vertices, Cull cull = Cull::none) {
    return {RawVertices{Space::window, topology, std::move(vertices)},
            vertex_color(),
            glm::mat4(1.0F),
            {.depth_test = DepthTest::always, .cull = cull}};
}

TEST(Edges, NothingInViewIsBackground) {
    FrameStats stats;
    Scene scene = black_scene("ideal");
    EXPECT_EQ(lit_pixels(scene, &stats), 0);
    EXPECT_EQ(stats.triangles, 0U);
    const Mesh mesh(shapes::sphere(16, 8));
    const glm::vec3 away(0.0F, 1.0F, 0.0F);
    // Left, right, above, below, behind the camera and beyond the far plane, and an empty mesh.
    for (const glm::vec3 at :
         {glm::vec3{-50, 0, 0}, {50, 0, 0}, {0, 50, 0}, {0, -50, 0}, {0, 0, 50}, {0, 0, -500}}) {
        scene.objects.push_back({mesh, nullptr, placement(at, away, 0.0F, 1.0F), {}});
    }
    scene.objects.push_back({Mesh(), nullptr, glm::mat4(1.0F), {}});
    scene.objects.push_back(raw_object(Topology::triangles, {}));
    scene.background = {1.0F, 0.0F, 0.0F, 1.0F};
    Framebuffer frame(40, 30);
    stats = Renderer().render(scene, frame);
    EXPECT_EQ(stats.triangles, 6 * mesh.triangle_count());
    EXPECT_EQ(stats.binned_triangles, 0U);
    EXPECT_EQ(stats.clipped_triangles, 0U);
    EXPECT_EQ(stats.shaded_pixels, 0U);
    EXPECT_EQ(frame.row(15)[4 * 20], std::byte{255});
}

// 8 bits, 16 bits and floats of the same colour, clamped; what is no number is 0.
TEST(Edges, BackgroundInEveryFormat) {
    Scene scene;
    const std::array<float, 6> given{0.25F, 1.5F, -1.0F, kNan, kInfinity, 0.7F};
    for (const float x : given) {
        scene.background = {x, 0.5F, x, 1.0F};
        const float clamped = x > 0.0F ? std::min(x, 1.0F) : 0.0F;
        for (const PixelFormat format :
             {PixelFormat::rgba8, PixelFormat::rgba16, PixelFormat::rgba32f}) {
            Framebuffer frame(67, 9, format);
            Renderer().render(scene, frame);
            for (const int column : {0, 63, 64, 66}) {
                const std::byte* p =
                    frame.row(8) + static_cast<std::size_t>(column) * pixel_size(format);
                if (format == PixelFormat::rgba8) {
                    EXPECT_EQ(std::to_integer<int>(p[0]), static_cast<int>(clamped * 255 + 0.5F));
                    EXPECT_EQ(std::to_integer<int>(p[1]), 128);
                    EXPECT_EQ(std::to_integer<int>(p[3]), 255);
                } else if (format == PixelFormat::rgba16) {
                    std::array<std::uint16_t, 4> v{};
                    std::memcpy(v.data(), p, sizeof v);
                    EXPECT_EQ(v[0], static_cast<int>(clamped * 65535 + 0.5F));
                    EXPECT_EQ(v[1], 32768);
                    EXPECT_EQ(v[3], 65535);
                } else {
                    std::array<float, 4> v{};
                    std::memcpy(v.data(), p, sizeof v);
                    EXPECT_EQ(v[0], clamped);
                    EXPECT_EQ(v[1], 0.5F);
                    EXPECT_EQ(v[3], 1.0F);
                }
            }
        }
    }
}

// The rectangle [4, 12) x [5, 11) as every primitive; culled as one, since strips turn every other
// triangle round. Vertices that complete no primitive are left out.
TEST(Edges, PrimitivesFaceOneWay) {
    const RawVertex a = white_at(4, 5), b = white_at(12, 5), c = white_at(12, 11),
                    d = white_at(4, 11), extra = white_at(39, 29);
    const std::vector<std::pair<Topology, std::vector<RawVertex>>> clockwise{
        {Topology::triangles, {a, b, c, a, c, d, extra, extra}},
        {Topology::triangle_strip, {a, b, d, c}},
        {Topology::triangle_fan, {a, b, c, d}},
        {Topology::quads, {a, b, c, d, extra, extra, extra}},
        {Topology::quad_strip, {a, d, white_at(8, 5), white_at(8, 11), b, c, extra}},
    };
    for (const auto& [topology, vertices] : clockwise) {
        const bool turned = topology == Topology::quad_strip;  // its order turns the other way
        const auto draw = [&, t = topology, &v = vertices](Cull cull) {
            Scene scene = black_scene();
            scene.objects.push_back(raw_object(t, v, cull));
            return lit_pixels(scene);
        };
        EXPECT_EQ(draw(Cull::none), 48) << static_cast<int>(topology);
        EXPECT_EQ(draw(Cull::front), turned ? 0 : 48) << static_cast<int>(topology);
        EXPECT_EQ(draw(Cull::back), turned ? 48 : 0) << static_cast<int>(topology);
    }
}

TEST(Edges, IncompletePrimitivesDrawNothing) {
    for (const Topology topology :
         {Topology::triangles, Topology::triangle_strip, Topology::triangle_fan, Topology::quads,
          Topology::quad_strip}) {
        for (std::size_t count = 0; count < 3; ++count) {
            Scene scene = black_scene();
            scene.objects.push_back(
                raw_object(topology, std::vector<RawVertex>(count, white_at(5, 5))));
            FrameStats stats;
            EXPECT_EQ(lit_pixels(scene, &stats), 0);
            EXPECT_EQ(stats.triangles, 0U);
        }
    }
}

TEST(Edges, RawVerticesThatAreNoNumbersAreCounted) {
    for (const float bad : {kNan, kInfinity, -kInfinity}) {
        for (int component = 0; component < 4; ++component) {
            for (const Space space : {Space::window, Space::clip, Space::object}) {
                RawVertex broken = white_at(20, 20);
                broken.position[component] = bad;
                Scene scene = black_scene();
                scene.objects.push_back(
                    raw_object(Topology::triangles, {white_at(1, 1), white_at(30, 1), broken}));
                std::get<RawVertices>(scene.objects[0].geometry).space = space;
                FrameStats stats;
                EXPECT_EQ(lit_pixels(scene, &stats), 0);
                EXPECT_EQ(stats.nonfinite_triangles, 1U)
                    << bad << ", component " << component << ", space " << static_cast<int>(space);
            }
        }
    }
}

// Colours and coordinates may be anything: pixels get some colour, the same on every instruction
// set.
TEST(Edges, ColoursThatAreNoNumbersAreTheSameEverywhere) {
    using namespace combine;
    ProgramBuilder p;
    p.lerp(raw(Register::zero), raw(Register::zero), raw(tex(0)), raw(Register::col0));
    auto material = std::make_shared<Material>();
    material->program.emplace();
    material->program->combiners = p.build();
    Image8 image(4, 4);
    for (std::size_t i = 0; i < image.rgba.size(); ++i)
        image.rgba[i] = static_cast<std::uint8_t>(i);
    material->program->units = {std::make_shared<Texture>(image, Sampler{})};
    for (const char* machine : {"nv2a", "ideal"}) {
        for (const float bad : {kNan, kInfinity, -kInfinity, 3e38F, -3e38F, 1e-45F}) {
            Scene scene = black_scene(machine);
            Object object = raw_object(Topology::triangles,
                                       {white_at(1, 1), white_at(38, 2), white_at(20, 29)});
            object.material = material;
            auto& vertices = std::get<RawVertices>(object.geometry).vertices;
            vertices[0].color0.g = bad;
            vertices[1].uv[0].x = bad;
            vertices[2].uv[0].y = -bad;
            scene.objects = {object};
            std::vector<std::byte> first;
            for (const IsaInfo& isa : instruction_sets()) {
                if (!isa.available) continue;
                Framebuffer frame(40, 30);
                Renderer({.threads = 1, .isa = std::string(isa.name)}).render(scene, frame);
                const std::vector<std::byte> bytes(frame.pixels(), frame.pixels() + 4 * 40 * 30);
                if (first.empty()) first = bytes;
                ASSERT_EQ(bytes, first) << isa.name << " on " << machine << ", " << bad;
            }
        }
    }
}

std::string message_of(const Scene& scene) {
    Framebuffer frame(8, 8);
    try {
        Renderer({.threads = 1}).render(scene, frame);
    } catch (const Error& e) {
        EXPECT_EQ(e.code(), ErrorCode::bad_option) << e.what();
        return e.what();
    }
    return "no error";
}

TEST(Edges, CamerasThatSeeNothingAreRefused) {
    const auto with = [](const std::function<void(Camera&)>& change) {
        Scene scene = black_scene();
        change(scene.camera);
        return message_of(scene);
    };
    EXPECT_EQ(with([](Camera& c) { c.view_angle = 180.0F; }),
              "camera: view_angle 180, expected between 0 and 180 degrees");
    EXPECT_EQ(with([](Camera& c) { c.view_angle = kNan; }),
              "camera: view_angle nan, expected between 0 and 180 degrees");
    EXPECT_EQ(with([](Camera& c) { c.near = 0.0F; }),
              "camera: near 0, far 100, expected 0 < near < far");
    EXPECT_EQ(with([](Camera& c) { c.far = c.near = 1.0F; }),
              "camera: near 1, far 1, expected 0 < near < far");
    EXPECT_EQ(with([](Camera& c) {
                  c.view_up = {0.0F, 0.0F, 2.0F};
              }),
              "camera: view_up x line of sight has no direction");
    EXPECT_EQ(with([](Camera& c) { c.view_up = glm::vec3(0.0F); }),
              "camera: view_up has no direction");
    EXPECT_EQ(with([](Camera& c) { c.position.x = kNan; }),
              "camera: focal_point - position has no direction");
    EXPECT_EQ(with([](Camera& c) { c.view = glm::mat4(0.0F); }),
              "camera view matrix has no inverse");
}

TEST(Edges, ObjectsWithoutVolumeAreRefused) {
    Scene scene = black_scene("ideal");
    scene.objects.push_back({Mesh(shapes::cube()), nullptr, glm::mat4(0.0F), {}});
    EXPECT_EQ(message_of(scene), "object matrix has no inverse");
}

TEST(Edges, FramesThatCannotBeAreRefused) {
    std::vector<std::uint16_t> memory(4096);
    const auto message = [](const std::function<void()>& make) {
        try {
            make();
        } catch (const Error& e) {
            EXPECT_EQ(e.code(), ErrorCode::bad_option);
            return std::string(e.what());
        }
        return std::string("no error");
    };
    EXPECT_EQ(message([] { Framebuffer(16385, 1); }),
              "frame size 16385x1, expected 1 .. 16384 both ways");
    EXPECT_EQ(message([&] { Framebuffer(memory.data(), 31, 8, 8); }),
              "row pitch 31, expected a multiple of 1 and at least 32");
    EXPECT_EQ(message([&] { Framebuffer(memory.data(), 65, 8, 8, PixelFormat::rgba16); }),
              "row pitch 65, expected a multiple of 2 and at least 64");
    EXPECT_NE(message([] { Framebuffer(nullptr, 32, 8, 8); }).find("expected an address"),
              std::string::npos);
    EXPECT_EQ(message([] { Renderer({.threads = 1025}); }),
              "threads: 1025 found, expected 0 .. 1024");
}

TEST(Edges, FramesAreBlackAndBeginAtLinesAndWhereLargeAtHugePages) {
    const auto check = [](int width, int height, std::uintptr_t border) {
        const Framebuffer frame(width, height);
        EXPECT_EQ(reinterpret_cast<std::uintptr_t>(frame.pixels()) % border, 0U) << height;
        const std::byte* const end = frame.row(height - 1) + frame.pitch();
        EXPECT_EQ(std::count(frame.pixels(), end, std::byte{0}), end - frame.pixels());
    };
    constexpr std::uintptr_t kHugePage = std::uintptr_t{2} << 20;
    check(1, 1, 64);
    check(1024, 255, 64);
    check(1024, 256, kHugePage);  // half of one
    check(1024, 767, kHugePage);  // and small pages behind it
    check(1024, 768, kHugePage);
}

/// What a frame made of its materials goes with them, even if it never came to an end.
TEST(Edges, MaterialsOfRefusedFramesAreForgotten) {
    for (const char* machine : {"ideal", "double"}) {
        Scene scene = black_scene(machine);
        scene.objects.push_back({Mesh(shapes::cube()), nullptr, glm::mat4(1.0F), {}});
        scene.objects.push_back({RawVertices{}, nullptr, glm::mat4(1.0F), {}});
        Framebuffer frame(8, 8);
        Renderer renderer({.threads = 1});
        std::vector<std::weak_ptr<const Material>> seen;
        const auto alive = [&] {
            return std::count_if(seen.begin(), seen.end(),
                                 [](const auto& each) { return !each.expired(); });
        };
        const auto next = [&] {
            scene.objects[0].material = std::make_shared<const Material>();
            seen.push_back(scene.objects[0].material);
        };
        for (int i = 0; i < 8; ++i) {
            next();
            EXPECT_THROW(renderer.render(scene, frame), Error);
        }
        EXPECT_LE(alive(), 2) << machine;
        if (scene.machine.double_precision) continue;
        for (int i = 0; i < 16; ++i) {
            next();
            renderer.program(scene, 0);
        }
        EXPECT_LE(alive(), 6) << "three rounds of as many as there are objects";
    }
}

TEST(Edges, ProgramsAreOfObjectsThatAreThere) {
    Renderer renderer({.threads = 1});
    try {
        renderer.program(black_scene(), 99);
        ADD_FAILURE() << "of object 99 of none";
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::bad_option);
        EXPECT_STREQ(error.what(), "object 99 of a scene that has 0, counted from 0");
    }
}

TEST(Edges, RenderersAndFramesMove) {
    Scene scene = black_scene();
    scene.objects.push_back(raw_object(
        Topology::quads, {white_at(0, 0), white_at(40, 0), white_at(40, 30), white_at(0, 30)}));
    Renderer first({.threads = 2});
    Framebuffer frame(40, 30);
    first.render(scene, frame);
    Renderer second = std::move(first);
    Framebuffer moved = std::move(frame);
    EXPECT_EQ(moved.row(29)[4 * 39], std::byte{255});
    std::memset(moved.pixels(), 0, 4 * 40 * 30);
    EXPECT_EQ(second.render(scene, moved).shaded_pixels, 1200U);
    EXPECT_EQ(moved.row(29)[4 * 39], std::byte{255});
}

}  // namespace
}  // namespace burnish
