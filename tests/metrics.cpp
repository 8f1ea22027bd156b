// Measures of pictures whose answers are known beforehand; FLIP has a test of its own.
#include "metrics/metrics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <burnish/error.hpp>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "metrics/flicker.hpp"
#include "metrics/frame_errors.hpp"
#include "metrics/heat_map.hpp"
#include "metrics/ssim.hpp"
#include "tests/float_picture.hpp"

namespace burnish::metrics {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

Comparison compared(const Framebuffer& test, const Framebuffer& reference,
                    const CompareOptions& options = {}) {
    WorkerPool pool(2);
    return compare(test, reference, options, pool);
}

// Of 4 x 3 pixels (1, 1) and (2, 1) have eight neighbours. Differences are +0.125 and -0.25:
// squares 1/64 and 4/64, mean 2.5/64; the pair differs by 0.375, in the other picture by 0.
TEST(FrameErrors, OfTwoInteriorPixels) {
    const Framebuffer want = plain(4, 3, 0.5F);
    Framebuffer got = plain(4, 3, 7.0F);
    set(got, 1, 1, {0.625F, 0.625F, 0.625F, 0.0F});
    set(got, 2, 1, {0.25F, 0.25F, 0.25F, 0.0F});
    const FrameErrors errors = interior_errors(got, want);
    EXPECT_EQ(errors.pixels, 2U);
    EXPECT_DOUBLE_EQ(errors.rmse, std::sqrt(2.5 / 64.0));
    EXPECT_DOUBLE_EQ(errors.bias, -0.0625);
    EXPECT_DOUBLE_EQ(errors.largest, 0.25);
    EXPECT_DOUBLE_EQ(errors.p99, 0.25);
    EXPECT_DOUBLE_EQ(errors.step_excess, 0.375);
}

TEST(FrameErrors, AHoleIsSurroundedByNoInterior) {
    Framebuffer want = plain(5, 5, 0.5F);
    set(want, 2, 2, glm::vec4(0.0F));  // a neighbour of all nine pixels that are not on the border
    const FrameErrors errors = interior_errors(plain(5, 5, 0.0F), want);
    EXPECT_EQ(errors.pixels, 0U);
    EXPECT_EQ(errors.rmse, 0.0);
    EXPECT_EQ(interior_peak(want), 0.0);
    EXPECT_EQ(interior_peak(plain(3, 3, 0.25F)), 0.25);
}

TEST(FrameErrors, AStepCountsAlongRowsAndColumns) {
    for (const bool row : {true, false}) {
        Framebuffer want = plain(3, 3, 0.0F), got = plain(3, 3, 0.0F);
        for (int i = 0; i < 3; ++i) {  // all of the last row, or of the last column
            const glm::ivec2 at = row ? glm::ivec2(i, 2) : glm::ivec2(2, i);
            set(want, at.x, at.y, {0.0F, 0.25F, 0.0F, 1.0F});
            set(got, at.x, at.y, {0.0F, 0.75F, 0.0F, 1.0F});
        }
        EXPECT_EQ(compared(got, want)[Metric::step_excess], 0.5);
        EXPECT_EQ(compared(want, got)[Metric::step_excess], 0.0);  // others are as flat
    }
}

TEST(Metrics, OfAConstantOffset) {
    const Comparison c = compared(plain(16, 12, 0.375F), plain(16, 12, 0.25F));
    EXPECT_EQ(c.pixels, 192U);
    EXPECT_DOUBLE_EQ(c[Metric::rmse], 0.125);
    EXPECT_NEAR(c[Metric::psnr], 18.0618, 1e-4);  // 20 log10(8)
    EXPECT_EQ(c[Metric::max], 0.125);
    EXPECT_EQ(c[Metric::p99], 0.125);
    EXPECT_EQ(c[Metric::bias], 0.125);
    EXPECT_DOUBLE_EQ(c[Metric::energy_ratio], 1.5);
    EXPECT_EQ(c[Metric::step_excess], 0.0);
    EXPECT_EQ(c[Metric::levels], 1.0);
    EXPECT_EQ(c[Metric::nonfinite], 0.0);
    // No variance: only luminances are left of Wang's equation 13.
    EXPECT_NEAR(c[Metric::ssim], (2.0 * 0.375 * 0.25 + 1e-4) / (0.375 * 0.375 + 0.0625 + 1e-4),
                1e-12);
}

TEST(Metrics, OfEqualPictures) {
    const Framebuffer picture = noise(13, 17, 5);
    const Comparison c = compared(picture, picture);
    EXPECT_EQ(c[Metric::rmse], 0.0);
    EXPECT_EQ(c[Metric::psnr], std::numeric_limits<double>::infinity());
    EXPECT_EQ(c[Metric::energy_ratio], 1.0);
    EXPECT_DOUBLE_EQ(c[Metric::ssim], 1.0);
    EXPECT_EQ(c[Metric::flip], 0.0);
    EXPECT_EQ(c[Metric::flip_hdr], 0.0);
}

// 100 pixels have 300 differences, 99 of 100 are 297: three of one pixel may be larger, six not.
TEST(Metrics, ThePercentileLeavesOutOneInAHundred) {
    const Framebuffer want = plain(10, 10, 0.5F);
    Framebuffer got = plain(10, 10, 0.5F);
    set(got, 3, 8, {0.75F, 0.0F, 1.0F, 1.0F});
    EXPECT_EQ(compared(got, want)[Metric::p99], 0.0);
    EXPECT_EQ(compared(got, want)[Metric::max], 0.5);
    EXPECT_EQ(compared(got, want)[Metric::bias], (0.25 - 0.5 + 0.5) / 300.0);
    set(got, 9, 0, {0.75F, 0.75F, 0.75F, 1.0F});
    EXPECT_EQ(compared(got, want)[Metric::p99], 0.25);
}

// Against a sorted list, for differences of any size.
TEST(Metrics, ThePercentileOfNoiseIsThatOfASortedList) {
    const Framebuffer got = noise(31, 17, 8), want = noise(31, 17, 9);
    std::vector<double> differences;
    for (int y = 0; y < 17; ++y)
        for (int x = 0; x < 31; ++x)
            for (int c = 0; c < 3; ++c)
                differences.push_back(
                    std::abs(double{get(got, x, y)[c]} - double{get(want, x, y)[c]}));
    std::sort(differences.begin(), differences.end());
    EXPECT_EQ(compared(got, want)[Metric::p99], differences[(differences.size() * 99 - 1) / 100]);
    EXPECT_EQ(compared(got, want)[Metric::max], differences.back());
}

// Green rises from 1/256 to 1 in 256 steps, red is brighter nowhere. Above half of the peak lie
// 128 values; the test keeps every fourth.
TEST(Metrics, LevelsAreThoseOfTheHighlight) {
    Framebuffer want = plain(256, 2, 0.25F), got = plain(256, 2, 0.25F);
    for (int x = 0; x < 256; ++x) {
        for (int y = 0; y < 2; ++y) {
            set(want, x, y, {0.25F, static_cast<float>(x + 1) / 256.0F, 0.0F, 1.0F});
            set(got, x, y, {0.25F, static_cast<float>((x + 1) / 4) / 64.0F, 0.0F, 1.0F});
        }
    }
    const Comparison c = compared(got, want);
    EXPECT_EQ(c[Metric::reference_levels], 128.0);
    // 129 .. 256 over 4, whole: 32 .. 64.
    EXPECT_EQ(c[Metric::levels], 33.0);
}

TEST(Metrics, RegionsFollowTheReferencesAlpha) {
    Framebuffer want = plain(6, 5, 0.5F);
    for (int y = 0; y < 5; ++y) set(want, 0, y, glm::vec4(0.0F));  // 25 covered pixels are left
    Framebuffer got = plain(6, 5, 0.0F);
    for (const auto& [region, pixels] :
         {std::pair(Region::all, 30U), {Region::covered, 25U}, {Region::interior, 9U}}) {
        CompareOptions options;
        options.region = region;
        const Comparison c = compared(got, want, options);
        EXPECT_EQ(c.pixels, pixels);
        EXPECT_DOUBLE_EQ(c[Metric::rmse],
                         region == Region::all ? 0.5 * std::sqrt(25.0 / 30.0) : 0.5);
    }
}

TEST(Metrics, WhatIsNoNumberIsCountedAndLeftOut) {
    Framebuffer got = plain(20, 20, 0.75F), want = plain(20, 20, 0.5F);
    set(got, 4, 4, {kNaN, 0.75F, 0.75F, 1.0F});
    set(want, 5, 4, {0.5F, 0.5F, -kInfinity, 1.0F});
    set(got, 6, 4, {0.75F, kInfinity, 0.75F, 1.0F});
    set(want, 6, 4, {0.5F, kInfinity, 0.5F, 1.0F});
    set(got, 7, 4, {0.75F, 0.75F, 0.75F, kNaN});  // alpha is no colour
    const Comparison c = compared(got, want);
    EXPECT_EQ(c[Metric::nonfinite], 3.0);
    EXPECT_EQ(c.pixels, 397U);
    EXPECT_DOUBLE_EQ(c[Metric::rmse], 0.25);
    EXPECT_DOUBLE_EQ(c[Metric::energy_ratio], 1.5);
    for (std::size_t m = 0; m < kMetricCount; ++m)
        EXPECT_TRUE(std::isfinite(c.values[m])) << metric_name(static_cast<Metric>(m));
    for (const Plane* map : {&c.ssim, &c.flip, &c.flip_hdr})
        for (const double value : map->values) ASSERT_TRUE(std::isfinite(value));
}

TEST(Metrics, NothingToCompareHasNoNumber) {
    Framebuffer want = plain(4, 4, 0.0F);
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 4; ++x) set(want, x, y, glm::vec4(0.0F));
    CompareOptions options;
    options.region = Region::covered;
    const Comparison c = compared(want, want, options);
    EXPECT_EQ(c.pixels, 0U);
    for (const Metric m : {Metric::rmse, Metric::psnr, Metric::ssim, Metric::flip, Metric::levels})
        EXPECT_TRUE(std::isnan(c[m])) << metric_name(m);
    EXPECT_TRUE(std::isnan(compared(plain(2, 2, 1.0F), plain(2, 2, 0.0F))[Metric::energy_ratio]));
}

