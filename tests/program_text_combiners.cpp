#include <burnish/error.hpp>

#include "program_text.hpp"

/// What combiner programs mean: defaults, mappings, the forms of each statement.
namespace burnish {
namespace {

using namespace combine;

constexpr Input kUnsignedZero{Register::zero, Mapping::unsigned_identity, Component::rgb};
constexpr Input kOne{Register::zero, Mapping::unsigned_invert, Component::rgb};

TEST(ProgramText, NoGeneralStageGivesAnIdleOne) {
    const CombinerProgram program = combiners("!!RC1.0");
    ASSERT_EQ(program.stages.size(), 1U);
    EXPECT_EQ(program.stages[0], idle_stage());
    EXPECT_EQ(program.final_combiner, FinalCombiner());
}

TEST(ProgramText, GlobalConstants) {
    const CombinerProgram program =
        combiners("!!RC1.0 const1 = (0.1, 0.2, 0.3, 0.4); const0 = (1, 0, 1, 0.5);");
    EXPECT_EQ(program.const0, glm::vec4(1.0F, 0.0F, 1.0F, 0.5F));
    EXPECT_EQ(program.const1, glm::vec4(0.1F, 0.2F, 0.3F, 0.4F));
}

TEST(ProgramText, LocalConstantsBelongToTheirStage) {
    const CombinerProgram program = combiners(
        "!!RC1.0 const0 = (1, 1, 1, 1);"
        "{ const1 = (0.5, 0, 0, 1); rgb { spare0 = const0; } } { rgb { spare0 = const1; } }");
    EXPECT_EQ(program.stages[0].const1, glm::vec4(0.5F, 0.0F, 0.0F, 1.0F));
    EXPECT_FALSE(program.stages[0].const0) << "the global one";
    EXPECT_FALSE(program.stages[1].const1);
    EXPECT_NO_THROW(program.validate(machine_profile("nv2a")));
    EXPECT_THROW(program.validate(machine_profile("geforce256")), Error);
}

TEST(ProgramText, ConstantsKeepEveryBitOfAFloat) {
    EXPECT_EQ(combiners("!!RC1.0 const0 = (0.1, 0.333333343, 0.0000001, 1);").const0,
              glm::vec4(0.1F, 1.0F / 3.0F, 1e-7F, 1.0F));
}

TEST(ProgramText, MappingsOfGeneralInputs) {
    const auto mapping = [](const std::string& input) {
        return rgb("spare0 = " + input + ";").a.mapping;
    };
    EXPECT_EQ(mapping("tex0"), Mapping::signed_identity);
    EXPECT_EQ(mapping("-tex0"), Mapping::signed_negate);
    EXPECT_EQ(mapping("unsigned(tex0)"), Mapping::unsigned_identity);
    EXPECT_EQ(mapping("unsigned_invert(tex0)"), Mapping::unsigned_invert);
    EXPECT_EQ(mapping("expand(tex0)"), Mapping::expand);
    EXPECT_EQ(mapping("-expand(tex0)"), Mapping::expand_negate);
    EXPECT_EQ(mapping("half_bias(tex0)"), Mapping::half_bias);
    EXPECT_EQ(mapping("-half_bias(tex0)"), Mapping::half_bias_negate);
}

TEST(ProgramText, OneIsZeroBehindAnotherMapping) {
    const auto one = [](const std::string& input) { return rgb("spare0 = " + input + ";").a; };
    EXPECT_EQ(one("one"), kOne);
    EXPECT_EQ(one("unsigned(one)"), kOne);
    EXPECT_EQ(one("expand(one)"), kOne);
    EXPECT_EQ(one("-one").mapping, Mapping::expand);
    EXPECT_EQ(one("-expand(one)").mapping, Mapping::expand);
    EXPECT_EQ(one("unsigned_invert(one)").mapping, Mapping::unsigned_identity);
    EXPECT_EQ(one("half_bias(one)").mapping, Mapping::half_bias_negate);
    EXPECT_EQ(one("-half_bias(one)").mapping, Mapping::half_bias);
    EXPECT_EQ(one("-one").reg, Register::zero);
    EXPECT_EQ(final_combiner("out.rgb = one;").d, kOne);
    EXPECT_EQ(final_combiner("out.rgb = unsigned_invert(one);").d, kUnsignedZero);
}

TEST(ProgramText, EveryRegisterIsKnown) {
    for (const char* name : {"zero", "const0", "const1", "fog", "col0", "col1", "spare0", "spare1",
                             "tex0", "tex1", "tex2", "tex3"})
        EXPECT_EQ(register_name(rgb("discard = " + std::string(name) + ";").a.reg), name);
    for (const char* name :
         {"col0", "col1", "spare0", "spare1", "tex0", "tex1", "tex2", "tex3", "discard"})
        EXPECT_EQ(register_name(rgb(std::string(name) + " = zero;").ab_out), name);
}

TEST(ProgramText, ComponentsByDefaultAndByName) {
    EXPECT_EQ(rgb("spare0 = tex0;").a.component, Component::rgb);
    EXPECT_EQ(rgb("spare0 = tex0.rgb;").a.component, Component::rgb);
    EXPECT_EQ(rgb("spare0 = tex0.a;").a.component, Component::alpha);
    EXPECT_EQ(alpha("spare0 = tex0;").a.component, Component::alpha);
    EXPECT_EQ(alpha("spare0 = tex0.a;").a.component, Component::alpha);
    EXPECT_EQ(alpha("spare0 = expand(tex0.b);").a.component, Component::blue);
    EXPECT_EQ(final_combiner("out.rgb = tex0;").d.component, Component::rgb);
    EXPECT_EQ(final_combiner("out.rgb = fog.a;").d.component, Component::alpha);
    EXPECT_EQ(final_combiner("out.a = tex0;").g.component, Component::alpha);
    EXPECT_EQ(final_combiner("out.a = tex0.b;").g.component, Component::blue);
    EXPECT_EQ(alpha("spare0 = fog.b;").a, blue(in(Register::fog)));
}

TEST(ProgramText, ZeroIsTheSameInEveryComponent) {
    EXPECT_EQ(rgb("spare0 = zero.a * one.a;"), rgb("spare0 = zero;"));
    EXPECT_EQ(alpha("spare0 = zero.b;"), alpha("spare0 = zero;"));
    EXPECT_EQ(final_combiner("out.rgb = one.a; out.a = zero.b;"), final_combiner("out.rgb = one;"));
    expect_combiner_error("!!RC1.0 { rgb { spare0 = @zero.b; } }", "component .b of zero");
}

TEST(ProgramText, DestinationsMayCarryTheirComponent) {
    EXPECT_EQ(rgb("spare0.rgb = tex0;"), rgb("spare0 = tex0;"));
    EXPECT_EQ(alpha("spare0.a = tex0;"), alpha("spare0 = tex0;"));
}

TEST(ProgramText, OneProduct) {
    const Portion m = rgb("spare0 = tex0 * col0;");
    EXPECT_EQ(m.a, in(tex(0)));
    EXPECT_EQ(m.b, in(Register::col0));
    EXPECT_EQ(m.ab_product, Product::multiply);
    EXPECT_EQ(m.ab_out, Register::spare0);
    EXPECT_EQ(m.cd_out, Register::discard);
    const Portion d = rgb("spare1 = tex0 . col0;");
    EXPECT_EQ(d.ab_product, Product::dot);
    EXPECT_EQ(d.ab_out, Register::spare1);
}

TEST(ProgramText, OneInputMeansTimesOne) {
    EXPECT_EQ(rgb("spare0 = tex0;"), rgb("spare0 = tex0 * one;"));
    EXPECT_EQ(alpha("spare0 = tex0.b;"), alpha("spare0 = tex0.b * one;"));
}

TEST(ProgramText, TwoProductsInOrder) {
    const Portion p = rgb("spare0 = tex0 . col0; spare1 = tex1 * col1;");
    EXPECT_EQ(p.a, in(tex(0)));
    EXPECT_EQ(p.c, in(tex(1)));
    EXPECT_EQ(p.d, in(Register::col1));
    EXPECT_EQ(p.ab_product, Product::dot);
    EXPECT_EQ(p.cd_product, Product::multiply);
    EXPECT_EQ(p.cd_out, Register::spare1);
    EXPECT_EQ(rgb("discard = tex0 * col0; spare1 = tex1 . col1;").cd_product, Product::dot);
    EXPECT_EQ(rgb("discard = tex0 . col0; spare1 = tex1 . col1;").ab_product, Product::dot);
}

TEST(ProgramText, SumAndMux) {
    const Portion sum = rgb("discard = tex0; discard = tex1; spare0 = sum();");
    EXPECT_EQ(sum.third, Third::sum);
    EXPECT_EQ(sum.third_out, Register::spare0);
    const Portion mux = alpha("spare1 = tex0; discard = tex1; col0 = mux();");
    EXPECT_EQ(mux.third, Third::mux);
    EXPECT_EQ(mux.third_out, Register::col0);
    EXPECT_EQ(mux.ab_out, Register::spare1);
}

TEST(ProgramText, ScaleAndBias) {
    const auto scaled = [](const std::string& word) {
        const Portion p = rgb("spare0 = tex0; " + word);
        return std::pair(p.scale, p.bias_minus_half);
    };
    EXPECT_EQ(scaled(""), std::pair(Scale::one, false));
    EXPECT_EQ(scaled("scale_by_one_half();"), std::pair(Scale::half, false));
    EXPECT_EQ(scaled("scale_by_two();"), std::pair(Scale::two, false));
    EXPECT_EQ(scaled("scale_by_four();"), std::pair(Scale::four, false));
    EXPECT_EQ(scaled("bias_by_negative_one_half();"), std::pair(Scale::one, true));
    EXPECT_EQ(scaled("bias_by_negative_one_half_scale_by_two();"), std::pair(Scale::two, true));
}

TEST(ProgramText, PortionsInEitherOrder) {
    EXPECT_EQ(stage("alpha { spare0 = tex0; } rgb { spare1 = tex1; }"),
              stage("rgb { spare1 = tex1; } alpha { spare0 = tex0; }"));
    EXPECT_EQ(stage("rgb { spare0 = tex0; }").alpha, idle_stage().alpha);
    EXPECT_EQ(stage("alpha { spare0 = tex0; }").rgb, idle_stage().rgb);
}

TEST(ProgramText, EightStages) {
    std::string text = "!!RC1.0 ";
    for (int i = 0; i < 8; ++i) text += "{ rgb { spare0 = spare0; } }\n";
    EXPECT_EQ(combiners(text).stages.size(), 8U);
    expect_combiner_error(text + "@{ rgb { spare0 = spare0; } } { rgb { spare0 = spare0; } }",
                          "general stage number 9, !!RC1.0 has at most 8");
}

TEST(ProgramText, TheGeForce256HasTwoStages) {
    const std::string stage = "{ rgb { spare0 = spare0; } }";
    const Machine machine = machine_profile("geforce256");
    EXPECT_NO_THROW(combiners("!!RC1.0" + stage + stage).validate(machine));
    EXPECT_THROW(combiners("!!RC1.0" + stage + stage + stage).validate(machine), Error);
}

TEST(ProgramTextFinal, MissingOutputsAreZero) {
    EXPECT_EQ(final_combiner("out.a = tex0;").d, kUnsignedZero);
    EXPECT_EQ(final_combiner("out.rgb = tex0;").g,
              (Input{Register::zero, Mapping::unsigned_identity, Component::alpha}));
}

TEST(ProgramTextFinal, MappingsAreUnsigned) {
    EXPECT_EQ(final_combiner("out.rgb = tex0;").d, raw(tex(0)));
    EXPECT_EQ(final_combiner("out.rgb = unsigned(tex0);").d, raw(tex(0)));
    EXPECT_EQ(final_combiner("out.rgb = unsigned_invert(tex0);").d, invert(tex(0)));
}

TEST(ProgramTextFinal, LerpHasTheWeightFirst) {
    const FinalCombiner f = final_combiner("out.rgb = lerp(tex0.a, tex1, tex2);");
    EXPECT_EQ(f.a, alpha(raw(tex(0))));
    EXPECT_EQ(f.b, raw(tex(1)));
    EXPECT_EQ(f.c, raw(tex(2)));
    EXPECT_EQ(f.d, kUnsignedZero);
}

TEST(ProgramTextFinal, LerpWithASummandOnEitherSide) {
    const FinalCombiner f = final_combiner("out.rgb = lerp(tex0, tex1, tex2) + color_sum;");
    EXPECT_EQ(f.d, raw(Register::color_sum));
    EXPECT_EQ(final_combiner("out.rgb = color_sum + lerp(tex0, tex1, tex2);"), f);
}

TEST(ProgramTextFinal, ProductWithAndWithoutASummand) {
    const FinalCombiner f = final_combiner("out.rgb = tex0 * col0;");
    EXPECT_EQ(f.a, raw(tex(0)));
    EXPECT_EQ(f.b, raw(Register::col0));
    EXPECT_EQ(f.c, kUnsignedZero);
    EXPECT_EQ(f.d, kUnsignedZero);
    EXPECT_EQ(final_combiner("out.rgb = tex0 * col0 + col1;").d, raw(Register::col1));
}

TEST(ProgramTextFinal, OneRegisterGoesToD) {
    const FinalCombiner f = final_combiner("out.rgb = spare0;");
    EXPECT_EQ(f.a, kUnsignedZero);
    EXPECT_EQ(f.b, kUnsignedZero);
    EXPECT_EQ(f.c, kUnsignedZero);
    EXPECT_EQ(f.d, raw(Register::spare0));
}

TEST(ProgramTextFinal, SumIsTimesOne) {
    const FinalCombiner f = final_combiner("out.rgb = tex0 + tex1;");
    EXPECT_EQ(f.a, raw(tex(0)));
    EXPECT_EQ(f.b, kOne);
    EXPECT_EQ(f.c, kUnsignedZero);
    EXPECT_EQ(f.d, raw(tex(1)));
}

TEST(ProgramTextFinal, TheColorSumIsMovedOutOfA) {
    for (const char* text : {"out.rgb = color_sum + tex0;", "out.rgb = color_sum * tex0;",
                             "out.rgb = color_sum + color_sum;"}) {
        const FinalCombiner f = final_combiner(text);
        EXPECT_NE(f.a.reg, Register::color_sum) << text;
        EXPECT_EQ(f.b, raw(Register::color_sum)) << text;
    }
    EXPECT_EQ(final_combiner("out.rgb = color_sum + tex0;").a, kOne);
    EXPECT_EQ(final_combiner("out.rgb = color_sum * tex0;").a, raw(tex(0)));
    EXPECT_EQ(final_combiner("out.rgb = tex0 + color_sum;").d, raw(Register::color_sum));
}

TEST(ProgramTextFinal, FinalProductIsETimesF) {
    const FinalCombiner f = final_combiner(
        "final_product = tex0 * unsigned_invert(fog.a); out.rgb = final_product * tex1;");
    EXPECT_EQ(f.e, raw(tex(0)));
    EXPECT_EQ(f.f, alpha(invert(Register::fog)));
    EXPECT_EQ(f.a, raw(Register::final_product));
    EXPECT_EQ(final_combiner("final_product = tex0 * tex1; out.rgb = lerp(final_product, "
                             "final_product, color_sum) + final_product;")
                  .d,
              raw(Register::final_product));
}

TEST(ProgramTextFinal, TheColorSumIsClampedOnRequest) {
    EXPECT_FALSE(final_combiner("out.rgb = color_sum;").clamp_color_sum);
    EXPECT_TRUE(final_combiner("clamp_color_sum(); out.rgb = color_sum;").clamp_color_sum);
}

TEST(ProgramTextFinal, StatementsInEitherOrder) {
    EXPECT_EQ(final_combiner("clamp_color_sum(); final_product = tex0 * tex1; out.a = tex0; "
                             "out.rgb = tex1;"),
              final_combiner("final_product = tex0 * tex1; clamp_color_sum(); out.rgb = tex1; "
                             "out.a = tex0;"));
}

}  // namespace
}  // namespace burnish
