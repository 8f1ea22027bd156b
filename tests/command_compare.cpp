// `burnish compare`: what it prints, writes and returns.
#include <gtest/gtest.h>

#include <burnish/files.hpp>
#include <burnish/texture.hpp>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

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

    double metric(const std::string& arguments, const std::string& name) {
        const Result result = run("compare " + arguments + " --json");
        EXPECT_EQ(result.code, 0) << result.err;
        return Json::parse(result.out)["metrics"][name].number;
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
    const Result result =
        run("compare test.exr reference.exr --json --exposures -1,2.5 --mask covered");
    ASSERT_EQ(result.code, 0) << result.err;
    const Json json = Json::parse(result.out);
    EXPECT_EQ(json["test"].text, "test.exr");
    EXPECT_EQ(json["reference"].text, "reference.exr");
    EXPECT_EQ(json["mask"].text, "covered");
    EXPECT_EQ(json["encoding"].text, "srgb");
    EXPECT_EQ(json["pixels"].number, 192.0);
    EXPECT_EQ(json["exposures"]["start"].number, -1.0);
    EXPECT_EQ(json["exposures"]["count"].number, 4.0);  // 3.5 stops
    EXPECT_EQ(json["metrics"].object.size(), 13U);
    EXPECT_EQ(json["metrics"]["rmse"].number, 0.125);
    EXPECT_TRUE(json["passed"].boolean);
    const Json same = Json::parse(run("compare test.exr test.exr --json").out);
    EXPECT_EQ(same["metrics"]["psnr"].kind, Json::Kind::null);  // infinite
    EXPECT_EQ(same["metrics"]["flip"].number, 0.0);
}

TEST_F(Compare, PrintsOnlyWhatIsAskedFor) {
    const std::string want = "pixels     192\nrmse       0.125\nmax        0.125\nnonfinite  0\n";
    EXPECT_EQ(run("compare --metric max,rmse test.exr reference.exr").out, want);
    EXPECT_EQ(run("compare test.exr reference.exr --metric rmse --metric max").out, want);
    EXPECT_EQ(run("compare test.exr reference.exr --quiet").out, "");
}

TEST_F(Compare, FailsWhereAThresholdIsPassed) {
    const Result good =
        run("compare test.exr reference.exr --metric rmse --threshold rmse=0.125 "
            "--threshold psnr=18,energy_ratio=0.5,bias=0.125");
    EXPECT_EQ(good.code, 0) << good.err;
    EXPECT_EQ(good.err, "");
    EXPECT_SAYS(good.out, "psnr");
    const Result bad =
        run("compare test.exr reference.exr --threshold rmse=0.1 --threshold psnr=20 "
            "--threshold energy_ratio=0.4 --threshold max=1");
    EXPECT_EQ(bad.code, 1);
    EXPECT_EQ(bad.err,
              "burnish: test.exr: rmse 0.125, expected at most 0.1\n"
              "burnish: test.exr: psnr 18.0618, expected at least 20\n"
              "burnish: test.exr: energy_ratio 1.5, expected 1 +- 0.4\n");
    EXPECT_SAYS(bad.out, "rmse");  // numbers are there all the same
    const Result json = run("compare test.exr reference.exr --threshold bias=0.1 --json");
    EXPECT_EQ(json.code, 1);
    EXPECT_FALSE(Json::parse(json.out)["passed"].boolean);
}

TEST_F(Compare, WhatIsNoNumberIsReportedAndFailsLimits) {
    Framebuffer picture = plain(16, 12, 0.375F);
    set(picture, 3, 3, {std::numeric_limits<float>::quiet_NaN(), 0.0F, 0.0F, 1.0F});
    set(picture, 4, 3, {0.0F, std::numeric_limits<float>::infinity(), 0.0F, 1.0F});
    save_image(picture, path("nan.exr"));
    const Result plainly = run("compare nan.exr reference.exr");
    EXPECT_EQ(plainly.code, 0);
    EXPECT_SAYS(plainly.out, "pixels            190\nrmse              0.125\n");
    EXPECT_SAYS(plainly.out, "nonfinite         2\n");
    EXPECT_SAYS(plainly.err, "burnish: nan.exr: 2 pixels are NaN or infinite");
    const Result limited = run("compare nan.exr reference.exr --threshold rmse=0.2");
    EXPECT_EQ(limited.code, 1);
    EXPECT_EQ(limited.err, "burnish: nan.exr: nonfinite 2, expected at most 0\n");
    EXPECT_EQ(run("compare nan.exr reference.exr --threshold rmse=0.2,nonfinite=2").code, 0);
}

TEST_F(Compare, MasksFollowTheReference) {
    Framebuffer picture = plain(16, 12, 0.25F);
    for (int x = 0; x < 16; ++x) set(picture, x, 0, glm::vec4(0.25F, 0.25F, 0.25F, 0.0F));
    save_image(picture, path("reference.exr"));
    EXPECT_SAYS(run("compare test.exr reference.exr").out, "pixels            192\n");
    EXPECT_SAYS(run("compare test.exr reference.exr --mask covered").out,
                "pixels            176\n");
    EXPECT_SAYS(run("compare test.exr reference.exr --mask interior").out,
                "pixels            126\n");
    save_image(Image8(4, 4), path("empty.png"));  // alpha 0 throughout
    expect_failure("compare empty.png empty.png --mask covered", 3,
                   "empty.png: no pixel to compare");
}

