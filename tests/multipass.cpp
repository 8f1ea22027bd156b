// Programs in several passes, against the whole program on a machine that has room for it: the
// passes' frames and the last pass's colour by the interpreter, and pictures.
#include <burnish/multipass.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <burnish/error.hpp>
#include <burnish/program_text.hpp>
#include <burnish/renderer.hpp>
#include <burnish/shapes.hpp>
#include <burnish/trace.hpp>
#include <cstring>
#include <set>
#include <string>

#include "machine/interpreter.hpp"
#include "models/compile_model.hpp"
#include "tests/random_program.hpp"
#include "tests/scenes.hpp"

namespace burnish {
namespace {

constexpr auto kTexels = UnitTexels::unsigned_texels;

Machine roomy() {
    Machine machine = machine_profile("nv2a");
    machine.general_stages = 16;
    machine.texture_units = 16;
    return machine;
}

Machine small(int stages, int units, bool stage_constants = true) {
    Machine machine = machine_profile("nv2a");
    machine.general_stages = stages;
    machine.texture_units = units;
    machine.stage_constants = stage_constants;
    return machine;
}

CombinerProgram parsed(const std::string& body) {
    const auto result = parse_combiners("!!RC1.0\n" + body);
    EXPECT_TRUE(result.program) << (result.errors.empty() ? "" : result.errors[0].message);
    return result.program.value_or(CombinerProgram{});
}

/// The picture of one fragment, pass by pass.
Codes run_passes(const std::vector<ProgramPass>& passes, const Machine& machine,
                 const RegisterFile& inputs) {
    std::vector<Codes> frames;
    for (const ProgramPass& pass : passes) {
        RegisterFile file;
        file[Register::col0] = inputs[Register::col0];
        file[Register::col1] = inputs[Register::col1];
        for (int i = 0; i < 16; ++i) file[tex(i)] = {0, 0, 0, 255};
        EXPECT_LE(pass.units.size(), static_cast<std::size_t>(machine.texture_units));
        for (std::size_t i = 0; i < pass.units.size(); ++i) {
            const PassUnit& unit = pass.units[i];
            if (unit.material_unit >= 0)
                file[tex(static_cast<int>(i))] = inputs[tex(unit.material_unit)];
            if (unit.frame >= 0)
                file[tex(static_cast<int>(i))] = frames.at(static_cast<std::size_t>(unit.frame));
        }
        frames.push_back(run_combiners(pass.program, machine, file));
        // What an 8-bit frame holds.
        for (const int code : frames.back()) EXPECT_TRUE(code >= 0 && code <= 255) << code;
    }
    return frames.back();
}

RegisterFile random_file(Random& random, std::span<const UnitTexels> units) {
    RegisterFile file;
    for (int& code : file[Register::col0]) code = random.below(256);
    for (int& code : file[Register::col1]) code = random.below(256);
    for (std::size_t i = 0; i < units.size(); ++i) {
        for (int& code : file[tex(static_cast<int>(i))]) {
            if (units[i] == UnitTexels::unsigned_texels) code = random.below(256);
            if (units[i] == UnitTexels::signed_texels) code = 2 * random.between(-128, 127);
        }
        if (units[i] == UnitTexels::none) file[tex(static_cast<int>(i))] = {0, 0, 0, 255};
    }
    return file;
}

void expect_same(const CombinerProgram& program, const Machine& machine,
                 std::span<const UnitTexels> units, const std::vector<ProgramPass>& passes,
                 Random& random) {
    Machine room = machine;
    room.general_stages = room.texture_units = 16;
    room.stage_constants = true;
    for (int i = 0; i < 20; ++i) {
        const RegisterFile file = random_file(random, units);
        ASSERT_EQ(run_passes(passes, machine, file), run_combiners(program, room, file));
    }
}

const std::vector<UnitTexels> kFour(4, kTexels);

TEST(Multipass, AProgramThatFitsIsOnePass) {
    const CombinerProgram program = parsed("{ rgb { spare0 = tex0 * col0; } }\nout.rgb = spare0;");
    const auto passes = split_into_passes(program, small(2, 2), kFour);
    ASSERT_EQ(passes.size(), 1U);
    EXPECT_EQ(passes[0].program.stages, program.stages);
    EXPECT_EQ(passes[0].units[0], (PassUnit{0, -1}));
    EXPECT_EQ(passes[0].units[1], PassUnit{});  // nothing reads it
}

/// The lobe of the paper squared twice: four stages, of which each pair leaves one number.
TEST(Multipass, SquaresPassThroughOneFrame) {
    const CombinerProgram program = parsed(
        "{ rgb { spare0 = expand(tex0) . expand(col0); spare1 = expand(tex1) . expand(col0); } }\n"
        "{ rgb { discard = spare0 * spare0; discard = spare1 * spare1; spare0 = sum(); } }\n"
        "{ rgb { spare0 = unsigned_invert(spare0) * unsigned_invert(spare0); } }\n"
        "{ rgb { spare0 = spare0 * spare0; } }\n"
        "out.rgb = spare0 * tex2; out.a = unsigned_invert(zero);");
    const auto passes = split_into_passes(program, small(2, 2), kFour);
    ASSERT_EQ(passes.size(), 2U);
    EXPECT_EQ(passes[0].program.stages.size(), 2U);
    EXPECT_EQ(passes[0].units, (std::vector<PassUnit>{{0, -1}, {1, -1}}));
    // Unit 2 of the material and the frame are all that the second pass reads.
    EXPECT_EQ(passes[1].program.stages.size(), 2U);
    EXPECT_EQ(passes[1].units, (std::vector<PassUnit>{{-1, 0}, {2, -1}}));
    Random random(1);
    expect_same(program, small(2, 2), kFour, passes, random);
}

TEST(Multipass, TwoColoursTakeTwoFrames) {
    const CombinerProgram program = parsed(
        "{ rgb { spare0 = tex0 * col0; spare1 = tex1 * col0; } alpha { spare1 = tex0 * tex1; } }\n"
        "{ rgb { discard = spare0 * tex0; discard = spare1 * tex1; spare0 = sum(); } }\n"
        "{ rgb { spare0 = spare0 * spare1.a; } }\n"
        "out.rgb = spare0; out.a = spare1.a;");
    const auto passes = split_into_passes(program, small(1, 4), kFour);
    EXPECT_EQ(passes.size(), 4U);  // two for stage 0
    Random random(2);
    expect_same(program, small(1, 4), kFour, passes, random);
}

/// Where the last cut that the machine allows would leave a sign, an earlier one may not.
TEST(Multipass, StepsBackToACutThatHolds) {
    const CombinerProgram program = parsed(
        "{ rgb { spare0 = tex0 * tex1; } }\n"
        "{ rgb { spare0 = expand(spare0) * col0; } }\n"
        "{ rgb { spare1 = -spare0 * col0; } }\n"
        "out.rgb = spare1;");
    const auto passes = split_into_passes(program, small(2, 4), kFour);
    ASSERT_EQ(passes.size(), 2U);
    EXPECT_EQ(passes[0].program.stages.size(), 1U);
    Random random(3);
    expect_same(program, small(2, 4), kFour, passes, random);
}

TEST(Multipass, ConstantsOfStagesBecomeConstantsOfPasses) {
    const CombinerProgram program = parsed(
        "{ const0 = (1, 0.5, 0, 1); rgb { spare0 = tex0 * const0; } }\n"
        "{ const0 = (0, 0.5, 1, 1); rgb { spare0 = spare0 * const0; } }\n"
        "out.rgb = spare0;");
    const auto passes = split_into_passes(program, small(2, 2, false), kFour);
    ASSERT_EQ(passes.size(), 2U);
    EXPECT_EQ(passes[0].program.const0, glm::vec4(1.0F, 0.5F, 0.0F, 1.0F));
    EXPECT_EQ(passes[1].program.const0, glm::vec4(0.0F, 0.5F, 1.0F, 1.0F));
    Random random(4);
    expect_same(program, small(2, 2, false), kFour, passes, random);
}

std::string obstacle(const std::string& body, const Machine& machine,
                     std::span<const UnitTexels> units = kFour, bool fixed = false) {
    try {
        split_into_passes(parsed(body), machine, units, fixed);
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::bad_program);
        return error.what();
    }
    return "";
}

TEST(Multipass, ObstaclesAreNamed) {
    const auto says = [](const std::string& text, const std::string& part) {
        EXPECT_NE(text.find(part), std::string::npos) << text;
    };
    says(
        obstacle("{ rgb { spare0 = expand(tex0) * col0; } }\n{ rgb { spare1 = -spare0 * col0; } }\n"
                 "out.rgb = spare1;",
                 small(1, 4)),
        "stage 1: spare0.rgb may be -255 / 255 and is read with its sign, which an 8-bit frame "
        "cannot hold");
    says(obstacle("{ alpha { spare0 = tex0 * col0; } }\n"
                  "{ rgb { discard = tex0; discard = tex1; spare1 = mux(); } }\nout.rgb = spare1;",
                  small(1, 4)),
         "stage 1: spare0.a is read by mux(), where no texture can stand for it");
    says(obstacle("{ rgb { spare0 = tex0 * col0; } }\n{ rgb { spare1 = tex1 * col0; } }\n"
                  "out.rgb = color_sum * spare1;",
                  small(1, 4)),
         "spare0.rgb is read by color_sum");
    says(obstacle("{ rgb { spare0 = tex0 * tex1; } }\n{ rgb { spare0 = spare0 * tex2; } }\n"
                  "out.rgb = spare0 * tex3 + tex0;",
                  small(1, 2)),
         "3 textures and 1 frames of earlier passes are read, with 2 texture units");
    says(obstacle("{ rgb { spare0 = tex0 * tex1; } }\n{ rgb { spare0 = spare0 * tex1; } }\n"
                  "out.rgb = spare0;",
                  small(1, 2), std::vector<UnitTexels>(2, kTexels), true),
         "2 textures and 1 frames");
}

// One texture more in the final combiner than units beside a frame: the product before it gets a
// frame of its own.
TEST(Multipass, AProductBeforeTheLastPassGetsAFrame) {
    const std::vector<UnitTexels> units(4, kTexels);
    const CombinerProgram program = parsed(
        "{ rgb { spare0 = tex0 * tex1; } }\n{ rgb { spare0 = spare0 * tex2; } }\n"
        "out.rgb = spare0 * tex3;");
    const auto passes = split_into_passes(program, small(1, 2), units);
    ASSERT_EQ(passes.size(), 3U);
    const PassUnit first_frame{.frame = 0}, second_frame{.frame = 1};
    EXPECT_NE(std::ranges::find(passes[1].units, first_frame), passes[1].units.end());
    EXPECT_NE(std::ranges::find(passes[2].units, second_frame), passes[2].units.end());
    RegisterFile inputs;
    for (int i = 0; i < 4; ++i) inputs[tex(i)] = {200 + i, 255 - 7 * i, 90 + i, 255};
    EXPECT_EQ(run_passes(passes, small(1, 2), inputs), run_combiners(program, roomy(), inputs));
}

/// A register that no later stage needs with its sign may hold one: the frame clamps it as the
/// reading would have.
TEST(Multipass, RandomProgramsGiveTheSameBits) {
    int split = 0, passes_in_all = 0;
    for (unsigned seed = 0; seed < 40000; ++seed) {
        Random random(seed);
        Machine machine = small(random.between(1, 3), random.between(1, 4), random.chance(2));
        if (random.chance(2)) {
            machine.product_rounding = static_cast<ProductRounding>(random.below(3));
            machine.expand = random.chance(2) ? ExpandRule::ideal : ExpandRule::hardware;
            machine.halving = random.chance(2) ? Halving::down : Halving::half_up;
        }
        Machine writer = roomy();
        writer.general_stages = random.between(1, 6);
        writer.texture_units = 4;
        CombinerProgram program = random_program(random, writer);
        // Signs are the usual obstacle.
        for (GeneralStage& stage : program.stages) {
            for (Portion* p : {&stage.rgb, &stage.alpha}) {
                for (Input* input : {&p->a, &p->b, &p->c, &p->d}) {
                    if (random.chance(3)) continue;
                    if (input->mapping == Mapping::signed_identity)
                        input->mapping = Mapping::unsigned_identity;
                    if (input->mapping == Mapping::signed_negate)
                        input->mapping = Mapping::unsigned_invert;
                }
            }
        }
        std::vector<UnitTexels> units(4);
        for (UnitTexels& unit : units) unit = static_cast<UnitTexels>(random.below(3));
        std::vector<ProgramPass> passes;
        try {
            passes = split_into_passes(program, machine, units, random.chance(4));
        } catch (const Error&) {
            continue;
        }
        if (passes.size() == 1) continue;
        ++split;
        passes_in_all += static_cast<int>(passes.size());
        expect_same(program, machine, units, passes, random);
        ASSERT_FALSE(HasFatalFailure()) << "seed " << seed;
    }
    EXPECT_GT(split, 500);
    RecordProperty("split", split);
    RecordProperty("passes", passes_in_all);
}

// ---- pictures

/// Four stages and five textures, of which two machines have less.
ProgramMaterial long_material() {
    ProgramMaterial material;
    material.combiners = parsed(
        "{ const0 = (0.9, 0.8, 0.7, 1); rgb { spare0 = tex0 * col0; spare1 = tex1 * const0; }\n"
        "  alpha { spare1 = tex0 * unsigned(tex1); } }\n"
        "{ const0 = (0.2, 0.6, 0.4, 1); rgb { discard = spare0 * const0; discard = spare1 * tex2;\n"
        "  spare0 = sum(); scale_by_two(); } }\n"
        "{ rgb { discard = spare0 * spare0; discard = tex3 * spare1.a; spare0 = sum(); } }\n"
        "{ rgb { spare0 = unsigned_invert(spare0) * spare1.a; } alpha { spare0 = tex3 * col0; } }\n"
        "final_product = spare0 * col1; out.rgb = final_product + spare0; out.a = spare0;");
    const std::array sizes{16, 32, 8, 64};
    for (std::size_t i = 0; i < sizes.size(); ++i) {
        const auto shift = static_cast<std::uint8_t>(40 * i);
        material.units.push_back(scenes::streaks(
            sizes[i], sizes[i], {static_cast<std::uint8_t>(90 + shift), 200, 120, 220}, 60));
    }
    return material;
}

Scene ball(const Machine& machine) {
    Scene scene = scenes::lit_scene(machine, 96, 64);
    auto material = std::make_shared<Material>();
    material->program = long_material();
    material->program->col0_rgb = ColorInput::light_tangent;
    material->program->col0_a = ColorInput::n_dot_l;
    material->program->col1_rgb = ColorInput::half_tangent;
    scene.objects.push_back({Mesh(shapes::sphere(24, 12)), material, glm::mat4(1.0F), {}});
    return scene;
}

/// Every unit with coordinates of its own, one layer blended over another.
Scene quads(const Machine& machine) {
    Scene scene;
    scene.machine = machine;
    scene.width = 80;
    scene.height = 70;
    auto material = std::make_shared<Material>();
    material->program = long_material();
    RawVertices raw;
    raw.space = Space::window;
    raw.topology = Topology::quads;
    for (const float shift : {0.0F, 11.0F}) {
        for (const auto& [x, y] :
             {std::pair(3.0F, 2.0F), {70.0F, 5.0F}, {66.0F, 57.0F}, {9.0F, 50.0F}}) {
            RawVertex v;
            v.position = {x + shift / 2, y + shift, 0.5F, 1.0F + 0.01F * y};
            v.color0 = {x / 80.0F, y / 70.0F, 0.7F, 0.9F};
            v.color1 = {0.5F, 0.6F, x / 80.0F, 1.0F};
            for (std::size_t i = 0; i < v.uv.size(); ++i) {
                const auto k = static_cast<float>(i + 1);
                v.uv[i] = {0.02F * k * x, 0.03F * y - 0.1F * k, 0.0F, 1.0F};
            }
            raw.vertices.push_back(v);
        }
    }
    RasterState state{.depth_test = DepthTest::always};
    state.blend = Blend{BlendFactor::src_alpha, BlendFactor::one_minus_src_alpha};
    scene.objects.push_back({raw, material, glm::mat4(1.0F), state});
    return scene;
}

std::vector<std::uint8_t> picture(const Scene& scene, std::string_view isa) {
    Framebuffer target(scene.width, scene.height);
    Renderer({.threads = 2, .isa = std::string(isa)}).render(scene, target);
    std::vector<std::uint8_t> bytes;
    const auto row_size = 4 * static_cast<std::size_t>(scene.width);
    for (int y = 0; y < scene.height; ++y) {
        const auto* row = reinterpret_cast<const std::uint8_t*>(target.row(y));
        bytes.insert(bytes.end(), row, row + row_size);
    }
    return bytes;
}

class MultipassPictures : public testing::TestWithParam<Scene (*)(const Machine&)> {};

// All passes of a material are shaded at the same four texels.
TEST_P(MultipassPictures, HaveTheBitsOfOnePassFilteredAfter) {
    const auto make = GetParam();
    Machine machine = roomy();
    const std::vector<std::uint8_t> before = picture(make(machine), "");
    machine.filter_order = FilterOrder::after;
    const std::vector<std::uint8_t> want = picture(make(machine), "");
    EXPECT_NE(want, before);
    machine = small(2, 4, false);
    machine.multipass = true;
    machine.filter_order = FilterOrder::after;
    EXPECT_EQ(picture(make(machine), ""), want);
}

TEST_P(MultipassPictures, HaveTheBitsOfOnePass) {
    const auto make = GetParam();
    const std::vector<std::uint8_t> want = picture(make(roomy()), "reference");
    std::set<std::uint8_t> values(want.begin(), want.end());
    EXPECT_GT(values.size(), 50U);  // or the picture proves nothing
    for (const auto& [stages, units, constants] :
         {std::tuple(2, 4, true), {1, 4, true}, {3, 3, true}, {2, 4, false}}) {
        Machine machine = small(stages, units, constants);
        EXPECT_THROW(picture(make(machine), "reference"), Error);
        machine.multipass = true;
        for (const IsaInfo& isa : instruction_sets()) {
            if (!isa.available) continue;
            EXPECT_EQ(picture(make(machine), isa.name), want)
                << isa.name << ", " << stages << " stages, " << units << " units";
        }
    }
}

INSTANTIATE_TEST_SUITE_P(All, MultipassPictures, testing::Values(ball, quads),
                         [](const auto& test) { return test.param == ball ? "ball" : "quads"; });

/// Registers of a program in passes are those of the program: traced, and as pictures.
TEST(Multipass, RegistersAreThoseOfTheWholeProgram) {
    Machine machine = small(2, 4);
    machine.multipass = true;
    const Scene scene = ball(machine);
    const PixelTrace trace = trace_pixel(scene, 50, 30);
    ASSERT_TRUE(trace.fragment);
    EXPECT_EQ(trace.fragment->stages.size(), 6U);  // inputs, four stages, final
    const std::vector<std::uint8_t> bytes = picture(scene, "");
    for (std::size_t c = 0; c < 4; ++c)
        EXPECT_EQ(trace.stored[c], bytes[4 * (30 * 96 + 50) + c]) << c;
    // A register between the passes, and one within the first of them.
    for (const std::size_t stages : {1U, 3U}) {
        Framebuffer one(scene.width, scene.height), several(scene.width, scene.height);
        Renderer renderer({.threads = 2});
        renderer.render(ball(roomy()), one, ShownRegister{Register::spare1, stages});
        renderer.render(scene, several, ShownRegister{Register::spare1, stages});
        for (int y = 0; y < scene.height; ++y)
            ASSERT_EQ(
                std::memcmp(one.row(y), several.row(y), 4 * static_cast<std::size_t>(scene.width)),
                0)
                << stages << " stages, row " << y;
    }
}

// Models whose tables the NV2A reads before its combiners only: passes with dependent reads against
// the same program with fetches between stages, byte by byte.
TEST(Multipass, TablesBecomeDependentReads) {
    constexpr std::array kModels{Model::abp,  Model::banks,     Model::kajiya_kay,
                                 Model::ward, Model::ward_duer, Model::ashikhmin_shirley,
                                 Model::ggx};
    for (const Model model : kModels) {
        Material material;
        material.model = model;
        material.alpha_x = 0.15F;
        material.exponent = 12.0F;
        material.kd = {0.1F, 0.12F, 0.2F};
        material.ks = {0.8F, 0.7F, 0.6F};
        Machine machine = machine_profile("nv2a");
        machine.multipass = true;
        auto program = std::make_shared<Material>();
        program->program =
            compile_model(material, machine, glm::vec3(0.5F), glm::vec3(0.02F)).program;
        Scene scene;
        scene.width = scene.height = 96;
        scene.lights.push_back(Light{.position = {0.4F, 0.5F, 0.8F}});
        scene.objects.push_back({Mesh(shapes::sphere(24, 12)), program, glm::mat4(1.0F), {}});
        Renderer renderer;
        Framebuffer passes(96, 96), whole(96, 96);
        scene.machine = machine;
        renderer.render(scene, passes);
        scene.machine = with_room(machine);
        scene.machine.multipass = false;
        renderer.render(scene, whole);
        int different = 0;
        for (int y = 0; y < 96; ++y) {
            for (int x = 0; x < 4 * 96; ++x) different += passes.row(y)[x] != whole.row(y)[x];
        }
        EXPECT_EQ(different, 0) << "model " << static_cast<int>(model);
        const std::vector<UnitTexels> units(16, kTexels);
        EXPECT_GT(split_into_passes(program->program->combiners, machine, units).size(), 1U);
    }
}

}  // namespace
}  // namespace burnish
