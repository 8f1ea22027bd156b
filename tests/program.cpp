#include <gtest/gtest.h>
#include <burnish/combiner.hpp>
#include <burnish/error.hpp>

#include <functional>
#include <limits>
#include <string>

namespace burnish {
namespace {

using namespace combine;

Input unsigned_alpha(Register reg) {
    return alpha(raw(reg));
}

/// A program that every machine runs: the GeForce 256 one for the modified model.
CombinerProgram legal_program() {
    ProgramBuilder p;
    p.stage();
    p.rgb()
        .ab(dot(expand(tex(0)), expand(Register::col0)), Register::spare0)
        .cd(dot(expand(tex(1)), expand(Register::col0)), Register::spare1)
        .scale(Scale::four);
    p.alpha().ab(mul(alpha(in(tex(0))), alpha(in(Register::col0))), Register::spare0);
    p.stage();
    p.rgb()
        .ab(mul(in(Register::spare0), in(Register::spare0)))
        .cd(mul(in(Register::spare1), in(Register::spare1)))
        .sum(Register::spare0);
    p.lerp(raw(Register::spare0), raw(Register::zero), raw(Register::final_product),
           raw(Register::const1));
    p.product(unsigned_alpha(Register::spare0), raw(Register::const0));
    p.out_alpha(alpha(one()));
    return p.build();
}

std::string complaint(const CombinerProgram& program, const Machine& machine) {
    try {
        program.validate(machine);
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::bad_program);
        return error.what();
    }
    return {};
}

/// What `machine` says to the legal program after one change.
std::string after(const std::function<void(CombinerProgram&)>& change,
                  const std::string& machine = "ideal") {
    CombinerProgram program = legal_program();
    change(program);
    return complaint(program, machine_profile(machine));
}

#define EXPECT_SAYS(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)

TEST(Program, LegalProgramRunsOnEveryMachine) {
    for (const std::string_view name : machine_profile_names())
        EXPECT_EQ(complaint(legal_program(), machine_profile(name)), "") << name;
}

TEST(Program, EmptyProgramIsLegal) {
    EXPECT_EQ(complaint(ProgramBuilder().build(), machine_profile("geforce256")), "");
}

TEST(Program, BuilderFillsEveryFieldOfAPortion) {
    ProgramBuilder p;
    p.stage();
    p.rgb()
        .ab(dot(expand(tex(2)), alpha(half_bias(Register::col1))), Register::spare0)
        .cd(mul(invert(Register::fog), one()), tex(3))
        .mux(Register::spare1)
        .scale(Scale::two)
        .bias()
        .wide();
    const Portion portion = p.build().stages.at(0).rgb;
    EXPECT_EQ(portion.a.reg, tex(2));
    EXPECT_EQ(portion.a.mapping, Mapping::expand);
    EXPECT_EQ(portion.b.reg, Register::col1);
    EXPECT_EQ(portion.b.mapping, Mapping::half_bias);
    EXPECT_EQ(portion.b.component, Component::alpha);
    EXPECT_EQ(portion.c.mapping, Mapping::unsigned_invert);
    EXPECT_EQ(portion.d.reg, Register::zero);
    EXPECT_EQ(portion.ab_product, Product::dot);
    EXPECT_EQ(portion.cd_product, Product::multiply);
    EXPECT_EQ(portion.ab_out, Register::spare0);
    EXPECT_EQ(portion.cd_out, tex(3));
    EXPECT_EQ(portion.third, Third::mux);
    EXPECT_EQ(portion.third_out, Register::spare1);
    EXPECT_EQ(portion.scale, Scale::two);
    EXPECT_TRUE(portion.bias_minus_half);
    EXPECT_TRUE(portion.wide);
    EXPECT_FALSE(p.build().stages.at(0).alpha.writes());
}

TEST(Program, PortionNeedsAnOpenStage) {
    EXPECT_THROW(ProgramBuilder().rgb(), Error);
}

TEST(Program, StagesAreCountedAgainstTheMachine) {
    const auto three = [](CombinerProgram& p) { p.stages.resize(3); };
    EXPECT_EQ(after(three, "nv2a"), "");
    EXPECT_SAYS(after(three, "geforce256"), "3 general stages, machine 'geforce256' has 2");
    EXPECT_SAYS(after([](CombinerProgram& p) { p.stages.resize(9); }, "nv2a"), "9 general stages");
}

TEST(Program, UnitsAreCountedAgainstTheMachine) {
    const auto reads = [](CombinerProgram& p) { p.stages[1].rgb.a = in(tex(4)); };
    EXPECT_EQ(after(reads, "ideal"), "");
    EXPECT_SAYS(after(reads, "nv2a"), "stage 1, rgb: reads tex4");
    EXPECT_SAYS(after([](CombinerProgram& p) { p.stages[0].alpha.cd_out = tex(2); }, "geforce256"),
                "stage 0, alpha: writes tex2");
    EXPECT_SAYS(after([](CombinerProgram& p) { p.final_combiner.d = raw(tex(2)); }, "geforce256"),
                "final combiner: reads tex2");
}

TEST(Program, StageConstantsNeedAMachineThatHasThem) {
    const auto own = [](CombinerProgram& p) { p.stages[1].const1 = glm::vec4(0.5F); };
    EXPECT_EQ(after(own, "nv2a"), "");
    EXPECT_SAYS(after(own, "geforce256"), "stage 1: has constants of its own");
}

TEST(Program, WideNeedsWideRegisters) {
    const auto wide = [](CombinerProgram& p) { p.stages[0].rgb.wide = true; };
    EXPECT_EQ(after(wide, "ideal"), "");
    EXPECT_SAYS(after(wide, "nv2a"), "stage 0, rgb: wide");
}

TEST(Program, ReadOnlyRegistersAreNoDestinations) {
    for (const Register reg : {Register::zero, Register::const0, Register::const1, Register::fog,
                               Register::color_sum, Register::final_product}) {
        EXPECT_SAYS(after([&](CombinerProgram& p) { p.stages[0].rgb.ab_out = reg; }),
                    "cannot be written");
        EXPECT_SAYS(after([&](CombinerProgram& p) { p.stages[1].alpha.third_out = reg; }),
                    "stage 1, alpha: the sum goes to");
    }
    for (const Register reg : {Register::col0, Register::col1, tex(1)})
        EXPECT_EQ(after([&](CombinerProgram& p) { p.stages[0].rgb.ab_out = reg; }), "");
}

TEST(Program, DiscardIsNeverRead) {
    EXPECT_SAYS(after([](CombinerProgram& p) { p.stages[0].rgb.d = in(Register::discard); }),
                "stage 0, rgb: D reads discard");
    EXPECT_SAYS(
        after([](CombinerProgram& p) { p.final_combiner.g = unsigned_alpha(Register::discard); }),
        "final combiner: G reads discard");
}

TEST(Program, RegistersOutsideTheEnumerationAreRefused) {
    const auto wild = static_cast<Register>(static_cast<int>(Register::discard) + 1);
    EXPECT_SAYS(after([=](CombinerProgram& p) { p.stages[0].rgb.d = in(wild); }),
                "D reads an unknown register");
    EXPECT_SAYS(after([=](CombinerProgram& p) { p.stages[0].rgb.ab_out = wild; }),
                "cannot be written");
}

TEST(Program, FogAlphaIsForTheFinalCombiner) {
    const Input fog_alpha = unsigned_alpha(Register::fog);
    EXPECT_SAYS(after([&](CombinerProgram& p) { p.stages[0].rgb.a = fog_alpha; }), "alpha of fog");
    EXPECT_SAYS(after([&](CombinerProgram& p) { p.stages[0].alpha.a = fog_alpha; }),
                "alpha of fog");
    EXPECT_EQ(after([&](CombinerProgram& p) { p.final_combiner.a = fog_alpha; }), "");
    EXPECT_EQ(after([](CombinerProgram& p) { p.stages[0].rgb.a = in(Register::fog); }), "");
    EXPECT_EQ(after([](CombinerProgram& p) { p.stages[0].alpha.a = blue(in(Register::fog)); }), "");
}

TEST(Program, PseudoRegistersAreForTheFinalCombinerOnly) {
    for (const Register reg : {Register::color_sum, Register::final_product})
        EXPECT_SAYS(after([&](CombinerProgram& p) { p.stages[0].rgb.c = in(reg); }),
                    "only the final combiner");
}

TEST(Program, ColorSumFeedsBCD) {
    const Input sum = raw(Register::color_sum);
    EXPECT_EQ(after([&](CombinerProgram& p) { p.final_combiner.b = sum; }), "");
    EXPECT_EQ(after([&](CombinerProgram& p) { p.final_combiner.c = sum; }), "");
    EXPECT_EQ(after([&](CombinerProgram& p) { p.final_combiner.d = sum; }), "");
    EXPECT_SAYS(after([&](CombinerProgram& p) { p.final_combiner.a = sum; }), "A reads color_sum");
    EXPECT_SAYS(after([&](CombinerProgram& p) { p.final_combiner.e = sum; }), "E reads color_sum");
    EXPECT_SAYS(after([&](CombinerProgram& p) { p.final_combiner.f = sum; }), "F reads color_sum");
    EXPECT_SAYS(after([&](CombinerProgram& p) { p.final_combiner.g = alpha(sum); }),
                "G reads color_sum");
}

TEST(Program, FinalProductFeedsABCD) {
    const Input product = raw(Register::final_product);
    EXPECT_EQ(after([&](CombinerProgram& p) { p.final_combiner.a = product; }), "");
    EXPECT_EQ(after([&](CombinerProgram& p) { p.final_combiner.d = product; }), "");
    EXPECT_SAYS(after([&](CombinerProgram& p) { p.final_combiner.e = product; }),
                "E reads final_product");
    EXPECT_SAYS(after([&](CombinerProgram& p) { p.final_combiner.f = product; }),
                "F reads final_product");
    EXPECT_SAYS(after([&](CombinerProgram& p) { p.final_combiner.b = alpha(product); }),
                "alpha of final_product");
}

TEST(Program, ComponentsFitTheirPortion) {
    EXPECT_SAYS(after([](CombinerProgram& p) { p.stages[0].rgb.a = blue(in(Register::col0)); }),
                "stage 0, rgb: A reads the blue of col0");
    EXPECT_SAYS(after([](CombinerProgram& p) { p.stages[0].alpha.b = in(Register::col0); }),
                "stage 0, alpha: B reads the rgb of col0");
    EXPECT_EQ(after([](CombinerProgram& p) { p.stages[0].alpha.b = blue(in(Register::col0)); }),
              "");
    EXPECT_EQ(after([](CombinerProgram& p) { p.stages[0].rgb.b = alpha(in(Register::col0)); }), "");
    EXPECT_SAYS(after([](CombinerProgram& p) { p.final_combiner.f = blue(raw(Register::col0)); }),
                "F reads the blue");
    EXPECT_SAYS(after([](CombinerProgram& p) { p.final_combiner.g = raw(Register::col0); }),
                "G reads the rgb");
    EXPECT_EQ(after([](CombinerProgram& p) { p.final_combiner.g = blue(raw(Register::col0)); }),
              "");
}

TEST(Program, DotsAreForRgbPortions) {
    EXPECT_SAYS(after([](CombinerProgram& p) { p.stages[0].alpha.ab_product = Product::dot; }),
                "stage 0, alpha: dot product");
    // Two dots with a sum: legal since revision 1.6 of the extension.
    EXPECT_EQ(after([](CombinerProgram& p) { p.stages[0].rgb.third_out = tex(0); }), "");
}

TEST(Program, BiasGoesWithScaleOneAndTwo) {
    const auto with = [](Scale scale) {
        return after([scale](CombinerProgram& p) {
            p.stages[0].rgb.bias_minus_half = true;
            p.stages[0].rgb.scale = scale;
        });
    };
    EXPECT_EQ(with(Scale::one), "");
    EXPECT_EQ(with(Scale::two), "");
    EXPECT_SAYS(with(Scale::four), "bias by -1/2 with scale 4");
    EXPECT_SAYS(with(Scale::half), "bias by -1/2 with scale 1/2");
}

TEST(Program, ARegisterIsWrittenOncePerPortion) {
    EXPECT_SAYS(after([](CombinerProgram& p) { p.stages[0].rgb.cd_out = Register::spare0; }),
                "stage 0, rgb: spare0 is written twice");
    EXPECT_SAYS(after([](CombinerProgram& p) {
                    p.stages[0].rgb.cd_out = Register::discard;
                    p.stages[0].rgb.third_out = Register::spare0;
                }),
                "written twice");
    EXPECT_SAYS(after([](CombinerProgram& p) { p.stages[0].rgb.third_out = Register::spare1; }),
                "spare1 is written twice");
    // The portions write different components.
    EXPECT_EQ(after([](CombinerProgram& p) { p.stages[0].alpha.ab_out = Register::spare0; }), "");
}

TEST(Program, FinalMappingsAreUnsigned) {
    for (int i = 0; i < kMappingCount; ++i) {
        const auto mapping = static_cast<Mapping>(i);
        const bool legal =
            mapping == Mapping::unsigned_identity || mapping == Mapping::unsigned_invert;
        for (Input FinalCombiner::*slot :
             {&FinalCombiner::a, &FinalCombiner::d, &FinalCombiner::f}) {
            const std::string text = after([&](CombinerProgram& p) {
                p.final_combiner.*slot = {Register::spare1, mapping, Component::rgb};
            });
            EXPECT_EQ(text.empty(), legal) << i;
        }
        const std::string text = after([&](CombinerProgram& p) {
            p.final_combiner.g = {Register::spare1, mapping, Component::alpha};
        });
        EXPECT_EQ(text.empty(), legal) << i;
    }
}

TEST(Program, ConstantsAreNumbers) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_SAYS(after([&](CombinerProgram& p) { p.const0.z = nan; }), "const0");
    EXPECT_SAYS(after([&](CombinerProgram& p) { p.stages[1].const1 = glm::vec4(nan); }),
                "stage 1, const1");
    EXPECT_EQ(after([&](CombinerProgram& p) { p.const0.z = 7.0F; }), "");
}

