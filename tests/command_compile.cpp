#include "tests/run_command.hpp"

/// `burnish compile` as a user sees it.
namespace burnish {
namespace {

class Compile : public Command {
  protected:
    void SetUp() override {
        Command::SetUp();
        write(path("bump.rc"),
              "!!RC1.0\n"
              "const0 = (0.25, 0, 0, 1);\n"
              "{ rgb { spare0 = expand(tex0) . expand(col0); scale_by_two(); }\n"
              "  alpha { discard = tex0; discard = -tex1.b; spare0 = mux(); } }\n"
              "out.rgb = lerp(spare0, tex1, const0);\n"
              "out.a = unsigned_invert(zero);\n");
        write(path("table.ts"), "!!TS1.0 texture_2d(); dependent_gb(tex0);");
        write(path("bad.rc"), "!!RC1.0\n{ rgb { spare0 = fog.a; zero = tex0; } }\nout.a = tex9;\n");
        write(path("bad.ts"), "!!TS1.0\ndependent_gb(tex0);\n");
    }
};

TEST_F(Compile, PrintsWhatTheProgramBecame) {
    const Result result = run("compile bump.rc");
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_EQ(result.err, "");
    EXPECT_EQ(result.out, R"(bump.rc: RC1.0, 1 general stage
constants
  const0  0.25  0  0  1
  const1  0     0  0  0
general stages
  stage  portion  A                 B                 C        D     AB               CD     third          output
  0      rgb      expand(tex0.rgb)  expand(col0.rgb)  zero     zero  A . B -> spare0  -      -              x * 2
  0      alpha    tex0.a            one               -tex1.b  one   A * B            C * D  mux -> spare0  x
final combiner: rgb = A * B + (1 - A) * C + D, alpha = G, final_product = E * F
  A                     B                   C                     D               E               F               G    color_sum
  unsigned(spare0.rgb)  unsigned(tex1.rgb)  unsigned(const0.rgb)  unsigned(zero)  unsigned(zero)  unsigned(zero)  one  not clamped
machines
  geforce256  runs it
  nv2a        runs it
  ideal       runs it
)");
}

TEST_F(Compile, ShowsTextureUnits) {
    const Result result = run("compile bump.rc table.ts");
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_SAYS(result.out,
                "table.ts: TS1.0\ntexture units\n  tex0  texture_2d()\n  tex1  "
                "dependent_gb(tex0)\n  tex2  nop()\n");
    EXPECT_SAYS(
        result.out,
        "geforce256  cannot: texture unit 1: machine 'geforce256' does not have dependent_gb\n");
    EXPECT_SAYS(result.out, "nv2a        runs it\n");
}

TEST_F(Compile, SaysWhyAMachineCannotRunIt) {
    write(path("new.rc"),
          "!!BRN1.0 fetch { tex1 = table_1d(tex0.r); }\n"
          "{ const1 = (0.5, 0, 0, 1); wide rgb { spare0 = tex1; bias_by_negative_one_half(); } }");
    const Result result = run("compile new.rc");
    EXPECT_EQ(result.code, 0);
    EXPECT_SAYS(result.out, "new.rc: BRN1.0, 1 general stage\n");
    EXPECT_SAYS(result.out, "fetches\n  before stage 0  tex1 = table_1d(tex0.r)\n");
    EXPECT_SAYS(result.out, "  const1 in stage 0  0.5  0  0  1\n");
    EXPECT_SAYS(result.out, "A * B -> spare0  -   -      (x - 1/2), wide\n");
    EXPECT_SAYS(
        result.out,
        "geforce256  cannot: stage 0: has constants of its own, machine 'geforce256' has only");
    EXPECT_SAYS(result.out, "nv2a        cannot: stage 0, fetch: machine 'nv2a' has no fetches");
    EXPECT_SAYS(result.out, "ideal       runs it\n");
}

/// Two stages too many for geforce256, and what is left after two of them is positive.
TEST_F(Compile, CountsThePasses) {
    write(path("long.rc"),
          "!!RC1.0\n{ rgb { spare0 = tex0 * tex1; } }\n{ rgb { spare0 = spare0 * col0; } }\n"
          "{ rgb { spare0 = spare0 * spare0; } }\nout.rgb = spare0;\n");
    const Result result = run("compile long.rc");
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_SAYS(result.out,
                "geforce256  in 2 passes: 3 general stages, machine 'geforce256' has 2\n");
    EXPECT_SAYS(run("compile long.rc --json").out,
                "\"complaint\": \"3 general stages, machine 'geforce256' has 2\", \"passes\": 2}");
}

TEST_F(Compile, Json) {
    const Result result = run("compile bump.rc table.ts --json");
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_TRUE(
        result.out.starts_with("{\"combiners\": {\"file\": \"bump.rc\", \"language\": \"RC1.0\", "
                               "\"const0\": [0.25, 0, 0, 1], "));
    EXPECT_EQ(result.out.find('\n'), result.out.size() - 1);
    for (const char* part :
         {"\"rgb\": {\"a\": \"expand(tex0.rgb)\", \"b\": \"expand(col0.rgb)\", \"c\": \"zero\", "
          "\"d\": \"zero\", \"ab\": {\"operation\": \"dot\", \"to\": \"spare0\"}",
          "\"third\": {\"operation\": \"mux\", \"to\": \"spare0\"}, \"scale\": 1, \"bias\": 0, "
          "\"wide\": false",
          "\"scale\": 2", "\"g\": \"one\", \"clamp_color_sum\": false",
          "\"text\": \"!!RC1.0\\u000aconst0 = (0.25, 0, 0, 1);",
          "{\"operation\": \"dependent_gb\", \"statement\": \"dependent_gb(tex0)\"}",
          "{\"name\": \"nv2a\", \"runs\": true, \"complaint\": null, \"passes\": 1}",
          "{\"name\": \"geforce256\", \"runs\": false, \"complaint\": \"texture unit 1: "})
        EXPECT_SAYS(result.out, part);
    EXPECT_SAYS(run("compile bump.rc --json").out, "\"texture_shader\": null");
}

TEST_F(Compile, EveryErrorIsALine) {
    const Result result = run("compile bad.rc bad.ts");
    EXPECT_EQ(result.code, 3);
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(result.err,
              "burnish: bad.rc:2:18: the alpha of fog in a general stage, only the final combiner "
              "has it\n"
              "burnish: bad.rc:2:25: zero is written, it is read-only\n"
              "burnish: bad.rc:3:9: 'tex9' in !!RC1.0, which has tex0 .. tex3\n"
              "burnish: bad.ts:2:14: unit 0 refers to itself, expected an earlier unit\n");
    EXPECT_EQ(run("compile bump.rc bad.ts").code, 3);
}

TEST_F(Compile, FilesThatAreNoTexts) {
    expect_failure("compile nowhere.rc", 3, "nowhere.rc: cannot be opened");
    expect_failure("compile .", 3, ".: cannot be read");
    expect_failure("compile bump.rc nowhere.ts", 3, "nowhere.ts: cannot be opened");
    expect_failure("compile table.ts", 3, "table.ts:1:1: the text begins with '!!TS1.0'");
    expect_failure("compile /dev/zero", 3, "/dev/zero: more than 16 MB");
}

TEST_F(Compile, WrongUsage) {
    expect_failure("compile", 2, "FILE.rc");
    expect_failure("compile bump.rc table.ts more", 2, "");
    expect_failure("compile bump.rc --jsn", 2, "did you mean '--json'?");
    expect_failure("compil bump.rc", 2, "did you mean 'compile'?");
    const Result help = run("compile --help");
    EXPECT_EQ(help.code, 0);
    EXPECT_SAYS(help.out, "FILE.rc");
}

}  // namespace
}  // namespace burnish
