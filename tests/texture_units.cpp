// Texture shaders against a plain oracle: random programs, every unit's result at every pixel; and
// the rules that turn units off, one by one.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <burnish/error.hpp>
#include <burnish/program_text.hpp>
#include <burnish/renderer.hpp>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scratch_directory.hpp"
#include "unit_oracle.hpp"
#include "unit_scene.hpp"

namespace burnish {
namespace {

// --- consistency

TexturePtr texture_of(TexelFormat format) {
    return std::make_shared<const Texture>(Image8(2, 2), Sampler{}, format);
}

TextureShader shader_of(const std::string& statements) {
    Parsed<TextureShader> parsed = parse_texture_shader("!!TS1.0\n" + statements);
    EXPECT_TRUE(parsed.program.has_value()) << statements;
    return parsed.program.value_or(TextureShader{});
}

class Consistency : public testing::Test {
  protected:
    /// "1: reason; 2: reason" of a shader whose units all have the textures of `units`.
    std::string problems(const TextureShader& shader) const {
        std::string text;
        for (const UnitProblem& p : check_consistency(shader, units, machine)) {
            if (!text.empty()) text += "; ";
            text += std::to_string(p.unit) + ": " + p.reason;
        }
        return text;
    }
    std::string problems(const std::string& statements) const {
        return problems(shader_of(statements));
    }

    static TexturePtr cube() {
        TextureDescription description{.target = TextureTarget::cube};
        return std::make_shared<const Texture>(std::vector<Image8>(6, Image8(1, 1)), description);
    }

