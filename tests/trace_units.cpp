// Traces of texture units and of fetches between stages: what they end with is the renderer's
// pixel, on every instruction set, and what they list is what units do.
#include <gtest/gtest.h>

#include <burnish/program_text.hpp>
#include <burnish/renderer.hpp>
#include <burnish/trace.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "random_program.hpp"
#include "unit_scene.hpp"

namespace burnish {
namespace {

CombinerProgram combiners_of(const std::string& text) {
    const Parsed<CombinerProgram> parsed = parse_combiners(text);
    EXPECT_TRUE(parsed.program.has_value());
    return parsed.program.value_or(CombinerProgram{});
}

std::array<double, 4> pixel_of(const Framebuffer& frame, int x, int y) {
    const auto* at = reinterpret_cast<const float*>(frame.row(y)) + std::ptrdiff_t{4} * x;
    return {static_cast<double>(at[0]), static_cast<double>(at[1]), static_cast<double>(at[2]),
            static_cast<double>(at[3])};
}

/// Every 7th pixel of a scene; how many show a fragment.
int check_pixels(const Scene& scene, const std::string& what) {
    std::vector<Framebuffer> frames;
    for (const IsaInfo& isa : instruction_sets()) {
        if (!isa.available) continue;
        frames.emplace_back(scene.width, scene.height, scene.format);
        Renderer({.threads = 1, .isa = std::string(isa.name)}).render(scene, frames.back());
    }
    int fragments = 0;
    for (int i = 0; i < scene.width * scene.height; i += 7) {
        const int x = i % scene.width, y = i / scene.width;
        const PixelTrace trace = trace_pixel(scene, x, y);
        for (const Framebuffer& frame : frames)
            EXPECT_EQ(trace.stored, pixel_of(frame, x, y)) << what << " at " << x << "," << y;
        fragments += trace.fragment ? 1 : 0;
    }
    return fragments;
}

// Half of each unit's texel, signs included.
const char* const kAllUnits =
    "!!RC1.0 { rgb { discard = tex0; discard = tex1; spare0 = sum(); scale_by_one_half(); }"
    "alpha { discard = tex0; discard = tex1; spare0 = sum(); scale_by_one_half(); } }"
    "{ rgb { discard = -tex2; discard = tex3; spare1 = sum(); scale_by_one_half(); }"
    "alpha { discard = tex2; discard = -tex3; spare1 = sum(); scale_by_one_half(); } }"
    "out.rgb = spare0 * spare1 + spare0; out.a = spare1;";

TEST(TraceUnits, RandomShadersAreTracedToTheRenderersPixels) {
    for (const char* name : {"nv2a", "ideal"}) {
        const Machine machine = machine_profile(name);
        int fragments = 0;
        for (unsigned seed = 0; seed < 150; ++seed) {
            Random random(seed);
            UnitScene units(random, machine);
            units.use(combiners_of(kAllUnits));
            fragments += check_pixels(units.scene, std::string(name) + " " + std::to_string(seed));
        }
        EXPECT_GT(fragments, 2000);
    }
}

TEST(TraceUnits, FetchesBetweenStagesAreTracedToTheRenderersPixels) {
    Machine machine = machine_profile("ideal");
    machine.texture_units = 4;
    for (unsigned seed = 0; seed < 150; ++seed) {
        Random random(seed);
        UnitScene units(random, machine);
        CombinerProgram program = random_program(random, machine);
        for (GeneralStage& stage : program.stages) {
            for (StageFetch& fetch : random_fetches(random, machine)) {
                const auto unit = static_cast<std::size_t>(fetch.destination) -
                                  static_cast<std::size_t>(Register::tex0);
                const TexturePtr& texture = units.program.units[unit];
                if (texture) fetch.target = table_for(texture->target());
                stage.fetches.push_back(fetch);
            }
        }
        units.use(program);
        check_pixels(units.scene, "seed " + std::to_string(seed));
    }
}

/// A triangle with a mipmapped texture in unit 1, three texels a pixel, read at coordinates that
/// come from the interpolator or, moved by nothing, from an offset.
Scene mipmapped_triangle(const std::string& shader, const std::string& machine) {
    Scene scene;
    scene.width = scene.height = 40;
    scene.machine = machine_profile(machine);
    scene.format = PixelFormat::rgba32f;
    Random random(1);
    ProgramMaterial program;
    program.texture_shader = parse_texture_shader("!!TS1.0 " + shader).program;
    TextureDescription description{.format = TexelFormat::dsdt8};
    program.units.push_back(
        std::make_shared<const Texture>(std::vector<Image8>{Image8(1, 1)}, description));
    Image8 noise(64, 64);
    for (std::uint8_t& byte : noise.rgba) byte = static_cast<std::uint8_t>(random.below(256));
    description.format = TexelFormat::rgba8;
    description.box_mipmaps = true;
    description.sampler.filter = Filter::linear_mipmap_linear;
    program.units.push_back(
        std::make_shared<const Texture>(std::vector<Image8>{noise}, description));
    program.combiners = combiners_of("!!RC1.0 out.rgb = tex1; out.a = tex1;");
    auto material = std::make_shared<Material>();
    material->program = program;
    RawVertices raw{.space = Space::window, .topology = Topology::triangles, .vertices = {}};
    for (const auto& [x, y] : {std::pair{1, 2}, {37, 5}, {11, 39}}) {
        RawVertex v{.position = {x, y, 0.5F, 1.0F}};
        v.uv[1] = {3.0F * static_cast<float>(x) / 64.0F, static_cast<float>(y) / 64.0F, 0.0F, 1.0F};
        raw.vertices.push_back(v);
    }
    scene.objects.push_back({raw, material, glm::mat4(1.0F), {}});
    return scene;
}

// Differences within quads are the derivatives of what is linear, at the triangle's edges too.
TEST(TraceUnits, ComputedCoordinatesTakeTheirLevelOfDetailFromTheQuad) {
    for (const char* machine : {"nv2a", "ideal"}) {
        const Scene plain = mipmapped_triangle("nop(); texture_2d();", machine);
        const Scene moved =
            mipmapped_triangle("texture_2d(); offset_2d(tex0, 1, 0, 0, 1);", machine);
        Framebuffer one(40, 40, PixelFormat::rgba32f), other(40, 40, PixelFormat::rgba32f);
        Renderer renderer;
        renderer.render(plain, one);
        renderer.render(moved, other);
        int different = 0;
        for (int y = 0; y < 40; ++y) {
            for (int x = 0; x < 40; ++x)
                different += pixel_of(one, x, y) != pixel_of(other, x, y) ? 1 : 0;
        }
        EXPECT_EQ(different, 0) << machine;
        EXPECT_GT(check_pixels(moved, machine), 50);
    }
}

/// The trace of the middle of a quad whose units have these textures of one texel each.
TracedFragment traced(const std::string& shader, const std::vector<std::array<int, 4>>& texels,
                      const std::array<glm::vec4, 4>& uv) {
    Scene scene;
    scene.width = scene.height = 4;
    scene.machine = machine_profile("nv2a");
    ProgramMaterial program;
    program.texture_shader = parse_texture_shader(shader).program;
    for (const auto& texel : texels) {
        Image8 image(1, 1);
        for (std::size_t c = 0; c < 4; ++c) image.rgba[c] = static_cast<std::uint8_t>(texel[c]);
        program.units.push_back(std::make_shared<const Texture>(image, Sampler{}));
    }
    program.combiners = combiners_of("!!RC1.0 out.rgb = tex2; out.a = tex1;");
    auto material = std::make_shared<Material>();
    material->program = program;
    RawVertices raw{.space = Space::window, .topology = Topology::quads, .vertices = {}};
    for (const auto& [x, y] : {std::pair{0, 0}, {4, 0}, {4, 4}, {0, 4}})
        raw.vertices.push_back({.position = {x, y, 0.5F, 1.0F}, .uv = uv});
    scene.objects.push_back({raw, material, glm::mat4(1.0F), {}});
    const PixelTrace trace = trace_pixel(scene, 2, 1);
    return trace.fragment.value_or(TracedFragment{});
}

TEST(TraceUnits, ListsWhatUnitsRead) {
    const TracedFragment f = traced(
        "!!TS1.0 texture_2d(); dot_product_2d_1of2(tex0); dot_product_2d_2of2(expand(tex0));",
        {{51, 102, 255, 0}, {0, 0, 0, 0}, {1, 2, 3, 4}},
        {glm::vec4(0, 0, 0, 1), {0.5F, 0.25F, 0.125F, 1}, {1, 1, 1, 1}, {0, 0, 0, 1}});
    ASSERT_EQ(f.units.size(), 4U);
    EXPECT_EQ(f.units[1].text, "dot_product_2d_1of2(tex0)");
    ASSERT_EQ(f.units[1].numbers.size(), 4U);  // r, g, b and the dot product
    EXPECT_EQ(f.units[1].numbers[0].name, "tex0");
    EXPECT_EQ(f.units[1].numbers[1].components, "g");
    EXPECT_FLOAT_EQ(static_cast<float>(f.units[1].numbers[1].numbers[0].value), 0.4F);
    EXPECT_EQ(f.units[1].numbers[3].name, "dot");
    // 0.5 * 0.2 + 0.25 * 0.4 + 0.125 * 1
    EXPECT_NEAR(f.units[1].numbers[3].numbers[0].value, 0.325, 1e-7);
    EXPECT_NEAR(f.units[1].numbers[3].numbers[0].exact, 0.325, 1e-12);
    EXPECT_EQ(f.units[2].numbers[0].name, "expand tex0");
    // -0.6 - 0.2 + 1
    EXPECT_NEAR(f.units[2].numbers[3].numbers[0].value, 0.2, 1e-6);
    EXPECT_EQ(f.units[3].text, "nop()");
    ASSERT_EQ(f.fetches.size(), 2U);
    EXPECT_EQ(f.fetches[1].unit, 2);
    EXPECT_NEAR(f.fetches[1].u.value, 0.325, 1e-7);
}

TEST(TraceUnits, SaysWhyAUnitIsOff) {
    const TracedFragment f = traced("!!TS1.0 texture_2d(); offset_2d(tex0, 1, 0, 0, 1);",
                                    {{1, 2, 3, 4}, {5, 6, 7, 8}}, {});
    EXPECT_EQ(f.units[0].problem, "");
    EXPECT_EQ(f.units[1].problem,
              "offset_2d reads unit 0, whose texels are unsigned colours, expected DSDT");
    EXPECT_TRUE(f.units[1].numbers.empty());
    EXPECT_EQ(f.codes[3], 0);
}

}  // namespace
}  // namespace burnish