TEST(MachineProfile, NamesAndLimits) {
    EXPECT_EQ(machine_profile("geforce256").texture_units, 2);
    EXPECT_EQ(machine_profile("geforce256").general_stages, 2);
    EXPECT_FALSE(machine_profile("geforce256").stage_constants);
    EXPECT_EQ(machine_profile("nv2a").texture_units, 4);
    EXPECT_EQ(machine_profile("nv2a").general_stages, 8);
    EXPECT_EQ(machine_profile("nv2a").numbers, NumberModel::nine_bit);
    EXPECT_FALSE(machine_profile("geforce256").stage_fetches);
    EXPECT_FALSE(machine_profile("nv2a").stage_fetches);
    EXPECT_TRUE(machine_profile("ideal").stage_fetches);
    EXPECT_EQ(machine_profile("geforce256").texture_operations, TextureOperations::plain);
    EXPECT_EQ(machine_profile("nv2a").texture_operations, TextureOperations::nv2a);
    EXPECT_EQ(machine_profile("ideal").texture_operations, TextureOperations::all);
    EXPECT_EQ(machine_profile("nv2a").subpixel_bits, 4);  // 1/16 pixel, measured
    EXPECT_TRUE(machine_profile("nv2a").snap_floor);
    EXPECT_EQ(machine_profile("ideal").numbers, NumberModel::wide);
    for (const std::string_view name : machine_profile_names()) {
        EXPECT_EQ(machine_profile(name).name, name);
        EXPECT_NO_THROW(machine_profile(name).validate());
    }
    try {
        (void)machine_profile("nv2b");
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::bad_option);
        EXPECT_SAYS(std::string(error.what()), "did you mean 'nv2a'?");
    }
}

TEST(MachineProfile, FieldsOutOfRangeAreRefused) {
    const auto refused = [](const std::function<void(Machine&)>& change) {
        Machine machine;
        change(machine);
        try {
            machine.validate();
        } catch (const Error& error) {
            return error.code() == ErrorCode::bad_option;
        }
        return false;
    };
    EXPECT_TRUE(refused([](Machine& m) { m.texture_units = 0; }));
    EXPECT_TRUE(refused([](Machine& m) { m.texture_units = 17; }));
    EXPECT_TRUE(refused([](Machine& m) { m.general_stages = -1; }));
    EXPECT_TRUE(refused([](Machine& m) { m.general_stages = 17; }));
    EXPECT_TRUE(refused([](Machine& m) { m.subpixel_bits = 3; }));
    EXPECT_TRUE(refused([](Machine& m) { m.subpixel_bits = 9; }));
    EXPECT_FALSE(refused([](Machine& m) { m.general_stages = 0; }));
}

}  // namespace
}  // namespace burnish