TEST(Metrics, OnlyWhatIsAskedForIsComputed) {
    CompareOptions options;
    options.metrics = {Metric::max, Metric::flip};
    const Comparison c = compared(plain(8, 8, 1.0F), plain(8, 8, 0.5F), options);
    EXPECT_EQ(c[Metric::max], 0.5);
    EXPECT_TRUE(std::isnan(c[Metric::rmse]));
    EXPECT_EQ(c.flip.values.size(), 64U);
    EXPECT_TRUE(c.ssim.values.empty());
    EXPECT_TRUE(c.flip_hdr.values.empty());
}

TEST(Metrics, TwoSizesOrFormatsAreRefused) {
    EXPECT_THROW(compared(plain(4, 4, 0.0F), plain(4, 5, 0.0F)), Error);
    EXPECT_THROW(compared(Framebuffer(4, 4, PixelFormat::rgba8), plain(4, 4, 0.0F)), Error);
}

TEST(Metrics, AreTheSameWithAnyNumberOfWorkers) {
    const Framebuffer got = noise(61, 203, 1), want = noise(61, 203, 2);
    WorkerPool one(1);
    const Comparison first = compare(got, want, {}, one);
    for (const int workers : {2, 5}) {
        WorkerPool pool(workers);
        const Comparison again = compare(got, want, {}, pool);
        EXPECT_EQ(again.values, first.values);
        EXPECT_EQ(again.ssim.values, first.ssim.values);
        EXPECT_EQ(again.flip.values, first.flip.values);
        EXPECT_EQ(again.flip_hdr.values, first.flip_hdr.values);
    }
}

