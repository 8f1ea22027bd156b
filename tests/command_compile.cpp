#include <burnish/error.hpp>
#include <burnish/materials.hpp>
#include <burnish/program_text.hpp>

#include "models/compile_model.hpp"
#include "models/error_estimate.hpp"
#include "tests/json.hpp"
#include "tests/run_command.hpp"

/// `burnish compile` as a user sees it, and what it tells of models.
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

/// In a white light, and without light from elsewhere.
CompiledModel compiled(const Material& material, std::string_view profile, bool multipass) {
    Machine machine = machine_profile(profile);
    machine.multipass = multipass;
    return compile_model(material, machine, glm::vec3(1.0F), glm::vec3(0.0F));
}

std::string refusal(const Material& material, std::string_view profile, bool multipass) {
    try {
        compiled(material, profile, multipass);
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::bad_program);
        return error.what();
    }
    return "";
}

Material of_model(Model model) {
    Material material;
    material.model = model;
    return material;
}

Material of_text(const std::string& text) {
    Material material = of_model(Model::text);
    material.name = "own";
    material.model_text = text;
    material.kd = {0.2F, 0.3F, 0.4F};
    return material;
}

/// Texts give the program again; the budget is the program's; the machine runs every pass.
void expect_whole(const CompiledModel& model, const Machine& machine) {
    const CombinerProgram& program = model.program.combiners;
    const Parsed<CombinerProgram> again = parse_combiners(print_combiners(program));
    ASSERT_TRUE(again.program) << again.errors.front().message;
    EXPECT_EQ(*again.program, program);
    if (model.program.texture_shader) {
        const std::string text = print_texture_shader(*model.program.texture_shader);
        EXPECT_EQ(parse_texture_shader(text).program, model.program.texture_shader) << text;
    }
    EXPECT_EQ(static_cast<std::size_t>(model.needs.units), model.program.units.size());
    EXPECT_EQ(static_cast<std::size_t>(model.needs.tables), model.tables.size());
    EXPECT_EQ(static_cast<std::size_t>(model.needs.stages), program.stages.size());
    if (model.passes.empty()) {
        EXPECT_EQ(shortages(model.needs, machine), "");
        EXPECT_NO_THROW(program.validate(machine));
    } else {
        EXPECT_NE(shortages(model.needs, machine), "");
        for (const ProgramPass& pass : model.passes)
            EXPECT_NO_THROW(pass.program.validate(machine));
    }
}

TEST(CompileModel, EveryModelOnEveryMachine) {
    for (const std::string_view name : model_names()) {
        const Model model = *model_named(name);
        for (const std::string_view profile : {"geforce256", "nv2a", "ideal"}) {
            SCOPED_TRACE(std::string(name) + " on " + std::string(profile));
            const bool has_tables = model != Model::blinn_phong && model != Model::abp &&
                                    model != Model::abp_modified && model != Model::abp_modified_n4;
            if (model == Model::lean && profile != "ideal") {
                EXPECT_EQ(refusal(of_model(model), profile, true),
                          std::string("lean on '") + std::string(profile) +
                              "': variances are small differences of filtered squares, which need "
                              "registers of 16 bits, expected profile ideal or double");
                continue;
            }
            if (profile != "geforce256" || !has_tables) {
                expect_whole(compiled(of_model(model), profile, true), machine_profile(profile));
                continue;
            }
            const std::string said = refusal(of_model(model), profile, true);
            EXPECT_TRUE(said.starts_with(std::string(name) + " on 'geforce256': needs ")) << said;
            EXPECT_SAYS(said, "the machine has no dependent fetch; needs ");
            EXPECT_SAYS(said, " texture units, it has 2; needs ");
            EXPECT_SAYS(said, " general stages, it has 2");
            EXPECT_EQ(said.find('\n'), std::string::npos);
        }
    }
}

