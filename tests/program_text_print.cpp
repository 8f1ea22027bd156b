#include <burnish/error.hpp>
#include <cmath>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>

#include "program_text.hpp"
#include "random_program.hpp"

/// Programs as text again.
namespace burnish {
namespace {

void expect_round_trip(const CombinerProgram& program) {
    const std::string text = print_combiners(program);
    const CombinerProgram again = combiners(text);
    ASSERT_EQ(again, program) << text;
    ASSERT_EQ(print_combiners(again), text);
}

std::string refusal(const std::function<void()>& print) {
    try {
        print();
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::bad_program);
        return error.what();
    }
    return "";
}

// --- the three examples of the specification's section 3.5

constexpr std::string_view kDiffuse = R"(!!RC1.0
const0 = ( 0.10, 0.10, 0.12, 1.0 );   # ambient
{
  rgb {
    spare0 = expand(tex0) . expand(col0);
  }
}
out.rgb = lerp( spare0, tex1, const0 );
out.a   = unsigned_invert(zero);
)";

constexpr std::string_view kLarger = R"(!!RC1.0
{ alpha {
    discard = tex0;          # A*1
    discard = -tex1;
    spare0  = sum();         # tex0.a - tex1.a
  } }
{ alpha {
    discard = -half_bias(zero);  // A*1 = +1/2
    discard = spare0;            // C*1 = d
    spare0  = sum();             // d + 1/2 : mux bit set iff d >= 0
  } }
{ rgb { discard = tex1; discard = tex0; spare1 = mux(); } }
out.rgb = spare1;
out.a   = unsigned_invert(zero);
)";

TEST(ProgramTextPrint, DiffuseBump) {
    ProgramBuilder p;
    using namespace combine;
    p.stage();
    p.rgb().ab(dot(expand(tex(0)), expand(Register::col0)), Register::spare0);
    p.lerp(raw(Register::spare0), raw(tex(1)), raw(Register::const0), raw(Register::zero));
    p.out_alpha(alpha(one()));
    p.constants(glm::vec4(0.10F, 0.10F, 0.12F, 1.0F), glm::vec4(0.0F));
    EXPECT_EQ(combiners(kDiffuse), p.build());
    EXPECT_EQ(print_combiners(p.build()), R"(!!RC1.0
const0 = (0.1, 0.1, 0.12, 1);
{
    rgb {
        spare0 = expand(tex0) . expand(col0);
    }
}
out.rgb = lerp(spare0, tex1, const0);
out.a = one;
)");
}

TEST(ProgramTextPrint, TextureWithTheLargerAlpha) {
    const CombinerProgram program = combiners(kLarger);
    ASSERT_EQ(program.stages.size(), 3U);
    EXPECT_EQ(program.stages[1].alpha.a.mapping, Mapping::half_bias_negate);
    EXPECT_EQ(program.stages[2].rgb.third, Third::mux);
    EXPECT_NO_THROW(program.validate(machine_profile("nv2a")));
    expect_round_trip(program);
}

TEST(ProgramTextPrint, AnisotropicLookup) {
    const TextureShader shader = texture_shader(R"(!!TS1.0
texture_2d();                            // normal/tangent frame map
dot_product_2d_1of2( expand(tex0) );     // h.t in (s,t,r) of unit 1
dot_product_2d_2of2( expand(tex0) );     // h.n in unit 2; samples G(h.t,h.n)
nop();
)");
    EXPECT_EQ(print_texture_shader(shader), R"(!!TS1.0
texture_2d();
dot_product_2d_1of2(expand(tex0));
dot_product_2d_2of2(expand(tex0));
nop();
)");
}

// --- canonical text

TEST(ProgramTextPrint, DefaultsAreNotSpelledOut) {
    const std::string text = R"(!!RC1.0
const1 = (0, 0.5, 0, 1);
{
    const0 = (1, 1, 1, 1);
    rgb {
        discard = tex0 * -col0.a;
        spare1 = -one . half_bias(fog);
        bias_by_negative_one_half_scale_by_two();
    }
    alpha {
        spare0 = tex0 * tex1.b;
        discard = one;
        col0 = mux();
    }
}
clamp_color_sum();
final_product = tex0.a * fog.a;
out.rgb = lerp(fog.a, color_sum, final_product) + unsigned_invert(col1);
out.a = tex3.b;
)";
    EXPECT_EQ(print_combiners(combiners(text)), text);
}

