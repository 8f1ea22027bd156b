// The trace of one pixel against numbers derived by hand from docs/numbers.md.
#include <burnish/trace.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <burnish/error.hpp>
#include <burnish/renderer.hpp>
#include <burnish/shapes.hpp>
#include <cfenv>
#include <cmath>
#include <string>
#include <vector>

#include "tests/vertex_color.hpp"

namespace burnish {
namespace {

using namespace combine;

/// 4 x 4 texels: red differs in the four texels around (0, 2), the others are the same everywhere.
TexturePtr checked_texture() {
    Image8 image(4, 4);
    for (int y = 0; y < 4; ++y) {
        for (int x = 0; x < 4; ++x) {
            std::uint8_t* texel = image.at(x, y);
            texel[1] = 100;
            texel[2] = 255;
            texel[3] = 128;
        }
    }
    image.at(0, 2)[0] = 10;
    image.at(1, 2)[0] = 50;
    image.at(0, 3)[0] = 90;
    image.at(1, 3)[0] = 200;
    return std::make_shared<Texture>(image, Sampler{});
}

/// spare0 = (expand(col0) * tex0, col0.a * tex0.a), then spare0 + col1; E*F = col0 * tex0.
std::shared_ptr<Material> quad_material() {
    ProgramBuilder p;
    p.stage().rgb().ab(mul(expand(Register::col0), in(tex(0))), Register::spare0);
    p.alpha().ab(mul(alpha(in(Register::col0)), alpha(in(tex(0)))), Register::spare0);
    p.product(raw(Register::col0), raw(tex(0)));
    p.lerp(raw(Register::final_product), raw(Register::zero), raw(Register::zero),
           raw(Register::color_sum));
    p.out_alpha(alpha(raw(Register::spare0)));
    auto material = std::make_shared<Material>();
    material->name = "quad";
    material->program.emplace();
    material->program->combiners = p.build();
    material->program->units = {checked_texture()};
    return material;
}

RawVertex window_vertex(float x, float y, float w, glm::vec2 uv) {
    RawVertex v;
    v.position = {x, y, 0.25F, w};
    v.color0 = {0.5F, 0.25F, 1.0F, 51.0F / 256};
    v.color1 = {26.0F / 256, 0.0F, 26.0F / 256, 1.0F};
    v.uv[0] = {uv.x, uv.y, 0.0F, 1.0F};
    return v;
}

/// 8 x 8 pixels, covered by one quad with uv from 0 to 1.
Scene quad_scene(const Machine& machine) {
    Scene scene;
    scene.width = scene.height = 8;
    scene.machine = machine;
    RawVertices quad{Space::window,
                     Topology::quads,
                     {window_vertex(0, 0, 1, {0, 0}), window_vertex(8, 0, 1, {1, 0}),
                      window_vertex(8, 8, 1, {1, 1}), window_vertex(0, 8, 1, {0, 1})}};
    scene.objects.push_back({std::move(quad), quad_material(), glm::mat4(1.0F), {}});
    return scene;
}

TracedFragment fragment_at(const Scene& scene, int x, int y) {
    const PixelTrace trace = trace_pixel(scene, x, y);
    if (!trace.fragment) throw std::runtime_error("the background");
    return *trace.fragment;
}

const TracedRegister& row(const TracedStage& stage, Register reg) {
    for (const TracedRegister& r : stage.registers) {
        if (r.reg == reg) return r;
    }
    throw std::runtime_error(stage.name + " has no " + std::string(register_name(reg)));
}

std::vector<std::string> names(const TracedStage& stage) {
    std::vector<std::string> list;
    for (const TracedRegister& r : stage.registers) list.emplace_back(register_name(r.reg));
    return list;
}

using Four = std::array<int, 4>;

void expect_numbers(const std::array<TracedNumber, 4>& got, const std::array<double, 4>& value,
                    const std::array<double, 4>& exact) {
    for (std::size_t c = 0; c < 4; ++c) {
        EXPECT_NEAR(got[c].value, value[c], 1e-12) << "component " << c;
        EXPECT_NEAR(got[c].exact, exact[c], 1e-7) << "component " << c;  // colours are floats
        EXPECT_EQ(got[c].error(), got[c].value - got[c].exact);
    }
}

// The centre of pixel (2, 5) is (2.5, 5.5) of 8: below the diagonal, so in the triangle of corners
// 0, 2, 3, with x = 8 b and y = 8 b + 8 c.
TEST(Trace, PlaceInTheTriangle) {
    const TracedFragment f = fragment_at(quad_scene(machine_profile("nv2a")), 2, 5);
    EXPECT_EQ(f.object, 0U);
    EXPECT_EQ(f.material, "quad");
    EXPECT_EQ(f.triangle, 1U);
    EXPECT_FALSE(f.clipped);
    EXPECT_EQ(f.vertices, (std::array<std::uint32_t, 3>{0, 2, 3}));
    EXPECT_NEAR(f.barycentrics[1], 2.5 / 8, 1e-15);
    EXPECT_NEAR(f.barycentrics[2], 3.0 / 8, 1e-15);
    EXPECT_NEAR(f.barycentrics[0], 2.5 / 8, 1e-15);
    EXPECT_EQ(f.depth, 0.25);
    EXPECT_EQ(f.one_over_w.value, 1.0);
    EXPECT_NEAR(f.one_over_w.exact, 1.0, 1e-15);
}

// u = 2.5/8 of 4 texels: 1.25 - 0.5 = 0 + 192/256; v = 5.5/8: 2.75 - 0.5 = 2 + 64/256.
TEST(Trace, TapsAndWeights) {
    const TracedFragment f = fragment_at(quad_scene(machine_profile("nv2a")), 2, 5);
    ASSERT_EQ(f.fetches.size(), 1U);
    const TracedFetch& fetch = f.fetches[0];
    EXPECT_EQ(fetch.unit, 0);
    EXPECT_EQ(fetch.width, 4);
    EXPECT_EQ(fetch.height, 4);
    EXPECT_EQ(fetch.u.value, 2.5 / 8);
    EXPECT_EQ(fetch.v.value, 5.5 / 8);
    EXPECT_EQ((Four{fetch.x0, fetch.y0, fetch.x1, fetch.y1}), (Four{0, 2, 1, 3}));
    EXPECT_EQ(fetch.weight_x, 192);
    EXPECT_EQ(fetch.weight_y, 64);
    using Texel = std::array<std::uint16_t, 4>;
    EXPECT_EQ(fetch.taps[0], (Texel{10, 100, 255, 128}));
    EXPECT_EQ(fetch.taps[1], (Texel{50, 100, 255, 128}));
    EXPECT_EQ(fetch.taps[2], (Texel{90, 100, 255, 128}));
    EXPECT_EQ(fetch.taps[3], (Texel{200, 100, 255, 128}));
    // (64*10 + 192*50 + 128) >> 8 = 40, (64*90 + 192*200 + 128) >> 8 = 173,
    // (192*40 + 64*173 + 128) >> 8 = 73; exactly 40, 172.5, 73.125.
    EXPECT_EQ(fetch.codes, (Four{73, 100, 255, 128}));
    expect_numbers(fetch.color, {73 / 255.0, 100 / 255.0, 1.0, 128 / 255.0},
                   {73.125 / 255, 100 / 255.0, 1.0, 128 / 255.0});
}

// The wide filter keeps 16 bits: v = 73.125 * 256 = 18720, x = 18720 + 73, (x + 2) >> 2 = 4698.
TEST(Trace, WideTexels) {
    const TracedFragment f = fragment_at(quad_scene(machine_profile("ideal")), 2, 5);
    EXPECT_EQ(f.fetches.at(0).codes[0], 4698);
    EXPECT_NEAR(f.fetches[0].color[0].error() * 16384, 4698 - 73.125 / 255 * 16384, 1e-9);
}

// The last column and row have the first ones beside them, or themselves.
TEST(Trace, NeighboursWrapOrStay) {
    Scene scene = quad_scene(machine_profile("nv2a"));
    const TracedFetch wrapped = fragment_at(scene, 7, 7).fetches.at(0);  // 3.75 - 0.5
    EXPECT_EQ((Four{wrapped.x0, wrapped.y0, wrapped.x1, wrapped.y1}), (Four{3, 3, 0, 0}));
    Image8 image(4, 4);
    image.at(3, 3)[0] = 77;
    auto material = std::make_shared<Material>(*scene.objects[0].material);
    material->program->units = {std::make_shared<Texture>(
        image, Sampler{Filter::linear, Wrap::clamp_to_edge, Wrap::clamp_to_edge})};
    scene.objects[0].material = material;
    const TracedFetch kept = fragment_at(scene, 7, 7).fetches.at(0);
    EXPECT_EQ((Four{kept.x0, kept.y0, kept.x1, kept.y1}), (Four{3, 3, 3, 3}));
    for (const auto& tap : kept.taps) EXPECT_EQ(tap[0], 77);
    EXPECT_NEAR(kept.color[0].exact, 77 / 255.0, 1e-12);
}

// col0 = (128, 64, 255, 51), of floor(255 x + 1/2); col1 = (26, 0, 26); tex0 from above.
TEST(Trace, EveryRegisterOfEveryStage) {
    const TracedFragment f = fragment_at(quad_scene(machine_profile("nv2a")), 2, 5);
    ASSERT_EQ(f.stages.size(), 3U);
    const std::vector<std::string> rows{"const0", "const1", "col0",  "col1",
                                        "tex0",   "spare0", "spare1"};
    const TracedStage &inputs = f.stages[0], &stage = f.stages[1], &last = f.stages[2];
    EXPECT_EQ(inputs.name, "inputs");
    EXPECT_EQ(stage.name, "stage 0");
    EXPECT_EQ(last.name, "final");
    EXPECT_EQ(inputs.text, "");
    EXPECT_NE(stage.text.find("spare0 = expand(col0) * tex0;\n"), std::string::npos) << stage.text;
    EXPECT_NE(stage.text.find("alpha {\n"), std::string::npos) << stage.text;
    EXPECT_NE(last.text.find("final_product = col0 * tex0;\n"), std::string::npos) << last.text;
    EXPECT_EQ(names(inputs), rows);
    EXPECT_EQ(names(stage), rows);

    EXPECT_EQ(row(inputs, Register::const0).codes, (Four{0, 0, 0, 0}));
    EXPECT_EQ(row(inputs, Register::const1).codes, (Four{0, 0, 0, 0}));
    EXPECT_EQ(row(inputs, Register::col0).codes, (Four{128, 64, 255, 51}));
    EXPECT_EQ(row(inputs, Register::tex0).codes, (Four{73, 100, 255, 128}));
    EXPECT_EQ(row(inputs, Register::spare0).codes, (Four{0, 0, 0, 128})) << "alpha of tex0";
    EXPECT_EQ(row(inputs, Register::spare1).codes, (Four{0, 0, 0, 0}));
    EXPECT_EQ(row(inputs, Register::col1).codes, (Four{26, 0, 26, 0}));
    const std::array<bool, 4> all{true, true, true, true}, none{}, rgb{true, true, true, false};
    EXPECT_EQ(row(inputs, Register::col1).filled, rgb) << "nothing reads its alpha";
    for (const TracedRegister& r : inputs.registers) {
        EXPECT_EQ(r.changed, none);
        if (r.reg == Register::col1) continue;
        EXPECT_EQ(r.filled, all);
    }
    expect_numbers(row(inputs, Register::col0).color, {128 / 255.0, 64 / 255.0, 1.0, 51 / 255.0},
                   {0.5, 0.25, 1.0, 51.0 / 256});

    // 0 * 73, -128 * 100, 254 * 255 and 51 * 128 over 255: 0, -50.2, 254, 25.6.
    EXPECT_EQ(row(stage, Register::spare0).codes, (Four{0, -50, 254, 26}));
    EXPECT_EQ(row(stage, Register::spare0).changed, all);
    expect_numbers(row(stage, Register::spare0).color, {0.0, -50 / 255.0, 254 / 255.0, 26 / 255.0},
                   {0.0, -0.5 * 100 / 255, 1.0, 51.0 / 256 * 128 / 255});
    for (const TracedRegister& r : stage.registers) {
        if (r.reg == Register::spare0) continue;
        EXPECT_EQ(r.codes, row(inputs, r.reg).codes) << register_name(r.reg);
        EXPECT_EQ(r.changed, none) << register_name(r.reg);
    }
}

// sum = (0 + 26, 0 + 0, 254 + 26); E*F = 128*73/255 = 36.6, 64*100/255 = 25.1, 255.
TEST(Trace, FinalCombinerAndFrame) {
    const Scene scene = quad_scene(machine_profile("nv2a"));
    const PixelTrace trace = trace_pixel(scene, 2, 5);
    ASSERT_TRUE(trace.fragment);
    const TracedStage& last = trace.fragment->stages.back();
    EXPECT_EQ(names(last),
              (std::vector<std::string>{"const0", "const1", "col0", "col1", "tex0", "spare0",
                                        "spare1", "color_sum", "final_product"}));
    EXPECT_EQ(row(last, Register::color_sum).codes, (Four{26, 0, 280, 0}));
    expect_numbers(row(last, Register::color_sum).color, {26 / 255.0, 0.0, 280 / 255.0, 0.0},
                   {26.0 / 256, 0.0, 1.0 + 26.0 / 256, 0.0});
    EXPECT_EQ(row(last, Register::final_product).codes, (Four{37, 25, 255, 0}));
    expect_numbers(row(last, Register::final_product).color, {37 / 255.0, 25 / 255.0, 1.0, 0.0},
                   {0.5 * 73.125 / 255, 0.25 * 100 / 255, 1.0, 0.0});
    EXPECT_EQ(trace.fragment->codes, (Four{26, 0, 255, 26}));
    expect_numbers(trace.fragment->color, {26 / 255.0, 0.0, 1.0, 26 / 255.0},
                   {26.0 / 256, 0.0, 1.0, 51.0 / 256 * 128 / 255});
    EXPECT_EQ(trace.one, 255);
    EXPECT_EQ(trace.machine.name, "nv2a");
    EXPECT_EQ(trace.stored, (std::array<double, 4>{26, 0, 255, 26}));
}

TEST(Trace, StoredInEveryFormat) {
    Scene scene = quad_scene(machine_profile("nv2a"));
    scene.format = PixelFormat::rgba16;
    EXPECT_EQ(trace_pixel(scene, 2, 5).stored[0], 26.0 * 257);
    scene.format = PixelFormat::rgba32f;
    EXPECT_EQ(trace_pixel(scene, 2, 5).stored[0], static_cast<double>(26.0F / 255.0F));
}

// Corners at w = 1, 2, 4. Pixel (8, 4) of a triangle (0,0) (34,0) (0,18): its centre (8.5, 4.5) has
// areas 1/2, 1/4, 1/4, over w 1/2, 1/8, 1/16: 8/11, 2/11, 1/11 of 11/16.
TEST(Trace, BarycentricsAreThoseOfPerspective) {
    Scene scene;
    scene.width = scene.height = 32;
    RawVertices triangle{Space::window,
                         Topology::triangles,
                         {window_vertex(0, 0, 1, {0, 0}), window_vertex(34, 0, 2, {1, 0}),
                          window_vertex(0, 18, 4, {0, 1})}};
    triangle.vertices[1].color0 = {1.0F, 0.0F, 0.0F, 1.0F};
    scene.objects.push_back({std::move(triangle), vertex_color(), glm::mat4(1.0F), {}});
    const TracedFragment f = fragment_at(scene, 8, 4);
    EXPECT_EQ(f.vertices, (std::array<std::uint32_t, 3>{0, 1, 2}));
    EXPECT_NEAR(f.barycentrics[0], 8.0 / 11, 1e-14);
    EXPECT_NEAR(f.barycentrics[1], 2.0 / 11, 1e-14);
    EXPECT_NEAR(f.barycentrics[2], 1.0 / 11, 1e-14);
    EXPECT_NEAR(f.one_over_w.exact, 11.0 / 16, 1e-14);
    EXPECT_NEAR(f.one_over_w.value, 11.0 / 16, 1e-7);
    ASSERT_EQ(f.interpolants.size(), 1U);
    EXPECT_EQ(f.interpolants[0].name, "color0");
    EXPECT_EQ(f.interpolants[0].components, "rgba");
    EXPECT_NEAR(f.interpolants[0].numbers[0].exact, 0.5 * 9 / 11 + 1.0 * 2 / 11, 1e-14);
    EXPECT_NEAR(f.interpolants[0].numbers[0].error(), 0.0, 1e-7);
}

// Setup turns a triangle that winds the other way; the trace names corners as they were submitted.
TEST(Trace, WeightsBelongToTheirCornersHoweverTheyWind) {
    Scene scene;
    scene.width = scene.height = 32;
    const glm::vec2 at[3] = {{0.0F, 0.0F}, {0.0F, 18.0F}, {34.0F, 0.0F}};
    for (const bool turned : {false, true}) {
        RawVertices triangle{Space::window, Topology::triangles, {}};
        const std::size_t order[3] = {0, turned ? 2U : 1U, turned ? 1U : 2U};
        for (const std::size_t i : order)
            triangle.vertices.push_back(window_vertex(at[i].x, at[i].y, 1.0F, {0, 0}));
        scene.objects = {{triangle, vertex_color(), glm::mat4(1.0F), {}}};
        const TracedFragment f = fragment_at(scene, 8, 2);
        EXPECT_EQ(f.vertices, (std::array<std::uint32_t, 3>{0, 1, 2}));
        double x = 0.0, y = 0.0;
        for (std::size_t i = 0; i < 3; ++i) {
            x += f.barycentrics[i] * static_cast<double>(triangle.vertices[i].position.x);
            y += f.barycentrics[i] * static_cast<double>(triangle.vertices[i].position.y);
        }
        EXPECT_NEAR(x, 8.5, 1e-12);
        EXPECT_NEAR(y, 2.5, 1e-12);
    }
}

// q = 2 everywhere: coordinates are halved after interpolation, in both arithmetics.
TEST(Trace, CoordinatesAreDividedByQ) {
    Scene scene = quad_scene(machine_profile("nv2a"));
    for (RawVertex& v : std::get<RawVertices>(scene.objects[0].geometry).vertices)
        v.uv[0] = {2.0F * v.uv[0].s, 2.0F * v.uv[0].t, 0.0F, 2.0F};
    const TracedFragment f = fragment_at(scene, 2, 5);
    const TracedFetch& fetch = f.fetches.at(0);
    EXPECT_EQ(fetch.u.value, 2.5 / 8);
    EXPECT_EQ(fetch.v.value, 5.5 / 8);
    EXPECT_NEAR(fetch.u.exact, 2.5 / 8, 1e-14);
    EXPECT_NEAR(fetch.v.exact, 5.5 / 8, 1e-14);
    EXPECT_EQ(fetch.codes[0], 73);
    EXPECT_NEAR(fetch.color[0].exact, 73.125 / 255, 1e-12);
    const TracedInterpolant& uv = f.interpolants.back();
    EXPECT_EQ(uv.name + "." + uv.components, "uv0.stq");
    EXPECT_NEAR(uv.numbers[2].exact, 2.0, 1e-14);
}

TEST(Trace, DoesNotDependOnTheCallersRounding) {
    const Scene scene = quad_scene(machine_profile("ideal"));
    const TracedFragment plain = fragment_at(scene, 6, 3);
    std::fesetround(FE_UPWARD);
    const TracedFragment upward = fragment_at(scene, 6, 3);
    std::fesetround(FE_TONEAREST);
    ASSERT_EQ(plain.stages.size(), upward.stages.size());
    for (std::size_t s = 0; s < plain.stages.size(); ++s) {
        for (std::size_t r = 0; r < plain.stages[s].registers.size(); ++r) {
            for (std::size_t c = 0; c < 4; ++c) {
                EXPECT_EQ(plain.stages[s].registers[r].color[c].exact,
                          upward.stages[s].registers[r].color[c].exact);
            }
        }
    }
    EXPECT_EQ(plain.codes, upward.codes);
    EXPECT_EQ(plain.barycentrics, upward.barycentrics);
}

// A constant of a stage is marked where it begins and where it ends.
TEST(Trace, ConstantsOfAStageAreMarked) {
    Scene scene = quad_scene(machine_profile("nv2a"));
    auto material = std::make_shared<Material>(*scene.objects[0].material);
    CombinerProgram& program = material->program->combiners;
    program.stages.push_back(program.stages[0]);
    program.stages.push_back(program.stages[0]);
    program.stages[1].const0 = {0.0F, 1.0F, 0.0F, 0.0F};
    scene.objects[0].material = material;
    const TracedFragment f = fragment_at(scene, 2, 5);
    const std::array<bool, 4> none{}, green{false, true, false, false};
    const std::array<bool, 4> want[5] = {none, none, green, green, none};
    for (std::size_t s = 0; s < 5; ++s) {
        EXPECT_EQ(row(f.stages[s], Register::const0).changed, want[s]) << f.stages[s].name;
    }
}

// What a stage writes is there to see even if nothing reads it, with the inputs that it needs.
TEST(Trace, ShowsResultsThatNothingReads) {
    Scene scene = quad_scene(machine_profile("nv2a"));
    auto material = std::make_shared<Material>(*scene.objects[0].material);
    ProgramBuilder p;
    p.stage().rgb().cd(mul(in(tex(0)), in(Register::col1)), Register::spare1);
    material->program->combiners = p.build();
    scene.objects[0].material = material;
    const TracedFragment f = fragment_at(scene, 2, 5);
    // (73, 100, 255) * (26, 0, 26) / 255
    EXPECT_EQ(row(f.stages[1], Register::spare1).codes, (Four{7, 0, 26, 0}));
    EXPECT_EQ(f.codes, (Four{0, 0, 0, 0}));
}

// spare0 = (0, -50, 254) as above, and its blue goes to the alpha that the quad's program wrote.
TEST(Trace, BlueThatGoesToAlphaIsMarked) {
    Scene scene = quad_scene(machine_profile("nv2a"));
    auto material = std::make_shared<Material>(*scene.objects[0].material);
    GeneralStage& stage = material->program->combiners.stages[0];
    stage.alpha = {};
    stage.rgb.ab_blue_to_alpha = true;
    scene.objects[0].material = material;
    const TracedFragment f = fragment_at(scene, 2, 5);
    const TracedRegister& spare0 = row(f.stages[1], Register::spare0);
    EXPECT_EQ(spare0.codes, (Four{0, -50, 254, 254}));
    EXPECT_EQ(spare0.changed, (std::array<bool, 4>{true, true, true, true}));
    EXPECT_NEAR(spare0.color[3].exact, 1.0, 1e-12);
    EXPECT_NE(f.stages[1].text.find("// the blue of AB goes to alpha"), std::string::npos);
}

TEST(Trace, Background) {
    Scene scene = quad_scene(machine_profile("nv2a"));
    scene.width = 12;
    scene.background = {0.2F, 0.4F, 0.6F, 1.0F};
    const PixelTrace trace = trace_pixel(scene, 9, 3);
    EXPECT_FALSE(trace.fragment);
    EXPECT_EQ(trace.stored, (std::array<double, 4>{51, 102, 153, 255}));
}

TEST(Trace, PixelsOutsideTheFrameAreErrors) {
    const Scene scene = quad_scene(machine_profile("nv2a"));
    for (const auto& [x, y] : {std::pair{-1, 0}, {0, -1}, {8, 0}, {0, 8}}) {
        try {
            trace_pixel(scene, x, y);
            ADD_FAILURE() << x << "," << y;
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), ErrorCode::bad_option);
            EXPECT_NE(std::string(error.what()).find("8x8"), std::string::npos);
        }
    }
}

