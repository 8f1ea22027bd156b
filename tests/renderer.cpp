// The renderer as a caller sees it: exact pixels of raw vertices, depth tests, culling, what is
// dropped and counted, and what is refused with which words.
#include <gtest/gtest.h>

#include <array>
#include <burnish/error.hpp>
#include <burnish/renderer.hpp>
#include <burnish/shapes.hpp>
#include <cstdlib>
#include <limits>
#include <memory>
#include <vector>

#include "tests/vertex_color.hpp"

namespace burnish {
namespace {

using Rgba = std::array<std::uint8_t, 4>;

Rgba pixel(const Framebuffer& frame, int x, int y) {
    const auto* p = reinterpret_cast<const std::uint8_t*>(frame.row(y)) + 4 * x;
    return {p[0], p[1], p[2], p[3]};
}

RawVertex corner(float x, float y, float z, const Rgba& color, float w = 1.0F) {
    RawVertex v;
    v.position = {x, y, z, w};
    for (int c = 0; c < 4; ++c)
        v.color0[c] = static_cast<float>(color[static_cast<std::size_t>(c)]) / 255.0F;
    return v;
}

/// A rectangle in window coordinates, corners clockwise as seen.
Object rectangle(float x0, float y0, float x1, float y1, float z, const Rgba& color,
                 RasterState raster = {.depth_test = DepthTest::always}) {
    return {RawVertices{Space::window,
                        Topology::quads,
                        {corner(x0, y0, z, color), corner(x1, y0, z, color),
                         corner(x1, y1, z, color), corner(x0, y1, z, color)}},
            vertex_color(), glm::mat4(1.0F), raster};
}

Scene flat_scene(const char* machine = "nv2a") {
    Scene scene;
    scene.machine = machine_profile(machine);
    scene.background = {0.0F, 0.0F, 0.0F, 1.0F};
    return scene;
}

constexpr Rgba kBlack{0, 0, 0, 255}, kRed{200, 17, 3, 254}, kGreen{1, 128, 77, 100};

std::string message_of(const std::function<void()>& call, ErrorCode code) {
    try {
        call();
    } catch (const Error& e) {
        EXPECT_EQ(e.code(), code) << e.what();
        return e.what();
    }
    return "no error";
}

TEST(Renderer, QuadInWindowCoordinatesComesOutToThePixel) {
    for (const char* machine : {"geforce256", "nv2a", "ideal"}) {
        Scene scene = flat_scene(machine);
        // Centres at .5: the rectangle [10.5, 20.5) x [7, 9.5) holds the centres of 10 columns, of
        // which the left edge's is its own, and of rows 7 and 8.
        scene.objects.push_back(rectangle(10.5F, 7.0F, 20.5F, 9.5F, 0.5F, kRed));
        Framebuffer frame(40, 20);
        const FrameStats stats = Renderer().render(scene, frame);
        for (int y = 0; y < 20; ++y) {
            for (int x = 0; x < 40; ++x) {
                const bool inside = x >= 10 && x < 20 && y >= 7 && y < 9;
                ASSERT_EQ(pixel(frame, x, y), inside ? kRed : kBlack)
                    << machine << ' ' << x << ", " << y;
            }
        }
        EXPECT_EQ(stats.shaded_pixels, 20U);
    }
}

TEST(Renderer, WKeepsWindowPositionsAndBendsColours) {
    Scene scene = flat_scene();
    const Rgba white{255, 255, 255, 255};
    scene.objects.push_back(
        {RawVertices{
             Space::window,
             Topology::quads,
             {corner(0.0F, 0.0F, 0.5F, kBlack, 1.0F), corner(32.0F, 0.0F, 0.5F, white, 3.0F),
              corner(32.0F, 4.0F, 0.5F, white, 3.0F), corner(0.0F, 4.0F, 0.5F, kBlack, 1.0F)}},
         vertex_color(),
         glm::mat4(1.0F),
         {.depth_test = DepthTest::always}});
    Framebuffer frame(32, 4);
    Renderer().render(scene, frame);
    for (int x = 0; x < 32; ++x) {
        // Half way across, w = 1 / (1/2 + 1/6) and the colour is (1/6) w = 1/4.
        const double t = (x + 0.5) / 32.0, value = (t / 3.0) / ((1.0 - t) + t / 3.0);
        EXPECT_NEAR(pixel(frame, x, 2)[0], 255.0 * value, 0.51) << x;
    }
}

TEST(Renderer, DepthTestsAndWrites) {
    const std::array<DepthTest, 8> tests{DepthTest::never,  DepthTest::less,    DepthTest::equal,
                                         DepthTest::lequal, DepthTest::greater, DepthTest::notequal,
                                         DepthTest::gequal, DepthTest::always};
    for (std::size_t i = 0; i < tests.size(); ++i) {
        for (const float z : {0.25F, 0.5F, 0.75F}) {
            for (const bool write : {false, true}) {
                Scene scene = flat_scene();
                scene.objects.push_back(rectangle(0.0F, 0.0F, 8.0F, 8.0F, 0.5F, kRed));
                scene.objects.push_back(rectangle(0.0F, 0.0F, 8.0F, 8.0F, z, kGreen,
                                                  {.depth_test = tests[i], .depth_write = write}));
                // What the second left behind: passes where the depth is still 0.5.
                scene.objects.push_back(rectangle(0.0F, 0.0F, 8.0F, 4.0F, 0.5F, kBlack,
                                                  {.depth_test = DepthTest::equal}));
                Framebuffer frame(8, 8);
                Renderer().render(scene, frame);
                const bool passes =
                    i == 7 || (i & 1 && z < 0.5F) || (i & 2 && z == 0.5F) || (i & 4 && z > 0.5F);
                ASSERT_EQ(pixel(frame, 3, 6), passes ? kGreen : kRed)
                    << "test " << i << ", z " << z;
                const bool kept = !passes || !write || z == 0.5F;
                ASSERT_EQ(pixel(frame, 3, 1), kept ? kBlack : kGreen)
                    << "test " << i << ", z " << z;
            }
        }
    }
}

TEST(Renderer, EqualDepthsKeepTheFirstAndLequalTheLast) {
    for (const bool last : {false, true}) {
        Scene scene = flat_scene();
        const RasterState state{.depth_test = last ? DepthTest::lequal : DepthTest::less};
        scene.objects.push_back(rectangle(0.0F, 0.0F, 70.0F, 70.0F, 0.5F, kRed, state));
        scene.objects.push_back(rectangle(0.0F, 0.0F, 70.0F, 70.0F, 0.5F, kGreen, state));
        Framebuffer frame(70, 70);
        Renderer({.memory_cap = 1}).render(scene, frame);
        EXPECT_EQ(pixel(frame, 66, 66), last ? kGreen : kRed);
    }
}

TEST(Renderer, CullsBySeenWinding) {
    for (const Cull cull : {Cull::none, Cull::back, Cull::front}) {
        for (const bool clockwise : {false, true}) {
            Scene scene = flat_scene();
            const RasterState state{.depth_test = DepthTest::always, .cull = cull};
            Object object = clockwise ? rectangle(0.0F, 0.0F, 8.0F, 8.0F, 0.5F, kRed, state)
                                      : rectangle(0.0F, 8.0F, 8.0F, 0.0F, 0.5F, kRed, state);
            scene.objects.push_back(object);
            Framebuffer frame(8, 8);
            Renderer().render(scene, frame);
            // Counter-clockwise is the front.
            const bool drawn = cull == Cull::none || (cull == Cull::back) == !clockwise;
            EXPECT_EQ(pixel(frame, 4, 4), drawn ? kRed : kBlack);
        }
    }
}

TEST(Renderer, MeshesHaveNoVertexColoursWhateverWasDrawnBefore) {
    Scene scene = flat_scene();
    scene.lights.push_back({});
    const auto lit = vertex_color();
    lit->program->col0_rgb = ColorInput::half_tangent;
    lit->program->col0_a = ColorInput::n_dot_l;
    scene.objects.push_back({Mesh(shapes::cube()), lit, glm::mat4(1.0F), {}});
    Renderer renderer;
    Framebuffer before(32, 32), after(32, 32);
    renderer.render(scene, before);
    EXPECT_NE(pixel(before, 16, 16), (Rgba{0, 0, 0, 0}));
    scene.objects.front().material = vertex_color();
    renderer.render(scene, after);
    EXPECT_EQ(pixel(after, 16, 16), (Rgba{0, 0, 0, 0}));
}

TEST(Renderer, DrawsIntoMemoryOfTheCaller) {
    Scene scene = flat_scene();
    scene.objects.push_back(rectangle(0.0F, 0.0F, 200.0F, 200.0F, 0.5F, kRed));
    constexpr int kWidth = 70, kHeight = 67, kPitch = 4 * kWidth + 20;
    std::vector<std::uint8_t> memory(static_cast<std::size_t>(kPitch) * kHeight + 64, 0xa5);
    Framebuffer frame(memory.data(), kPitch, kWidth, kHeight);
    Renderer({.threads = 2}).render(scene, frame);
    for (std::size_t i = 0; i < memory.size(); ++i) {
        const std::size_t x = i % kPitch, y = i / kPitch;
        const std::uint8_t want = x < 4 * kWidth && y < kHeight ? kRed[x % 4] : 0xa5;
        ASSERT_EQ(memory[i], want) << "byte " << x << " of row " << y;
    }
}

TEST(Renderer, FillsFramesOfAnySize) {
    Scene scene = flat_scene();
    scene.background = {1.0F, 0.5F, 0.25F, 0.125F};
    for (const auto& [width, height] : {std::pair{1, 1}, {63, 65}, {8191, 3}, {64, 64}, {3, 300}}) {
        Framebuffer frame(width, height);
        Renderer().render(scene, frame);
        const Rgba want{255, 128, 64, 32};
        EXPECT_EQ(pixel(frame, 0, 0), want);
        EXPECT_EQ(pixel(frame, width - 1, height - 1), want);
    }
}

TEST(Renderer, CountsWhatItDrops) {
    MeshData data = shapes::sphere(16, 8);
    const std::size_t whole = data.indices.size() / 3;
    data.indices.insert(data.indices.end(), {5, 5, 9});  // no area
    data.positions[40].y = std::numeric_limits<float>::quiet_NaN();
    data.positions[41].x = std::numeric_limits<float>::infinity();
    std::size_t touched = 0;
    for (std::size_t i = 0; i < data.indices.size(); i += 3) {
        bool bad = false;
        for (std::size_t k = 0; k < 3; ++k)
            bad |= data.indices[i + k] == 40 || data.indices[i + k] == 41;
        touched += bad ? 1 : 0;
    }
    Scene scene = flat_scene("ideal");
    scene.lights.push_back({});
    scene.objects.push_back({Mesh(data), nullptr, glm::mat4(1.0F), {}});
    FrameStats first;
    for (const IsaInfo& isa : instruction_sets()) {
        if (!isa.available) continue;
        for (const int threads : {1, 3}) {
            Framebuffer frame(64, 64);
            const FrameStats stats =
                Renderer({.threads = threads, .isa = std::string(isa.name)}).render(scene, frame);
            EXPECT_EQ(stats.triangles, whole + 1);
            EXPECT_EQ(stats.nonfinite_triangles, touched);
            EXPECT_GE(stats.degenerate_triangles, 1U);
            if (first.triangles == 0) first = stats;
            EXPECT_EQ(stats.degenerate_triangles, first.degenerate_triangles);
            EXPECT_EQ(stats.binned_triangles, first.binned_triangles);
            EXPECT_EQ(stats.shaded_pixels, first.shaded_pixels);
        }
    }
    EXPECT_GT(touched, 4U);
}

TEST(Renderer, RefusesInOneLine) {
    const auto render = [](const Scene& scene) {
        return [&scene] {
            Framebuffer frame(8, 8);
            Renderer().render(scene, frame);
        };
    };
    EXPECT_EQ(message_of([] { Renderer({.isa = "mmx"}); }, ErrorCode::bad_option).substr(0, 30),
              "isa: 'mmx' cannot run here, ex");
    EXPECT_EQ(message_of([] { Renderer({.threads = -1}); }, ErrorCode::bad_option),
              "threads: -1 found, expected 0 .. 1024");
    EXPECT_EQ(message_of([] { Framebuffer(0, 8); }, ErrorCode::bad_option),
              "frame size 0x8, expected 1 .. 16384 both ways");

    Scene lights = flat_scene();
    lights.lights.resize(9);
    lights.objects.push_back({Mesh(shapes::cube()), nullptr, glm::mat4(1.0F), {}});
    EXPECT_EQ(message_of(render(lights), ErrorCode::bad_option), "9 lights, expected at most 8");

    Scene units = flat_scene("geforce256");
    auto many = vertex_color();
    many->program->units.resize(3);
    units.objects.push_back({Mesh(shapes::cube()), many, glm::mat4(1.0F), {}});
    EXPECT_EQ(message_of(render(units), ErrorCode::bad_program),
              "3 texture units, machine 'geforce256' has 2");

    Scene camera = flat_scene();
    camera.camera.focal_point = camera.camera.position;
    EXPECT_EQ(message_of(render(camera), ErrorCode::bad_option),
              "camera: focal_point - position has no direction");

    // Two scales by 4 reach 1/8.
    Scene narrow = flat_scene("geforce256");
    narrow.lights.push_back({});
    auto material = std::make_shared<Material>();
    material->alpha_x = 0.01F;
    narrow.objects.push_back({Mesh(shapes::cube()), material, glm::mat4(1.0F), {}});
    EXPECT_EQ(
        message_of(render(narrow), ErrorCode::bad_program),
        "abp_modified on 'geforce256': needs 6 general stages, the machine has 2; in 3 passes "
        "it fits (multipass)");

    Scene raw = flat_scene();
    raw.objects.push_back({RawVertices{}, nullptr, glm::mat4(1.0F), {}});
    EXPECT_NE(message_of(render(raw), ErrorCode::bad_program).find("raw vertices need a program"),
              std::string::npos);
}

TEST(Renderer, TakesTheInstructionSetFromTheEnvironment) {
    setenv("BURNISH_ISA", "reference", 1);
    EXPECT_EQ(Renderer().isa(), "reference");
    EXPECT_EQ(Renderer({.isa = std::string(instruction_sets().back().name)}).isa(), "reference");
    setenv("BURNISH_ISA", "mmx", 1);
    EXPECT_EQ(message_of([] { Renderer(); }, ErrorCode::bad_option).substr(0, 24),
              "BURNISH_ISA: 'mmx' canno");
    unsetenv("BURNISH_ISA");
}

}  // namespace
}  // namespace burnish