TEST(Metrics, LimitsLieOnTheSideThatIsBad) {
    EXPECT_FALSE(is_worse(Metric::rmse, 0.5, 0.5));
    EXPECT_TRUE(is_worse(Metric::rmse, 0.51, 0.5));
    EXPECT_TRUE(is_worse(Metric::psnr, 29.0, 30.0));
    EXPECT_FALSE(is_worse(Metric::psnr, std::numeric_limits<double>::infinity(), 30.0));
    EXPECT_TRUE(is_worse(Metric::ssim, 0.8, 0.9));
    EXPECT_TRUE(is_worse(Metric::bias, -0.2, 0.1));
    EXPECT_FALSE(is_worse(Metric::bias, -0.05, 0.1));
    EXPECT_TRUE(is_worse(Metric::energy_ratio, 0.8, 0.1));
    EXPECT_TRUE(is_worse(Metric::energy_ratio, 1.2, 0.1));
    EXPECT_FALSE(is_worse(Metric::energy_ratio, 0.95, 0.1));
    for (const Metric m : all_metrics()) {
        EXPECT_TRUE(is_worse(m, kNaN, 0.0)) << metric_name(m);
        EXPECT_EQ(metric_named(metric_name(m)), m);
    }
    EXPECT_FALSE(metric_named("mse"));
}