// The nearest of three quads is the second; the third is behind it, under the same pixel.
TEST(Trace, NamesTheObjectThatIsSeen) {
    Scene scene = quad_scene(machine_profile("nv2a"));
    for (const float z : {0.125F, 0.5F}) {
        Object object = scene.objects[0];
        for (RawVertex& v : std::get<RawVertices>(object.geometry).vertices) v.position.z = z;
        scene.objects.push_back(object);
    }
    const TracedFragment f = fragment_at(scene, 5, 2);
    EXPECT_EQ(f.object, 1U);
    EXPECT_EQ(f.triangle, 0U);
    EXPECT_EQ(f.depth, 0.125);
    scene.objects[2].raster = {.depth_test = DepthTest::greater, .depth_write = false};
    EXPECT_EQ(fragment_at(scene, 5, 2).object, 2U);
    EXPECT_EQ(fragment_at(scene, 5, 2).depth, 0.5) << "its own, not what the depth buffer kept";
}

// Triangle numbers count what was submitted: culled ones before, clipped ones in several pieces.
TEST(Trace, NumbersOfTriangles) {
    Scene scene;
    scene.width = scene.height = 16;
    RawVertices list{Space::clip, Topology::triangles, {}};
    const auto add = [&](glm::vec4 a, glm::vec4 b, glm::vec4 c) {
        for (const glm::vec4& p : {a, b, c}) {
            RawVertex v;
            v.position = p;
            list.vertices.push_back(v);
        }
    };
    add({5, 5, 0, 1}, {6, 5, 0, 1}, {5, 6, 0, 1});            // outside
    add({-1, -1, 0, 1}, {-1, -1, 0, 1}, {1, 1, 0, 1});        // no area
    add({-1, -1, -3, 1}, {1, -1, 0.5F, 1}, {0, 0, 0.5F, 1});  // its near corner is cut off
    add({-1, 1, 0.9F, 1}, {1, 1, 0.9F, 1}, {0, -1, 0.9F, 1});
    scene.objects.push_back({std::move(list), vertex_color(), glm::mat4(1.0F), {}});
    const TracedFragment cut = fragment_at(scene, 9, 10);
    EXPECT_EQ(cut.triangle, 2U);
    EXPECT_TRUE(cut.clipped);
    EXPECT_EQ(cut.vertices, (std::array<std::uint32_t, 3>{6, 7, 8}));
    EXPECT_NEAR(cut.barycentrics[0] + cut.barycentrics[1] + cut.barycentrics[2], 1.0, 1e-15);
    // The corners' own z at the pixel: the plane of depth goes through the vertices before the cut.
    const double z = cut.barycentrics[0] * -3 + (cut.barycentrics[1] + cut.barycentrics[2]) * 0.5;
    EXPECT_NEAR(cut.depth, z * 0.5 + 0.5, 1e-3);  // cut corners are snapped to the vertex grid
    const TracedFragment whole = fragment_at(scene, 8, 1);
    EXPECT_EQ(whole.triangle, 3U);
    EXPECT_FALSE(whole.clipped);
}

