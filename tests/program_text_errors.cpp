#include "program_text.hpp"

/// What is wrong with combiner programs: each error once, with its place.
namespace burnish {
namespace {

std::string in_rgb(const std::string& body) {
    return "!!RC1.0\n{\n  rgb {\n    " + body + "\n  }\n}\n";
}
std::string in_alpha(const std::string& body) {
    return "!!RC1.0\n{\n  alpha {\n    " + body + "\n  }\n}\n";
}

TEST(ProgramTextErrors, ConstantsAreSetOncePerScope) {
    expect_combiner_error("!!RC1.0\nconst0 = (1, 1, 1, 1);\n@const0 = (1, 1, 1, 1);",
                          "const0 is set twice");
    expect_combiner_error(
        "!!RC1.0 { const1 = (1, 1, 1, 1);\n  @const1 = (0, 0, 0, 0); rgb { spare0 = tex0; } }",
        "const1 is set twice");
    EXPECT_EQ(combiners("!!RC1.0 const0 = (0, 0, 0, 1);"
                        "{ const0 = (1, 0, 0, 1); rgb { spare0 = tex0; } }")
                  .stages[0]
                  .const0,
              glm::vec4(1.0F, 0.0F, 0.0F, 1.0F));
}

TEST(ProgramTextErrors, ConstantsLieBetweenZeroAndOne) {
    expect_combiner_error("!!RC1.0 const0 = (0, @1.5, 0, 0);",
                          "a component of const0 is 1.5, expected 0 .. 1");
    expect_combiner_error("!!RC1.0 const0 = (@-0.5, 0, 0, 0);", "is -0.5, expected 0 .. 1");
    expect_combiner_error("!!RC1.0 { const1 = (0, 0, 0, @2); rgb { spare0 = tex0; } }",
                          "a component of const1 is 2");
    expect_combiner_error("!!RC1.0 const0 = (0, @1" + std::string(400, '0') + ", 0, 0);",
                          "too large");
    EXPECT_EQ(combiners("!!RC1.0 const0 = (0." + std::string(400, '0') + "1, 0, 0, 0);").const0,
              glm::vec4(0.0F));
}

TEST(ProgramTextErrors, APortionIsDeclaredOncePerStage) {
    expect_combiner_error("!!RC1.0 { rgb { spare0 = tex0; }\n  @rgb { spare1 = tex0; } }",
                          "a second rgb portion");
    expect_combiner_error("!!RC1.0 { alpha { spare0 = tex0; } @alpha { spare1 = tex0; } }",
                          "a second alpha portion");
}

TEST(ProgramTextErrors, ReadOnlyRegistersAreNotWritten) {
    for (const char* name :
         {"zero", "one", "const0", "const1", "fog", "color_sum", "final_product"})
        expect_combiner_error(in_rgb(std::string("@") + name + " = tex0;"),
                              std::string(name) + " is written, it is read-only");
}

TEST(ProgramTextErrors, ARegisterIsWrittenOncePerPortion) {
    // The second stage of the comparison of two alphas, with one name too many.
    expect_combiner_error(in_alpha("discard = -half_bias(zero);\n"
                                   "    spare0 = spare0;\n"
                                   "    @spare0 = sum();"),
                          "spare0 is written twice in one portion");
    expect_combiner_error(in_rgb("spare0 = tex0; @spare0 = tex1;"), "written twice");
    EXPECT_EQ(stage("rgb { spare0 = tex0; } alpha { spare0 = tex0; }").alpha.ab_out,
              Register::spare0);
}

TEST(ProgramTextErrors, NoDotInAlphaPortions) {
    expect_combiner_error(in_alpha("spare0 = tex0 @. tex1;"), "a dot product in an alpha portion");
}

TEST(ProgramTextErrors, DiscardIsNotRead) {
    expect_combiner_error(in_rgb("spare0 = tex0 * @discard;"), "discard is read");
    expect_combiner_error("!!RC1.0 out.rgb = @discard;", "discard is read");
}

TEST(ProgramTextErrors, FinalOnlyRegisters) {
    expect_combiner_error(in_rgb("spare0 = @fog.a;"), "the alpha of fog in a general stage");
    expect_combiner_error(in_alpha("spare0 = @fog;"), "the alpha of fog in a general stage");
    expect_combiner_error(in_rgb("spare0 = @color_sum;"), "color_sum in a general stage");
    expect_combiner_error(in_alpha("spare0 = @final_product;"), "final_product in a general stage");
}

TEST(ProgramTextErrors, ComponentsFitTheirPlace) {
    expect_combiner_error(in_rgb("spare0 = expand(@tex0.b);"),
                          "component .b of tex0 in an rgb portion, expected .rgb or .a");
    expect_combiner_error(in_alpha("spare0 = @tex0.rgb;"),
                          "component .rgb of tex0 in an alpha portion, expected .a or .b");
    expect_combiner_error("!!RC1.0 out.rgb = @tex0.b;", "component .b of tex0");
    expect_combiner_error("!!RC1.0 out.a = @tex0.rgb;", "component .rgb of tex0 in out.a");
    expect_combiner_error(in_rgb("spare0 = @tex0.r;"), "component .r of tex0");
    expect_combiner_error(in_alpha("spare0 = @tex0.g;"), "component .g of tex0");
    expect_combiner_error(in_rgb("@spare0.a = tex0;"), "component .a written in an rgb portion");
    expect_combiner_error(in_alpha("@spare0.rgb = tex0;"), "component .rgb written in an alpha");
    expect_combiner_error("!!RC1.0 @out.b = tex0;", "found 'out.b', expected out.rgb or out.a");
    expect_combiner_error("!!RC1.0 @out = tex0;", "found 'out', expected out.rgb or out.a");
}

TEST(ProgramTextErrors, FinalProductIsSetBeforeItIsUsed) {
    expect_combiner_error("!!RC1.0\nout.rgb = tex0 * @final_product;\nout.a = tex0;",
                          "final_product is used but never set");
    expect_combiner_error("!!RC1.0 out.rgb = tex0; @final_product = tex0 * tex1;",
                          "'final_product' comes too late, expected it in front of out.rgb");
}

TEST(ProgramTextErrors, FinalProductHasTwoOrdinaryFactors) {
    expect_combiner_error("!!RC1.0 final_product = tex0 * @final_product;", "refers to itself");
    expect_combiner_error("!!RC1.0 final_product = @color_sum * tex0;",
                          "color_sum in final_product");
    expect_combiner_error("!!RC1.0 final_product = tex0@;", "found ';', expected '*'");
    expect_combiner_error("!!RC1.0 final_product = tex0 * tex1;\n@final_product = tex0 * tex1;",
                          "a second 'final_product'");
}

TEST(ProgramTextErrors, TheColorSumHasItsPlaces) {
    expect_combiner_error("!!RC1.0 out.rgb = lerp(@color_sum, tex0, tex1);",
                          "color_sum as the weight of lerp");
    expect_combiner_error("!!RC1.0 out.rgb = color_sum * @color_sum;", "color_sum times color_sum");
    expect_combiner_error("!!RC1.0 out.a = @color_sum;", "color_sum as alpha");
    expect_combiner_error("!!RC1.0 out.rgb = @color_sum.a;", "color_sum as alpha");
    expect_combiner_error("!!RC1.0 final_product = tex0 * tex1; out.a = @final_product;",
                          "final_product as alpha");
    expect_combiner_error("!!RC1.0 clamp_color_sum(); @clamp_color_sum();",
                          "a second 'clamp_color_sum'");
}

TEST(ProgramTextErrors, MappingsThatAPlaceDoesNotHave) {
    expect_combiner_error(in_rgb("spare0 = @-unsigned(tex0);"), "minus in front of unsigned");
    expect_combiner_error(in_rgb("spare0 = @-unsigned_invert(tex0);"),
                          "minus in front of unsigned_invert");
    expect_combiner_error("!!RC1.0 out.rgb = @expand(tex0);", "expand in the final combiner");
    expect_combiner_error("!!RC1.0 out.a = @half_bias(tex0);", "half_bias in the final combiner");
    expect_combiner_error("!!RC1.0 out.rgb = @-tex0;", "minus in the final combiner");
    expect_combiner_error("!!RC1.0 out.rgb = tex0 * @-one;", "-one needs expand(zero)");
}

TEST(ProgramTextErrors, SequencesOfOperations) {
    expect_combiner_error(in_rgb("spare0 = tex0; spare1 = @sum();"),
                          "sum() after 1 product, expected two of them");
    expect_combiner_error(in_rgb("spare1 = @mux();"), "mux() after 0 products");
    expect_combiner_error(in_rgb("spare0 = tex0; spare1 = tex1; col0 = @tex2;"),
                          "'tex2' begins a third product, expected mux() or sum()");
    expect_combiner_error(in_rgb("spare0 = tex0; spare1 = tex1; col0 = sum(); @col1 = tex0;"),
                          "'col1' begins a fourth operation");
    expect_combiner_error(in_rgb("@scale_by_two(); spare0 = tex0;"),
                          "'scale_by_two' in front of the operations");
    expect_combiner_error(in_rgb("spare0 = tex0; scale_by_two(); @scale_by_four();"),
                          "a second scale");
    expect_combiner_error(in_rgb("spare0 = tex0; scale_by_two(); @spare1 = tex0;"),
                          "'spare1' after the scale");
    expect_combiner_error("!!RC1.0 { rgb { @} }", "a portion without operations");
    expect_combiner_error("!!RC1.0 { @}", "a stage without portions");
}

TEST(ProgramTextErrors, ThePartsHaveAnOrder) {
    expect_combiner_error("!!RC1.0 { rgb { spare0 = tex0; } } @const0 = (1, 1, 1, 1);",
                          "'const0' comes too late, expected it in front of the general stages");
    expect_combiner_error("!!RC1.0 out.rgb = tex0; @{ rgb { spare0 = tex0; } }",
                          "'{' comes too late, expected it in front of the final combiner");
    expect_combiner_error("!!RC1.0 out.rgb = tex0; @clamp_color_sum();", "comes too late");
    expect_combiner_error("!!RC1.0 { rgb { spare0 = tex0; } @const0 = (1, 1, 1, 1); }",
                          "const0 after a portion");
    expect_combiner_error("!!RC1.0 out.rgb = tex0; @out.rgb = tex1;", "a second 'out.rgb'");
    expect_combiner_error("!!RC1.0 out.a = tex0; @out.a = tex1;", "a second 'out.a'");
}

TEST(ProgramTextErrors, SyntaxErrorsNameTheTokenAndTheExpectation) {
    expect_combiner_error(in_rgb("spare0 @tex0;"), "found 'tex0', expected '='");
    expect_combiner_error(in_rgb("spare0 = tex0 @+ tex1;"), "found '+', expected '*', '.' or ';'");
    expect_combiner_error(in_alpha("spare0 = tex0 @+ tex1;"), "found '+', expected '*' or ';'");
    expect_combiner_error(in_rgb("spare0 = expand @tex0;"), "found 'tex0', expected '('");
    expect_combiner_error(in_rgb("spare0 = expand(tex0@;"), "found ';', expected ')'");
    expect_combiner_error(in_rgb("spare0 = @lerp;"), "found 'lerp', expected a register");
    expect_combiner_error(in_rgb("discard = tex0; discard = tex1; spare0 = sum@;"),
                          "found ';', expected '('");
    expect_combiner_error("!!RC1.0 @spare0 = tex0;", "found 'spare0', expected const0");
    expect_combiner_error("!!RC1.0 @}", "found '}', expected const0");
    expect_combiner_error("!!RC1.0 out.rgb = lerp(tex0, tex1@);", "found ')', expected ','");
    expect_combiner_error("!!RC1.0 { rgb { spare0 = tex0;\n@",
                          "found the end of the text, expected '}'");
    expect_combiner_error("!!RC1.0 out.rgb = tex0@", "found the end of the text, expected ';'");
}

TEST(ProgramTextErrors, UnrecognizedWordsSuggestTheNearest) {
    expect_combiner_error("!!RC1.0 { @rbg { spare0 = tex0; } }",
                          "unrecognized token 'rbg', did you mean 'rgb'?");
    expect_combiner_error(in_rgb("spare0 = @texo;"), "did you mean 'tex0'?");
    expect_combiner_error(in_rgb("spare0 = @xyzzy;"),
                          "unrecognized token 'xyzzy', expected a register");
    expect_combiner_error("!!RC1.0 @clamp_colour_sum();", "did you mean 'clamp_color_sum'?");
}

TEST(ProgramTextErrors, ParsingGoesOn) {
    const auto parsed = parse_combiners(
        "!!RC1.0\n"
        "const0 = (1, 2, 3, 4);\n"
        "{ rgb { spare0 = xyz; spare1 = tex0.b;\n"
        "        tex0 = sum()\n"
        "        scale_by_two(); } }\n"
        "out.rgb = -tex0;\n"
        "out.a = color_sum;\n");
    EXPECT_EQ(listed(parsed.errors),
              "2:14: a component of const0 is 2, expected 0 .. 1\n"
              "2:17: a component of const0 is 3, expected 0 .. 1\n"
              "2:20: a component of const0 is 4, expected 0 .. 1\n"
              "3:18: unrecognized token 'xyz', expected a register\n"
              "3:32: component .b of tex0 in an rgb portion, expected .rgb or .a\n"
              "5:9: found 'scale_by_two', expected ';' in front of it\n"
              "6:11: minus in the final combiner, expected a register, unsigned or "
              "unsigned_invert\n"
              "7:9: color_sum as alpha, it has only rgb\n");
}

/// A right text with '@' in front of what the machine lacks: validate() names the part that has its
/// line.
void expect_fault(std::string text, const Machine& machine, std::string_view part) {
    const std::size_t at = text.find('@');
    text.erase(at, 1);
    const auto before = text.begin() + static_cast<std::ptrdiff_t>(at);
    const auto line = static_cast<std::size_t>(std::count(text.begin(), before, '\n')) + 1;
    const Parsed<CombinerProgram> parsed = parse_combiners(text);
    ASSERT_TRUE(parsed.program) << text << "\n" << listed(parsed.errors);
    try {
        parsed.program->validate(machine);
        ADD_FAILURE() << text;
    } catch (const ProgramFault& fault) {
        EXPECT_EQ(line_of(fault.place(), parsed.lines), line) << text << "\n" << fault.what();
        EXPECT_NE(std::string_view(fault.what()).find(part), std::string_view::npos)
            << fault.what();
    }
}

TEST(ProgramTextErrors, WhatAMachineLacksHasALine) {
    const Machine old = machine_profile("geforce256"), nv2a = machine_profile("nv2a");
    Machine small = machine_profile("ideal");
    small.texture_units = 8;
    const std::string idle = "{ rgb { spare0 = zero; } }\n";
    expect_fault("!!RC1.0\n" + idle + idle + "\n@" + idle, old, "3 general stages");
    expect_fault("!!RC1.0\n" + idle + "{\n@const1 = (0, 0, 0, 1);\nrgb { spare0 = const1; } }\n",
                 old, "stage 1: has constants of its own");
    expect_fault("!!BRN1.0\n{ alpha { spare0 = zero; }\n @wide rgb { spare0 = zero; } }\n", nv2a,
                 "stage 0, rgb: wide");
    expect_fault("!!BRN1.0\n@fetch { tex1 = table_1d(tex0.r); }\n" + idle, nv2a, "stage 0, fetch");
    expect_fault("!!BRN1.0\nfetch {\ntex1 = table_1d(tex0.r);\n}\n" + idle +
                     "fetch { tex2 = table_1d(tex0.r);\n@tex9 = table_1d(tex8.r); }\n" + idle,
                 small, "stage 1, fetch: writes tex9");
    expect_fault(in_rgb("discard = tex0;\n@discard = tex3;\nspare0 = sum();"), old, "reads tex3");
    expect_fault(in_rgb("discard = tex0;\ndiscard = tex1;\n@tex3 = sum();"), old, "writes tex3");
    expect_fault(in_alpha("spare0 = zero;\n@spare1 = tex2.a;"), old, "reads tex2");
    expect_fault("!!RC1.0\n" + idle + "final_product = tex0\n* tex0;\n@out.rgb = tex2;\n", old,
                 "final combiner: reads tex2");
    expect_fault("!!RC1.0\n@final_product = tex0 * tex2;\nout.rgb = final_product;\n", old,
                 "final combiner: reads tex2");
    expect_fault("!!RC1.0\nout.rgb = tex0;\n@out.a = tex2;\n", old, "final combiner: reads tex2");
}

TEST(ProgramTextErrors, ThirtyTwoAreEnough) {
    std::string text = "!!RC1.0\n";
    for (int i = 0; i < 100; ++i) text += "foo;\n";
    const auto parsed = parse_combiners(text);
    ASSERT_EQ(parsed.errors.size(), kMaxTextErrors);
    EXPECT_EQ(kMaxTextErrors, 32U);
    EXPECT_EQ(parsed.errors.back().line, 33U);
    EXPECT_FALSE(parsed.program);
}

}  // namespace
}  // namespace burnish