/// n_dot_l * sqrt(h.n) is one vector, one map, one table over one dot product and one product.
TEST(CompileModel, RefusalsCountAndSayWhere) {
    const std::string said =
        refusal(of_text("s = 1\nn_dot_l * ks * sqrt(max(0, dot(h, n)))"), "geforce256", false);
    EXPECT_EQ(
        said,
        "material 'own', model_text:2:16 on 'geforce256': needs 1 dependent table, the machine "
        "has no dependent fetch");
    EXPECT_SAYS(refusal(of_text("ks * max(dot(l, n)^2, dot(h, n)^2)"), "geforce256", true),
                "model_text:1:6 on 'geforce256': needs 1 dependent table, ");
    EXPECT_SAYS(refusal(of_text("ks * min(dot(l, n)^2, dot(h, n)^2)"), "geforce256", true),
                "model_text:1:6 on 'geforce256': needs 1 dependent table, ");
    // Dot products of three vectors: two come as colours.
    EXPECT_SAYS(
        refusal(of_text("ks * dot(h, t)^2 * dot(l, t)^2 * dot(v, t)^2"), "geforce256", true),
        "; needs three vectors at a pixel, it has colours for two and no pass_through");
    // A map each, more than there are registers for.
    std::string sum = "ks * dot(h, t)^2";
    for (int i = 1; i < 20; ++i) sum += " + ks * dot(h, t + " + std::to_string(i) + " * b)^2";
    EXPECT_EQ(refusal(of_text(sum), "ideal", false),
              "material 'own', model_text on 'ideal': needs 20 texture units, the machine has 16");
    // As many products as there are factors, one after the other.
    std::string product = "ks * dot(h, n)";
    for (int i = 1; i < 40; ++i) product += " * max(0, dot(h, n) - 0.0" + std::to_string(i) + ")";
    EXPECT_SAYS(refusal(of_text(product), "geforce256", true), "; several passes have 16 together");
}

TEST(CompileModel, RefusalsSayWhatSeveralPassesWouldDo) {
    EXPECT_EQ(refusal(of_model(Model::abp), "geforce256", false),
              "abp on 'geforce256': needs 3 texture units, the machine has 2; in 2 passes it fits "
              "(multipass)");
    EXPECT_EQ(compiled(of_model(Model::abp), "geforce256", true).passes.size(), 2U);
    // What is read with its sign cannot lie in a frame.
    EXPECT_SAYS(
        refusal(of_text("ks * dot(h, t)^2 * dot(l, b)^2 + kd * n_dot_l"), "geforce256", true),
        " general stages, the machine has 2; cannot be split into passes for ");
    Machine cube = machine_profile("geforce256");
    choose_half_vector(cube, "cube:32");
    try {
        compile_model(of_model(Model::abp_modified), cube.for_programs(), glm::vec3(1.0F),
                      glm::vec3(0.0F));
        FAIL();
    } catch (const Error& error) {
        EXPECT_SAYS(std::string(error.what()),
                    "needs 2 texture units, the machine has 1 besides the one that normalises half "
                    "vectors");
    }
}

/// Light that comes with the vertices has a place only beside one vector.
TEST(CompileModel, TwoVectorsAndTheLightOfTheVertices) {
    const Material material = of_text("ks * dot(h, t)^2 * dot(l, b)^2 + kd * n_dot_l");
    const CompiledModel model = compiled(material, "nv2a", false);
    EXPECT_EQ(model.program.col1_rgb, ColorInput::light_tangent);
    EXPECT_EQ(model.program.col0_a, ColorInput::n_dot_l);
}

TEST_F(Compile, ModelOnGeforce256) {
    const Result result = run("compile --model abp_modified --machine geforce256");
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_EQ(result.err, "");
    EXPECT_TRUE(result.out.starts_with(
        "abp_modified on geforce256: 1 pass, 2 texture units (2 of the material, 0 tables), 2 "
        "general stages\n"
        "material: the default, kd 0, ks 1, alpha_x 0.15, alpha_y 0.5, N 2\n"
        "light: 1, without ambient light\n"
        "estimate: RMS 0.0"))
        << result.out;
    EXPECT_SAYS(result.out, "  col0.rgb  half_tangent\n  col0.a    n_dot_l\n");
    // The lobe's x reaches 1 / 0.15 = 6.67, in a power of two 8: bytes are expanded to -8 .. 8.
    EXPECT_SAYS(result.out, "  tex0      rgb       X         (t / alpha_x)  16 x - 8.03137\n");
    EXPECT_SAYS(result.out, "  constant  -         ks                       1\n");
    EXPECT_SAYS(result.out, "  geforce256  1 pass\n  nv2a        1 pass\n");
    const std::string text = result.out.substr(result.out.find("!!RC1.0"));
    const Parsed<CombinerProgram> program = parse_combiners(text);
    ASSERT_TRUE(program.program);
    EXPECT_EQ(print_combiners(*program.program), text);
    EXPECT_EQ(program.program->stages.size(), 2U);
}

TEST_F(Compile, ModelInSeveralPasses) {
    const CompiledModel model = compiled(of_model(Model::ward), "nv2a", true);
    const Result result = run("compile --model ward --machine nv2a");
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_TRUE(result.out.starts_with("ward on nv2a: " + std::to_string(model.passes.size()) +
                                       " passes, " + std::to_string(model.needs.units) +
                                       " texture units ("))
        << result.out;
    EXPECT_SAYS(result.out, std::to_string(model.needs.tables) + " tables, 1 vector), " +
                                std::to_string(model.needs.stages) + " general stages\n");
    EXPECT_SAYS(result.out, " dot(h, n) = 0 .. 1, linear\n");
    EXPECT_SAYS(result.out, "\n  1     1       spare0.b              tex0 = unit 0\n");
    EXPECT_SAYS(result.out, "tex0 = the frame of pass 1");
    EXPECT_SAYS(result.out, "  geforce256  cannot: needs ");
    EXPECT_SAYS(result.out, "pass_through();\n\n!!BRN1.0\n");
}

