#include <gtest/gtest.h>
#include <burnish/materials.hpp>

#include <cmath>
#include <string>

#include "models/texel.hpp"
#include "tests/scene_file.hpp"

namespace burnish {
namespace {

/// Textures that the tests refer to: t, one texel (51, 102, 204, 255), and a generated alpha map.
const std::string kTextures =
    "[[textures]]\nname = \"t\"\nwidth = 1\nheight = 1\ntexels = [51, 102, 204, 255]\n"
    "[[textures]]\nname = \"widths\"\ngenerator = \"lathe\"\nmap = \"alpha\"\nsize = 8\n";

class SceneMaterials : public SceneFile {
  protected:
    /// The material that the keys make, with its first line in line 14.
    std::shared_ptr<const Material> material(const std::string& keys) {
        return scene(kTextures + "[[materials]]\nname = \"m\"\n" + keys +
                     "[[objects]]\nshape = \"cube\"\nmaterial = \"m\"\n")
            .objects.at(0)
            .material;
    }
    std::string complaint(const std::string& keys) {
        return complaint_of([&] { material(keys); });
    }
    TexelParameters texel(const std::string& keys) { return TexelSource(*material(keys)).at(0, 0); }
};

TEST_F(SceneMaterials, EveryModelHasItsName) {
    for (const std::string_view name : model_names()) {
        const auto m = material("model = \"" + std::string(name) + "\"\n");
        EXPECT_EQ(m->model, *model_named(name));
    }
    EXPECT_EQ(model_names().size(), static_cast<std::size_t>(Model::text));
    const auto text = material("model_text = \"ks * dot(n, h)\"\n");
    EXPECT_EQ(text->model, Model::text);
    EXPECT_EQ(text->model_text, "ks * dot(n, h)");
    EXPECT_EQ(
        complaint("model = \"ward\"\nmodel_text = \"ks\"\n"),
        "s.toml:14: [[materials]] has both 'model_text' and 'model' = \"ward\", expected one");
    EXPECT_SAYS(complaint("model = \"text\"\n"), "'model' = \"text\" in [[materials]]");
    EXPECT_SAYS(complaint("model_text = \"\"\n"), "s.toml:14: [[materials]] has no 'model_text'");
}

// The place in the file, whichever way the text is quoted, escaped and broken into lines.
TEST_F(SceneMaterials, ErrorsOfModelTextsStandWhereTheTextDoes) {
    const std::string name = "unknown name 'foo', expected n, t, b,";
    EXPECT_SAYS(complaint("model_text = \"ks * foo\"\n"), "s.toml:14:20: " + name);
    EXPECT_SAYS(complaint("model_text  =  'ks * foo'\n"), "s.toml:14:22: " + name);
    EXPECT_SAYS(complaint("model_text = \"x = 2\\nks*\\u0009foo\"\n"), "s.toml:14:31: " + name);
    EXPECT_SAYS(
        complaint("model_text = \"\"\"\nx = 2 # \xc3\xa9 \\U0001F600\\\"\nks * foo\"\"\"\n"),
        "s.toml:16:6: " + name);
    EXPECT_SAYS(complaint("model_text = '''x = 2\n\n  ks * foo'''\n"), "s.toml:16:8: " + name);
    EXPECT_SAYS(complaint("model_text = \"\"\"\r\nx = 2\r\nks * foo\r\n\"\"\"\n"),
                "s.toml:16:6: " + name);
    EXPECT_SAYS(complaint("model_text = \"\"\"ks \\\n   \n   * foo\"\"\"\n"),
                "s.toml:16:6: " + name);
    EXPECT_SAYS(complaint("model_text = \"\"\"ks * \\  \n  foo\"\"\"\n"), "s.toml:15:3: " + name);
    // What is missing at the end is expected there.
    EXPECT_EQ(complaint("model_text = \"ks * (2\"\n"), "s.toml:14:22: the end, expected ')'");
    EXPECT_EQ(complaint("model_text = \"\"\"\nks * (2\n\"\"\"\n"),
              "s.toml:15:8: the end of the statement, expected ')'");
    EXPECT_EQ(complaint("model_text = \"ks / (2 - 2)\"\n"),
              "s.toml:14:18: division by a constant zero, expected another divisor");
    EXPECT_EQ(complaint("kd = 0.1 # \xc3\xa9\nmodel_text = \"n\"\n"),
              "s.toml:15:15: the value is a vector, expected a colour or a number");
}

TEST_F(SceneMaterials, ErrorsOfModelTextsFromElsewhereSayFromWhere) {
    write(path("m.toml"), "schema = 1\n[material]\nmodel_text = '''\nks *\n'''\n");
    EXPECT_EQ(complaint("file = \"m.toml\"\n"),
              "s.toml:14: m.toml:4:5: the end of the statement, expected a name, a number or '('");
    write(path("s.toml"), "schema = 1\n[[materials]]\nname = \"m\"\n");
    EXPECT_EQ(complaint_of([&] { load_scene(path("s.toml"), {"materials.m.model_text=ks * n"}); }),
              "-D materials.m.model_text=ks * n: model_text:1:4: a colour times a vector, expected "
              "a number on one side");
}

TEST_F(SceneMaterials, ParametersAreNumbersOrMaps) {
    const auto numbers = material("alpha_x = 0.25\nalpha_y = 1\nexponent = 128\n");
    EXPECT_EQ(numbers->alpha_x, 0.25F);
    EXPECT_EQ(numbers->alpha_y, 1.0F);
    EXPECT_EQ(numbers->exponent, 128.0F);
    EXPECT_EQ(material("N = 40\n")->exponent, 40.0F);
    // 51 / 255 = 0.2 and 102 / 255 = 0.4.
    EXPECT_NEAR(texel("alpha_x = \"t\"\n").alpha_x, 0.2, 1e-12);
    EXPECT_NEAR(texel("alpha_y = { map = \"t\", channel = \"g\" }\n").alpha_y, 0.4, 1e-12);
    EXPECT_NEAR(texel("alpha_y = { map = \"t\", channel = \"g\", low = 0.5, high = 1 }\n").alpha_y,
                0.7, 1e-7);
    EXPECT_NEAR(texel("exponent = { map = \"t\", channel = \"b\", low = 2, high = 12 }\n").exponent,
                10.0, 1e-6);
}

TEST_F(SceneMaterials, GeneratedAlphaMapsBringTheirRanges) {
    const GeneratedSet set = generated_set("lathe", 1, 8);
    const auto m = material("alpha_x = \"widths\"\nalpha_y = \"widths\"\nexponent = \"widths\"\n");
    EXPECT_EQ(m->alpha_x_map.channel, 0);
    EXPECT_EQ(m->alpha_y_map.channel, 1);
    EXPECT_EQ(m->exponent_map.channel, 2);
    EXPECT_EQ(m->alpha_x_map.low, set.alpha_x_range.low);
    EXPECT_EQ(m->alpha_y_map.high, set.alpha_y_range.high);
    EXPECT_EQ(m->exponent_map.high, set.exponent_range.high);
    const auto other = material("alpha_x = { map = \"widths\", channel = \"g\", high = 0.5 }\n");
    EXPECT_EQ(other->alpha_x_map.low, set.alpha_y_range.low);
    EXPECT_EQ(other->alpha_x_map.high, 0.5F);
}

TEST_F(SceneMaterials, ColoursAreColoursGreysOrMaps) {
    EXPECT_EQ(material("kd = [0.1, 0.2, 0.3]\n")->kd, glm::vec3(0.1F, 0.2F, 0.3F));
    EXPECT_EQ(material("ks = 0.5\n")->ks, glm::vec3(0.5F));
    const TexelParameters map = texel("kd = \"t\"\nks = { map = \"t\", color = [1, 0.5, 0] }\n");
    EXPECT_NEAR(map.kd.r, 0.2, 1e-12);
    EXPECT_NEAR(map.kd.b, 0.8, 1e-12);
    EXPECT_NEAR(map.ks.r, 0.2, 1e-12);
    EXPECT_NEAR(map.ks.g, 0.2, 1e-12);
    EXPECT_EQ(map.ks.b, 0.0);
    EXPECT_NEAR(texel("ks = 0.5\nspecular_map = \"t\"\n").ks.r, 0.1, 1e-12);
    EXPECT_LT(texel("kd = \"t\"\nsrgb_colors = true\n").kd.r, 0.04);
}

TEST_F(SceneMaterials, EncodingsNormalsAndDirections) {
    EXPECT_EQ(material("encoding = \"b\"\n")->encoding, VectorEncoding::b);
    EXPECT_EQ(material("exponent_coding = \"log\"\n")->exponent_coding,
              ExponentCoding::logarithmic);
    EXPECT_TRUE(material("normal_y = \"up\"\n")->normal_y_up);
    EXPECT_FALSE(material("normal_y = \"down\"\n")->normal_y_up);
    const double third = 1.0471975511965976;
    for (const char* encoding : {"a", "b", "c", "d"}) {
        const TexelParameters p =
            texel("encoding = \"" + std::string(encoding) + "\"\ndirection = 60\n");
        EXPECT_NEAR(p.t.x, std::cos(third), 2e-5);  // 16 bits
        EXPECT_NEAR(p.t.y, std::sin(third), 2e-5);
    }
    EXPECT_NE(material("direction_map = \"t\"\n")->direction_map, nullptr);
    EXPECT_SAYS(complaint("direction = 3\ndirection_map = \"t\"\n"), "expected one: an angle or a");
}

TEST_F(SceneMaterials, ExponentsOfAshikhminAndShirley) {
    const auto m = material("model = \"ashikhmin_shirley\"\nnu = 8\nnv = 200\n");
    EXPECT_EQ(m->alpha_x, 0.5F);  // sqrt(2 / 8)
    EXPECT_EQ(m->alpha_y, 0.1F);  // sqrt(2 / 200)
    EXPECT_SAYS(complaint("model = \"ward\"\nnu = 8\n"),
                "'nu' in [[materials]] without 'model' = \"ashikhmin_shirley\"");
    EXPECT_SAYS(complaint("model = \"ashikhmin_shirley\"\nnu = 8\nalpha_x = 0.5\n"),
                "has both 'nu' and 'alpha_x', expected one: alpha_x = sqrt(2 / nu)");
    EXPECT_SAYS(complaint("model = \"ashikhmin_shirley\"\nnu = 1\n"), "of at least 2");
}

TEST_F(SceneMaterials, MistakesHaveAPlaceAndACure) {
    EXPECT_EQ(complaint("alpha_z = 1\n"),
              "s.toml:14: unknown key 'alpha_z' in [[materials]], did you mean 'alpha_x'?");
    EXPECT_EQ(complaint("\nalpha_x = \"tt\"\n"),
              "s.toml:15: 'alpha_x' in [[materials]] names the unknown texture 'tt', did you mean "
              "'t'?");
    EXPECT_SAYS(complaint("alpha_x = 1.5\n"), "expected a number above 0 and at most 1");
    EXPECT_SAYS(complaint("alpha_x = { chanel = \"g\" }\n"),
                "unknown key 'chanel' in 'alpha_x' of [[materials]], did you mean 'channel'?");
    EXPECT_SAYS(complaint("alpha_x = { channel = \"g\" }\n"),
                "'alpha_x' of [[materials]] has no 'map'");
    EXPECT_SAYS(complaint("alpha_x = { map = \"t\", channel = \"red\" }\n"), "expected r, g, b, a");
    EXPECT_SAYS(complaint("alpha_x = { map = \"t\", high = 2 }\n"), "at most 1");
    EXPECT_SAYS(complaint("exponent = \"t\"\n"), "'exponent' in [[materials]] is a map without a");
    EXPECT_SAYS(complaint("N = { map = \"t\" }\n"), "is a map without a range");
    EXPECT_SAYS(complaint("exponent = 2\nN = 2\n"), "two names of one number");
    EXPECT_SAYS(complaint("exponent = 0\n"), "above 0");
    EXPECT_SAYS(complaint("ks = { map = \"t\" }\nspecular_map = \"t\"\n"), "expected one");
    EXPECT_SAYS(complaint("kd = [1, 2]\n"), "expected an array of 3 numbers");
    EXPECT_SAYS(complaint("exponent_coding = \"cubic\"\n"), "expected auto, linear, log");
    EXPECT_SAYS(complaint("encoding = \"e\"\n"), "'encoding' = \"e\" in [[materials]]");
    EXPECT_SAYS(complaint("normal_y = \"left\"\n"), "expected up, down");
    EXPECT_SAYS(complaint("generator = \"lath\"\n"), "did you mean 'lathe'?");
    EXPECT_SAYS(complaint("seed = 3\n"), "'seed' in [[materials]] without 'generator'");
    EXPECT_SAYS(complaint("generator = \"lathe\"\nfile = \"a.toml\"\n"), "expected one");
    EXPECT_SAYS(complaint("units = []\nmodel_text = \"ks\"\n"), "both 'units' and 'model_text'");
}

TEST_F(SceneMaterials, GeneratorsMakeWholeMaterials) {
    const auto m = material("generator = \"weave\"\nseed = 5\nsize = 32\nks = 0.25\n");
    EXPECT_EQ(m->name, "m");
    EXPECT_EQ(m->direction_map->width(), 32);
    EXPECT_EQ(m->specular_map, nullptr) << "a number replaces a map";
    EXPECT_EQ(m->ks, glm::vec3(0.25F));
    EXPECT_NE(m->kd_map, nullptr);
    const Material same = generated_material("weave", 5, 32);
    EXPECT_EQ(m->alpha_y_map.low, same.alpha_y_map.low);
}

TEST_F(SceneMaterials, EveryGeneratedMapIsATexture) {
    for (const std::string_view name : generated_set_names()) {
        for (const char* map : {"normal", "direction", "alpha", "kd", "ks"}) {
            const Scene s = scene("[[textures]]\nname = \"g\"\ngenerator = \"" + std::string(name) +
                                  "\"\nmap = \"" + map +
                                  "\"\nsize = 4\n[[materials]]\nname = \"m\"\nunits = [\"g\"]\n"
                                  "[[objects]]\nshape = \"cube\"\nmaterial = \"m\"\n");
            EXPECT_EQ(s.objects.at(0).material->program->units.at(0)->width(), 4) << name << map;
        }
    }
    EXPECT_SAYS(complaint_of([&] {
                    scene("[[textures]]\nname = \"g\"\ngenerator = \"lathe\"\nmap = \"tangent\"\n");
                }),
                "'map' = \"tangent\" in [[textures]], expected normal, direction, alpha, kd, ks");
    EXPECT_SAYS(
        complaint_of([&] {
            scene("[[textures]]\nname = \"g\"\ngenerator = \"lathe\"\nsize = 4\nwidth = 8\n");
        }),
        "s.toml:5: 'size' in [[textures]] differs from 'width'");
}

class MaterialFiles : public SceneMaterials {
  protected:
    void SetUp() override {
        SceneMaterials::SetUp();
        write(path("brass.toml"),
              "schema = 1\n[[textures]]\nname = \"t\"\nwidth = 1\nheight = 1\ntexels = [255, 0, 0, "
              "255]\n[material]\nmodel = \"ward\"\nalpha_x = 0.05\nalpha_y = 0.16\nkd = \"t\"\n");
    }
    std::string file_complaint(const std::string& text) {
        write(path("m.toml"), text);
        return complaint_of([&] { load_material(path("m.toml")); });
    }
};

TEST_F(MaterialFiles, StandAlone) {
    const Material brass = load_material(path("brass.toml"));
    EXPECT_EQ(brass.name, "brass") << "the name of the file";
    EXPECT_EQ(brass.model, Model::ward);
    EXPECT_EQ(brass.alpha_x, 0.05F);
    EXPECT_EQ(TexelSource(brass).at(0, 0).kd, glm::dvec3(1.0, 0.0, 0.0));
}

TEST_F(MaterialFiles, AreReferredToAndChangedByScenes) {
    const auto m = material("file = \"brass.toml\"\nalpha_y = 0.5\nmodel = \"ggx\"\n");
    EXPECT_EQ(m->name, "m");
    EXPECT_EQ(m->model, Model::ggx);
    EXPECT_EQ(m->alpha_x, 0.05F);
    EXPECT_EQ(m->alpha_y, 0.5F);
    // The name t in brass.toml is brass.toml's texture, not the scene's.
    EXPECT_EQ(TexelSource(*m).at(0, 0).kd, glm::dvec3(1.0, 0.0, 0.0));
}

TEST_F(MaterialFiles, Mistakes) {
    EXPECT_SAYS(complaint("file = \"none.toml\"\n"), "s.toml:14: none.toml: No such file");
    EXPECT_EQ(file_complaint("[material]\n"), "m.toml:1: no 'schema' key, expected schema = 1");
    EXPECT_SAYS(file_complaint("schema = 1\n"), "no [material] table, expected one");
    EXPECT_SAYS(file_complaint("schema = 1\n[materials]\n"), "did you mean 'material'?");
    EXPECT_EQ(file_complaint("schema = 1\n[material]\nalhpa_x = 1\n"),
              "m.toml:3: unknown key 'alhpa_x' in [material], did you mean 'alpha_x'?");
    EXPECT_SAYS(file_complaint("schema = 1\n[material]\nfile = \"m.toml\"\n"),
                "unknown key 'file'");
    write(path("bad.toml"), "schema = 1\n[material]\nalpha_x = 7\n");
    EXPECT_SAYS(complaint("file = \"bad.toml\"\n"),
                "s.toml:14: bad.toml:3: 'alpha_x' in [material]");
    write(path("pipe.toml"), "schema = 1\n[material]\nunits = []\n");
    EXPECT_TRUE(material("file = \"pipe.toml\"\n")->program.has_value());
    EXPECT_SAYS(complaint("file = \"pipe.toml\"\nalpha_x = 0.5\n"), "changes a model");
}

/// Every file of meshes/materials is read, and a scene may use it.
TEST(MaterialLibrary, IsReadable) {
    int count = 0;
    const std::filesystem::path library(BURNISH_SOURCE_DIR "/meshes/materials");
    for (const auto& entry : std::filesystem::directory_iterator(library)) {
        if (entry.path().extension() != ".toml") continue;
        ++count;
        EXPECT_NO_THROW({
            const Material m = load_material(entry.path());
            EXPECT_EQ(m.name, entry.path().stem().string());
            EXPECT_FALSE(m.program.has_value());
        }) << entry.path();
    }
    EXPECT_GE(count, 10);
}

TEST(MaterialLibrary, HasWardsTenMeasuredMaterials) {
    struct Measured {
        const char* name;
        float kd, ks, alpha_x, alpha_y;
    };
    // Ward 1992, table 1.
    const Measured all[] = {{"rolled_brass", 0.10F, 0.33F, 0.050F, 0.16F},
                            {"rolled_aluminium", 0.10F, 0.21F, 0.04F, 0.09F},
                            {"lightly_brushed_aluminium", 0.15F, 0.19F, 0.088F, 0.13F},
                            {"varnished_plywood", 0.33F, 0.025F, 0.04F, 0.11F},
                            {"enamel_finished_metal", 0.25F, 0.047F, 0.080F, 0.096F},
                            {"painted_cardboard_box", 0.19F, 0.043F, 0.076F, 0.085F},
                            {"white_ceramic_tile", 0.70F, 0.050F, 0.071F, 0.071F},
                            {"glossy_grey_paper", 0.29F, 0.083F, 0.082F, 0.082F},
                            {"ivory_computer_plastic", 0.45F, 0.043F, 0.13F, 0.13F},
                            {"plastic_laminate", 0.67F, 0.070F, 0.092F, 0.092F}};
    for (const Measured& m : all) {
        const Material material =
            load_material(std::filesystem::path(BURNISH_SOURCE_DIR) / "meshes/materials" /
                          (std::string(m.name) + ".toml"));
        EXPECT_EQ(material.model, Model::ward);
        EXPECT_EQ(material.kd, glm::vec3(m.kd)) << m.name;
        EXPECT_EQ(material.ks, glm::vec3(m.ks)) << m.name;
        EXPECT_EQ(material.alpha_x, m.alpha_x) << m.name;
        EXPECT_EQ(material.alpha_y, m.alpha_y) << m.name;
    }
}

}  // namespace
}  // namespace burnish
