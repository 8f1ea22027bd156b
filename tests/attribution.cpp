// Where a picture's error comes from, stage by stage.
#include "lab/attribution.hpp"

#include <gtest/gtest.h>

#include <burnish/error.hpp>
#include <cmath>
#include <string>

#include "lab/measure_model.hpp"
#include "lab/stage_bits_text.hpp"
#include "textured_quad.hpp"

namespace burnish::lab {
namespace {

Scene ramp() {
    return textured_scene(make_texture({row_image({0, 255})}, {}), 128, 8, flat(0.25F, 0.75F));
}

Scene sphere(const char* machine) {
    ModelParameters parameters = constant_parameters(0.3F, 0.3F, 2.0F);
    Scene scene = measured_scene(parameters.material, machine);
    scene.width = scene.height = 48;
    expose(scene);
    return scene;
}

// Everything is the frame's: what it does alone, with all others, and what is left without it.
TEST(Attribution, OfAFrameAlone) {
    const Attribution of = attribute_error(ramp(), {.frame = 6}, 1);
    EXPECT_EQ(of.pixels, 128U * 8U);
    EXPECT_FALSE(of.plan.has_value());  // a program has no formula
    ASSERT_EQ(of.stages.size(), 6U);    // with one general stage
    for (const StageError& stage : of.stages) {
        const bool is_frame = stage.stage == "frame";
        EXPECT_EQ(stage.only, is_frame ? of.all : 0.0) << stage.stage;
        EXPECT_EQ(stage.all_but, is_frame ? 0.0 : of.all) << stage.stage;
        EXPECT_EQ(stage.cumulative, is_frame ? of.all : 0.0) << stage.stage;
    }
    // Uniform between two codes of 63: 1/63 / sqrt(12), within what 128 columns can tell.
    EXPECT_NEAR(of.all * 63.0 * std::sqrt(12.0), 1.0, 0.1);
}

// Roundings that know nothing of each other add up as squares. (Those of nine-bit machines do: what
// `expand` takes for 1/2 undoes what its rounding did.)
TEST(Attribution, AddsUpAsSquares) {
    StageBits bits;
    set_stage_bits(bits, "8");
    const Attribution of = attribute_error(sphere("ideal"), bits, 2);
    double squares = 0.0;
    for (const StageError& stage : of.stages) {
        squares += stage.only * stage.only;
        EXPECT_LT(stage.all_but, 1.1 * of.all) << stage.stage;
    }
    EXPECT_NEAR(std::sqrt(squares) / of.all, 1.0, 0.2);
}

// The last row is all stages, and with the bits of a machine nothing is left of its error.
TEST(Attribution, OfAMachine) {
    const Scene scene = sphere("geforce256");
    const Attribution of = attribute_error(scene, machine_bits(scene.machine), 2);
    ASSERT_EQ(of.stages.size(), 5U + 2U);
    EXPECT_EQ(of.stages[3].stage, "stage 0");
    EXPECT_NE(of.stages[3].text.find("expand"), std::string::npos);
    EXPECT_DOUBLE_EQ(of.stages.back().cumulative, of.all);
    EXPECT_EQ(of.stages[5].only, 0.0);  // no table
    EXPECT_GT(of.machine, 0.002);
    EXPECT_LT(of.rest, 0.05 * of.machine);
    ASSERT_TRUE(of.plan.has_value());
    EXPECT_LT(*of.plan, of.machine);
}

TEST(Attribution, OfAPixelEndsAtTheMachines) {
    const Scene scene = sphere("geforce256");
    const StageBits bits = machine_bits(scene.machine);
    const PixelAttribution of = attribute_pixel(scene, bits, 24, 24, 1);
    ASSERT_EQ(of.steps.size(), 1U + 5U + 2U);
    glm::dvec3 sum = of.steps.front().color;
    for (const PixelStep& step : of.steps) sum += step.change;
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(sum[c], of.steps.back().color[c], 1e-12);
        EXPECT_NEAR(of.steps.back().color[c], of.machine[c], 1e-6);
    }
    EXPECT_THROW(attribute_pixel(scene, bits, 0, 0, 1), Error);   // background
    EXPECT_THROW(attribute_pixel(scene, bits, 48, 0, 1), Error);  // outside
}

TEST(StageBitsText, SetsStages) {
    StageBits bits;
    set_stage_bits(bits, "8");
    EXPECT_EQ(bits.half_vector, 8);
    EXPECT_EQ(bits.frame, 8);
    EXPECT_EQ(bits.combiners, 9);
    set_stage_bits(bits, "table=exact,stage1=12,rounding=shift8");
    EXPECT_EQ(bits.table, kExactBits);
    EXPECT_EQ(bits.combiner_stages, (std::vector<int>{9, 12}));
    EXPECT_EQ(bits.rounding, BitRounding::shift8);
    set_stage_bits(bits, "combiners=10");
    EXPECT_TRUE(bits.combiner_stages.empty());
}

std::string complaint(std::string_view text) {
    StageBits bits;
    try {
        set_stage_bits(bits, text);
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

TEST(StageBitsText, SaysWhatItExpects) {
    EXPECT_EQ(complaint("frame=25"), "bits of frame: '25', expected 1 .. 24 or exact");
    EXPECT_EQ(complaint("combiners=1"), "bits of combiners: '1', expected 2 .. 24 or exact");
    EXPECT_EQ(complaint("rounding=up"),
              "rounding 'up', expected one of nearest, truncate, shift8, stochastic");
    EXPECT_EQ(complaint("frame"), "bits 'frame', expected a number or KEY=VALUE,..");
    EXPECT_NE(complaint("stage16=9").find("stage0 .. stage15"), std::string::npos);
    EXPECT_NE(complaint("999999999999").find("expected"), std::string::npos);
}

}  // namespace
}  // namespace burnish::lab