double length(const TracedInterpolant& i, bool exact) {
    double sum = 0.0;
    for (const TracedNumber& n : i.numbers) {
        const double x = exact ? n.exact : n.value;
        sum += x * x;
    }
    return std::sqrt(sum);
}

// A lit mesh: the tangent frame, and half vectors with the light from the eye's side.
TEST(Trace, InterpolantsOfAMesh) {
    Scene scene;
    scene.width = scene.height = 33;
    scene.machine = machine_profile("ideal");
    scene.lights.push_back({.position = {0.0F, 0.0F, 1.0F}});
    scene.objects.push_back({Mesh(shapes::plane(2, 2)), nullptr, glm::mat4(1.0F), {}});
    const TracedFragment f =
        fragment_at(scene, 16, 16);  // the camera looks at (0, 0, 0) from z = 3
    std::vector<std::string> got;
    for (const TracedInterpolant& i : f.interpolants) got.push_back(i.name + "." + i.components);
    EXPECT_EQ(got, (std::vector<std::string>{"uv.uv", "tangent.xyz", "bitangent.xyz", "normal.xyz",
                                             "position.xyz", "half_tangent.xyz", "n_dot_l.x"}));
    for (std::size_t k = 1; k < 4; ++k) EXPECT_NEAR(length(f.interpolants[k], true), 1.0, 1e-6);
    const auto& half = f.interpolants[5].numbers;  // straight up: (0, 0, 1), coded x/2 + 1/2
    EXPECT_NEAR(half[0].exact, 0.5, 1e-7);
    EXPECT_NEAR(half[1].exact, 0.5, 1e-7);
    EXPECT_NEAR(half[2].exact, 1.0, 1e-7);
    EXPECT_NEAR(f.interpolants[6].numbers[0].exact, 1.0, 1e-7);
    for (const TracedInterpolant& i : f.interpolants) {
        for (const TracedNumber& n : i.numbers) EXPECT_NEAR(n.error(), 0.0, 1e-6) << i.name;
    }
}