/// Wang et al. 2004, equations 14 to 16 and 13, one channel at one pixel, as they stand there.
double ssim_by_definition(const Framebuffer& x, const Framebuffer& y, int channel, int px, int py) {
    struct Sample {
        double weight, x, y;
    };
    std::vector<Sample> window;
    double total = 0.0;
    for (int j = -5; j <= 5; ++j) {
        for (int i = -5; i <= 5; ++i) {
            const double weight = std::exp(-(i * i + j * j) / (2.0 * 1.5 * 1.5));
            window.push_back(
                {weight, get(x, px + i, py + j)[channel], get(y, px + i, py + j)[channel]});
            total += weight;
        }
    }
    double mean_x = 0.0, mean_y = 0.0, var_x = 0.0, var_y = 0.0, covariance = 0.0;
    for (const Sample& s : window) {
        mean_x += s.weight / total * s.x;
        mean_y += s.weight / total * s.y;
    }
    for (const Sample& s : window) {
        var_x += s.weight / total * (s.x - mean_x) * (s.x - mean_x);
        var_y += s.weight / total * (s.y - mean_y) * (s.y - mean_y);
        covariance += s.weight / total * (s.x - mean_x) * (s.y - mean_y);
    }
    return (2.0 * mean_x * mean_y + 1e-4) * (2.0 * covariance + 9e-4) /
           ((mean_x * mean_x + mean_y * mean_y + 1e-4) * (var_x + var_y + 9e-4));
}

TEST(Ssim, IsItsDefinitionAtEveryWholeWindow) {
    const Framebuffer got = noise(19, 14, 3), want = noise(19, 14, 4);
    const Comparison c = compared(got, want);
    double total = 0.0;
    for (int y = 5; y < 9; ++y) {
        for (int x = 5; x < 14; ++x) {
            double mean = 0.0;
            for (int channel = 0; channel < 3; ++channel)
                mean += ssim_by_definition(got, want, channel, x, y) / 3.0;
            EXPECT_NEAR(c.ssim.row(y)[x], mean, 1e-12) << x << ' ' << y;
            total += mean;
        }
    }
    EXPECT_NEAR(c[Metric::ssim], total / 36.0,
                1e-12);  // windows that leave the picture do not count
    EXPECT_NEAR(compared(want, got)[Metric::ssim], c[Metric::ssim], 1e-14);
}

// Contrast reversed about the mean: no negative of the structure is alike.
TEST(Ssim, OfAReversedPictureIsNegative) {
    Framebuffer want = plain(31, 31, 0.5F), got = plain(31, 31, 0.5F);
    for (int y = 0; y < 31; ++y) {
        for (int x = 0; x < 31; ++x) {
            const float wave = (x + y) % 2 == 0 ? 0.25F : -0.25F;
            set(want, x, y, glm::vec4(glm::vec3(0.5F + wave), 1.0F));
            set(got, x, y, glm::vec4(glm::vec3(0.5F - wave), 1.0F));
        }
    }
    // Variances and covariance of a checkerboard: +-1/16, but for what its own mean takes away.
    EXPECT_NEAR(compared(got, want)[Metric::ssim], (-0.125 + 9e-4) / (0.125 + 9e-4), 1e-3);
}

TEST(Ssim, SmallPicturesCountWithTheirBorder) {
    const Comparison c = compared(plain(3, 40, 1.0F), plain(3, 40, 0.0F));
    EXPECT_NEAR(c[Metric::ssim], 1e-4 / (1.0 + 1e-4), 1e-12);
}