    TexturePtr rgba = texture_of(TexelFormat::rgba8);
    TexturePtr signed_rgba = texture_of(TexelFormat::signed_rgba8);
    std::vector<TexturePtr> units{rgba, rgba, rgba, rgba};
    Machine machine = machine_profile("nv2a");
};

TEST_F(Consistency, NothingIsWrongWithGoodShaders) {
    EXPECT_EQ(problems("texture_2d(); dependent_ar(tex0); dependent_gb(tex1); pass_through();"),
              "");
    EXPECT_EQ(problems("texture_2d(); dot_product_2d_1of2(tex0); dot_product_2d_2of2(tex0);"), "");
    EXPECT_EQ(problems("nop(); pass_through(); dependent_ar(tex1);"), "");
    EXPECT_EQ(problems(""), "");
}

TEST_F(Consistency, UnitsThatSampleNeedATexture) {
    units[1] = nullptr;
    EXPECT_EQ(problems("texture_2d(); texture_2d();"),
              "1: texture_2d without a texture, expected a 2D texture");
    units.resize(1);
    EXPECT_EQ(problems("texture_2d(); nop(); dependent_ar(tex0);"),
              "2: dependent_ar without a texture, expected a 2D texture");
}

TEST_F(Consistency, TexturesNeedTheTargetOfTheOperation) {
    EXPECT_EQ(problems("texture_rectangle();"),
              "0: texture_rectangle with a 2D texture, expected rectangle");
    EXPECT_EQ(problems("texture_cube_map(); texture_3d(); texture_1d();"),
              "0: texture_cube_map with a 2D texture, expected cube map; "
              "1: texture_3d with a 2D texture, expected 3D; "
              "2: texture_1d with a 2D texture, expected 1D");
}

TEST_F(Consistency, TheUnitReadHasATexel) {
    TextureShader shader = shader_of(
        "texture_2d(); dot_product_2d_1of2(tex0); "
        "dot_product_2d_2of2(tex0);");
    shader.units[3] = {.operation = TextureOperation::dependent_ar, .previous = 1};
    EXPECT_EQ(problems(shader),
              "3: dependent_ar reads unit 1, whose operation dot_product has no texel");
    shader.units[3].previous = 2;
    EXPECT_EQ(problems(shader), "");
    shader.units[3].previous = 0;
    shader.units[0].operation = TextureOperation::none;
    EXPECT_SAYS(problems(shader),
                "3: dependent_ar reads unit 0, whose operation none has no texel");
}

TEST_F(Consistency, AUnitThatIsOffTakesItsReadersWithIt) {
    units[0] = nullptr;
    EXPECT_EQ(problems("texture_2d(); dependent_ar(tex0); dependent_gb(tex1);"),
              "0: texture_2d without a texture, expected a 2D texture; "
              "1: dependent_ar reads unit 0, which is off; "
              "2: dependent_gb reads unit 1, which is off");
}

TEST_F(Consistency, DependentReadsTakeUnsignedColors) {
    units[0] = signed_rgba;
    for (const std::string op : {"dependent_ar", "dependent_gb"})
        EXPECT_EQ(problems("texture_2d(); " + op + "(tex0);"),
                  "1: " + op +
                      " reads unit 0, whose texels are signed colours, expected unsigned "
                      "colours");
}

TEST_F(Consistency, OffsetsTakeDsdtUnlessTheMaterialSaysBytes) {
    TextureShader shader = shader_of("texture_2d(); offset_2d(tex0, 1, 0, 0, 1);");
    EXPECT_EQ(problems(shader),
              "1: offset_2d reads unit 0, whose texels are unsigned colours, expected DSDT");
    shader.bump_source = BumpSource::rgba8;
    EXPECT_EQ(problems(shader), "");
    units[0] = signed_rgba;
    EXPECT_EQ(problems(shader), "");
    shader = shader_of("texture_2d(); offset_2d_scale(tex0, 1, 0, 0, 1, 1, 0);");
    EXPECT_EQ(problems(shader),
              "1: offset_2d_scale reads unit 0, whose texels are signed colours, "
              "expected DSDT with magnitude");
    shader.bump_source = BumpSource::rgba8;  // red is an unsigned magnitude
    EXPECT_EQ(problems(shader),
              "1: offset_2d_scale reads unit 0, whose texels are signed colours, "
              "expected unsigned colours");
}

TEST_F(Consistency, HiloOperationsTakeHilo) {
    machine = machine_profile("ideal");
    EXPECT_EQ(
        problems("texture_2d(); dependent_hilo(tex0); offset_hilo_2d(tex0, 1, 0, 0, 1);"),
        "1: dependent_hilo reads unit 0, whose texels are unsigned colours, expected unsigned "
        "HILO; 2: offset_hilo_2d reads unit 0, whose texels are unsigned colours, expected "
        "signed HILO");
}

TEST_F(Consistency, GroupsOfDotProductsFollowEachOther) {
    TextureShader shader;
    const auto dot = [](TextureOperation op) {
        return TextureUnit{.operation = op, .previous = 0};
    };
    shader.units[0].operation = TextureOperation::texture_2d;
    shader.units[1] = dot(TextureOperation::dot_product_2d);
    EXPECT_EQ(problems(shader), "1: dot_product_2d in unit 1, expected dot_product in unit 0");
    shader.units[1] = dot(TextureOperation::dot_product);
    shader.units[3] = dot(TextureOperation::dot_product_depth_replace);
    EXPECT_EQ(problems(shader),
              "3: dot_product_depth_replace in unit 3, expected dot_product in unit 2");
    // Three products, of which the first is missing.
    units[3] = cube();
    shader.units = {};
    shader.units[1].operation = TextureOperation::pass_through;
    shader.units[2] = {.operation = TextureOperation::dot_product, .previous = 1};
    shader.units[3] = {.operation = TextureOperation::dot_product_cube_map, .previous = 1};
    EXPECT_EQ(problems(shader),
              "3: dot_product_cube_map in unit 3, expected dot_product in unit 1");
}

TEST_F(Consistency, ADotProductThatIsOffTakesItsGroupWithIt) {
    units[0] = nullptr;
    EXPECT_EQ(problems("texture_2d(); dot_product_2d_1of2(tex0); dot_product_2d_2of2(tex0);"),
              "0: texture_2d without a texture, expected a 2D texture; "
              "1: dot_product reads unit 0, which is off; "
              "2: dot_product_2d reads unit 0, which is off");
    TextureShader shader = shader_of(
        "texture_2d(); dot_product_2d_1of2(tex0); "
        "dot_product_2d_2of2(tex0);");
    shader.units[3] = shader.units[2];
    units[0] = rgba;
    EXPECT_EQ(problems(shader), "3: dot_product_2d in unit 3, expected dot_product in unit 2");
}

TEST_F(Consistency, TheLastUnitTakesNoBareDotProduct) {
    TextureShader shader;
    shader.units[2].operation = TextureOperation::texture_2d;
    shader.units[3] = {.operation = TextureOperation::dot_product, .previous = 2};
    EXPECT_EQ(problems(shader), "3: dot_product in the last unit, expected a unit behind it");
    machine.texture_units = 3;
    shader.units = {};
    shader.units[1].operation = TextureOperation::texture_2d;
    shader.units[2] = {.operation = TextureOperation::dot_product, .previous = 1};
    EXPECT_EQ(problems(shader), "2: dot_product in the last unit, expected a unit behind it");
}

TEST_F(Consistency, DotMappingsOfTheHardwareFitTheirTexels) {
    TextureShader shader = shader_of(
        "texture_2d(); dot_product_2d_1of2(tex0); "
        "dot_product_2d_2of2(tex0);");
    shader.units[1].dot_mapping = DotMapping::nv2a_gl;
    EXPECT_EQ(problems(shader), "");
    units[0] = signed_rgba;
    EXPECT_SAYS(problems(shader),
                "1: dot_product reads unit 0 by a dot mapping of the NV2A, whose texels are signed "
                "colours, expected unsigned colours");
    shader.units[1].dot_mapping = DotMapping::nv2a_hilo;
    EXPECT_SAYS(problems(shader), "expected unsigned HILO");
    shader.units[1].dot_mapping = DotMapping::nv2a_hemisphere_gl;
    EXPECT_SAYS(problems(shader), "expected signed HILO");
}

TEST_F(Consistency, OffsetsWithScaleNeedAMagnitude) {
    units[0] = texture_of(TexelFormat::dsdt8);
    EXPECT_EQ(problems("texture_2d(); offset_2d(tex0, 1, 0, 0, 1);"), "");
    EXPECT_EQ(problems("texture_2d(); offset_2d_scale(tex0, 1, 0, 0, 1, 1, 0);"),
              "1: offset_2d_scale reads unit 0, whose texels are DSDT, expected DSDT with "
              "magnitude");
    for (const TexelFormat format : {TexelFormat::dsdt8_mag8, TexelFormat::dsdt8_mag8_intensity8}) {
        units[0] = texture_of(format);
        EXPECT_EQ(problems("texture_2d(); offset_2d_scale(tex0, 1, 0, 0, 1, 1, 0);"), "");
    }
    TextureShader shader = shader_of("texture_2d(); offset_2d(tex0, 1, 0, 0, 1);");
    shader.bump_source = BumpSource::rgba8;
    EXPECT_SAYS(problems(shader), "expected colours");
}

TEST_F(Consistency, HiloOfTheRightSign) {
    machine = machine_profile("ideal");
    const std::string offset = "texture_2d(); offset_hilo_2d(tex0, 1, 0, 0, 1);";
    const std::string dependent = "texture_2d(); dependent_hilo(tex0);";
    units[0] = texture_of(TexelFormat::hilo16);
    EXPECT_EQ(problems(dependent), "");
    EXPECT_EQ(problems(offset),
              "1: offset_hilo_2d reads unit 0, whose texels are unsigned HILO, "
              "expected signed HILO");
    units[0] = texture_of(TexelFormat::signed_hilo8);
    EXPECT_EQ(problems(offset), "");
    EXPECT_EQ(problems(dependent),
              "1: dependent_hilo reads unit 0, whose texels are signed HILO, "
              "expected unsigned HILO");
}

TEST_F(Consistency, DotProductsReadOneSign) {
    const std::string dots = "texture_2d(); dot_product_2d_1of2(tex0); dot_product_2d_2of2(tex0);";
    for (const TexelFormat format : {TexelFormat::rgba8, TexelFormat::signed_rgba8,
                                     TexelFormat::hilo16, TexelFormat::signed_hilo16}) {
        units[0] = texture_of(format);
        EXPECT_EQ(problems(dots), "");
    }
    units[0] = texture_of(TexelFormat::signed_rgb8_unsigned_alpha8);
    EXPECT_SAYS(problems(dots),
                "1: dot_product reads unit 0, whose texels are colours with and "
                "without sign, expected colours of one sign or HILO; 2: ");
    units[0] = texture_of(TexelFormat::dsdt8);
    EXPECT_SAYS(problems(dots), "1: dot_product reads unit 0, whose texels are DSDT");
}

TEST_F(Consistency, ReflectionsReadAUnitInFrontOfTheirDotProducts) {
    units[2] = units[3] = cube();
    TextureShader shader = shader_of(
        "texture_2d(); dot_product_cube_map_and_reflect_cube_map_eye_from_qs_1of3(tex0); "
        "dot_product_cube_map_and_reflect_cube_map_eye_from_qs_2of3(tex0); "
        "dot_product_cube_map_and_reflect_cube_map_eye_from_qs_3of3(tex0);");
    EXPECT_EQ(problems(shader), "");
    shader.units[3].previous = 2;  // the diffuse half has a texel
    EXPECT_SAYS(problems(shader),
                "3: dot_product_reflect_cube_map reads unit 2, expected one in "
                "front of its dot products");
}

TEST_F(Consistency, TheDiffuseHalfNeedsItsReflection) {
    units[2] = units[3] = cube();
    TextureShader shader = shader_of(
        "texture_2d(); dot_product_cube_map_and_reflect_cube_map_const_eye_1of3(tex0, 0, 0, 1); "
        "dot_product_cube_map_and_reflect_cube_map_const_eye_2of3(tex0); "
        "dot_product_cube_map_and_reflect_cube_map_const_eye_3of3(tex0);");
    EXPECT_EQ(problems(shader), "");
    units[3] = rgba;  // the reflection is off, its dot product is not needed less
    EXPECT_EQ(problems(shader),
              "3: dot_product_const_eye_reflect_cube_map with a 2D texture, "
              "expected cube map");
    shader.units[3] = {.operation = TextureOperation::texture_2d};
    EXPECT_EQ(problems(shader),
              "2: dot_product_diffuse_cube_map in unit 2, expected a reflection "
              "in unit 3");
}

TEST_F(Consistency, TheBrdfReadsTwoUnitsOfHilo) {
    TextureDescription volume{.target = TextureTarget::three_d};
    units[2] = std::make_shared<const Texture>(std::vector<Image8>{Image8(1, 1)}, volume);
    const std::string brdf = "texture_2d(); texture_2d(); texture_brdf();";
    EXPECT_EQ(problems(brdf),
              "2: texture_brdf reads unit 0, whose texels are unsigned colours, expected HILO");
    units[0] = units[1] = texture_of(TexelFormat::hilo16);
    EXPECT_EQ(problems(brdf), "");
    units[1] = nullptr;
    EXPECT_SAYS(problems(brdf), "2: texture_brdf in unit 2, expected HILO texels in units 0 and 1");
}

TEST_F(Consistency, MachinesWithoutTheHardwaresReadingsRefuseThem) {
    TextureShader shader = shader_of(
        "texture_2d(); dot_product_2d_1of2(tex0); "
        "dot_product_2d_2of2(tex0);");
    shader.units[1].dot_mapping = DotMapping::nv2a_d3d;
    EXPECT_NO_THROW(shader.validate(machine));
    EXPECT_THROW(shader.validate(machine_profile("ideal")), Error);
    EXPECT_THROW((void)print_texture_shader(shader), Error);
    shader = {};
    shader.bump_source = BumpSource::rgba8;
    EXPECT_NO_THROW(shader.validate(machine));
    EXPECT_THROW(shader.validate(machine_profile("ideal")), Error);
    EXPECT_THROW(shader.validate(machine_profile("geforce256")), Error);
    EXPECT_THROW((void)print_texture_shader(shader), Error);
}

// --- pictures

/// A program that reads every unit: 0 times each of them is added to one.
CombinerProgram reading_all(Register reg) {
    using namespace combine;
    const Input zero = in(Register::zero);
    ProgramBuilder p;
    const auto add = [&](const ProductExpr& x, const ProductExpr& y, Register out) {
        const auto of_alpha = [](const ProductExpr& e) {
            return ProductExpr{alpha(e.x), alpha(e.y), e.kind};
        };
        p.stage().rgb().ab(x).cd(y).sum(out);
        p.alpha().ab(of_alpha(x)).cd(of_alpha(y)).sum(out);
    };
    add(mul(in(tex(0)), zero), mul(in(tex(1)), zero), Register::spare0);
    add(mul(in(tex(2)), zero), mul(in(tex(3)), zero), Register::spare1);
    add(mul(in(Register::spare0), one()), mul(in(Register::spare1), one()), Register::spare0);
    add(mul(in(reg), one()), mul(in(Register::spare0), one()), reg);
    return p.build();
}

/// What register `reg` starts from at every pixel; nothing where the background is.
std::vector<std::optional<Codes>> registers(Renderer& renderer, UnitScene& units, Register reg) {
    units.use(reading_all(reg));
    const Scene& scene = units.scene;
    const float one = scene.machine.numbers == NumberModel::nine_bit ? 255.0F : 16384.0F;
    Framebuffer frame(scene.width, scene.height, PixelFormat::rgba32f);
    renderer.render(scene, frame, {reg, 4});
    std::vector<std::optional<Codes>> all;
    for (int y = 0; y < scene.height; ++y) {
        const auto* pixel = reinterpret_cast<const float*>(frame.row(y));
        for (int x = 0; x < scene.width; ++x, pixel += 4) {
            if (pixel[0] == scene.background.r && pixel[3] == scene.background.a) {
                all.emplace_back();
                continue;
            }
            Codes codes{};
            for (std::size_t c = 0; c < 4; ++c)
                codes[c] = static_cast<int>(std::lround(pixel[c] * one));
            all.emplace_back(codes);
        }
    }
    return all;
}

/// Every unit at every pixel; counts the operations whose results are not black.
void check_shaders(const Machine& machine, unsigned shaders, std::vector<int>& seen) {
    Renderer renderer(RendererOptions{.threads = 1});
    for (unsigned seed = 0; seed < shaders; ++seed) {
        Random random(seed);
        UnitScene units(random, machine);
        const TextureShader& shader = *units.program.texture_shader;
        for (int unit = 0; unit < kTextureShaderUnits; ++unit) {
            const TextureOperation op = shader.units.at(static_cast<std::size_t>(unit)).operation;
            const auto got = registers(renderer, units, tex(unit));
            for (std::size_t i = 0; i < got.size(); ++i) {
                const UnitOracle oracle(shader, units.program.units, machine, units.coordinates[i]);
                const bool lives =
                    oracle.kept() && (!oracle.replaces_depth() ||
                                      (oracle.depth() >= 0.0F && oracle.depth() <= 1.0F));
                ASSERT_EQ(got[i].has_value(), lives)
                    << machine.name << ", seed " << seed << ", pixel " << i;
                if (!lives) continue;
                Codes want = oracle.result(unit);
                for (int& code : want) code = std::max(code, -code_of_one(machine.numbers));
                ASSERT_EQ(*got[i], want) << machine.name << ", seed " << seed << ", unit " << unit
                                         << ", pixel " << i << ": " << texture_operation_name(op);
                seen.at(static_cast<std::size_t>(op)) += *got[i] != Codes{} ? 1 : 0;
            }
        }
    }
}

/// Operations that deliver a texel and that no random shader showed.
std::string missing(const std::vector<int>& seen, const Machine& machine) {
    std::string names;
    for (int i = 0; i < kTextureOperationCount; ++i) {
        const auto op = static_cast<TextureOperation>(i);
        TextureShader alone;
        alone.units[3].operation = op;
        try {
            alone.validate(machine);
        } catch (const Error&) {
            continue;
        }
        if (has_texel(op) && seen.at(static_cast<std::size_t>(i)) < 50)
            names += std::string(texture_operation_name(op)) + " ";
    }
    return names;
}

TEST(TextureUnits, RandomShadersOfTheNv2aEqualTheOracle) {
    std::vector<int> seen(kTextureOperationCount);
    Machine machine = machine_profile("nv2a");
    check_shaders(machine, 900, seen);
    machine.magnitude_factor = MagnitudeFactor::clamped;
    check_shaders(machine, 100, seen);
    EXPECT_EQ(missing(seen, machine), "");
}

TEST(TextureUnits, RandomShadersOfTheIdealMachineEqualTheOracle) {
    std::vector<int> seen(kTextureOperationCount);
    check_shaders(machine_profile("ideal"), 900, seen);
    EXPECT_EQ(missing(seen, machine_profile("ideal")), "");
}

}  // namespace
}  // namespace burnish
