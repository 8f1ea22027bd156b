// FLIP against its definition, worked out pixel by pixel without separating a filter, and against
// numbers that follow from the published constants. The authors' own pair of pictures is not at
// hand (docs/metrics.md).
#include "metrics/flip.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <burnish/error.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <vector>

#include "metrics/flip_color.hpp"
#include "metrics/flip_filters.hpp"
#include "tests/float_picture.hpp"

namespace burnish::metrics {
namespace {

constexpr double kPi = std::numbers::pi;

Plane flipped(const Framebuffer& test, const Framebuffer& reference,
              const FlipOptions& options = {}) {
    WorkerPool pool(2);
    return flip(test, reference, options, pool);
}

double at_centre(const Framebuffer& test, const Framebuffer& reference,
                 const FlipOptions& options = {}) {
    const Plane map = flipped(test, reference, options);
    return map.row(map.height / 2)[map.width / 2];
}

// IEC 61966-2-1: a straight line up to 0.04045, where 0.04 is 0.04 / 12.92, a power beyond it.
TEST(FlipColor, SrgbIsALineAndAPower) {
    EXPECT_NEAR(srgb_to_linear(0.04), 0.00309598, 1e-8);
    EXPECT_NEAR(srgb_to_linear(0.5), 0.21404114, 1e-8);
    EXPECT_EQ(srgb_to_linear(1.0), 1.0);
}

// github.com/NVlabs/flip, FLIP.h: a screen 0.7 m wide of 3840 pixels seen from 0.7 m, "67ppd" in
// its file names. HPG 2020, section 4.1.1: radius of the contrast filters 3 sqrt(0.04 / (2 pi^2))
// pixels per degree, whole; section 4.2: 3 * 0.5 * 0.082 pixels per degree.
TEST(FlipConstants, OfTheUsualScreen) {
    EXPECT_NEAR(kPixelsPerDegree, 67.0206, 1e-4);
    const FilterBank bank = flip_bank(kPixelsPerDegree);
    EXPECT_EQ(bank.columns[static_cast<std::size_t>(FlipResult::y)].taps.radius(), 10);
    EXPECT_EQ(bank.columns[static_cast<std::size_t>(FlipResult::cz_wide)].taps.radius(), 10);
    EXPECT_EQ(bank.columns[static_cast<std::size_t>(FlipResult::edge_y)].taps.radius(), 9);
    EXPECT_EQ(bank.columns.size(), 2 * static_cast<std::size_t>(FlipResult::count));
}

// L*, a*, b* of sRGB's green are 87.73, -86.18, 83.18, of its blue 32.30, 79.19, -107.86 (any table
// of colours): with a*, b* times L* / 100 their HyAB distance is 55.44 + 147.86.
TEST(FlipConstants, FarthestColours) {
    const glm::dvec3 green = hunt_lab_from_linear({0.0, 1.0, 0.0});
    const glm::dvec3 blue = hunt_lab_from_linear({0.0, 0.0, 1.0});
    EXPECT_NEAR(green.x, 87.73, 0.01);
    EXPECT_NEAR(green.y, -86.18 * 0.8773, 0.01);
    EXPECT_NEAR(blue.z, -107.86 * 0.3230, 0.01);
    EXPECT_NEAR(hyab(green, blue), 203.3, 0.05);
    const glm::dvec3 white = hunt_lab_from_linear({1.0, 1.0, 1.0});
    EXPECT_NEAR(white.x, 100.0, 1e-6);
    EXPECT_NEAR(white.y, 0.0, 1e-5);
    EXPECT_NEAR(white.z, 0.0, 1e-5);
    // FLIP.h's inverse matrix, 9 digits: linear red of X = 1 is 3.241003275.
    const glm::dvec3 rgb(0.2, 0.5, 0.7);
    EXPECT_LT(glm::length(linear_from_opponent(opponent_from_linear(rgb)) - rgb), 1e-13);
    EXPECT_NEAR(opponent_from_linear({1.0, 1.0, 1.0}).x, 100.0, 1e-6);
}

// Nothing but lightness differs and no feature: L* 0 and 100 are 100^0.7 = 25.1189 apart, beyond
// the knee at 0.4 * 203.3^0.7 = 16.51 of 41.28: 0.95 + 0.05 * 8.61 / 24.77.
TEST(Flip, OfBlackAndWhite) {
    EXPECT_NEAR(at_centre(plain(30, 30, 0.0F), plain(30, 30, 1.0F)), 0.96738, 1e-5);
}

TEST(Flip, OfTheFarthestColoursIsOne) {
    EXPECT_NEAR(at_centre(plain(9, 9, {0.0F, 1.0F, 0.0F}), plain(9, 9, {0.0F, 0.0F, 1.0F})), 1.0,
                1e-9);
}

// sRGB 0.5 is linear 0.214041, L* = 53.389; 0.6 is linear 0.318547, L* = 63.223: 9.834^0.7 = 4.954
// is below the knee: times 0.95 / 16.51.
TEST(Flip, OfTwoGreys) {
    EXPECT_NEAR(at_centre(plain(30, 30, 0.5F), plain(30, 30, 0.6F)), 4.954 * 0.95 / 16.510, 1e-4);
    FlipOptions linear;
    linear.encoding = Encoding::linear;
    EXPECT_NEAR(at_centre(plain(30, 30, 0.214041F), plain(30, 30, 0.318547F), linear),
                4.954 * 0.95 / 16.510, 1e-4);
}

/// One pixel of one picture, by sums over two dimensions.
struct Definition {
    using Weight = std::function<double(double x, double y)>;
    const Framebuffer& picture;
    double ppd;

