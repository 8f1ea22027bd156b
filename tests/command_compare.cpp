// `burnish compare`: what it prints, writes and returns. Few runs: OpenImageIO loads for a quarter
// of a second.
#include <gtest/gtest.h>

#include <burnish/files.hpp>
#include <burnish/texture.hpp>
#include <limits>
#include <string>
#include <vector>

#include "metrics/flip.hpp"
#include "tests/float_picture.hpp"
#include "tests/json.hpp"
#include "tests/run_command.hpp"

namespace burnish {
namespace {

class Compare : public Command {
  protected:
    void SetUp() override {
        Command::SetUp();
        save_image(plain(16, 12, 0.25F), path("reference.exr"));
        save_image(plain(16, 12, 0.375F), path("test.exr"));
    }
};

TEST_F(Compare, PrintsEveryMetric) {
    const Result text = run("compare test.exr reference.exr");
    EXPECT_EQ(text.code, 0) << text.err;
    EXPECT_EQ(text.err, "");
    EXPECT_SAYS(text.out,
                "pixels            192\nrmse              0.125\npsnr              18.0618\n");
    EXPECT_SAYS(text.out, "energy_ratio      1.5\n");
    for (const char* name : {"max", "p99", "bias", "ssim", "flip", "flip_hdr", "levels",
                             "reference_levels", "step_excess", "nonfinite"})
        EXPECT_SAYS(text.out, std::string("\n") + name + " ");
    EXPECT_EQ(entries(), (std::vector<std::string>{"reference.exr", "test.exr"}));
}

TEST_F(Compare, PrintsJson) {
    const Result result = run("compare test.exr test.exr --json --mask interior");
    ASSERT_EQ(result.code, 0) << result.err;
    const Json json = Json::parse(result.out);
    EXPECT_EQ(json["test"].text, "test.exr");
    EXPECT_EQ(json["reference"].text, "test.exr");
    EXPECT_EQ(json["mask"].text, "interior");
    EXPECT_EQ(json["encoding"].text, "srgb");
    EXPECT_EQ(json["pixels"].number, 140.0);            // 14 x 10
    EXPECT_EQ(json["exposures"]["count"].number, 2.0);  // of one luminance
    EXPECT_EQ(json["metrics"].object.size(), 13U);
    EXPECT_EQ(json["metrics"]["rmse"].number, 0.0);
    EXPECT_EQ(json["metrics"]["psnr"].kind, Json::Kind::null);  // infinite
    EXPECT_TRUE(json["passed"].boolean);
}

TEST_F(Compare, PrintsOnlyWhatIsAskedFor) {
    EXPECT_EQ(
        run("compare --metric p99,rmse test.exr reference.exr --metric max").out,
        "pixels     192\nrmse       0.125\nmax        0.125\np99        0.125\nnonfinite  0\n");
}

TEST_F(Compare, PassesOnTheThreshold) {
    const Result good =
        run("compare test.exr reference.exr --metric rmse --threshold rmse=0.125 "
            "--threshold psnr=18,energy_ratio=0.5,bias=0.125 --quiet");
    EXPECT_EQ(good.code, 0);
    EXPECT_EQ(good.out + good.err, "");
}

TEST_F(Compare, FailsBeyondIt) {
    const Result bad =
        run("compare test.exr reference.exr --metric bias --json --threshold rmse=0.1 "
            "--threshold psnr=20 --threshold energy_ratio=0.4 --threshold max=1");
    EXPECT_EQ(bad.code, 1);
    EXPECT_EQ(bad.err,
              "burnish: test.exr: rmse 0.125, expected at most 0.1\n"
              "burnish: test.exr: psnr 18.0618, expected at least 20\n"
              "burnish: test.exr: energy_ratio 1.5, expected 1 +- 0.4\n");
    const Json json = Json::parse(bad.out);  // numbers are there all the same
    EXPECT_FALSE(json["passed"].boolean);
    EXPECT_EQ(json["metrics"]["bias"].number, 0.125);
    EXPECT_EQ(json["metrics"]["max"].number, 0.125);
}

TEST_F(Compare, WhatIsNoNumberIsReportedAndFailsLimits) {
    Framebuffer picture = plain(16, 12, 0.375F);
    set(picture, 3, 3, {std::numeric_limits<float>::quiet_NaN(), 0.0F, 0.0F, 1.0F});
    set(picture, 4, 3, {0.0F, std::numeric_limits<float>::infinity(), 0.0F, 1.0F});
    save_image(picture, path("nan.exr"));
    const Result plainly = run("compare nan.exr reference.exr --metric rmse");
    EXPECT_EQ(plainly.code, 0);
    EXPECT_EQ(plainly.out, "pixels     190\nrmse       0.125\nnonfinite  2\n");
    EXPECT_SAYS(plainly.err, "burnish: nan.exr: 2 pixels are NaN or infinite");
    const Result limited = run("compare nan.exr reference.exr --threshold rmse=0.2");
    EXPECT_EQ(limited.code, 1);
    EXPECT_EQ(limited.err, "burnish: nan.exr: nonfinite 2, expected at most 0\n");
}

TEST_F(Compare, AMaskWithoutPixelsIsAnError) {
    save_image(Image8(4, 4), path("empty.png"));  // alpha 0 throughout
    expect_failure("compare empty.png empty.png --mask covered", 3,
                   "empty.png: no pixel to compare");
}

// 51 / 255 = 0.2 to the last bit of a float.
TEST_F(Compare, ReadsBytesAsTheirShareOf255) {
    Image8 bytes(16, 12);
    bytes.rgba.assign(bytes.rgba.size(), 51);
    save_image(bytes, path("bytes.png"));
    save_image(plain(16, 12, 0.2F), path("floats.exr"));
    EXPECT_SAYS(run("compare bytes.png floats.exr --metric max").out, "max        0\n");
}

TEST_F(Compare, FlipTakesItsOptions) {
    const Framebuffer test = noise(16, 12, 1), reference = noise(16, 12, 2);
    save_image(test, path("test.exr"));
    save_image(reference, path("reference.exr"));
    ASSERT_EQ(
        run("compare test.exr reference.exr --pixels-per-degree 30 --encoding linear --threads 3 "
            "--metric flip --heat-map flip.exr")
            .code,
        0);
    WorkerPool pool(1);
    metrics::FlipOptions options;
    options.pixels_per_degree = 30.0;
    options.encoding = metrics::Encoding::linear;
    const metrics::Plane map = metrics::flip(test, reference, options, pool);
    EXPECT_FLOAT_EQ(get(load_frame(path("flip.exr")), 5, 7).r, static_cast<float>(map.row(7)[5]));

    ASSERT_EQ(run("compare test.exr reference.exr --exposures -1,2.5 --metric flip_hdr "
                  "--heat-map flip_hdr.exr")
                  .code,
              0);
    options = {};
    options.exposures = metrics::Exposures{-1.0, 2.5, 4};
    const metrics::Plane hdr = metrics::flip_hdr(test, reference, options, pool);
    EXPECT_FLOAT_EQ(get(load_frame(path("flip_hdr.exr")), 5, 7).r,
                    static_cast<float>(hdr.row(7)[5]));
}

TEST_F(Compare, WritesPicturesOfTheError) {
    ASSERT_EQ(run("compare test.exr reference.exr --metric rmse --difference d.png --gain 4 "
                  "--absolute-difference a.exr --heat-map h.png")
                  .code,
              0);
    const Image8 difference = load_image(path("d.png"));
    EXPECT_EQ(difference.width, 16);
    EXPECT_EQ(difference.rgba[0], 192);  // 128 + 127 * 4 / 8, upwards
    EXPECT_EQ(get(load_frame(path("a.exr")), 5, 5), glm::vec4(0.125F, 0.125F, 0.125F, 1.0F));
    const Image8 heat = load_image(path("h.png"));  // some purple: FLIP is 0.4
    EXPECT_GT(heat.rgba[0], heat.rgba[1]);
    EXPECT_GT(heat.rgba[2], heat.rgba[1]);
}

TEST_F(Compare, SaysInOneLineWhatIsWrongWithFiles) {
    save_image(plain(16, 11, 0.0F), path("other.exr"));
    expect_failure("compare other.exr reference.exr", 3,
                   "other.exr: 16 x 11 pixels, expected 16 x 12 as in reference.exr");
    expect_failure("compare test.exr missing.exr", 3, "missing.exr: No such file");
    expect_failure("compare test.exr reference.exr --metric max --heat-map no/h.png", 3,
                   "no/h.png");
}

TEST_F(Compare, SaysInOneLineWhatIsWrongWithOptions) {
    const std::string pair = "compare test.exr reference.exr ";
    expect_failure("compare test.exr", 2, "REFERENCE");
    expect_failure(pair + "--metric rsme", 2, "did you mean 'rmse'");
    expect_failure(pair + "--threshold rmse", 2, "expected NAME=VALUE");
    expect_failure(pair + "--threshold rmse=x", 2, "--threshold rmse");
    expect_failure(pair + "--threshold flop=1", 2, "did you mean 'flip'");
    expect_failure(pair + "--mask inside", 2, "interior");
    expect_failure(pair + "--pixels-per-degree 0", 2, "pixels-per-degree");
    expect_failure(pair + "--exposures 1", 2, "--exposures 1");
    expect_failure(pair + "--exposures 1,2,99", 2, "--exposures 1,2,99");
    expect_failure(pair + "--exposures 2,1,2", 2, "--exposures 2,1,2");
    expect_failure(pair + "--gain 0", 2, "--gain");
}

}  // namespace
}  // namespace burnish
