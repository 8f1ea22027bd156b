// Reflectance models on machines against the double renderer, and the numbers that say how far off.
#include <gtest/gtest.h>

#include <burnish/error.hpp>
#include <burnish/files.hpp>
#include <burnish/materials.hpp>
#include <burnish/renderer.hpp>
#include <string>
#include <vector>

#include "core/read_text.hpp"
#include "lab/document_section.hpp"
#include "lab/measure_model.hpp"
#include "scratch_directory.hpp"

namespace burnish::lab {
namespace {

class OnIdeal : public testing::TestWithParam<int> {};

TEST_P(OnIdeal, ErrorsAreSmall) {
    const Model model{GetParam()};
    std::vector<ModelParameters> all{constant_parameters(0.05F, 0.2F, 16.0F),
                                     shift_variant_parameters("corrosion")};
    if (has_widths(model)) all.push_back(constant_parameters(0.05F, 0.05F, 2.0F));
    if (has_exponent(model)) all.push_back(constant_parameters(0.05F, 0.05F, 128.0F));
    for (const ModelParameters& parameters : all) {
        const ModelMeasurement measured = measure_model(model, "ideal", parameters);
        ASSERT_EQ(measured.refusal, "") << parameters.name;
        EXPECT_GT(measured.errors.pixels, 30000U) << parameters.name;
        EXPECT_EQ(measured.passes, 1) << parameters.name;
        EXPECT_LT(measured.errors.rmse, 0.0015) << parameters.name;
        EXPECT_LT(measured.errors.step_excess * 255.0, 2.0) << parameters.name;
        // With the same corners and texel coordinates nothing is left but arithmetic and tables.
        ASSERT_EQ(measured.on_its_grid.has_value(), parameters.shift_variant);
        if (!parameters.shift_variant) continue;
        EXPECT_LT(measured.on_its_grid->rmse, measured.errors.rmse + 2e-5) << parameters.name;
        EXPECT_LT(measured.on_its_grid->step_excess * 255.0, 2.0) << parameters.name;
    }
}
INSTANTIATE_TEST_SUITE_P(EveryModel, OnIdeal, testing::Range(0, 13), [](const auto& model) {
    return std::string(model_names()[static_cast<std::size_t>(model.param)]);
});

// A half vector of nine bits is off by up to 1/254 in each component, 1/254 / sqrt(3) in the mean;
// three of them along t, over alpha_x = 0.15, move u by 0.015 and 1 - u^2 by up to 0.03, over the
// fifteenth of the sphere that the lobe covers: 0.03 * 0.8 * sqrt(1/15) = 0.006, and as much again
// for products and maps.
TEST(OnGeforce256, ModifiedModelsAreOnePass) {
    for (const Model model : {Model::abp_modified, Model::abp_modified_n4}) {
        const ModelMeasurement measured =
            measure_model(model, "geforce256", constant_parameters(0.15F, 0.5F, 2.0F));
        ASSERT_EQ(measured.refusal, "");
        EXPECT_EQ(measured.passes, 1);
        EXPECT_LE(measured.units, 2);
        EXPECT_LE(measured.stages, 2);
        EXPECT_LT(measured.errors.rmse, 0.012);
        EXPECT_LT(std::abs(measured.errors.bias), 0.001);
    }
}

TEST(MeasuredScene, PeakIsNineTenths) {
    Scene scene = measured_scene(constant_parameters(0.15F, 0.5F, 16.0F).material, "double");
    scene.objects.front().material =
        std::make_shared<Material>(constant_parameters(0.05F, 0.05F, 16.0F).material);
    expose(scene);
    Framebuffer frame(scene.width, scene.height, PixelFormat::rgba32f);
    Renderer().render(scene, frame);
    EXPECT_NEAR(metrics::interior_peak(frame), 0.9, 1e-6);
}

class DocumentSection : public ScratchDirectory {};

TEST_F(DocumentSection, IsReplacedBetweenItsLines) {
    const std::filesystem::path file = path("a.md");
    save_text("x\n<!-- begin t -->\nold\n<!-- end t -->\ny\n", file);
    replace_section(file, "t", "new\n");
    EXPECT_EQ(read_text(file), "x\n<!-- begin t -->\nnew\n<!-- end t -->\ny\n");
    EXPECT_THROW(replace_section(file, "u", ""), Error);
}

}  // namespace
}  // namespace burnish::lab
