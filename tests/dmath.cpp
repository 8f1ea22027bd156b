#include "core/dmath.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace burnish {
namespace {

// The claims at the top of dmath.hpp, measured against the long double functions of the C library,
// which carry 11 bits more.
constexpr double kSineClaim = 4e-16;
constexpr double kArcClaim = 2e-15;
constexpr double kRelativeClaim = 1e-14;

using Function = std::function<double(double)>;
using Truth = std::function<long double(long double)>;

struct Worst {
    double error = 0.0;
    double at = 0.0;
};

Worst worst_absolute(double low, double high, int steps, const Function& f, const Truth& truth) {
    Worst worst;
    for (int i = 0; i <= steps; ++i) {
        const double x = low + (high - low) * i / steps;
        const auto error =
            static_cast<double>(std::fabs(static_cast<long double>(f(x)) - truth(x)));
        if (!(error <= worst.error)) worst = {error, x};
    }
    return worst;
}

Worst worst_relative(double low, double high, int steps, const Function& f, const Truth& truth) {
    Worst worst;
    for (int i = 0; i <= steps; ++i) {
        const double x = low + (high - low) * i / steps;
        const long double want = truth(x);
        const auto error =
            static_cast<double>(std::fabs((static_cast<long double>(f(x)) - want) / want));
        if (!(error <= worst.error)) worst = {error, x};
    }
    return worst;
}

TEST(Dmath, SinAndCosAcrossTheirRange) {
    const Truth sinl = [](long double x) { return std::sin(x); };
    const Truth cosl = [](long double x) { return std::cos(x); };
    for (const double reach : {1.0, 7.0, 1000.0, 999999.0}) {
        const Worst s = worst_absolute(-reach, reach, 200003, dmath::sin, sinl);
        const Worst c = worst_absolute(-reach, reach, 200003, dmath::cos, cosl);
        EXPECT_LT(s.error, kSineClaim) << "sin at " << s.at;
        EXPECT_LT(c.error, kSineClaim) << "cos at " << c.at;
    }
}

TEST(Dmath, AcosOverItsDomainAndDenselyNearOne) {
    const Truth acosl = [](long double x) { return std::acos(x); };
    const Worst all = worst_absolute(-1.0, 1.0, 400000, dmath::acos, acosl);
    EXPECT_LT(all.error, kArcClaim) << "acos at " << all.at;
    const Worst near = worst_absolute(1.0 - 1e-9, 1.0, 10000, dmath::acos, acosl);
    EXPECT_LT(near.error, kArcClaim) << "acos at " << near.at;
}

TEST(Dmath, AtanAndAtan2) {
    const Worst a = worst_absolute(-50.0, 50.0, 400000, dmath::atan,
                                   [](long double x) { return std::atan(x); });
    EXPECT_LT(a.error, kArcClaim) << "atan at " << a.at;
    const Worst far = worst_absolute(-1e200, 1e200, 1000, dmath::atan,
                                     [](long double x) { return std::atan(x); });
    EXPECT_LT(far.error, kArcClaim) << "atan at " << far.at;
    for (int i = 0; i < 3600; ++i) {
        const double angle = (i - 1800) * dmath::kPi / 1800.0 + 1e-4;
        const double y = 3.0 * std::sin(angle);
        const double x = 3.0 * std::cos(angle);
        EXPECT_NEAR(dmath::atan2(y, x), std::atan2(y, x), kArcClaim) << angle;
    }
}

TEST(Dmath, Exp2AndLog2) {
    const Worst e = worst_relative(-1000.0, 1000.0, 400000, dmath::exp2,
                                   [](long double x) { return std::exp2(x); });
    EXPECT_LT(e.error, kRelativeClaim) << "exp2 at " << e.at;
    const Truth log2l = [](long double x) { return std::log2(x); };
    const Worst above = worst_relative(1.01, 1000.0, 400000, dmath::log2, log2l);
    const Worst below = worst_relative(1e-6, 0.99, 400000, dmath::log2, log2l);
    EXPECT_LT(above.error, kRelativeClaim) << "log2 at " << above.at;
    EXPECT_LT(below.error, kRelativeClaim) << "log2 at " << below.at;
}

TEST(Dmath, PowOfUnitIntervalToExponentsOfTheModels) {
    for (const double exponent : {0.5, 1.0, 2.2, 16.0, 100.0}) {
        const Worst p = worst_relative(
            0.001, 1.0, 100000, [exponent](double x) { return dmath::pow(x, exponent); },
            [exponent](long double x) { return std::pow(x, static_cast<long double>(exponent)); });
        // The logarithm's error is multiplied by the exponent.
        EXPECT_LT(p.error, kRelativeClaim * std::max(1.0, exponent)) << exponent << " at " << p.at;
    }
}

TEST(Dmath, EdgesAreExact) {
    EXPECT_EQ(dmath::sin(0.0), 0.0);
    EXPECT_EQ(dmath::cos(0.0), 1.0);
    EXPECT_EQ(dmath::acos(1.0), 0.0);
    EXPECT_EQ(dmath::acos(1.5), 0.0);
    EXPECT_EQ(dmath::acos(-2.0), dmath::kPi);
    EXPECT_EQ(dmath::atan2(0.0, 0.0), 0.0);
    EXPECT_EQ(dmath::atan2(0.0, -1.0), dmath::kPi);
    for (int i = -1022; i <= 1023; ++i) {
        EXPECT_EQ(dmath::exp2(i), std::ldexp(1.0, i));
        EXPECT_EQ(dmath::log2(std::ldexp(1.0, i)), i);
    }
    EXPECT_EQ(dmath::exp2(-1e9), 0.0);
    EXPECT_EQ(dmath::exp2(1e9), std::numeric_limits<double>::infinity());
    EXPECT_EQ(dmath::pow(0.0, 0.0), 1.0);
    EXPECT_EQ(dmath::pow(0.0, 3.0), 0.0);
    EXPECT_EQ(dmath::pow(2.0, 10.0), 1024.0);
}

}  // namespace
}  // namespace burnish
