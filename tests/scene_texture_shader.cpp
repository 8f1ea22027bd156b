// Texture shaders in scene files: as file or text, with coordinates and the hardware's modes.
#include <gtest/gtest.h>

#include <burnish/renderer.hpp>
#include <string>

#include "tests/scene_file.hpp"

namespace burnish {
namespace {

class SceneTextureShaders : public SceneFile {
  protected:
    static constexpr const char* kUnits = "units = [\"\", \"\", \"\"]\n";
    static constexpr const char* kDots =
        "texture_shader_text = '''!!TS1.0 pass_through(); dot_product_2d_1of2(tex0); "
        "dot_product_2d_2of2(tex0);'''\n";

    ProgramMaterial program(const std::string& text) {
        return *scene("[machine]\nprofile = \"nv2a\"\n[[materials]]\nname = \"m\"\n" + text +
                      "[[objects]]\nmaterial = \"m\"\nvertices = []\n")
                    .objects[0]
                    .material->program;
    }
    std::string complaint(const std::string& text) {
        return complaint_of([&] { program(text); });
    }
};

TEST_F(SceneTextureShaders, FileAndTextGiveTheSameShader) {
    const ProgramMaterial text =
        program(std::string(kUnits) +
                "texture_shader_text = '''!!TS1.0\ntexture_2d();\ndependent_gb(tex0);\n'''\n");
    ASSERT_TRUE(text.texture_shader.has_value());
    EXPECT_EQ(text.texture_shader->units[1].operation, TextureOperation::dependent_gb);
    write(path("a.ts"), "!!TS1.0texture_2d(); dependent_gb(tex0);");
    EXPECT_EQ(program(std::string(kUnits) + "texture_shader = \"a.ts\"\n").texture_shader,
              text.texture_shader);
    EXPECT_FALSE(program(kUnits).texture_shader.has_value());
}

TEST_F(SceneTextureShaders, ErrorsOfTextHaveFileLineAndColumn) {
    write(path("a.ts"), "!!TS1.0\n  texture_9d();\n");
    EXPECT_SAYS(complaint(std::string(kUnits) + "texture_shader = \"a.ts\"\n"), "a.ts:2:3: ");
    EXPECT_SAYS(
        complaint(std::string(kUnits) + "texture_shader_text = '''!!TS1.0\n  texture_9d();\n'''\n"),
        "s.toml:7: texture_shader_text:2:3: ");
    EXPECT_SAYS(complaint(std::string(kUnits) + "texture_shader = \"b.ts\"\n"), "s.toml:7: ");
    EXPECT_SAYS(
        complaint(std::string(kUnits) + "texture_shader = \"a.ts\"\ntexture_shader_text = ''\n"),
        "has both 'texture_shader' and 'texture_shader_text', expected one");
    EXPECT_SAYS(complaint("texture_shader = \"a.ts\"\n"),
                "'texture_shader' in [[materials]] without 'units' or 'combiners'");
}

TEST_F(SceneTextureShaders, CoordinatesOfUnits) {
    const ProgramMaterial p = program(std::string(kUnits) +
                                      "[materials.inputs]\ncol0_rgb = \"normal\"\nuv0 = \"uv\"\n"
                                      "uv1 = \"half_tangent\"\nuv2 = \"light_tangent\"\n"
                                      "uv3 = \"vertex\"\n");
    EXPECT_EQ(p.uv[0], CoordinateInput::uv);
    EXPECT_EQ(p.uv[1], CoordinateInput::half_tangent);
    EXPECT_EQ(p.uv[2], CoordinateInput::light_tangent);
    EXPECT_EQ(p.uv[3], CoordinateInput::vertex);
    EXPECT_EQ(p.col0_rgb, ColorInput::normal);
    EXPECT_SAYS(complaint(std::string(kUnits) + "[materials.inputs]\nuv0 = \"view\"\n"),
                "expected uv, half_tangent, light_tangent, view_tangent, half_coded, light_coded, "
                "view_coded, vertex");
}

TEST_F(SceneTextureShaders, CullBitsReplaceTheTests) {
    const std::string text = std::string(kUnits) +
                             "texture_shader_text = '''!!TS1.0 cull_fragment(GEQUAL_TO_ZERO, "
                             "GEQUAL_TO_ZERO, GEQUAL_TO_ZERO, LESS_THAN_ZERO);'''\n"
                             "[materials.hardware]\ncull_fragment_bits = ";
    const auto cull = program(text + "\"0110\"\n").texture_shader->units[0].cull;
    EXPECT_EQ(cull, (std::array{CullTest::greater_or_equal_zero, CullTest::less_than_zero,
                                CullTest::less_than_zero, CullTest::greater_or_equal_zero}));
    EXPECT_SAYS(complaint(text + "\"012\"\n"), "expected four digits 0 or 1");
    EXPECT_SAYS(complaint(text + "\"0120\"\n"), "expected four digits 0 or 1");
    EXPECT_SAYS(complaint(std::string(kUnits) + kDots +
                          "[materials.hardware]\ncull_fragment_bits = \"0000\"\n"),
                "no unit does cull_fragment");
}

TEST_F(SceneTextureShaders, DotMappingsByTheirCodes) {
    const std::string text = std::string(kUnits) + kDots + "[materials.hardware]\ndot_mapping = ";
    const auto units = program(text + "[-1, 1, 7]\n").texture_shader->units;
    EXPECT_EQ(units[1].dot_mapping, DotMapping::nv2a_d3d);
    EXPECT_EQ(units[2].dot_mapping, DotMapping::nv2a_hemisphere_signed);
    EXPECT_EQ(program(text + "[-1, 4]\n").texture_shader->units[1].dot_mapping,
              DotMapping::nv2a_hilo);
    EXPECT_SAYS(complaint(text + "[0]\n"), "unit 0, which does pass_through");
    EXPECT_SAYS(complaint(text + "[-1, 8]\n"), "dot_mapping");
    EXPECT_SAYS(complaint(text + "[-1, 0.5]\n"), "expected whole numbers -1 .. 7");
}

TEST_F(SceneTextureShaders, ModesOfTheHardwareNeedAShader) {
    EXPECT_EQ(
        program(std::string(kUnits) + kDots + "[materials.hardware]\nbump_source = \"rgba8\"\n")
            .texture_shader->bump_source,
        BumpSource::rgba8);
    for (const std::string key :
         {"bump_source = \"rgba8\"", "dot_mapping = [1]", "cull_fragment_bits = \"0000\""})
        EXPECT_SAYS(complaint(std::string(kUnits) + "[materials.hardware]\n" + key + "\n"),
                    "without a texture shader");
}

TEST_F(SceneTextureShaders, TheMagnitudeFactorIsAChoiceOfTheMachine) {
    const auto factor = [&](const std::string& machine) {
        return scene("[machine]\n" + machine).machine.magnitude_factor;
    };
    EXPECT_EQ(factor("profile = \"nv2a\"\n"), MagnitudeFactor::unclamped);
    EXPECT_EQ(factor("profile = \"ideal\"\n"), MagnitudeFactor::clamped);
    EXPECT_EQ(factor("profile = \"nv2a\"\nmagnitude_factor = \"clamped\"\n"),
              MagnitudeFactor::clamped);
}

// On a mesh: s, t of the half vector, not coded. Seen from the light along the normal of a plane
// the half vector is (0, 0, 1): coded 128, as coordinates exactly 0, 0, 1.
TEST_F(SceneTextureShaders, VectorsAsCoordinatesOfAMesh) {
    for (const std::string half : {"pixel", "vertex"}) {
        Scene s = scene("[output]\nwidth = 9\nheight = 9\n[machine]\nhalf_vector = \"" + half +
                        "\"\n[camera]\nposition = [0, 0, 1000]\nview_angle = 0.05\nfar = 2000\n"
                        "[[lights]]\ndirection = [0, 0, 1]\n[[materials]]\nname = \"m\"\n"
                        "units = [\"\", \"\"]\n"
                        "texture_shader_text = '''!!TS1.0 pass_through(); pass_through();'''\n"
                        "combiners_text = '''!!RC1.0 out.rgb = tex0; out.a = tex1;'''\n"
                        "[materials.inputs]\nuv0 = \"half_tangent\"\nuv1 = \"vertex\"\n"
                        "[[objects]]\nshape = \"plane\"\nmaterial = \"m\"\n");
        s.format = PixelFormat::rgba32f;
        Framebuffer frame(9, 9, s.format);
        Renderer().render(s, frame);
        const auto* pixel = reinterpret_cast<const float*>(frame.row(4)) + std::ptrdiff_t{4} * 4;
        EXPECT_NEAR(pixel[0], 0.0F, 0.001F) << half;
        EXPECT_NEAR(pixel[1], 0.0F, 0.001F) << half;
        EXPECT_NEAR(pixel[2], 1.0F, 0.001F) << half;
        EXPECT_EQ(pixel[3], 1.0F) << half;  // q of a mesh
    }
}

}  // namespace
}  // namespace burnish
