// Several lights: each is drawn by its own program, and their colours add up to 1, code by code.
#include <gtest/gtest.h>

#include <algorithm>
#include <burnish/error.hpp>
#include <burnish/trace.hpp>
#include <cstring>
#include <vector>

#include "tests/scenes.hpp"

namespace burnish {
namespace {

const std::vector<Light>& all_lights() {
    static const std::vector<Light> lights{
        {.position = {-0.4F, 0.8F, 0.9F}, .color = {1.0F, 0.9F, 0.7F}},
        {.position = {1.5F, 0.3F, 1.2F}, .position_w = 1.0F, .color = {0.4F, 0.6F, 1.0F}},
        {.position = {0.2F, -1.0F, 0.6F}, .color = {0.8F, 0.1F, 0.1F}, .intensity = 0.6F},
        {.position = {0.0F, 0.0F, 1.3F}, .position_w = 1.0F, .intensity = 0.7F},
        {.position = {-1.0F, 0.0F, 0.3F}, .color = {0.1F, 0.8F, 0.2F}},
        {.position = {0.0F, 1.0F, 0.0F}, .intensity = 0.3F},
        {.position = {-2.0F, 2.0F, 2.0F}, .position_w = 1.0F, .color = {0.2F, 0.2F, 0.9F}},
        {.position = {1.0F, 1.0F, -0.2F}, .color = {0.9F, 0.5F, 0.1F}, .intensity = 0.5F}};
    return lights;
}

std::shared_ptr<Material> steel() {
    auto material = std::make_shared<Material>();
    material->kd = glm::vec3(0.15F);
    material->ks = glm::vec3(0.7F);
    material->alpha_x = 0.3F;
    material->normal_map = scenes::streaks(32, 16, {128, 128, 240, 255}, 60);
    return material;
}

Scene ball(const Machine& machine, std::vector<Light> lights, std::shared_ptr<Material> material) {
    Scene scene = scenes::lit_scene(machine, 90, 70);
    scene.format = PixelFormat::rgba32f;
    scene.background = glm::vec4(0.0F);
    scene.lights = std::move(lights);
    scene.objects.push_back({Mesh(shapes::sphere(24, 13, {1.3F, 1.0F, 1.0F})),
                             std::move(material),
                             glm::mat4(1.0F),
                             {}});
    return scene;
}

struct Case {
    const char* profile;
    HalfVector half;
};
std::vector<Machine> machines() {
    std::vector<Machine> list;
    for (const Case& c : {Case{"geforce256", HalfVector::vertex}, Case{"nv2a", HalfVector::vertex},
                          Case{"nv2a", HalfVector::pixel}, Case{"ideal", HalfVector::vertex},
                          Case{"ideal", HalfVector::pixel}}) {
        list.push_back(machine_profile(c.profile));
        list.back().half_vector = c.half;
    }
    return list;
}

/// Codes of the frame, which holds what registers held.
std::vector<int> codes(const Scene& scene, const std::string& isa = {}, int threads = 1) {
    const int one = scene.machine.numbers == NumberModel::nine_bit ? 255 : 16384;
    Framebuffer frame(scene.width, scene.height, scene.format);
    Renderer({.threads = threads, .isa = isa}).render(scene, frame);
    std::vector<int> result;
    for (int y = 0; y < frame.height(); ++y) {
        const auto* row = reinterpret_cast<const float*>(frame.row(y));
        for (int i = 0; i < 4 * frame.width(); ++i)
            result.push_back(static_cast<int>(row[i] * static_cast<float>(one) + 0.5F));
    }
    return result;
}

/// Pictures of one light each, the first with the ambient light, added and stopped at 1.
std::vector<int> sum_of_pictures(Scene scene, int& stopped) {
    const int one = scene.machine.numbers == NumberModel::nine_bit ? 255 : 16384;
    const std::vector<Light> lights = scene.lights;
    std::vector<int> sum;
    for (const Light& light : lights) {
        scene.lights = {light};
        const std::vector<int> picture = codes(scene);
        scene.ambient = {};
        if (sum.empty()) {
            sum = picture;
            continue;
        }
        for (std::size_t i = 0; i < sum.size(); ++i) {
            if (i % 4 == 3) continue;  // alpha is the first one's
            stopped += sum[i] + picture[i] > one ? 1 : 0;
            sum[i] = std::min(sum[i] + picture[i], one);
        }
    }
    return sum;
}

TEST(Lights, ArePicturesAddedCodeByCode) {
    int stopped = 0;
    for (const Machine& machine : machines()) {
        for (const std::size_t count : {std::size_t{2}, std::size_t{3}, std::size_t{8}}) {
            const auto first = all_lights().begin();
            const Scene scene =
                ball(machine, {first, first + static_cast<std::ptrdiff_t>(count)}, steel());
            EXPECT_EQ(codes(scene), sum_of_pictures(scene, stopped))
                << machine.name << ", " << count << " lights";
        }
    }
    EXPECT_GT(stopped, 100);
}

TEST(Lights, AreTheSameOnEveryInstructionSetAndThreadCount) {
    for (const Machine& machine : machines()) {
        const Scene scene = ball(machine, all_lights(), steel());
        const std::vector<int> want = codes(scene, "reference");
        for (const IsaInfo& isa : instruction_sets()) {
            if (!isa.available) continue;
            for (const int threads : {1, 2, 3})
                EXPECT_EQ(codes(scene, std::string(isa.name), threads), want)
                    << isa.name << ", " << threads << " threads, " << machine.name;
        }
    }
}

TEST(Lights, ComeInAnyOrder) {
    for (const Machine& machine : machines()) {
        Scene scene = ball(machine, all_lights(), steel());
        scene.ambient = {};  // goes with the first
        const std::vector<int> want = codes(scene);
        std::reverse(scene.lights.begin(), scene.lights.end());
        EXPECT_EQ(codes(scene), want) << machine.name;
        std::rotate(scene.lights.begin(), scene.lights.begin() + 3, scene.lights.end());
        EXPECT_EQ(codes(scene), want) << machine.name;
    }
}

// Every pass of every light runs; the sum meets blending and the alpha test like one colour.
TEST(Lights, PassesBlendingAndAlphaTests) {
    Machine machine = machine_profile("nv2a");
    machine.multipass = true;
    machine.general_stages = 2;
    machine.texture_units = 2;
    auto material = scenes::painted({160, 120, 90, 200});
    material->program->combiners.final_combiner.g = {Register::tex0, Mapping::unsigned_identity,
                                                     Component::alpha};
    ProgramMaterial& program = *material->program;
    program.combiners.stages.insert(program.combiners.stages.end(), 3,
                                    program.combiners.stages.front());
    int stopped = 0;
    Scene scene = ball(machine, {all_lights()[0], all_lights()[1]}, material);
    scene.objects[0].raster.cull = Cull::back;  // nothing behind what the test drops
    const std::vector<int> sum = codes(scene);
    EXPECT_EQ(sum, sum_of_pictures(scene, stopped));
    material->alpha_test = {Comparison::greater, 0.8F};
    const std::vector<int> tested = codes(scene);
    int dropped = 0;
    for (std::size_t i = 0; i < sum.size(); i += 4) {
        const bool lives = sum[i + 3] > 204;
        dropped += lives ? 0 : 1;
        for (std::size_t c = 0; c < 4; ++c) ASSERT_EQ(tested[i + c], lives ? sum[i + c] : 0);
    }
    EXPECT_GT(dropped, 100);
    material->alpha_test = {};
    scene.objects[0].raster.blend = Blend::add();
    EXPECT_EQ(codes(scene), sum);  // onto black
}

// A program that no light enters is not brighter for two of them.
TEST(Lights, DoNotMultiplyWhatTheyDoNotReach) {
    using namespace combine;
    ProgramBuilder p;
    p.constants({0.3F, 0.4F, 0.5F, 1.0F}, {});
    const Input zero = raw(Register::zero);
    p.lerp(zero, zero, zero, raw(Register::const0));
    p.out_alpha(alpha(one()));
    auto material = std::make_shared<Material>();
    material->program.emplace();
    material->program->combiners = p.build();
    material->program->col0_rgb = ColorInput::half_tangent;  // read by nothing
    const Machine machine = machine_profile("ideal");
    EXPECT_EQ(codes(ball(machine, all_lights(), material)),
              codes(ball(machine, {all_lights()[0]}, material)));
}

TEST(Lights, TracesAreThePictureAndShowEveryLight) {
    for (const Machine& machine : machines()) {
        const Scene scene = ball(machine, all_lights(), steel());
        const int one = machine.numbers == NumberModel::nine_bit ? 255 : 16384;
        const std::vector<int> picture = codes(scene);
        for (int y = 0; y < scene.height; y += 9) {
            for (int x = 0; x < scene.width; x += 7) {
                const PixelTrace trace = trace_pixel(scene, x, y);
                if (!trace.fragment) continue;
                const TracedFragment& f = *trace.fragment;
                const auto at = static_cast<std::size_t>(4 * (y * scene.width + x));
                ASSERT_TRUE(std::equal(f.codes.begin(), f.codes.end(),
                                       picture.begin() + static_cast<int>(at)))
                    << machine.name << " at " << x << "," << y;
                ASSERT_EQ(f.further_lights.size(), 7U);
                for (std::size_t c = 0; c < 3; ++c) {
                    int sum = f.light_codes[c];
                    for (const TracedFragment& light : f.further_lights) {
                        ASSERT_EQ(light.codes, light.light_codes);
                        sum += light.codes[c];
                    }
                    ASSERT_EQ(f.codes[c], std::min(sum, one));
                }
                if (machine.numbers == NumberModel::nine_bit) continue;
                for (const TracedNumber& n : f.color) ASSERT_NEAR(n.error(), 0.0, 8 * 2.0 / 255.0);
            }
        }
    }
}

TEST(Lights, RegistersAreThoseOfTheFirst) {
    const Machine machine = machine_profile("nv2a");
    Scene scene = ball(machine, all_lights(), steel());
    Framebuffer all(scene.width, scene.height, PixelFormat::rgba32f);
    Framebuffer one(scene.width, scene.height, PixelFormat::rgba32f);
    Renderer renderer;
    renderer.render(scene, all, ShownRegister{Register::spare0});
    scene.lights.resize(1);
    renderer.render(scene, one, ShownRegister{Register::spare0});
    for (int y = 0; y < scene.height; ++y)
        ASSERT_EQ(std::memcmp(all.row(y), one.row(y), static_cast<std::size_t>(scene.width) * 16),
                  0);
}

TEST(Lights, AreEightAtMost) {
    Scene scene = ball(machine_profile("ideal"), all_lights(), steel());
    scene.lights.push_back({});
    Framebuffer frame(8, 8);
    try {
        Renderer().render(scene, frame);
        FAIL() << "no error";
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::bad_option);
        EXPECT_STREQ(error.what(), "9 lights, expected at most 8");
    }
}

}  // namespace
}  // namespace burnish