TEST(FlickerMeasure, IsWhatChangesInTime) {
    WorkerPool pool(2);
    Flicker flicker(Region::all, true);
    // Red: the reference moves and so does the test: none. Green: an error that stays: none. Blue:
    // +0.25 and -0.25 in turns: a deviation of 0.25, in one channel of three.
    for (int t = 0; t < 4; ++t) {
        const float moving = 0.125F * static_cast<float>(t);
        const float turn = t % 2 == 0 ? 0.25F : -0.25F;
        flicker.add(plain(4, 3, {moving + 0.125F, 0.75F, 0.5F + turn}),
                    plain(4, 3, {moving + 0.125F, 0.5F, 0.5F}), pool);
    }
    EXPECT_EQ(flicker.frames(), 4);
    EXPECT_NEAR(flicker.value(), 0.25 / 3.0, 1e-12);
    EXPECT_NEAR(flicker.map().row(1)[2], 0.25 / 3.0, 1e-12);
    EXPECT_GT(flicker.flip_value(), 0.0);
}

TEST(FlickerMeasure, OfFlipIsTheDeviationOfItsMaps) {
    WorkerPool pool(1);
    Flicker flicker(Region::all, true);
    const Framebuffer want = plain(5, 5, 0.5F), near = plain(5, 5, 0.55F), far = plain(5, 5, 0.75F);
    flicker.add(near, want, pool);
    flicker.add(far, want, pool);
    const double a = flip(near, want, {}, pool).values[0], b = flip(far, want, {}, pool).values[0];
    EXPECT_NEAR(flicker.flip_value(), 0.5 * std::abs(a - b), 1e-12);
    EXPECT_NEAR(flicker.value(), 0.1, 1e-7);
    EXPECT_THROW(flicker.add(plain(5, 4, 0.0F), plain(5, 4, 0.0F), pool), Error);
}

TEST(FlickerMeasure, APixelCountsIfItCountedInEveryPair) {
    WorkerPool pool(1);
    Flicker flicker(Region::covered, false);
    Framebuffer first = plain(2, 1, 0.0F), second = plain(2, 1, 0.0F);
    set(first, 0, 0, {0.0F, 0.0F, 0.0F, 0.0F});
    const Framebuffer bright = plain(2, 1, 1.0F);
    flicker.add(first, first, pool);
    flicker.add(bright, second, pool);
    EXPECT_DOUBLE_EQ(flicker.value(), 0.5);  // of the right pixel: 0, then 1
    EXPECT_EQ(flicker.map().row(0)[0], 0.0);
    EXPECT_TRUE(std::isnan(flicker.flip_value()));
}

TEST(ErrorPictures, HeatMapsHaveTheColoursOfMagma) {
    Plane map(5, 1);
    map.values = {0.0, 1.0, 64.0 / 255.0, kNaN, 7.0};
    const Image8 image = heat_map(map);
    const auto rgb = [&image](int x) {
        const std::uint8_t* p = const_cast<Image8&>(image).at(x, 0);
        return glm::ivec3(p[0], p[1], p[2]);
    };
    // Entries 0, 255 and 64 of matplotlib's 256: (.001462 .000466 .013866), (.987053 .991438
    // .749504), (.316654 .071690 .485380), times 255.
    EXPECT_EQ(rgb(0), glm::ivec3(0, 0, 4));
    EXPECT_EQ(rgb(1), glm::ivec3(252, 253, 191));
    EXPECT_LE(glm::length(glm::vec3(rgb(2) - glm::ivec3(81, 18, 124))), 1.0F);
    EXPECT_EQ(rgb(3), rgb(0));
    EXPECT_EQ(rgb(4), rgb(1));
}

TEST(ErrorPictures, DifferencesAreGreyWhereThereIsNone) {
    const Framebuffer got = plain(1, 1, {0.5F, 0.75F, 0.0F}), want = plain(1, 1, 0.5F);
    const Image8 shown = difference_image(got, want, 2.0, DifferenceSign::shown);
    EXPECT_EQ(shown.rgba, (std::vector<std::uint8_t>{128, 192, 1, 255}));  // 128 + 127 * .5, - 127
    const Image8 size = difference_image(got, want, 2.0, DifferenceSign::ignored);
    EXPECT_EQ(size.rgba, (std::vector<std::uint8_t>{0, 128, 255, 255}));
    EXPECT_EQ(get(difference_frame(got, want, DifferenceSign::shown), 0, 0),
              glm::vec4(0.0F, 0.25F, -0.5F, 1.0F));
    EXPECT_EQ(get(difference_frame(got, want, DifferenceSign::ignored), 0, 0),
              glm::vec4(0.0F, 0.25F, 0.5F, 1.0F));
}

}  // namespace
}  // namespace burnish::metrics