/// A quad of one colour in front of all, given as codes.
Object sheet(std::array<int, 4> codes, const std::optional<Blend>& blend, AlphaTest test = {}) {
    RawVertices raw{Space::window, Topology::quads, {}};
    for (const auto& [x, y] : {std::pair{0.0F, 0.0F}, {8.0F, 0.0F}, {8.0F, 8.0F}, {0.0F, 8.0F}}) {
        RawVertex v = window_vertex(x, y, 1.0F, {});
        for (std::size_t c = 0; c < 4; ++c)
            v.color0[static_cast<int>(c)] = static_cast<float>(codes[c]) / 255.0F;
        raw.vertices.push_back(v);
    }
    auto material = vertex_color();
    material->alpha_test = test;
    return {std::move(raw),
            material,
            glm::mat4(1.0F),
            {.depth_test = DepthTest::always, .blend = blend}};
}

TEST(Trace, ListsWhatShowsThroughInOrder) {
    Scene scene;
    scene.width = scene.height = 8;
    scene.machine = machine_profile("nv2a");
    scene.objects = {
        sheet({9, 9, 9, 9}, Blend::add()), sheet({100, 50, 0, 255}, {}),
        sheet({1, 2, 3, 4}, {}, {Comparison::greater, 0.5F}),
        sheet({200, 100, 50, 64}, Blend::alpha()),
        sheet({10, 20, 30, 40}, Blend{BlendFactor::one_minus_dst_color, BlendFactor::one})};
    const PixelTrace trace = trace_pixel(scene, 3, 5);
    // What an opaque sheet hides and what a test drops is not in the colour.
    ASSERT_EQ(trace.below.size(), 2U);
    EXPECT_EQ(trace.below[0].object, 1U);
    EXPECT_FALSE(trace.below[0].blend);
    EXPECT_EQ(trace.below[1].object, 3U);
    ASSERT_TRUE(trace.below[1].blend);
    const TracedBlend& first = *trace.below[1].blend;
    using Numbers = std::array<double, 4>;
    EXPECT_EQ(first.source, (Numbers{200, 100, 50, 64}));
    EXPECT_EQ(first.source_factor, (Numbers{64, 64, 64, 64}));
    EXPECT_EQ(first.destination, (Numbers{100, 50, 0, 255}));
    EXPECT_EQ(first.destination_factor, (Numbers{191, 191, 191, 191}));
    // (200 64 + 100 191) / 255 = 125.1, (6400 + 9550) / 255 = 62.5 (62.55), 12.5 (12.55), 207.1
    EXPECT_EQ(first.result, (Numbers{125, 63, 13, 207}));
    ASSERT_TRUE(trace.fragment);
    EXPECT_EQ(trace.fragment->object, 4U);
    ASSERT_TRUE(trace.fragment->blend);
    const TracedBlend& last = *trace.fragment->blend;
    EXPECT_EQ(last.destination, first.result);
    EXPECT_EQ(last.source_factor, (Numbers{130, 192, 242, 48}));
    EXPECT_EQ(last.destination_factor, (Numbers{255, 255, 255, 255}));
    // 1300 / 255 = 5.1 and 125; 3840: 15.1; 7260: 28.5 (28.47); 1920: 7.5 (7.53)
    EXPECT_EQ(last.result, (Numbers{130, 78, 41, 215}));
    EXPECT_EQ(trace.stored, last.result);
}

}  // namespace
}  // namespace burnish