TEST(ProgramTextPrint, FormsOfOutRgb) {
    for (const char* form : {"tex0", "tex0 + tex1", "tex0 * tex1", "tex0 * tex1 + tex2",
                             "lerp(tex0, tex1, tex2)", "lerp(tex0, tex1, tex2) + col1", "zero",
                             "one", "tex0 * one", "one * color_sum + tex0", "zero * tex0"}) {
        const std::string text = "!!RC1.0\nout.rgb = " + std::string(form) + ";\nout.a = zero;\n";
        EXPECT_EQ(print_combiners(combiners(text)), text);
    }
}

TEST(ProgramTextPrint, ExtendedLanguageOnlyWhereNeeded) {
    const auto header = [](const CombinerProgram& program) {
        const std::string text = print_combiners(program);
        return text.substr(0, text.find('\n'));
    };
    EXPECT_EQ(header(combiners("!!BRN1.0 { rgb { spare0 = tex3 . tex0; } }")), "!!RC1.0");
    EXPECT_EQ(header(combiners("!!BRN1.0 { rgb { spare0 = tex4; } }")), "!!BRN1.0");
    EXPECT_EQ(header(combiners("!!BRN1.0 out.a = tex9;")), "!!BRN1.0");
    EXPECT_EQ(header(combiners("!!BRN1.0 { wide alpha { spare0 = tex0; } }")), "!!BRN1.0");
    EXPECT_EQ(header(combiners("!!BRN1.0 { rgb { discard = tex0 . tex1; discard = tex2; spare0 = "
                               "sum(); } }")),
              "!!BRN1.0");
    EXPECT_EQ(header(combiners("!!BRN1.0 fetch { tex1 = table_1d(tex0.r); }")), "!!BRN1.0");
    CombinerProgram nine;
    nine.stages.resize(9, idle_stage());
    EXPECT_EQ(header(nine), "!!BRN1.0");
    nine.stages.resize(8);
    EXPECT_EQ(header(nine), "!!RC1.0");
}

TEST(ProgramTextPrint, ExtendedProgram) {
    const std::string text = R"(!!BRN1.0
{
    wide rgb {
        discard = tex0 . tex1;
        discard = tex2;
        spare0 = sum();
        scale_by_four();
    }
}
fetch {
    tex4 = table_2d(spare0.r, expand(spare0.a));
    tex5 = table_cube_map(tex4.r, tex4.g, tex4.b);
}
{
    rgb {
        discard = zero * zero;
    }
}
{
    alpha {
        spare0 = tex15;
    }
}
fetch {
    tex0 = table_1d(spare0.a);
}
out.rgb = tex0;
out.a = zero;
)";
    const CombinerProgram program = combiners(text);
    EXPECT_EQ(print_combiners(program), text);
    expect_round_trip(program);
}

TEST(ProgramTextPrint, IdleStagesStay) {
    CombinerProgram program;
    program.stages.resize(3, idle_stage());
    expect_round_trip(program);
    program.stages.resize(1);
    expect_round_trip(program);
    EXPECT_EQ(print_combiners(program), "!!RC1.0\nout.rgb = zero;\nout.a = zero;\n");
    program.stages[0].const0 = glm::vec4(0.0F);
    expect_round_trip(program);
    program.stages[0] = idle_stage();
    program.stages[0].alpha.third = Third::mux;
    expect_round_trip(program);
    program.stages[0] = idle_stage();
    program.stages[0].rgb.scale = Scale::four;
    expect_round_trip(program);
    program.stages[0] = idle_stage();
    program.stages[0].rgb.cd_product = Product::dot;
    expect_round_trip(program);
}