    [[nodiscard]] glm::dvec3 opponent(int x, int y) const {
        const glm::vec4 p = get(picture, std::clamp(x, 0, picture.width() - 1),
                                std::clamp(y, 0, picture.height() - 1));
        return opponent_from_linear(
            {srgb_to_linear(p.r), srgb_to_linear(p.g), srgb_to_linear(p.b)});
    }
    /// Weights as they are, divided by the sum of all.
    [[nodiscard]] double average(int channel, int px, int py, const Weight& weight) const {
        const int r = static_cast<int>(std::ceil(3.0 * std::sqrt(0.04 / (2.0 * kPi * kPi)) * ppd));
        double total = 0.0, weights = 0.0;
        for (int y = -r; y <= r; ++y)
            for (int x = -r; x <= r; ++x) {
                total += weight(x, y) * opponent(px + x, py + y)[channel];
                weights += weight(x, y);
            }
        return total / weights;
    }
    [[nodiscard]] double sensitivity(double a, double b, double x, double y) const {
        const double squared = (x * x + y * y) / (ppd * ppd);
        return a * std::sqrt(kPi / b) * std::exp(-kPi * kPi * squared / b);
    }
    [[nodiscard]] glm::dvec3 lab(int px, int py) const {
        const glm::dvec3 filtered(
            average(0, px, py, [&](double x, double y) { return sensitivity(1, 0.0047, x, y); }),
            average(1, px, py, [&](double x, double y) { return sensitivity(1, 0.0053, x, y); }),
            average(2, px, py, [&](double x, double y) {
                return sensitivity(34.1, 0.04, x, y) + sensitivity(13.5, 0.025, x, y);
            }));
        return hunt_lab_from_linear(glm::clamp(linear_from_opponent(filtered), 0.0, 1.0));
    }
    /// Positive weights divided by their sum, negative ones by theirs.
    [[nodiscard]] double feature(int px, int py, const Weight& weight) const {
        const int r = static_cast<int>(std::ceil(3.0 * sigma()));
        double above = 0.0, below = 0.0, above_weights = 0.0, below_weights = 0.0;
        for (int y = -r; y <= r; ++y) {
            for (int x = -r; x <= r; ++x) {
                const double w = weight(x, y);
                const double value = (opponent(px + x, py + y)[0] + 16.0) / 116.0;
                (w > 0.0 ? above : below) += w * value;
                (w > 0.0 ? above_weights : below_weights) += w;
            }
        }
        return above / above_weights - below / below_weights;
    }
    [[nodiscard]] double sigma() const { return 0.5 * 0.082 * ppd; }
    [[nodiscard]] double edge(int px, int py) const {
        const auto g = [this](double x, double y) {
            return std::exp(-(x * x + y * y) / (2.0 * sigma() * sigma()));
        };
        return std::hypot(feature(px, py, [&](double x, double y) { return -x * g(x, y); }),
                          feature(px, py, [&](double x, double y) { return -y * g(x, y); }));
    }
    [[nodiscard]] double point(int px, int py) const {
        const double s2 = sigma() * sigma();
        const auto g = [s2](double x, double y) { return std::exp(-(x * x + y * y) / (2.0 * s2)); };
        return std::hypot(
            feature(px, py, [&](double x, double y) { return (x * x / s2 - 1.0) * g(x, y); }),
            feature(px, py, [&](double x, double y) { return (y * y / s2 - 1.0) * g(x, y); }));
    }
};

/// HPG 2020, section 4: q_c = 0.7, p_c = 0.4, p_t = 0.95, q_f = 0.5.
double flip_by_definition(const Framebuffer& test, const Framebuffer& reference, double ppd, int x,
                          int y) {
    const Definition t{test, ppd}, r{reference, ppd};
    const double largest = std::pow(
        hyab(hunt_lab_from_linear({0.0, 1.0, 0.0}), hunt_lab_from_linear({0.0, 0.0, 1.0})), 0.7);
    const double difference = std::pow(hyab(t.lab(x, y), r.lab(x, y)), 0.7);
    const double knee = 0.4 * largest;
    const double color = difference < knee ? 0.95 / knee * difference
                                           : 0.95 + (difference - knee) / (largest - knee) * 0.05;
    const double features =
        std::max(std::abs(t.edge(x, y) - r.edge(x, y)), std::abs(t.point(x, y) - r.point(x, y)));
    return std::pow(color, 1.0 - std::pow(features / std::sqrt(2.0), 0.5));
}

void expect_definition(const Framebuffer& test, const Framebuffer& reference, double ppd,
                       const std::vector<glm::ivec2>& places) {
    FlipOptions options;
    options.pixels_per_degree = ppd;
    const Plane map = flipped(test, reference, options);
    for (const glm::ivec2 p : places)
        EXPECT_NEAR(map.row(p.y)[p.x], flip_by_definition(test, reference, ppd, p.x, p.y), 1e-10)
            << p.x << ' ' << p.y;
}

TEST(Flip, IsItsDefinitionForOnePixel) {
    const Framebuffer want = plain(25, 23, {0.2F, 0.4F, 0.6F});
    Framebuffer got = plain(25, 23, {0.2F, 0.4F, 0.6F});
    set(got, 12, 11, {1.0F, 0.9F, 0.1F, 1.0F});
    expect_definition(got, want, kPixelsPerDegree, {{12, 11}, {13, 11}, {12, 14}, {5, 20}});
}

TEST(Flip, IsItsDefinitionForNoiseAndAtBorders) {
    expect_definition(noise(18, 15, 1), noise(18, 15, 2), 25.0,
                      {{0, 0}, {17, 14}, {0, 7}, {9, 7}, {16, 1}});
    expect_definition(noise(9, 3, 3), noise(9, 3, 4), 60.0, {{4, 1}, {8, 0}});  // filters reach out
    expect_definition(noise(5, 5, 5), noise(5, 5, 6), 1.0, {{2, 2}});
}

TEST(Flip, IsTheSameTheOtherWayRound) {
    const Framebuffer a = noise(20, 20, 7), b = noise(20, 20, 8);
    EXPECT_EQ(flipped(a, b).values, flipped(b, a).values);
}

// The same difference in more pixels, and an edge where there was none.
TEST(Flip, SeesALineBetterThanADot) {
    const Framebuffer grey = plain(41, 41, 0.5F);
    Framebuffer line = plain(41, 41, 0.5F), dot = plain(41, 41, 0.5F);
    for (int y = 0; y < 41; ++y) set(line, 20, y, {0.6F, 0.6F, 0.6F, 1.0F});
    set(dot, 20, 20, {0.6F, 0.6F, 0.6F, 1.0F});
    EXPECT_GT(at_centre(line, grey), at_centre(dot, grey));
}

TEST(Flip, OptionsOutOfRangeAreRefused) {
    const Framebuffer grey = plain(4, 4, 0.5F);
    WorkerPool pool(1);
    for (const double ppd : {0.0, -5.0, 1001.0, std::numeric_limits<double>::quiet_NaN()}) {
        FlipOptions options;
        options.pixels_per_degree = ppd;
        EXPECT_THROW(flip(grey, grey, options, pool), Error) << ppd;
        EXPECT_THROW(flip_hdr(grey, grey, options, pool), Error) << ppd;
    }
    for (const Exposures e : {Exposures{0, 1, 0}, {0, 1, 65}, {1, 0, 2}, {0, 1e9, 2}}) {
        FlipOptions options;
        options.exposures = e;
        EXPECT_THROW(flip_hdr(grey, grey, options, pool), Error);
    }
}

/// Narkowicz' curve with the exposure of 0.6 that FLIP's authors put in front of it.
double aces(double x) {
    const double y = 0.6 * x;
    return (y * (2.51 * y + 0.03)) / (y * (2.43 * y + 0.59) + 0.14);
}

TEST(FlipHdr, ExposuresMapTheBrightestAndTheMedianTo85Percent) {
    Framebuffer picture = plain(5, 1, 0.25F);
    set(picture, 0, 0, {40.0F, 40.0F, 40.0F, 1.0F});
    set(picture, 1, 0, {0.0F, 0.0F, 0.0F, 1.0F});
    const Exposures e = exposures_for(picture);
    EXPECT_NEAR(aces(40.0 * std::exp2(e.start)), 0.85, 1e-9);
    EXPECT_NEAR(aces(0.25 * std::exp2(e.stop)), 0.85, 1e-9);
    EXPECT_EQ(e.count, 8);  // log2(160) = 7.3 stops
}

// The authors' own pair runs from -12.5423 to +0.9427 in 14 exposures (the name of their expected
// result, "hdr.aces.m12.5423_to_p0.9427.14").
TEST(FlipHdr, AsManyExposuresAsInThePublishedResult) {
    // The light that this exposure maps to 0.85, by halving: the curve rises.
    const auto brightness = [](double stops) {
        double low = 0.0, high = 100.0;
        for (int i = 0; i < 200; ++i) {
            const double middle = 0.5 * (low + high);
            (aces(middle) < 0.85 ? low : high) = middle;
        }
        return static_cast<float>(low * std::exp2(-stops));
    };
    Framebuffer picture = plain(3, 1, brightness(0.9427));
    set(picture, 0, 0, glm::vec4(glm::vec3(brightness(-12.5423)), 1.0F));
    set(picture, 1, 0, {0.0F, 0.0F, 0.0F, 1.0F});
    const Exposures e = exposures_for(picture);
    EXPECT_NEAR(e.start, -12.5423, 1e-4);
    EXPECT_NEAR(e.stop, 0.9427, 1e-4);
    EXPECT_EQ(e.count, 14);
}

TEST(FlipHdr, APictureThatIsMostlyBlackHasTheMedianOfTheRest) {
    Framebuffer picture = plain(9, 1, 0.0F);
    set(picture, 0, 0, {2.0F, 2.0F, 2.0F, 1.0F});
    set(picture, 1, 0, {0.5F, 0.5F, 0.5F, 1.0F});
    set(picture, 2, 0, {0.25F, 0.25F, 0.25F, 1.0F});
    set(picture, 3, 0, {-1.0F, 0.0F, 0.0F, 1.0F});
    const Exposures e = exposures_for(picture);
    EXPECT_NEAR(e.stop - e.start, 2.0, 1e-9);
    EXPECT_EQ(exposures_for(plain(4, 4, 0.0F)).count, 1);
}

TEST(FlipHdr, IsTheLargestOverItsExposures) {
    const Framebuffer got = noise(12, 12, 1), want = noise(12, 12, 2);
    WorkerPool pool(1);
    const auto with = [&](Exposures e) {
        FlipOptions options;
        options.exposures = e;
        return flip_hdr(got, want, options, pool);
    };
    const Plane low = with({-2.0, -2.0, 1}), middle = with({0.0, 0.0, 1}),
                high = with({2.0, 2.0, 1});
    const Plane all = with({-2.0, 2.0, 3});
    std::size_t from_low = 0;
    for (std::size_t i = 0; i < all.values.size(); ++i) {
        EXPECT_EQ(all.values[i], std::max({low.values[i], middle.values[i], high.values[i]}));
        from_low += all.values[i] == low.values[i] ? 1 : 0;
    }
    EXPECT_LT(from_low, all.values.size());
}

TEST(FlipHdr, AnExposureIsTheToneMappedPair) {
    Framebuffer got = noise(12, 12, 3), want = noise(12, 12, 4);
    FlipOptions options;
    options.exposures = Exposures{1.0, 1.0, 1};
    WorkerPool pool(1);
    const Plane hdr = flip_hdr(got, want, options, pool);
    for (Framebuffer* frame : {&got, &want})
        for (int y = 0; y < 12; ++y)
            for (int x = 0; x < 12; ++x) {
                glm::vec4 p = get(*frame, x, y);
                for (int c = 0; c < 3; ++c)
                    p[c] = static_cast<float>(std::min(1.0, aces(2.0 * p[c])));
                set(*frame, x, y, p);
            }
    FlipOptions linear;
    linear.encoding = Encoding::linear;
    const Plane ldr = flip(got, want, linear, pool);
    for (std::size_t i = 0; i < hdr.values.size(); ++i)
        EXPECT_NEAR(hdr.values[i], ldr.values[i], 1e-5);  // frames are floats
}

// Eight times the light in both is another exposure and no other error.
TEST(FlipHdr, DoesNotDependOnTheUnitOfLight) {
    const Framebuffer got = noise(12, 12, 5), want = noise(12, 12, 6);
    const auto brighter = [](const Framebuffer& frame) {
        Framebuffer copy = plain(12, 12, 0.0F);
        for (int y = 0; y < 12; ++y)
            for (int x = 0; x < 12; ++x) set(copy, x, y, 8.0F * get(frame, x, y));
        return copy;
    };
    WorkerPool pool(1);
    const Plane a = flip_hdr(got, want, {}, pool);
    const Plane b = flip_hdr(brighter(got), brighter(want), {}, pool);
    for (std::size_t i = 0; i < a.values.size(); ++i) EXPECT_NEAR(a.values[i], b.values[i], 1e-9);
}

TEST(FlipHdr, BrightestFloatsStayNumbers) {
    Framebuffer got = plain(12, 12, 3e38F);
    const Framebuffer want = plain(12, 12, 1e-38F);
    WorkerPool pool(1);
    for (const double value : flip_hdr(got, want, {}, pool).values) {
        EXPECT_GE(value, 0.0);
        EXPECT_LE(value, 1.0);
    }
}

}  // namespace
}  // namespace burnish::metrics
