// What light hands to programs of meshes: vectors as colours and as coded coordinates, the half
// vector scaled, cosines.
#include <gtest/gtest.h>

#include <algorithm>
#include <burnish/trace.hpp>
#include <cmath>
#include <cstring>
#include <vector>

#include "tests/scenes.hpp"

namespace burnish {
namespace {

/// Colour 0 as it comes, or unit 0's coordinates passed through.
ProgramMaterial shows(Register reg) {
    using namespace combine;
    ProgramBuilder p;
    const Input zero = raw(Register::zero);
    p.lerp(zero, zero, zero, raw(reg));
    p.out_alpha(alpha(one()));
    ProgramMaterial material;
    material.combiners = p.build();
    if (reg == Register::col0) return material;
    material.units = {nullptr};
    material.texture_shader.emplace();
    material.texture_shader->units[0].operation = TextureOperation::pass_through;
    return material;
}

Scene ball(const Machine& machine, const ProgramMaterial& program) {
    Scene scene = scenes::lit_scene(machine, 40, 30);
    scene.format = PixelFormat::rgba32f;
    scene.background = glm::vec4(0.0F);
    auto material = std::make_shared<Material>();
    material->program = program;
    scene.objects.push_back({Mesh(shapes::sphere(16, 9)), material, glm::mat4(1.0F), {}});
    return scene;
}

std::vector<float> picture(const Scene& scene) {
    Framebuffer frame(scene.width, scene.height, scene.format);
    Renderer({.threads = 1}).render(scene, frame);
    std::vector<float> pixels;
    for (int y = 0; y < frame.height(); ++y) {
        const auto* row = reinterpret_cast<const float*>(frame.row(y));
        pixels.insert(pixels.end(), row, row + std::ptrdiff_t{4} * frame.width());
    }
    return pixels;
}

std::vector<Machine> machines() {
    std::vector<Machine> list;
    for (const char* profile : {"nv2a", "ideal"}) {
        for (const HalfVector half : {HalfVector::vertex, HalfVector::pixel}) {
            list.push_back(machine_profile(profile));
            list.back().half_vector = half;
        }
    }
    return list;
}

struct Pair {
    ColorInput color;
    CoordinateInput coordinate;
};
constexpr Pair kPairs[] = {{ColorInput::half_tangent, CoordinateInput::half_coded},
                           {ColorInput::light_tangent, CoordinateInput::light_coded},
                           {ColorInput::view_tangent, CoordinateInput::view_coded}};

// Passed through, a coded coordinate is the colour: the same number meets the same rounding.
TEST(LightingInputs, ACodedCoordinateIsTheColour) {
    for (const Machine& machine : machines()) {
        for (const Pair& pair : kPairs) {
            ProgramMaterial color = shows(Register::col0), unit = shows(Register::tex0);
            color.col0_rgb = pair.color;
            unit.uv[0] = pair.coordinate;
            color.half_scale = unit.half_scale = {3.0F, 0.5F, 1.0F};
            EXPECT_EQ(picture(ball(machine, color)), picture(ball(machine, unit)))
                << machine.name << ", input " << static_cast<int>(pair.color);
        }
    }
}

// c = x/2 + 1/2, so the code of s x is that of 1/2 + s (c - 1/2): here with c from another picture,
// half a code off, hence by s halves more.
TEST(LightingInputs, TheScaledHalfVectorStopsAtOne) {
    for (const Machine& machine : machines()) {
        const double one = machine.numbers == NumberModel::nine_bit ? 255.0 : 16384.0;
        ProgramMaterial program = shows(Register::col0);
        program.col0_rgb = ColorInput::half_tangent;
        const std::vector<float> plain = picture(ball(machine, program));
        program.half_scale = {4.0F, 2.0F, 0.5F};
        const std::vector<float> scaled = picture(ball(machine, program));
        int stopped = 0, changed = 0;
        for (std::size_t i = 0; i < plain.size(); ++i) {
            const auto c = static_cast<int>(i % 4);
            if (c == 3 || plain[i - i % 4 + 3] == 0.0F) continue;
            const auto s = static_cast<double>(program.half_scale[c]);
            const double want =
                std::clamp(0.5 + s * (static_cast<double>(plain[i]) - 0.5), 0.0, 1.0);
            ASSERT_NEAR(static_cast<double>(scaled[i]), want, (0.5 + 0.5 * s + 0.01) / one);
            stopped += want == 0.0 || want == 1.0 ? 1 : 0;
            ++changed;
        }
        EXPECT_GT(changed, 500) << machine.name;
        EXPECT_GT(stopped, 50) << machine.name;
    }
}

// The half vector stands half way: light 60 degrees from a distant eye, h.l = cos 30.
TEST(LightingInputs, HDotLIsTheCosineOfHalfTheAngle) {
    for (const Machine& machine : machines()) {
        ProgramMaterial program = shows(Register::col0);
        program.col0_rgb = ColorInput::h_dot_l;
        Scene scene = ball(machine, program);
        scene.objects[0].geometry = Mesh(shapes::plane(2, 2));
        scene.camera.position = {0.0F, 0.0F, 10000.0F};
        scene.camera.view_angle = 0.005F;
        scene.camera.far = 20000.0F;
        scene.lights[0].position = {std::sqrt(3.0F), 0.0F, 1.0F};
        const double one = machine.numbers == NumberModel::nine_bit ? 255.0 : 16384.0;
        const std::vector<float> pixels = picture(scene);
        const std::size_t middle = 4 * (15 * 40 + 20);
        EXPECT_NEAR(static_cast<double>(pixels[middle]), std::sqrt(0.75), 0.6 / one);
        EXPECT_EQ(pixels[middle], pixels[middle + 2]);
    }
}

TEST(LightingInputs, TracesAreThePicture) {
    for (const Machine& machine : machines()) {
        ProgramMaterial program = shows(Register::tex0);
        program.uv[0] = CoordinateInput::half_coded;
        program.half_scale = {2.0F, 1.0F, 3.0F};
        program.col0_a = ColorInput::h_dot_l;
        program.combiners.final_combiner.g = {Register::col0, Mapping::unsigned_identity,
                                              Component::alpha};
        const Scene scene = ball(machine, program);
        const std::vector<float> pixels = picture(scene);
        for (int y = 0; y < scene.height; y += 2) {
            for (int x = 0; x < scene.width; x += 3) {
                const PixelTrace trace = trace_pixel(scene, x, y);
                const auto at = static_cast<std::size_t>(4 * (y * scene.width + x));
                for (std::size_t c = 0; c < 4; ++c)
                    ASSERT_EQ(trace.stored[c], static_cast<double>(pixels[at + c]))
                        << x << "," << y;
                if (!trace.fragment || machine.numbers == NumberModel::nine_bit) continue;
                for (const TracedNumber& n : trace.fragment->color)
                    ASSERT_NEAR(n.error(), 0.0, 0.6 / 16384.0);
            }
        }
    }
}

}  // namespace
}  // namespace burnish
