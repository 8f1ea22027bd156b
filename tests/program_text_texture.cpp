#include <burnish/error.hpp>

#include "program_text.hpp"

/// Texture shaders: every statement, what it means, what is wrong with others.
namespace burnish {
namespace {

/// What unit `unit` of `!!TS1.0 body` does.
TextureUnit unit(const std::string& body, std::size_t unit) {
    return texture_shader("!!TS1.0 " + body).units.at(unit);
}

TEST(TextureShaderText, MissingStatementsAreNop) {
    EXPECT_EQ(texture_shader("!!TS1.0"), TextureShader());
    EXPECT_EQ(texture_shader("!!TS1.0 nop(); nop(); nop(); nop();"), TextureShader());
}

TEST(TextureShaderText, PlainOperations) {
    for (const TextureOperation operation :
         {TextureOperation::texture_1d, TextureOperation::texture_2d, TextureOperation::texture_3d,
          TextureOperation::texture_rectangle, TextureOperation::texture_cube_map,
          TextureOperation::pass_through}) {
        TextureUnit want;
        want.operation = operation;
        EXPECT_EQ(unit(std::string(texture_operation_name(operation)) + "();", 0), want);
    }
}

TEST(TextureShaderText, CullFragment) {
    const TextureUnit got = unit(
        "nop(); cull_fragment(GEQUAL_TO_ZERO, LESS_THAN_ZERO, LESS_THAN_ZERO, "
        "GEQUAL_TO_ZERO);",
        1);
    EXPECT_EQ(got.operation, TextureOperation::cull_fragment);
    EXPECT_EQ(got.cull, (std::array{CullTest::greater_or_equal_zero, CullTest::less_than_zero,
                                    CullTest::less_than_zero, CullTest::greater_or_equal_zero}));
}

TEST(TextureShaderText, OffsetsHaveTheMatrixColumnByColumn) {
    for (const char* name :
         {"offset_2d", "offset_rectangle", "offset_projective_2d", "offset_projective_rectangle",
          "offset_hilo_2d", "offset_hilo_rectangle", "offset_hilo_projective_2d",
          "offset_hilo_projective_rectangle"}) {
        const TextureUnit got = unit(
            "texture_2d(); texture_2d(); " + std::string(name) + "(tex1, 1, -2.5, +3, .25);", 2);
        EXPECT_EQ(texture_operation_name(got.operation), name);
        EXPECT_EQ(got.previous, 1);
        EXPECT_EQ(got.offset_matrix, glm::mat2(1.0F, -2.5F, 3.0F, 0.25F));
        // ds moves s by the first number and t by the second.
        EXPECT_EQ(got.offset_matrix * glm::vec2(1.0F, 0.0F), glm::vec2(1.0F, -2.5F));
    }
}

TEST(TextureShaderText, OffsetsWithScaleAndThenBias) {
    for (const char* name : {"offset_2d_scale", "offset_rectangle_scale",
                             "offset_projective_2d_scale", "offset_projective_rectangle_scale"}) {
        const TextureUnit got =
            unit("texture_2d(); " + std::string(name) + "(tex0, 1, 2, 3, 4, 0.5, -0.125);", 1);
        EXPECT_EQ(texture_operation_name(got.operation), name);
        EXPECT_EQ(got.offset_matrix, glm::mat2(1.0F, 2.0F, 3.0F, 4.0F));
        EXPECT_EQ(got.offset_scale, 0.5F);
        EXPECT_EQ(got.offset_bias, -0.125F);
    }
}

TEST(TextureShaderText, DependentOperations) {
    for (const char* name : {"dependent_ar", "dependent_gb", "dependent_hilo", "dependent_rgb_3d",
                             "dependent_rgb_cube_map"}) {
        const TextureUnit got =
            unit("texture_2d(); nop(); texture_2d(); " + std::string(name) + "(tex2);", 3);
        EXPECT_EQ(texture_operation_name(got.operation), name);
        EXPECT_EQ(got.previous, 2);
    }
}

TEST(TextureShaderText, DotMappings) {
    const auto mapping = [](const std::string& argument) {
        return unit("texture_2d(); dot_product_pass_through(" + argument + ");", 1).dot_mapping;
    };
    EXPECT_EQ(mapping("tex0"), DotMapping::unsigned_identity);
    EXPECT_EQ(mapping("expand(tex0)"), DotMapping::expand);
    EXPECT_EQ(mapping("force_blue_to_one(tex0)"), DotMapping::force_blue_to_one);
}

TEST(TextureShaderText, SingleDotProducts) {
    for (const char* name :
         {"dot_product_pass_through", "dot_product_1d", "dot_product_affine_depth_replace"}) {
        const TextureUnit got = unit("texture_2d(); " + std::string(name) + "(expand(tex0));", 1);
        EXPECT_EQ(texture_operation_name(got.operation), name);
        EXPECT_EQ(got.dot_mapping, DotMapping::expand);
    }
}

TEST(TextureShaderText, PairsOfDotProducts) {
    for (const char* name :
         {"dot_product_2d", "dot_product_rectangle", "dot_product_depth_replace"}) {
        const std::string word = name;
        const TextureShader shader = texture_shader(
            "!!TS1.0 texture_2d(); " + word + "_1of2(tex0); " + word + "_2of2(expand(tex0));");
        EXPECT_EQ(shader.units[1].operation, TextureOperation::dot_product);
        EXPECT_EQ(shader.units[1].dot_mapping, DotMapping::unsigned_identity);
        EXPECT_EQ(texture_operation_name(shader.units[2].operation), name);
        EXPECT_EQ(shader.units[2].dot_mapping, DotMapping::expand);
    }
}

std::string triple(const std::string& word, const std::string& eye = "") {
    return "!!TS1.0 texture_2d(); " + word + "_1of3(tex0" + eye + "); " + word + "_2of3(tex0); " +
           word + "_3of3(tex0);";
}

void expect_operations(const std::string& text, TextureOperation second, TextureOperation third) {
    const TextureShader shader = texture_shader(text);
    EXPECT_EQ(shader.units[1].operation, TextureOperation::dot_product) << text;
    EXPECT_EQ(shader.units[2].operation, second) << text;
    EXPECT_EQ(shader.units[3].operation, third) << text;
}

TEST(TextureShaderText, TriplesOfDotProducts) {
    using T = TextureOperation;
    expect_operations(triple("dot_product_3d"), T::dot_product, T::dot_product_3d);
    expect_operations(triple("dot_product_cube_map"), T::dot_product, T::dot_product_cube_map);
    expect_operations(triple("dot_product_reflect_cube_map_eye_from_qs"), T::dot_product,
                      T::dot_product_reflect_cube_map);
    expect_operations(triple("dot_product_reflect_cube_map_const_eye", ", 0, 0, 1"), T::dot_product,
                      T::dot_product_const_eye_reflect_cube_map);
    expect_operations(triple("dot_product_cube_map_and_reflect_cube_map_eye_from_qs"),
                      T::dot_product_diffuse_cube_map, T::dot_product_reflect_cube_map);
    expect_operations(triple("dot_product_cube_map_and_reflect_cube_map_const_eye", ", 0, 0, 1"),
                      T::dot_product_diffuse_cube_map, T::dot_product_const_eye_reflect_cube_map);
}

TEST(TextureShaderText, TheFirstOfThreeGivesTheEyeToTheLast) {
    const TextureShader shader =
        texture_shader(triple("dot_product_reflect_cube_map_const_eye", ", 0.5, -1, 2"));
    EXPECT_EQ(shader.units[3].const_eye, glm::vec3(0.5F, -1.0F, 2.0F));
    EXPECT_EQ(shader.units[1].const_eye, TextureUnit().const_eye);
    expect_texture_error(
        "!!TS1.0 texture_2d(); dot_product_reflect_cube_map_const_eye_1of3(tex0@); "
        "dot_product_reflect_cube_map_const_eye_2of3(tex0); "
        "dot_product_reflect_cube_map_const_eye_3of3(tex0);",
        "found ')', expected ','");
    expect_texture_error(
        "!!TS1.0 texture_2d(); dot_product_cube_map_1of3(tex0@, 0, 0, 1); "
        "dot_product_cube_map_2of3(tex0); dot_product_cube_map_3of3(tex0);",
        "found ',', expected ')'");
}

TEST(TextureShaderText, BrdfModeOfTheNv2a) {
    EXPECT_EQ(unit("texture_2d(); texture_2d(); texture_brdf();", 2).operation,
              TextureOperation::texture_brdf);
    expect_texture_error("!!TS1.0 texture_2d(); @texture_brdf();", "in unit 1, expected two units");
    expect_texture_error("!!TS1.0 texture_2d(); nop(); @texture_brdf();", "expected two units");
}

TEST(TextureShaderText, AnOperationWithTexelsMayBeReadLater) {
    EXPECT_EQ(unit("texture_2d(); dot_product_2d_1of2(tex0); dot_product_2d_2of2(tex0); "
                   "dependent_ar(tex2);",
                   3)
                  .previous,
              2);
}

TEST(TextureShaderErrors, FourStatements) {
    expect_texture_error("!!TS1.0 nop(); nop(); nop(); nop();\n@nop(); nop();",
                         "'nop' begins a fifth statement, there are 4 units");
}

TEST(TextureShaderErrors, PreviousStage) {
    expect_texture_error("!!TS1.0\ntexture_2d();\n@dot_product_2d_2of2(tex0);",
                         "the previous stage of 'dot_product_2d_2of2' is missing, expected "
                         "dot_product_2d_1of2");
    expect_texture_error(
        "!!TS1.0 texture_2d(); dot_product_2d_1of2(tex0); "
        "@dot_product_rectangle_2of2(tex0);",
        "'dot_product_rectangle_2of2' does not match the previous stage");
    expect_texture_error(
        "!!TS1.0 texture_2d(); dot_product_3d_1of3(tex0); "
        "@dot_product_3d_3of3(tex0);",
        "expected dot_product_3d_2of3");
}

TEST(TextureShaderErrors, NextStage) {
    expect_texture_error("!!TS1.0 texture_2d();\n@dot_product_2d_1of2(tex0);",
                         "the next stage of 'dot_product_2d_1of2' is missing, expected "
                         "dot_product_2d_2of2");
    expect_texture_error("!!TS1.0 texture_2d(); dot_product_2d_1of2(tex0); @texture_2d();",
                         "does not match the previous stage 'dot_product_2d_1of2', expected "
                         "dot_product_2d_2of2");
    expect_texture_error("!!TS1.0 texture_2d(); nop(); nop(); @dot_product_2d_1of2(tex0);",
                         "is missing");
}

TEST(TextureShaderErrors, References) {
    expect_texture_error("!!TS1.0 texture_2d(); dependent_ar(@tex1);", "unit 1 refers to itself");
    expect_texture_error("!!TS1.0 texture_2d(); dependent_ar(@);", "found ')', expected tex0");
}

TEST(TextureShaderErrors, ReferencesToLaterUnits) {
    expect_texture_error("!!TS1.0 texture_2d(); dependent_ar(@tex2);",
                         "tex2 is not ready in unit 1");
    expect_texture_error("!!TS1.0 dependent_ar(@tex0);", "unit 0 refers to itself");
    expect_texture_error("!!TS1.0 texture_2d(); dependent_ar(@tex3);",
                         "expected tex0, tex1 or tex2");
    expect_texture_error("!!TS1.0 texture_2d(); dependent_ar(@spare0);",
                         "expected tex0, tex1 or tex2");
}

TEST(TextureShaderErrors, ReferencesToUnitsWithoutOutput) {
    expect_texture_error("!!TS1.0 nop(); dependent_ar(@tex0);", "tex0 has no output");
    expect_texture_error(
        "!!TS1.0 texture_2d(); dot_product_2d_1of2(tex0); "
        "dot_product_2d_2of2(@tex1);",
        "tex1 has no output, its operation is dot_product");
    expect_texture_error(
        "!!TS1.0 cull_fragment(LESS_THAN_ZERO, LESS_THAN_ZERO, LESS_THAN_ZERO, "
        "LESS_THAN_ZERO); dependent_gb(@tex0);",
        "tex0 has no output");
}

TEST(TextureShaderErrors, DepthIsReplacedOnce) {
    expect_texture_error(
        "!!TS1.0 texture_2d(); dot_product_depth_replace_1of2(tex0); "
        "dot_product_depth_replace_2of2(tex0); "
        "@dot_product_affine_depth_replace(tex0);",
        "replaces the depth, as an earlier unit does");
    TextureShader shader;
    for (TextureUnit& unit : shader.units)
        unit.operation = TextureOperation::dot_product_affine_depth_replace;
    shader.units[0].operation = TextureOperation::texture_2d;
    EXPECT_THROW(shader.validate(Machine()), Error);
}

TEST(TextureShaderErrors, Arguments) {
    expect_texture_error("!!TS1.0 texture_2d(@tex0);", "found 'tex0', expected ')'");
    expect_texture_error("!!TS1.0 texture_2d(); offset_2d(tex0, 1, 2, 3@);", "expected ','");
    expect_texture_error("!!TS1.0 texture_2d(); offset_2d_scale(tex0, 1, 2, 3, 4@);",
                         "expected ','");
    expect_texture_error(
        "!!TS1.0 texture_2d(); offset_2d(tex0, 1, 2, 3, @9" + std::string(50, '9') + ");",
        "too large");
    expect_texture_error("!!TS1.0 texture_2d(); dependent_ar(@expand(tex0));",
                         "found 'expand', expected tex0");
    expect_texture_error("!!TS1.0 cull_fragment(LESS_THAN_ZERO, @GREATER);", "unrecognized token");
    expect_texture_error("!!TS1.0 cull_fragment(LESS_THAN_ZERO, @tex0);",
                         "found 'tex0', expected GEQUAL_TO_ZERO or LESS_THAN_ZERO");
}

TEST(TextureShaderErrors, Words) {
    expect_texture_error("!!TS1.0 @texture_2dd();",
                         "unrecognized token 'texture_2dd', did you mean 'texture_2d'?");
    expect_texture_error("!!TS1.0 @dot_product_2d_3of2(tex0);",
                         "did you mean 'dot_product_2d_1of2'?");
    expect_texture_error("!!TS1.0 @dot_product_2d(tex0);", "unrecognized token");
    expect_texture_error("!!TS1.0 @xyzzyxyzzyxyzzy();", "expected a texture operation");
    expect_texture_error("!!TS1.0 texture_2d()@", "expected ';'");
    expect_texture_error("!!TS1.0 texture_2d()\n@texture_2d();", "expected ';' in front of it");
}

TEST(TextureShaderErrors, OneErrorDoesNotMakeOthers) {
    // The unknown operation stands for something that later units may rely on.
    expect_texture_error("!!TS1.0 @textur2d(); dependent_ar(tex0); texture_2d();", "unrecognized");
    expect_texture_error(
        "!!TS1.0 texture_2d(); @dot_product_2d_1of_2(tex0); "
        "dot_product_2d_2of2(tex0);",
        "unrecognized");
}

std::string complaint(const std::string& text, std::string_view profile) {
    try {
        texture_shader(text).validate(machine_profile(profile));
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::bad_program);
        return error.what();
    }
    return "";
}

TEST(TextureShaderMachines, TheGeForce256OnlyFetches) {
    EXPECT_EQ(complaint("!!TS1.0 texture_2d(); texture_cube_map();", "geforce256"), "");
    EXPECT_EQ(complaint("!!TS1.0 texture_2d(); texture_2d(); texture_2d();", "geforce256"),
              "texture unit 2: is used, machine 'geforce256' has texture units 0 .. 1");
    for (const char* operation : {"texture_3d()", "pass_through()"})
        EXPECT_NE(complaint("!!TS1.0 " + std::string(operation) + ";", "geforce256"), "");
    EXPECT_EQ(complaint("!!TS1.0 texture_2d(); dependent_ar(tex0);", "geforce256"),
              "texture unit 1: machine 'geforce256' does not have dependent_ar");
}

TEST(TextureShaderMachines, TheNv2aLacksTheThirdExtension) {
    for (const char* operation :
         {"dependent_ar(tex0)", "offset_rectangle_scale(tex0, 1, 0, 0, 1, 1, 0)"})
        EXPECT_EQ(complaint("!!TS1.0 texture_2d(); " + std::string(operation) + ";", "nv2a"), "");
    for (const char* operation :
         {"dependent_hilo(tex0)", "dependent_rgb_3d(tex0)", "dependent_rgb_cube_map(tex0)",
          "offset_projective_2d(tex0, 1, 0, 0, 1)", "offset_hilo_2d(tex0, 1, 0, 0, 1)",
          "offset_hilo_projective_rectangle(tex0, 1, 0, 0, 1)", "dot_product_1d(tex0)",
          "dot_product_pass_through(tex0)", "dot_product_affine_depth_replace(tex0)",
          "dot_product_2d_1of2(force_blue_to_one(tex0)); dot_product_2d_2of2(tex0)"}) {
        const std::string text = "!!TS1.0 texture_2d(); " + std::string(operation) + ";";
        EXPECT_NE(complaint(text, "nv2a"), "") << operation;
        EXPECT_EQ(complaint(text, "ideal"), "") << operation;
    }
    EXPECT_EQ(complaint("!!TS1.0 texture_2d(); texture_2d(); texture_brdf();", "nv2a"), "");
}

}  // namespace
}  // namespace burnish
