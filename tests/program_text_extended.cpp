#include <burnish/error.hpp>

#include "machine/bind.hpp"
#include "machine/interpreter.hpp"
#include "program_text.hpp"

/// What !!BRN1.0 has beyond !!RC1.0.
namespace burnish {
namespace {

TEST(ProgramTextExtended, SixteenTextureRegisters) {
    const CombinerProgram program =
        combiners("!!BRN1.0 { rgb { tex15 = tex4; } } out.rgb = tex12;");
    EXPECT_EQ(program.stages[0].rgb.ab_out, tex(15));
    EXPECT_EQ(program.stages[0].rgb.a.reg, tex(4));
    EXPECT_EQ(program.final_combiner.d.reg, tex(12));
    expect_combiner_error("!!RC1.0 out.rgb = @tex4;", "'tex4' in !!RC1.0, which has tex0 .. tex3");
    expect_combiner_error("!!BRN1.0 out.rgb = @tex16;", "unrecognized token 'tex16'");
}

TEST(ProgramTextExtended, SixteenStages) {
    std::string text = "!!BRN1.0 ";
    for (int i = 0; i < 16; ++i) text += "{ alpha { spare0 = spare0; } }\n";
    EXPECT_EQ(combiners(text).stages.size(), 16U);
    expect_combiner_error(text + " @{ rgb { spare0 = spare0; } }", "at most 16");
    expect_combiner_error(text + " @fetch { tex0 = table_1d(col0.r); }", "at most 16");
}

TEST(ProgramTextExtended, WidePortions) {
    const CombinerProgram program =
        combiners("!!BRN1.0 { wide rgb { spare0 = tex0; } alpha { spare0 = tex0; } }");
    EXPECT_TRUE(program.stages[0].rgb.wide);
    EXPECT_FALSE(program.stages[0].alpha.wide);
    expect_combiner_error("!!RC1.0 { @wide rgb { spare0 = tex0; } }", "it is a word of !!BRN1.0");
    expect_combiner_error("!!BRN1.0 { wide @const0 = (1, 1, 1, 1); rgb { spare0 = tex0; } }",
                          "found 'const0', expected rgb or alpha");
}

TEST(ProgramTextExtended, DotProductsMayBeSummed) {
    const std::string stage = "{ rgb { discard = tex0 . tex1; discard = tex2; spare0 = ";
    EXPECT_EQ(combiners("!!BRN1.0 " + stage + "sum(); } }").stages[0].rgb.third_out,
              Register::spare0);
    expect_combiner_error("!!RC1.0 " + stage + "@sum(); } }", "sum() of a dot product");
    expect_combiner_error("!!RC1.0 " + stage + "@mux(); } }", "mux() of a dot product");
}

TEST(ProgramTextExtended, FetchesStandBeforeTheirStage) {
    const CombinerProgram program = combiners(
        "!!BRN1.0 { rgb { spare0 = tex0; } }\n"
        "fetch { tex4 = table_2d(spare0.r, expand(spare0.a)); tex5 = table_3d(tex4.r, tex4.g, "
        "tex4.b); } { rgb { spare0 = tex5; } }");
    ASSERT_EQ(program.stages.size(), 2U);
    EXPECT_TRUE(program.stages[0].fetches.empty());
    const StageFetch first{tex(4),
                           FetchTarget::table_2d,
                           {{{Register::spare0, 0, false}, {Register::spare0, 3, true}, {}}}};
    const StageFetch second{tex(5),
                            FetchTarget::table_3d,
                            {{{tex(4), 0, false}, {tex(4), 1, false}, {tex(4), 2, false}}}};
    EXPECT_EQ(program.stages[1].fetches, (std::vector{first, second}));
}

TEST(ProgramTextExtended, FetchesFromEveryTarget) {
    const auto target = [](const std::string& call) {
        return combiners("!!BRN1.0 fetch { tex0 = " + call + "; }").stages[0].fetches[0].target;
    };
    EXPECT_EQ(target("table_1d(col0.r)"), FetchTarget::table_1d);
    EXPECT_EQ(target("table_2d(col0.r, col0.g)"), FetchTarget::table_2d);
    EXPECT_EQ(target("table_3d(col0.r, col0.g, col0.b)"), FetchTarget::table_3d);
    EXPECT_EQ(target("table_cube_map(col0.r, col0.g, col0.b)"), FetchTarget::table_cube_map);
    EXPECT_EQ(target("table_rectangle(col0.r, col0.g)"), FetchTarget::table_rectangle);
}

TEST(ProgramTextExtended, TrailingFetchesGetAStage) {
    const CombinerProgram program = combiners(
        "!!BRN1.0 { rgb { spare0 = tex0; } } fetch { tex1 = table_1d(spare0.b); } out.rgb = tex1;");
    ASSERT_EQ(program.stages.size(), 2U);
    GeneralStage want = idle_stage();
    want.fetches = {{tex(1), FetchTarget::table_1d, {{{Register::spare0, 2, false}, {}, {}}}}};
    EXPECT_EQ(program.stages[1], want);
}

TEST(ProgramTextExtended, FetchErrors) {
    const auto fetch = [](const std::string& body) { return "!!BRN1.0 fetch { " + body + " }"; };
    expect_combiner_error("!!RC1.0 @fetch { tex0 = table_1d(col0.r); }",
                          "fetch in !!RC1.0, it is a word of !!BRN1.0");
    expect_combiner_error("!!BRN1.0 out.rgb = tex0; @fetch { tex0 = table_1d(col0.r); }",
                          "'fetch' comes too late");
    expect_combiner_error("!!BRN1.0 fetch { @}", "no fetch");
    expect_combiner_error(fetch("@spare0 = table_1d(col0.r);"),
                          "expected a whole texture register");
    expect_combiner_error(fetch("@tex0.a = table_1d(col0.r);"),
                          "expected a whole texture register");
    expect_combiner_error(fetch("tex0 = @table_4d(col0.r);"), "did you mean 'table_1d'?");
    expect_combiner_error(fetch("tex0 = @lerp(col0.r);"), "found 'lerp', expected a table");
    expect_combiner_error(fetch("tex0 = table_1d(@col0);"), "expected one component");
    expect_combiner_error(fetch("tex0 = table_1d(@col0.rgb);"), "expected one component");
    expect_combiner_error(fetch("tex0 = table_1d(col0.r@, col0.g);"), "found ',', expected ')'");
    expect_combiner_error(fetch("tex0 = table_2d(col0.r@);"), "found ')', expected ','");
    expect_combiner_error(fetch("tex0 = table_1d(@fog.a);"), "only the final combiner has");
    expect_combiner_error(fetch("tex0 = table_1d(@color_sum.r);"), "expected another register");
    expect_combiner_error(fetch("tex0 = table_1d(@discard.r);"), "expected another register");
    expect_combiner_error(fetch("tex0 = table_1d(@one.r);"), "expected another register");
    expect_combiner_error(fetch("tex0 = table_1d(col0.r); @tex0 = table_1d(col0.g);"),
                          "tex0 is fetched twice before one stage");
}

std::string complaint(const CombinerProgram& program, const Machine& machine) {
    try {
        program.validate(machine);
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::bad_program);
        return error.what();
    }
    return "";
}

TEST(ProgramTextExtended, OldMachinesHaveNoFetchesBetweenStages) {
    CombinerProgram program = combiners("!!BRN1.0 fetch { tex1 = table_1d(tex0.r); }");
    EXPECT_EQ(complaint(program, machine_profile("ideal")), "");
    for (const char* profile : {"geforce256", "nv2a"})
        EXPECT_NE(complaint(program, machine_profile(profile)).find("stage 0, fetch: machine '"),
                  std::string::npos);
}

TEST(ProgramTextExtended, FetchesAsDataAreChecked) {
    const CombinerProgram program = combiners("!!BRN1.0 fetch { tex1 = table_1d(tex0.r); }");
    const auto after = [&](auto change) {
        CombinerProgram changed = program;
        change(changed.stages[0].fetches);
        return complaint(changed, machine_profile("ideal"));
    };
    EXPECT_EQ(after([](auto& f) { f[0].destination = Register::spare0; }),
              "stage 0, fetch: the destination is spare0, expected a texture register");
    EXPECT_EQ(after([](auto& f) { f.push_back(f[0]); }), "stage 0, fetch: tex1 is written twice");
    EXPECT_EQ(after([](auto& f) { f[0].coordinates[0].component = 4; }),
              "stage 0, fetch: component 4, expected 0 .. 3");
    EXPECT_NE(after([](auto& f) { f[0].coordinates[0].reg = Register::color_sum; }), "");
    EXPECT_NE(after([](auto& f) { f[0].coordinates[0] = {Register::fog, 3, false}; }), "");
    EXPECT_EQ(after([](auto& f) {
                  f[0].coordinates[2] = {Register::discard, 9, false};
              }),
              "")
        << "one coordinate counts";
}

TEST(ProgramTextExtended, FetchesNeedSomethingToFetchFrom) {
    const CombinerProgram program = combiners("!!BRN1.0 fetch { tex1 = table_1d(tex0.r); }");
    try {
        (void)run_combiners(program, machine_profile("ideal"), {});
        ADD_FAILURE() << "no error";
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::bad_program);
        EXPECT_STREQ(error.what(), "stage 0: fetches, but there are no textures to fetch from");
    }
}

}  // namespace
}  // namespace burnish