// 51 / 255 = 0.2 and 102 / 255 = 0.4, whether a file has bytes, words or floats.
TEST_F(Compare, ReadsBytesAsTheirShareOf255) {
    Image8 a(12, 12), b(12, 12);
    a.rgba.assign(a.rgba.size(), 102);
    b.rgba.assign(b.rgba.size(), 51);
    save_image(a, path("a.png"));
    save_image(b, path("b.png"));
    EXPECT_NEAR(metric("a.png b.png", "rmse"), 0.2, 1e-7);
    save_image(plain(12, 12, 0.2F), path("b.exr"));
    EXPECT_EQ(metric("b.png b.exr", "max"), 0.0);
}

TEST_F(Compare, FlipTakesItsOptions) {
    const std::string pair = "test.exr reference.exr ";
    EXPECT_NE(metric(pair, "flip"), metric(pair + "--encoding linear", "flip"));
    save_image(noise(16, 12, 1), path("test.exr"));
    EXPECT_NE(metric(pair, "flip"), metric(pair + "--pixels-per-degree 30", "flip"));
    EXPECT_NE(metric(pair, "flip_hdr"), metric(pair + "--exposures 0,0,1", "flip_hdr"));
    EXPECT_EQ(metric(pair + "--threads 1", "flip"), metric(pair + "--threads 3", "flip"));
}

TEST_F(Compare, WritesPicturesOfTheError) {
    const Result result =
        run("compare test.exr reference.exr --metric rmse --difference d.png --gain 4 "
            "--absolute-difference a.png --heat-map h.png");
    ASSERT_EQ(result.code, 0) << result.err;
    const auto first_pixel = [this](const char* name) {
        const Image8 image = load_image(path(name));
        EXPECT_EQ(image.width, 16);
        return std::vector<std::uint8_t>(image.rgba.begin(), image.rgba.begin() + 4);
    };
    EXPECT_EQ(first_pixel("d.png"), (std::vector<std::uint8_t>{192, 192, 192, 255}));  // 128 + 63.5
    EXPECT_EQ(first_pixel("a.png"), (std::vector<std::uint8_t>{128, 128, 128, 255}));
    // Between magma's 96 and 128 of 256, say, for a FLIP of some 0.4: purple.
    const std::vector<std::uint8_t> heat = first_pixel("h.png");
    EXPECT_GT(heat[0], heat[1]);
    EXPECT_GT(heat[2], heat[1]);
}

TEST_F(Compare, WritesNumbersToExr) {
    ASSERT_EQ(run("compare reference.exr test.exr --difference d.exr --gain 9 "
                  "--absolute-difference a.exr --heat-map h.exr")
                  .code,
              0);
    EXPECT_EQ(get(load_frame(path("d.exr")), 5, 5), glm::vec4(-0.125F, -0.125F, -0.125F, 1.0F));
    EXPECT_EQ(get(load_frame(path("a.exr")), 5, 5), glm::vec4(0.125F, 0.125F, 0.125F, 1.0F));
    EXPECT_NEAR(get(load_frame(path("h.exr")), 5, 5).r, metric("reference.exr test.exr", "flip"),
                1e-6);
    ASSERT_EQ(run("compare reference.exr test.exr --metric flip_hdr --heat-map hdr.exr").code, 0);
    EXPECT_NEAR(get(load_frame(path("hdr.exr")), 5, 5).r,
                metric("reference.exr test.exr", "flip_hdr"), 1e-6);
}

TEST_F(Compare, SaysInOneLineWhatIsWrong) {
    save_image(plain(16, 11, 0.0F), path("other.exr"));
    write(path("broken.png"), "no image");
    expect_failure("compare other.exr reference.exr", 3,
                   "other.exr: 16 x 11 pixels, expected 16 x 12 as in reference.exr");
    expect_failure("compare missing.exr reference.exr", 3, "missing.exr: No such file");
    expect_failure("compare test.exr broken.png", 3, "broken.png: ");
    expect_failure("compare test.exr reference.exr --heat-map no/h.png", 3, "no/h.png");
    expect_failure("compare test.exr", 2, "REFERENCE");
    expect_failure("compare test.exr reference.exr --metric rsme", 2, "did you mean 'rmse'");
    expect_failure("compare test.exr reference.exr --threshold rmse", 2, "expected NAME=VALUE");
    expect_failure("compare test.exr reference.exr --threshold rmse=x", 2, "--threshold rmse");
    expect_failure("compare test.exr reference.exr --threshold flop=1", 2, "did you mean 'flip'");
    expect_failure("compare test.exr reference.exr --mask inside", 2, "interior");
    expect_failure("compare test.exr reference.exr --pixels-per-degree 0", 2, "pixels-per-degree");
    expect_failure("compare test.exr reference.exr --exposures 1", 2, "--exposures 1");
    expect_failure("compare test.exr reference.exr --exposures 1,2,99", 2, "--exposures 1,2,99");
    expect_failure("compare test.exr reference.exr --exposures 2,1,2", 2, "exposures from 2 to 1");
    expect_failure("compare test.exr reference.exr --gain 0", 2, "--gain");
}

}  // namespace
}  // namespace burnish