TEST(ProgramTextPrint, NumbersHaveNoExponent) {
    CombinerProgram program;
    program.stages.push_back(idle_stage());
    const float tiny = std::numeric_limits<float>::denorm_min();
    program.const0 = glm::vec4(tiny, 1e-20F, 0.1F, std::nextafter(1.0F, 0.0F));
    expect_round_trip(program);
    program.const1 = glm::vec4(-3.0F, 7.0F, -0.0F, 0.0F);
    EXPECT_EQ(combiners(print_combiners(program)).const1, glm::vec4(0.0F, 1.0F, 0.0F, 0.0F))
        << "as the machine takes them";
}

TEST(ProgramTextPrint, WhatNoTextCanSay) {
    const auto after = [](const std::function<void(CombinerProgram&)>& change) {
        CombinerProgram program;
        program.stages.push_back(idle_stage());
        change(program);
        return refusal([&] { print_combiners(program); });
    };
    const std::string end = ", which no text can say: it belongs to the material";
    EXPECT_EQ(after([](auto&) {}), "");
    EXPECT_EQ(after([](auto& p) { p.fog = glm::vec4(0.5F); }), "fog has a colour" + end);
    EXPECT_EQ(after([](auto& p) { p.mux_bit = MuxBit::lsb; }),
              "mux tests the least significant bit" + end);
    for (bool FinalCombiner::*flag :
         {&FinalCombiner::complement_spare0, &FinalCombiner::complement_secondary})
        EXPECT_EQ(after([flag](auto& p) { p.final_combiner.*flag = true; }),
                  "final combiner: an operand of the colour sum is complemented" + end);
    for (bool Portion::*flag : {&Portion::ab_blue_to_alpha, &Portion::cd_blue_to_alpha})
        EXPECT_EQ(after([flag](auto& p) { p.stages[0].rgb.*flag = true; }),
                  "stage 0, rgb: blue goes to alpha" + end);
}

TEST(ProgramTextPrint, WhatNoMachineCanRun) {
    CombinerProgram program;
    program.stages.resize(17, idle_stage());
    EXPECT_EQ(refusal([&] { print_combiners(program); }),
              "17 general stages, machine 'ideal' has 16");
    program.stages.resize(1);
    program.stages[0].rgb.a.reg = Register::discard;
    EXPECT_NE(refusal([&] { print_combiners(program); }), "");
}

TEST(ProgramTextPrint, ExamplesOfTheManual) {
    std::ifstream file(BURNISH_SOURCE_DIR "/docs/programs.md");
    const std::string manual((std::istreambuf_iterator<char>(file)), {});
    int examples = 0;
    for (std::size_t at = 0; (at = manual.find("```\n!!", at)) != std::string::npos; ++examples) {
        const std::size_t end = manual.find("```", at + 3);
        expect_round_trip(combiners(manual.substr(at + 4, end - at - 4)));
        at = end + 3;
    }
    EXPECT_EQ(examples, 2);
}

// --- random programs

/// 12000 programs of three machines, most of them with several stages.
TEST(ProgramTextPrint, RandomProgramsComeBack) {
    for (const char* profile : {"geforce256", "nv2a", "ideal"}) {
        const Machine machine = machine_profile(profile);
        for (unsigned seed = 0; seed < 4000; ++seed) {
            Random random(seed);
            CombinerProgram program = random_program(random, machine);
            if (machine.stage_fetches) {
                for (GeneralStage& stage : program.stages) {
                    if (random.chance(3)) stage.fetches = random_fetches(random, machine);
                }
            }
            program = sayable(program);
            ASSERT_NO_FATAL_FAILURE(expect_round_trip(program)) << profile << ", seed " << seed;
            EXPECT_NO_THROW(combiners(print_combiners(program)).validate(machine));
        }
    }
}

// --- texture shaders

