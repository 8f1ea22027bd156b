// Programs in scene files: as file or text, with constants, switches and the machine's choices.
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "tests/scene_file.hpp"

namespace burnish {
namespace {

class ScenePrograms : public SceneFile {
  protected:
    static constexpr const char* kProgram =
        "'''!!RC1.0\n{ rgb { spare0 = expand(tex0) . "
        "expand(col0); } }\nout.rgb = spare0;\n'''\n";

    /// The program of a material whose table goes on with `text`.
    CombinerProgram program(const std::string& text) {
        const Scene s = scene("[[materials]]\nname = \"m\"\n" + text +
                              "[[objects]]\nmaterial = \"m\"\nvertices = []\n");
        return s.objects[0].material->program->combiners;
    }
    std::string complaint(const std::string& text) {
        return complaint_of([&] { program(text); });
    }
};

TEST_F(ScenePrograms, TextAndFileGiveTheSameProgram) {
    const CombinerProgram text = program(std::string("combiners_text = ") + kProgram);
    ASSERT_EQ(text.stages.size(), 1U);
    EXPECT_EQ(text.stages[0].rgb.ab_product, Product::dot);
    EXPECT_EQ(text.final_combiner.d.reg, Register::spare0);
    write(path("p.rc"),
          "!!RC1.0{ rgb { spare0 = expand(tex0) . expand(col0); } }"
          "out.rgb = spare0;");
    EXPECT_EQ(program("combiners = \"p.rc\"\n"), text);
}

TEST_F(ScenePrograms, ConstantsOfTheMaterialReplaceThoseOfTheText) {
    const std::string text =
        "combiners_text = '''!!RC1.0\nconst0 = (1, 1, 1, 1);\n"
        "const1 = (0, 0.5, 0, 1);\nout.rgb = const0;'''\n";
    const CombinerProgram p =
        program(text +
                "const0_bytes = [25, 63, 255, 127]\nfog = [0.5, 0.25, 1, 0.125]\n"
                "clamp_color_sum = true\n");
    EXPECT_EQ(p.const0, (glm::vec4(25.0F, 63.0F, 255.0F, 127.0F) / 255.0F));
    EXPECT_EQ(p.const1, glm::vec4(0.0F, 0.5F, 0.0F, 1.0F));
    EXPECT_EQ(p.fog, glm::vec4(0.5F, 0.25F, 1.0F, 0.125F));
    EXPECT_TRUE(p.final_combiner.clamp_color_sum);
    EXPECT_EQ(program(text + "const1 = [1, 0, 0, 0]\n").const1, glm::vec4(1.0F, 0.0F, 0.0F, 0.0F));
}

TEST_F(ScenePrograms, Switches) {
    const CombinerProgram p = program(std::string("combiners_text = ") + kProgram +
                                      "[materials.hardware]\nmux_bit = \"lsb\"\n"
                                      "complement = [\"secondary\"]\n"
                                      "blue_to_alpha = [[0, \"ab\"]]\n");
    EXPECT_EQ(p.mux_bit, MuxBit::lsb);
    EXPECT_FALSE(p.final_combiner.complement_spare0);
    EXPECT_TRUE(p.final_combiner.complement_secondary);
    EXPECT_TRUE(p.stages[0].rgb.ab_blue_to_alpha);
    EXPECT_FALSE(p.stages[0].rgb.cd_blue_to_alpha);
}

TEST_F(ScenePrograms, ChoicesOfTheMachine) {
    const Machine machine = scene(
                                "[machine]\nprofile = \"nv2a\"\nproduct_rounding = \"shift8\"\n"
                                "expand = \"ideal\"\nhalving = \"down\"\n"
                                "lerp_rounding = \"each\"\n")
                                .machine;
    EXPECT_EQ(machine.product_rounding, ProductRounding::shift8);
    EXPECT_EQ(machine.expand, ExpandRule::ideal);
    EXPECT_EQ(machine.halving, Halving::down);
    EXPECT_EQ(machine.lerp_rounding, LerpRounding::each);
    const Machine usual = scene("[machine]\nprofile = \"nv2a\"\n").machine;
    EXPECT_EQ(usual.product_rounding, ProductRounding::nearest);
    EXPECT_EQ(usual.expand, ExpandRule::hardware);
    EXPECT_EQ(usual.halving, Halving::half_up);
    EXPECT_EQ(usual.lerp_rounding, LerpRounding::once);
    EXPECT_THROW(scene("[machine]\nproduct_rounding = \"shift8\"\n"), Error);  // wide numbers
}

TEST_F(ScenePrograms, Errors) {
    const std::string text = std::string("combiners_text = ") + kProgram;
    write(path("bad.rc"), "!!RC1.0\n{ rgb { spare0 = tex9; } }\nout.rgb = spare0;\nout.a = fog;");
    const std::vector<std::pair<std::string, std::string>> cases{
        {"combiners = \"none.rc\"\n", "s.toml:4: none.rc: cannot be opened for reading"},
        {"combiners = \"bad.rc\"\n", "bad.rc:2:18: "},
        {"combiners_text = \"!!RC1.0 out.rgb = tex9;\"\n", "s.toml:4: combiners_text:1:19: "},
        {text + "combiners = \"bad.rc\"\n", "both 'combiners' and 'combiners_text', expected one"},
        {text + "model = \"abp_modified\"\n", "both 'combiners_text' and 'model', expected one"},
        {text + "const0 = [0, 0, 0, 0]\nconst0_bytes = [0, 0, 0, 0]\n",
         "both 'const0' and 'const0_bytes', expected one"},
        {text + "const0 = [0, 0, 0, 2]\n", "value 2"},
        {text + "const0_bytes = [0, 0, 0, 0.5]\n", "element 0.5, expected whole numbers 0 .. 255"},
        {text + "const0_bytes = [0, 0, 0, 256]\n", "value 256"},
        {"const0 = [0, 0, 0, 0]\n", "'const0' in [[materials]] without 'units' or 'combiners'"},
        {text + "[materials.hardware]\nmux_bit = \"mbs\"\n", "did you mean 'msb'?"},
        {text + "[materials.hardware]\ncomplement = [\"spare1\"]\n", "did you mean 'spare0'?"},
        {text + "[materials.hardware]\nblue_to_alpha = [[1, \"ab\"]]\n",
         "expected pairs of a stage, 0 .. 0, and \"ab\" or \"cd\""},
        {text + "[materials.hardware]\nblue_to_alpha = [[0, \"sum\"]]\n", "expected pairs"},
        {text + "[materials.hardware]\nblue_to_alpha = [0]\n", "expected pairs"},
        {text + "[materials.hardware]\nblue_to_alpha = 0\n", "expected pairs"}};
    for (const auto& [from, wanted] : cases) EXPECT_SAYS(complaint(from), wanted);
}

}  // namespace
}  // namespace burnish
