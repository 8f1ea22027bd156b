#include "machine/interpreter.hpp"

#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace burnish {
namespace {

using namespace combine;

const Machine kNv2a = machine_profile("nv2a");
const Machine kIdeal = machine_profile("ideal");

RegisterFile registers(const Codes& col0, const Codes& tex0 = {}) {
    RegisterFile file;
    file[Register::col0] = col0;
    file[Register::tex0] = tex0;
    return file;
}

Input alpha_of(Register r, Mapping m = Mapping::signed_identity) {
    return {r, m, Component::alpha};
}

/// out.rgb = D, out.a = G, both of the same register.
FinalCombiner show(Register r) {
    FinalCombiner f;
    f.d.reg = r;
    f.g.reg = r;
    return f;
}

TEST(Interpreter, ConstantsAreRoundedToNearestAndClamped) {  // H1
    CombinerProgram p;
    p.final_combiner = show(Register::const0);
    p.const0 = {25.0F / 255, 63.4F / 255, 63.5F / 255, 1.5F};
    EXPECT_EQ(run_combiners(p, kNv2a, {}), (Codes{25, 63, 64, 255}));
    p.const0 = {0.5F, 0.25F, -1.0F, 1.0F};
    EXPECT_EQ(run_combiners(p, kIdeal, {}), (Codes{8192, 4096, 0, 16384}));
}

TEST(Interpreter, SpareZeroAlphaBeginsAsThatOfTextureZero) {
    CombinerProgram p;
    p.final_combiner = show(Register::spare0);
    EXPECT_EQ(run_combiners(p, kNv2a, registers({}, {9, 9, 9, 200})), (Codes{0, 0, 0, 200}));
}

TEST(Interpreter, BiasHalfScaleAndShifts) {  // H2, H3, H4, H5
    ProgramBuilder b;
    b.stage().rgb().ab(mul(in(Register::col0), one()), Register::spare0).bias().scale(Scale::two);
    b.alpha().ab(mul(alpha_of(Register::col0), alpha(one())), Register::spare0).scale(Scale::half);
    CombinerProgram p = b.build();
    p.final_combiner = show(Register::spare0);
    EXPECT_EQ(run_combiners(p, kNv2a, registers({25, 192, 255, 25})), (Codes{0, 128, 254, 13}));
    p.stages[0].rgb.scale = Scale::half;
    p.stages[0].rgb.bias_minus_half = false;
    p.stages[0].alpha.scale = Scale::one;
    p.stages[0].alpha.bias_minus_half = true;
    EXPECT_EQ(run_combiners(p, kNv2a, registers({25, 63, 255, 255})), (Codes{13, 32, 128, 127}));
    p.stages[0].rgb.scale = p.stages[0].alpha.scale = Scale::four;
    p.stages[0].alpha.bias_minus_half = false;
    EXPECT_EQ(run_combiners(p, kNv2a, registers({25, 63, 255, 1})), (Codes{100, 252, 255, 4}));
}

TEST(Interpreter, ExpandOfMiddleGreyIsZero) {
    ProgramBuilder b;
    b.stage().rgb().ab(dot(expand(Register::tex0), expand(Register::col0)), Register::spare0);
    CombinerProgram p = b.build();
    p.final_combiner = show(Register::spare0);
    EXPECT_EQ(run_combiners(p, kNv2a, registers({128, 128, 255, 0}, {255, 0, 128, 0})),
              (Codes{0, 0, 0, 0}));
    // 254 * 254 / 255 = 253.004
    EXPECT_EQ(run_combiners(p, kNv2a, registers({128, 128, 255, 0}, {128, 128, 255, 0})),
              (Codes{253, 253, 253, 0}));
}

// Two registers change places in one stage: both read the state before it.
TEST(Interpreter, ReadsPrecedeWrites) {
    ProgramBuilder b;
    b.stage()
        .rgb()
        .ab(mul(in(Register::tex0), one()), Register::col0)
        .cd(mul(in(Register::col0), one()), Register::tex0);
    b.alpha().ab(mul(blue({Register::col0}), one()), Register::col0);
    CombinerProgram p = b.build();
    p.final_combiner = show(Register::col0);
    std::vector<RegisterFile> trace;
    const Codes out = run_combiners(p, kNv2a, registers({1, 2, 3, 4}, {5, 6, 7, 8}), &trace);
    EXPECT_EQ(out, (Codes{5, 6, 7, 3}));
    ASSERT_EQ(trace.size(), 3U);
    EXPECT_EQ(trace[0][Register::col0], (Codes{1, 2, 3, 4}));
    EXPECT_EQ(trace[1][Register::tex0], (Codes{1, 2, 3, 8}));
    EXPECT_EQ(trace[2][Register::col0], (Codes{5, 6, 7, 3}));
}

TEST(Interpreter, MuxLooksAtTheAlphaBeforeTheStage) {
    ProgramBuilder b;
    b.stage()
        .rgb()
        .ab(mul(in(Register::tex0), one()))
        .cd(mul(in(Register::col0), one()))
        .mux(Register::spare1);
    b.alpha().ab(mul(alpha_of(Register::zero), one()), Register::spare0);
    CombinerProgram p = b.build();
    p.final_combiner = show(Register::spare1);
    const auto muxed = [&](int alpha) {
        return run_combiners(p, kNv2a, registers({2, 2, 2, 0}, {1, 1, 1, alpha}))[0];
    };
    EXPECT_EQ(muxed(0), 1);
    EXPECT_EQ(muxed(127), 1);
    EXPECT_EQ(muxed(128), 2);
    EXPECT_EQ(muxed(255), 2);
}

TEST(Interpreter, SumIsOfUnscaledProducts) {
    ProgramBuilder b;
    b.stage()
        .rgb()
        .ab(mul(in(Register::col0), one()), Register::tex0)
        .cd(mul(in(Register::col0), one()))
        .sum(Register::spare0)
        .scale(Scale::half);
    CombinerProgram p = b.build();
    p.final_combiner = show(Register::spare0);
    // 510 / 2; the sum of the halved products would be 256.
    EXPECT_EQ(run_combiners(p, kNv2a, registers({255, 99, 1, 0})), (Codes{255, 99, 1, 0}));
}

TEST(Interpreter, StageConstantsEndBeforeTheFinalCombiner) {
    ProgramBuilder b;
    b.stage().rgb().ab(mul(in(Register::const0), one()), Register::spare0);
    b.stage().rgb().ab(mul(in(Register::const0), one()), Register::spare1);
    CombinerProgram p = b.build();
    p.const0 = glm::vec4(0.2F);
    p.stages[0].const0 = glm::vec4(0.4F);
    p.final_combiner = show(Register::const0);
    std::vector<RegisterFile> trace;
    EXPECT_EQ(run_combiners(p, kNv2a, {}, &trace), (Codes{51, 51, 51, 51}));
    EXPECT_EQ(trace[2][Register::spare0][0], 102);
    EXPECT_EQ(trace[2][Register::spare1][0], 51);
    EXPECT_EQ(trace[1][Register::const0][0], 102);
}

TEST(Interpreter, ColorSumWithAndWithoutClamp) {  // H7
    CombinerProgram p;
    p.final_combiner.a.reg = Register::const0;
    p.final_combiner.b.reg = Register::color_sum;
    p.const0 = glm::vec4(127.0F / 255);
    ProgramBuilder b;
    b.stage().rgb().ab(mul(in(Register::tex0), one()), Register::spare0);
    p.stages = b.build().stages;
    RegisterFile file;
    file[Register::tex0] = {255, 255, -50, 0};
    file[Register::col1] = {255, -255, 255, 0};
    EXPECT_EQ(run_combiners(p, kNv2a, file), (Codes{254, 127, 127, 0}));
    p.final_combiner.clamp_color_sum = true;
    EXPECT_EQ(run_combiners(p, kNv2a, file), (Codes{127, 127, 127, 0}));
}

TEST(Interpreter, FinalProductAndFog) {  // H8
    CombinerProgram p;
    p.final_combiner.d.reg = Register::final_product;
    p.final_combiner.e.reg = Register::col0;
    p.final_combiner.f = alpha_of(Register::fog, Mapping::unsigned_identity);
    p.final_combiner.g = {Register::fog, Mapping::unsigned_invert, Component::alpha};
    p.fog.a = 127.0F / 255;
    EXPECT_EQ(run_combiners(p, kNv2a, registers({255, 191, 127, 0})), (Codes{127, 95, 63, 128}));
}

TEST(Interpreter, FogBlendRoundsOnce) {  // H10
    CombinerProgram p;
    p.final_combiner.a = alpha_of(Register::fog, Mapping::unsigned_identity);
    p.final_combiner.b = {Register::zero, Mapping::unsigned_invert, Component::rgb};
    p.final_combiner.c.reg = Register::fog;
    p.fog = {48.0F / 255, 32.0F / 255, 127.0F / 255, 1.0F / 255};
    EXPECT_EQ(run_combiners(p, kNv2a, {}), (Codes{49, 33, 128, 0}));
}

TEST(Interpreter, WideRegistersHoldTwoOnlyWherePortionsAllowIt) {
    ProgramBuilder b;
    b.stage().rgb().ab(mul(in(Register::col0), one()), Register::spare0).scale(Scale::four).wide();
    b.stage().rgb().ab(mul(in(Register::spare0), one()), Register::spare1);
    CombinerProgram p = b.build();
    std::vector<RegisterFile> trace;
    run_combiners(p, kIdeal, registers({16384, 5000, -9000, 0}), &trace);
    EXPECT_EQ(trace[1][Register::spare0], (Codes{32767, 20000, -32768, 0}));
    EXPECT_EQ(trace[2][Register::spare1], (Codes{16384, 16384, -16384, 0}));
}

RealRegisters real_registers(const Reals& col0, const Reals& tex0 = {}) {
    RealRegisters file;
    file[Register::col0] = col0;
    file[Register::tex0] = tex0;
    return file;
}

void expect_reals(const Reals& got, const Reals& want) {
    for (std::size_t c = 0; c < 4; ++c) EXPECT_NEAR(got[c], want[c], 1e-15) << "component " << c;
}

TEST(Interpreter, ExactArithmeticRoundsNothing) {
    ProgramBuilder b;
    b.stage()
        .rgb()
        .ab(mul(in(Register::col0), in(Register::tex0)), Register::spare0)
        .scale(Scale::half);
    b.alpha().ab(mul(alpha_of(Register::col0), alpha(one())), Register::spare0).bias();
    CombinerProgram p = b.build();
    p.final_combiner = show(Register::spare0);
    const RealRegisters inputs = real_registers({0.1, 0.7, 1.0, 0.9}, {0.3, 0.9, 0.01, 0.0});
    for (const Machine& machine : {kNv2a, kIdeal}) {
        expect_reals(run_combiners_exactly(p, machine, inputs), {0.015, 0.315, 0.005, 0.4});
    }
}

// 1/2 is 1/2, where the nine-bit machine has 128/255.
TEST(Interpreter, ExactMappings) {
    const double e = 0.3;
    const std::array<double, kMappingCount> want{0.3, 0.7, -0.4, 0.4, -0.2, 0.2, 0.3, -0.3};
    for (int m = 0; m < kMappingCount; ++m) {
        ProgramBuilder b;
        b.stage().rgb().ab(mul({Register::col0, static_cast<Mapping>(m)}, one()), Register::spare0);
        std::vector<RealRegisters> trace;
        run_combiners_exactly(b.build(), kNv2a, real_registers({e, e, e, e}), &trace);
        EXPECT_NEAR(trace[1][Register::spare0][0], want[static_cast<std::size_t>(m)], 1e-15) << m;
    }
}

TEST(Interpreter, ExactDotAndMuxAtOneHalf) {
    ProgramBuilder b;
    b.stage()
        .rgb()
        .ab(dot(in(Register::col0), in(Register::tex0)), Register::spare1)
        .cd(mul(in(Register::tex0), one()))
        .mux(Register::spare0);
    CombinerProgram p = b.build();
    std::vector<RealRegisters> trace;
    RealRegisters inputs = real_registers({0.1, 0.2, 0.3, 1.0}, {0.4, 0.5, 0.6, 0.5});
    run_combiners_exactly(p, kNv2a, inputs, &trace);
    EXPECT_NEAR(trace[1][Register::spare1][1], 0.32, 1e-15);
    EXPECT_EQ(trace[1][Register::spare0][1], 0.5) << "CD from 1/2 on";
    inputs[Register::tex0][3] = 0.4999;
    trace.clear();
    run_combiners_exactly(p, kNv2a, inputs, &trace);
    EXPECT_NEAR(trace[1][Register::spare0][1], 0.32, 1e-15) << "AB below";
}

// The same clamps: outputs at -1 and 1 or, wide, at the register's range; the colour sum at 2.
TEST(Interpreter, ExactClampsAreThoseOfTheMachine) {
    ProgramBuilder b;
    b.stage().rgb().ab(mul(in(Register::col0), one()), Register::spare0).scale(Scale::four);
    CombinerProgram p = b.build();
    p.final_combiner.b.reg = Register::color_sum;
    p.final_combiner.a = {Register::zero, Mapping::unsigned_invert, Component::rgb};
    std::vector<RealRegisters> trace;
    RealRegisters inputs = real_registers({0.9, -0.9, 0.2, 0.0});
    inputs[Register::col1] = {1.0, 0.25, 0.75, 0.0};
    expect_reals(run_combiners_exactly(p, kNv2a, inputs, &trace), {1.0, 0.25, 1.0, 0.0});
    expect_reals(trace[1][Register::spare0], {1.0, -1.0, 0.8, 0.0});
    expect_reals(trace[2][Register::color_sum], {2.0, 0.25, 1.55, 0.0});
    p.stages[0].rgb.wide = true;
    trace.clear();
    run_combiners_exactly(p, kIdeal, inputs, &trace);
    expect_reals(trace[1][Register::spare0], {32767.0 / 16384, -2.0, 0.8, 0.0});
    expect_reals(trace[2][Register::color_sum], {32767.0 / 16384, 0.25, 1.55, 0.0});
    p.final_combiner.clamp_color_sum = true;
    trace.clear();
    run_combiners_exactly(p, kIdeal, inputs, &trace);
    expect_reals(trace[2][Register::color_sum], {1.0, 0.25, 1.0, 0.0});
}

}  // namespace
}  // namespace burnish
