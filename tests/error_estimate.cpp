// The error estimate of compiled models against pictures.
#include "models/error_estimate.hpp"

#include <gtest/gtest.h>

#include <burnish/error.hpp>
#include <burnish/materials.hpp>
#include <burnish/renderer.hpp>
#include <ostream>
#include <string>
#include <vector>

#include "lab/measure_model.hpp"

namespace burnish {
namespace {

Machine with_passes(std::string_view name) {
    Machine machine = machine_profile(name);
    machine.multipass = true;
    return machine;
}

struct Cell {
    Model model;
    const char* machine;
    const char* set;  ///< null: constants
};
void PrintTo(const Cell& cell, std::ostream* to) {
    *to << cell.machine << ", " << (cell.set != nullptr ? cell.set : "constants");
}

class MeasuredPictures : public testing::TestWithParam<Cell> {};

TEST_P(MeasuredPictures, AreWithinTheEstimate) {
    const auto [model, machine, set] = GetParam();
    const lab::ModelParameters parameters = set != nullptr
                                                ? lab::shift_variant_parameters(set)
                                                : lab::constant_parameters(0.15F, 0.5F, 16.0F);
    Material material = parameters.material;
    material.model = model;
    const ErrorEstimate estimate = estimate_error(material, with_passes(machine));
    const lab::ModelMeasurement measured = lab::measure_model(model, machine, parameters);
    ASSERT_EQ(measured.refusal, "");
    EXPECT_LE(measured.errors.rmse, estimate.rms);
    EXPECT_LE(measured.errors.p99, estimate.largest);
    // Of use: not all of the picture, and not a machine of eight bits where there are sixteen.
    EXPECT_LE(estimate.rms, 6.0 * measured.errors.rmse);
}
INSTANTIATE_TEST_SUITE_P(, MeasuredPictures,
                         testing::Values(Cell{Model::abp, "geforce256", nullptr},
                                         Cell{Model::abp_modified, "nv2a", "corrosion"},
                                         Cell{Model::banks, "nv2a", nullptr},
                                         Cell{Model::ward, "ideal", nullptr},
                                         Cell{Model::blinn_phong, "ideal", "brushed"}),
                         [](const auto& cell) {
                             return std::string(
                                        model_names()[static_cast<std::size_t>(cell.param.model)]) +
                                    "_" + cell.param.machine;
                         });

// Differences to the same formula: the root of their mean square is a norm, so it is at most the
// sum.
TEST(RoundLobePictures, AreBlinnPhongWithinBothEstimates) {
    for (const std::string_view name : {"geforce256", "nv2a", "ideal"}) {
        Material material = lab::constant_parameters(1.0F, 1.0F, 16.0F).material;
        std::vector<Framebuffer> pictures;
        double rms = 0.0, largest = 0.0;
        for (const Model model : {Model::abp, Model::blinn_phong}) {
            material.model = model;
            Scene scene = lab::measured_scene(material, name);
            lab::expose(scene);
            Framebuffer& picture =
                pictures.emplace_back(scene.width, scene.height, PixelFormat::rgba32f);
            Renderer({.threads = 1}).render(scene, picture);
            const ErrorEstimate estimate = estimate_error(material, scene.machine);
            rms += estimate.rms;
            largest += estimate.largest;
        }
        const metrics::FrameErrors errors = metrics::interior_errors(pictures[0], pictures[1]);
        EXPECT_LE(errors.rmse, rms) << name;
        EXPECT_LE(errors.p99, largest) << name;
    }
}

TEST(ErrorEstimate, IsTheSameAgain) {
    Material material;
    material.model = Model::abp_modified;
    const ErrorEstimate a = estimate_error(material, machine_profile("nv2a"));
    const ErrorEstimate b = estimate_error(material, machine_profile("nv2a"));
    EXPECT_EQ(a.rms, b.rms);
    EXPECT_EQ(a.largest, b.largest);
    EXPECT_GT(a.rms, 0.0);
}

TEST(ErrorEstimate, OfTextsIsThatOfTheModelTheySay) {
    Material material;
    material.model = Model::abp_modified;
    const ErrorEstimate named = estimate_error(material, machine_profile("nv2a"));
    material.model = Model::text;
    material.model_text =
        "X = t / alpha_x\nY = b / alpha_y\n"
        "(ks * max(0, 1 - dot(h, X)^2 - dot(h, Y)^2) + kd) * n_dot_l";
    const ErrorEstimate text = estimate_error(material, machine_profile("nv2a"));
    EXPECT_NEAR(text.rms, named.rms, 1e-9);
    EXPECT_NEAR(text.largest, named.largest, 1e-9);
}

TEST(ErrorEstimate, OfDoublePrecisionIsNothing) {
    const ErrorEstimate estimate = estimate_error(Material{}, machine_profile("double"));
    EXPECT_EQ(estimate.rms, 0.0);
    EXPECT_EQ(estimate.largest, 0.0);
}

TEST(ErrorEstimate, RefusesWhatTheMachineCannot) {
    Material material;
    material.model = Model::ggx;
    EXPECT_THROW(estimate_error(material, machine_profile("geforce256")), Error);
    material.model = Model::text;
    material.model_text = "ks * nothing";
    EXPECT_THROW(estimate_error(material, machine_profile("ideal")), Error);
}

}  // namespace
}  // namespace burnish