TEST_F(Compile, ModelAsJson) {
    const CompiledModel model = compiled(of_model(Model::ward), "nv2a", true);
    const Result result = run("compile --model ward --machine nv2a --json");
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_EQ(result.out.find('\n'), result.out.size() - 1);
    const Json json = Json::parse(result.out);
    EXPECT_EQ(json["model"].text, "ward");
    EXPECT_EQ(json["budget"]["passes"].number, static_cast<double>(model.passes.size()));
    EXPECT_EQ(json["budget"]["texture_units"].number, model.needs.units);
    EXPECT_EQ(json["budget"]["material_units"].number + model.needs.tables + 1, model.needs.units);
    EXPECT_EQ(json["budget"]["general_stages"].number, model.needs.stages);
    EXPECT_EQ(json["passes"].list.size(), model.passes.size());
    EXPECT_EQ(json["passes"].list.back()["leaves"].kind, Json::Kind::null);
    EXPECT_EQ(json["layer"].list.size(), model.layer.size());
    ASSERT_EQ(json["tables"].list.size(), model.tables.size());
    EXPECT_EQ(json["tables"][0]["function"].text, model.tables[0].function);
    EXPECT_EQ(json["tables"][0]["axes"][0]["argument"].text, model.tables[0].axes[0].argument);
    EXPECT_EQ(json["combiners"]["language"].text, "BRN1.0");
    EXPECT_EQ(json["combiners"]["stages"].list.size(), model.program.combiners.stages.size());
    EXPECT_EQ(json["texture_shader"]["units"].list.size(), 4U);
    EXPECT_EQ(json["inputs"]["uv"][3].text, "half_coded");
    EXPECT_FALSE(json["profiles"][0]["runs"].boolean);
    EXPECT_EQ(json["profiles"][1]["passes"].number, static_cast<double>(model.passes.size()));
    EXPECT_GT(json["estimate"]["rms"].number, 0.0);
    EXPECT_GE(json["estimate"]["largest"].number, json["estimate"]["rms"].number);
}

TEST_F(Compile, MaterialFiles) {
    const std::string begin = "schema = 1\n[material]\nname = \"own\"\nalpha_x = 0.25\n";
    write(path("own.toml"), begin + "model_text = \"ks * sqrt(max(0, dot(h, n)))\"\n");
    write(path("abp.toml"), begin + "model = \"abp\"\n");
    write(path("pipe.toml"), begin + "combiners_text = \"!!RC1.0 out.rgb = col0;\"\n");
    const Result result = run("compile --material own.toml");
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_TRUE(result.out.starts_with("model_text on ideal: 1 pass, 2 texture units"))
        << result.out;
    EXPECT_SAYS(result.out, "material: 'own' of own.toml\n");
    expect_failure("compile --material own.toml --machine geforce256", 3,
                   "own.toml: material 'own', model_text:1:6 on 'geforce256': needs 1 dependent "
                   "table");
    expect_failure("compile --material abp.toml --model ward --machine geforce256", 3,
                   "abp.toml: ward on 'geforce256': needs ");
    expect_failure("compile --material pipe.toml", 3, "pipe.toml: material 'own' is a pipeline");
}

TEST_F(Compile, RenderRefusesInTheSameWords) {
    write_scene("scene.toml");
    const Result compile = run("compile --model ward --machine geforce256");
    const Result render = run("render scene.toml --model ward --machine geforce256 -o a.png");
    EXPECT_EQ(compile.code, 3);
    EXPECT_EQ(render.code, 3);
    EXPECT_SAYS(compile.err, "burnish: ward on 'geforce256': needs ");
    EXPECT_EQ(render.err, compile.err);
}

TEST_F(Compile, WrongUsageOfModels) {
    expect_failure("compile --model wrad", 2, "--model wrad, did you mean 'ward'?");
    expect_failure("compile --model lambert", 2, "expected blinn_phong, abp, ");
    expect_failure("compile --model ward --machine nv2", 2, "did you mean 'nv2a'?");
    expect_failure("compile --model ward --machine double", 2, "expected geforce256, nv2a, ideal");
    expect_failure("compile bump.rc --model ward", 2, "excludes");
    expect_failure("compile --machine nv2a", 2,
                   "expected FILE.rc, --model NAME or --material FILE");
    EXPECT_SAYS(run("compile --help").out, "--model NAME");
}

}  // namespace
}  // namespace burnish