TEST(TextureShaderPrint, EveryStatementComesBack) {
    for (const char* body :
         {"texture_1d();\ntexture_2d();\ntexture_3d();\ntexture_rectangle();\n",
          "texture_cube_map();\npass_through();\nnop();\ndependent_ar(tex1);\n",
          "cull_fragment(GEQUAL_TO_ZERO, LESS_THAN_ZERO, LESS_THAN_ZERO, GEQUAL_TO_ZERO);\n"
          "nop();\nnop();\nnop();\n",
          "texture_2d();\noffset_2d(tex0, 1, -2, 0.5, 0);\n"
          "offset_rectangle_scale(tex1, 1, 0, 0, 1, 2, -0.5);\n"
          "offset_hilo_projective_2d(tex0, 100, 0, 0, 1);\n",
          "texture_2d();\ndot_product_depth_replace_1of2(force_blue_to_one(tex0));\n"
          "dot_product_depth_replace_2of2(tex0);\ndependent_rgb_cube_map(tex0);\n",
          "texture_2d();\ndot_product_cube_map_and_reflect_cube_map_const_eye_1of3(tex0, 0, 0.5, "
          "-1);\ndot_product_cube_map_and_reflect_cube_map_const_eye_2of3(expand(tex0));\n"
          "dot_product_cube_map_and_reflect_cube_map_const_eye_3of3(tex0);\n",
          "texture_2d();\ndot_product_reflect_cube_map_eye_from_qs_1of3(tex0);\n"
          "dot_product_reflect_cube_map_eye_from_qs_2of3(tex0);\n"
          "dot_product_reflect_cube_map_eye_from_qs_3of3(tex0);\n",
          "texture_2d();\ndot_product_pass_through(tex0);\ntexture_brdf();\n"
          "dot_product_affine_depth_replace(expand(tex2));\n"}) {
        const std::string text = "!!TS1.0\n" + std::string(body);
        EXPECT_EQ(print_texture_shader(texture_shader(text)), text);
    }
}

TEST(TextureShaderPrint, WhatNoTextCanSay) {
    const auto says = [](const TextureShader& shader) {
        return refusal([&] { print_texture_shader(shader); });
    };
    TextureShader shader = texture_shader("!!TS1.0 texture_2d(); nop(); nop();");
    shader.units[1].operation = TextureOperation::dot_product;
    EXPECT_EQ(says(shader),
              "texture unit 1: dot_product is not part of a group of units that the text has a "
              "word for");
    shader = texture_shader("!!TS1.0 texture_2d();");
    shader.units[0].dot_mapping = DotMapping::expand;
    EXPECT_EQ(says(shader), "texture unit 0: has a field that texture_2d has no use for");
    shader = texture_shader("!!TS1.0 texture_2d(); dependent_ar(tex0);");
    shader.units[1].previous = 1;
    EXPECT_EQ(says(shader), "texture unit 1: reads unit 1, expected an earlier one");
    shader.units[1].previous = -1;
    EXPECT_NE(says(shader), "");
    shader.units[1].previous = 0;
    shader.units[0].operation = TextureOperation::none;
    EXPECT_EQ(says(shader), "texture unit 1: reads unit 0, whose operation none has no output");
    shader = texture_shader("!!TS1.0 texture_2d(); offset_2d(tex0, 1, 0, 0, 1);");
    shader.units[1].offset_matrix[1][0] = std::numeric_limits<float>::infinity();
    EXPECT_EQ(says(shader), "texture unit 1: a parameter is not a finite number");
}

/// Units with operations by chance: those that text can say come back.
TEST(TextureShaderPrint, RandomShadersComeBack) {
    int said = 0;
    for (unsigned seed = 0; seed < 200000; ++seed) {
        Random random(seed);
        TextureShader shader;
        for (int i = 0; i < kTextureShaderUnits; ++i) {
            TextureUnit& unit = shader.units[static_cast<std::size_t>(i)];
            unit.operation = static_cast<TextureOperation>(random.below(kTextureOperationCount));
            if (random.chance(3)) unit.operation = TextureOperation::dot_product;
            if (i == 0 || random.chance(4)) unit.operation = TextureOperation::texture_2d;
            if (random.chance(2) && unit.operation >= TextureOperation::dot_product &&
                unit.operation != TextureOperation::texture_brdf)
                unit.dot_mapping = static_cast<DotMapping>(random.below(3));
        }
        std::string text;
        try {
            text = print_texture_shader(shader);
        } catch (const Error&) {
            continue;
        }
        ++said;
        ASSERT_EQ(texture_shader(text), shader) << text;
    }
    EXPECT_GT(said, 10000);
}

}  // namespace
}  // namespace burnish
