#include "models/mips/parameter_mips.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <burnish/error.hpp>
#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

#include "models/mips/slope_lobe.hpp"
#include "models/mips/texel_moments.hpp"

namespace burnish::mips {
namespace {

constexpr MipMethod kMethods[] = {
    MipMethod::box,   MipMethod::normalize, MipMethod::mag,     MipMethod::toksvig,
    MipMethod::clean, MipMethod::lean,      MipMethod::moments, MipMethod::moments_unweighted};
constexpr Model kLobes[] = {Model::blinn_phong, Model::abp, Model::abp_modified,
                            Model::ward,        Model::ggx, Model::banks};

LobeShape shape_of(Model model) {
    Material material;
    material.model = model;
    return LobeShape(material);
}

/// Normal of that slope, tangent at that angle from u.
TexelParameters texel(const glm::dvec2& slope, double angle, double alpha_x, double alpha_y,
                      double exponent = 10.0) {
    TexelParameters p;
    p.n = normal_of(slope);
    p.t = perpendicular({std::cos(angle), std::sin(angle), 0.0}, p.n);
    p.b = glm::cross(p.n, p.t);
    p.alpha_x = alpha_x;
    p.alpha_y = alpha_y;
    p.exponent = exponent;
    p.ks = {0.5, 0.4, 0.3};
    p.kd = {0.1, 0.2, 0.3};
    return p;
}

ParameterGrid grid(int width, int height, const std::function<TexelParameters(int, int)>& at) {
    ParameterGrid g{width, height, {}};
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) g.texels.push_back(at(x, y));
    }
    return g;
}

std::vector<ParameterGrid> mips_of(const ParameterGrid& level0, const LobeShape& shape,
                                   MipMethod method, int bits = 0) {
    return parameter_mips([&](int x, int y) { return level0.at(x, y); }, level0.width,
                          level0.height, shape, {method, bits});
}

/// What stands for two texels.
TexelParameters filtered(const TexelParameters& a, const TexelParameters& b, Model model,
                         MipMethod method) {
    const ParameterGrid pair{2, 1, {a, b}};
    return mips_of(pair, shape_of(model), method).front().at(0, 0);
}

void expect_near(const glm::dvec3& a, const glm::dvec3& b, double tolerance) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], tolerance) << "component " << c;
}

/// The half vector at (h.t, h.b).
glm::dvec3 half_at(const TexelParameters& p, double u, double w) {
    return p.t * u + p.b * w + p.n * std::sqrt(1.0 - u * u - w * w);
}

/// Derivative of the slope of h by (h.t, h.b), from differences.
glm::dmat2 numeric_jacobian(const TexelParameters& p) {
    constexpr double step = 1e-5;
    const auto slope = [&](double u, double w) {
        const glm::dvec3 h = half_at(p, u, w);
        return glm::dvec2(h) / h.z;
    };
    return {(slope(step, 0.0) - slope(-step, 0.0)) / (2.0 * step),
            (slope(0.0, step) - slope(0.0, -step)) / (2.0 * step)};
}

/// Where a lobe's light is, over slopes.
struct Distribution {
    double energy = 0.0;
    glm::dvec2 first{0.0};
    Symmetric second;

    void add(double e, const glm::dvec2& slope) {
        energy += e;
        first += slope * e;
        second = second + Symmetric::outer(slope) * e;
    }
    [[nodiscard]] glm::dvec2 mean() const { return first / energy; }
    [[nodiscard]] Symmetric covariance() const {
        return second * (1.0 / energy) - Symmetric::outer(mean());
    }
};

/// Of the lobe max(0, 1 - q)^(N/2), `count` points of its own density around the normal.
template <class SlopeAt>
void add_lobe(Distribution& to, const TexelParameters& p, int count, std::mt19937& random,
              const SlopeAt& slope_at) {
    const double energy =
        p.ks.x * 2.0 * std::numbers::pi * p.alpha_x * p.alpha_y / (p.exponent + 2.0);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    for (int i = 0; i < count; ++i) {
        const double r = std::sqrt(1.0 - std::pow(unit(random), 2.0 / (p.exponent + 2.0)));
        const double angle = 2.0 * std::numbers::pi * unit(random);
        // Both senses: the mean is the centre's.
        for (const double sense : {1.0, -1.0})
            to.add(0.5 * energy / count, slope_at(sense * p.alpha_x * r * std::cos(angle),
                                                  sense * p.alpha_y * r * std::sin(angle)));
    }
}

TEST(SlopeJacobian, IsTheDerivativeAndHasItsDeterminant) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    for (int i = 0; i < 50; ++i) {
        const TexelParameters p = texel({any(random), any(random)}, 3.0 * any(random), 0.1, 0.2);
        const glm::dmat2 j = slope_jacobian(p), numeric = numeric_jacobian(p);
        for (int c = 0; c < 2; ++c) {
            for (int r = 0; r < 2; ++r) EXPECT_NEAR(j[c][r], numeric[c][r], 1e-8);
        }
        EXPECT_NEAR(glm::determinant(j), 1.0 / (p.n.z * p.n.z * p.n.z), 1e-12);
    }
}

TEST(ParameterMips, AConstantMaterialStaysAsItIs) {
    const TexelParameters p = texel({0.3, -0.2}, 1.1, 0.08, 0.21);
    for (const Model model : kLobes) {
        for (const MipMethod method : kMethods) {
            const auto levels = mips_of({7, 5, std::vector(35, p)}, shape_of(model), method);
            ASSERT_EQ(levels.size(), 2U);
            EXPECT_EQ(levels[0].width, 3);
            EXPECT_EQ(levels[0].height, 2);
            EXPECT_EQ(levels[1].texels.size(), 1U);
            SCOPED_TRACE(testing::Message() << "model " << static_cast<int>(model) << ", method "
                                            << static_cast<int>(method));
            for (const ParameterGrid& level : levels) {
                for (const TexelParameters& q : level.texels) {
                    expect_near(q.n, p.n, 1e-12);
                    expect_near(q.t, p.t, 1e-12);
                    expect_near(q.b, p.b, 1e-12);
                    expect_near(q.ks, p.ks, 1e-12);
                    expect_near(q.kd, p.kd, 1e-12);
                    EXPECT_NEAR(q.alpha_x, p.alpha_x, 1e-12);
                    EXPECT_NEAR(q.alpha_y, p.alpha_y, 1e-12);
                    EXPECT_NEAR(q.exponent, p.exponent, 1e-9);
                }
            }
        }
    }
    EXPECT_TRUE(mips_of({2, 2, std::vector(4, p)}, shape_of(Model::abp), MipMethod::none).empty());
}

/// Random 64 x 64 texels; their lobes' distribution over slopes.
class Region : public testing::Test {
  protected:
    Region()
        : random(7), level0(grid(64, 64, [&](int, int) {
              std::uniform_real_distribution<double> any(0.0, 1.0);
              const double tilt = 0.3, x = any(random) - 0.3, y = any(random) - 0.5;
              TexelParameters p = texel({tilt * x, tilt * y}, 3.0 * any(random),
                                        0.03 + 0.1 * any(random), 0.05 + 0.2 * any(random));
              p.ks = glm::dvec3(any(random));
              return p;
          })) {}

    std::mt19937 random;
    ParameterGrid level0;
};

TEST_F(Region, HasTheMomentsOfItsTexels) {
    const LobeShape shape = shape_of(Model::abp);
    const TexelParameters top = mips_of(level0, shape, MipMethod::moments).back().at(0, 0);
    // Points at which a lobe's moments are exact, by differences instead of formulas.
    const auto linear = [](const TexelParameters& p, double energy, Distribution& to) {
        const glm::dmat2 j = numeric_jacobian(p);
        const glm::dvec2 centre = glm::dvec2(p.n) / p.n.z;
        const double x = p.alpha_x * std::sqrt(2.0 / (p.exponent + 4.0)),
                     y = p.alpha_y * std::sqrt(2.0 / (p.exponent + 4.0));
        for (const glm::dvec2& at : {glm::dvec2(x, 0), {-x, 0}, {0, y}, {0, -y}})
            to.add(0.25 * energy, centre + j * at);
    };
    const auto energy = [](const TexelParameters& p) {
        return p.ks.x * p.alpha_x * p.alpha_y * 2.0 * std::numbers::pi / (p.exponent + 2.0);
    };
    Distribution all, one;
    for (const TexelParameters& p : level0.texels) linear(p, energy(p) / 4096.0, all);
    linear(top, energy(top), one);
    EXPECT_NEAR(one.energy / all.energy, 1.0, 1e-12);
    EXPECT_NEAR(one.mean().x, all.mean().x, 1e-12);
    EXPECT_NEAR(one.mean().y, all.mean().y, 1e-12);
    EXPECT_NEAR(one.covariance().xx / all.covariance().xx, 1.0, 1e-8);
    EXPECT_NEAR(one.covariance().yy / all.covariance().yy, 1.0, 1e-8);
    EXPECT_NEAR(one.covariance().xy / all.covariance().xx,
                all.covariance().xy / all.covariance().xx, 1e-8);
}

TEST_F(Region, IsAsWideAsItsTexelsAreToTheEye) {
    // Half vectors as they are, without a derivative: 4096 texels with 32 of them each. What is
    // left is the curvature of the plane of slopes over the widths.
    const TexelParameters top =
        mips_of(level0, shape_of(Model::abp), MipMethod::moments).back().at(0, 0);
    Distribution all, one;
    const auto add = [&](const TexelParameters& p, int count, Distribution& to) {
        add_lobe(to, p, count, random, [&](double u, double w) {
            const glm::dvec3 h = half_at(p, u, w);
            return glm::dvec2(h) / h.z;
        });
    };
    for (const TexelParameters& p : level0.texels) add(p, 16, all);
    add(top, 65536, one);
    EXPECT_NEAR(4096.0 * one.energy / all.energy, 1.0, 1e-9);
    EXPECT_NEAR(one.mean().x, all.mean().x, 0.001);
    EXPECT_NEAR(one.mean().y, all.mean().y, 0.001);
    EXPECT_NEAR(one.covariance().xx / all.covariance().xx, 1.0, 0.05);
    EXPECT_NEAR(one.covariance().yy / all.covariance().yy, 1.0, 0.05);
}

/// Integral of the lobe that (h.X, h.Y) give, over (h.x, h.y).
double lobe_energy(const glm::dvec2& X, const glm::dvec2& Y, double ks, double exponent) {
    constexpr int steps = 400;
    constexpr double reach = 0.4;
    double sum = 0.0;
    for (int j = 0; j < steps; ++j) {
        for (int i = 0; i < steps; ++i) {
            const glm::dvec2 h(reach * ((2 * i + 1.0) / steps - 1.0),
                               reach * ((2 * j + 1.0) / steps - 1.0));
            const double u = glm::dot(h, X), w = glm::dot(h, Y);
            const double s = 1.0 - u * u - w * w;
            if (s > 0.0) sum += std::pow(s, 0.5 * exponent);
        }
    }
    return ks * sum * (4.0 * reach * reach) / (steps * steps);
}

TEST(MomentMips, KeepTheEnergyOfTwoTexelsAt90Degrees) {
    const TexelParameters a = texel({0.0, 0.0}, 0.0, 0.05, 0.20);
    const TexelParameters b = texel({0.0, 0.0}, 0.5 * std::numbers::pi, 0.05, 0.20);
    const auto X = [](const TexelParameters& p) { return glm::dvec2(p.t) / p.alpha_x; };
    const auto Y = [](const TexelParameters& p) { return glm::dvec2(p.b) / p.alpha_y; };
    const double truth = lobe_energy(X(a), Y(a), a.ks.x, a.exponent);
    EXPECT_NEAR(lobe_energy(0.5 * (X(a) + X(b)), 0.5 * (Y(a) + Y(b)), a.ks.x, a.exponent) / truth,
                1.99, 0.02)
        << "filtered before it is combined";
    const TexelParameters m = filtered(a, b, Model::abp, MipMethod::moments);
    EXPECT_NEAR(lobe_energy(X(m), Y(m), m.ks.x, m.exponent) / truth, 1.0, 0.01);
    EXPECT_NEAR(m.alpha_x, std::sqrt(0.5 * (0.0025 + 0.04)), 1e-12) << "round, and as wide as both";
    EXPECT_NEAR(m.alpha_x, m.alpha_y, 1e-12);
    const TexelParameters u = filtered(a, b, Model::abp, MipMethod::moments_unweighted);
    EXPECT_NEAR(u.ks.x, a.ks.x, 1e-15);
    EXPECT_GT(lobe_energy(X(u), Y(u), u.ks.x, u.exponent) / truth, 2.0) << "too much light";
}

TEST(MomentMips, WeightByLight) {
    TexelParameters bright = texel({0.1, 0.0}, 0.0, 0.05, 0.10),
                    dark = texel({-0.1, 0.0}, 0.0, 0.05, 0.10);
    dark.ks = glm::dvec3(0.0);
    const TexelParameters m = filtered(bright, dark, Model::abp, MipMethod::moments);
    expect_near(m.n, bright.n, 1e-12);
    EXPECT_NEAR(m.alpha_x, bright.alpha_x, 1e-12);
    expect_near(m.ks, 0.5 * bright.ks, 1e-12);
    expect_near(filtered(bright, dark, Model::abp, MipMethod::moments_unweighted).n,
                {0.0, 0.0, 1.0}, 1e-12);
    bright.ks = dark.ks;
    expect_near(filtered(bright, dark, Model::abp, MipMethod::moments).n, {0.0, 0.0, 1.0}, 1e-12);
}

TEST(MomentMips, TangentsAreLines) {
    const TexelParameters a = texel({0.0, 0.0}, 0.4, 0.05, 0.20);
    const TexelParameters b = texel({0.0, 0.0}, 0.4 + std::numbers::pi, 0.05, 0.20);
    const TexelParameters m = filtered(a, b, Model::abp, MipMethod::moments);
    EXPECT_NEAR(std::abs(glm::dot(m.t, a.t)), 1.0, 1e-12);
    EXPECT_NEAR(m.alpha_x, 0.05, 1e-12);
    EXPECT_NEAR(m.alpha_y, 0.20, 1e-12);
    // The lobe's narrow side comes to be t, as at most of the texels, and in their sense.
    const TexelParameters c =
        filtered(a, texel({0.0, 0.0}, 1.0, 0.05, 0.20), Model::abp, MipMethod::moments);
    EXPECT_NEAR(std::atan2(c.t.y, c.t.x), 0.7, 1e-12);
    EXPECT_LT(c.alpha_x, c.alpha_y);
}

/// Two normals of slope +-0.3 along u, widths 0.1 and 0.2 along u and v.
class TwoNormals : public testing::Test {
  protected:
    [[nodiscard]] TexelParameters filtered(Model model, MipMethod method) const {
        return mips::filtered(texel({0.3, 0.0}, 0.0, 0.1, 0.2), texel({-0.3, 0.0}, 0.0, 0.1, 0.2),
                              model, method);
    }
    const double length = 1.0 / std::sqrt(1.09);  ///< of the mean normal
};

TEST_F(TwoNormals, BoxKeepsTheShortVector) {
    const TexelParameters p = filtered(Model::ward, MipMethod::box);
    expect_near(p.n, {0.0, 0.0, length}, 1e-15);
    expect_near(p.t, {length, 0.0, 0.0}, 1e-15);
    EXPECT_EQ(p.kd.x, 0.1);
}

TEST_F(TwoNormals, LengthGoesToTheDiffusePart) {
    const TexelParameters plain = filtered(Model::ward, MipMethod::normalize);
    expect_near(plain.n, {0.0, 0.0, 1.0}, 1e-15);
    EXPECT_EQ(plain.kd.x, 0.1);
    for (const MipMethod method : kMethods) {
        if (method == MipMethod::box || method == MipMethod::normalize) continue;
        EXPECT_NEAR(filtered(Model::ward, method).kd.x, 0.1 * length, 1e-15);
    }
    EXPECT_EQ(filtered(Model::ward, MipMethod::mag).alpha_x, 0.1);
}

TEST_F(TwoNormals, ToksvigsFormula) {
    // s = 10 for cos^10: ft = |Na| / (|Na| + s (1 - |Na|)).
    const double ft = length / (length + 10.0 * (1.0 - length));
    const TexelParameters round = filtered(Model::blinn_phong, MipMethod::toksvig);
    EXPECT_NEAR(round.exponent, 10.0 * ft, 1e-12);
    EXPECT_NEAR(round.ks.x, 0.5 * (1.0 + 10.0 * ft) / 11.0, 1e-12);
    // A Gaussian of alpha^2 / 2 is cos^(2 / alpha^2); sigma^2 = (1 - |Na|) / |Na| more.
    const TexelParameters wide = filtered(Model::ward, MipMethod::toksvig);
    const double variance = (1.0 - length) / length;
    EXPECT_NEAR(wide.alpha_x, std::sqrt(0.01 + 2.0 * variance), 1e-12);
    EXPECT_NEAR(wide.alpha_y, std::sqrt(0.04 + 2.0 * variance), 1e-12);
    EXPECT_EQ(wide.ks.x, 0.5) << "its height follows from the widths";
}

TEST_F(TwoNormals, LeanAndCleanAddVariance) {
    // The mean slope is 0, its variance 0.09 along u; the texels' own widths stay.
    const TexelParameters lean = filtered(Model::ward, MipMethod::lean);
    EXPECT_NEAR(lean.alpha_x, std::sqrt(0.01 + 0.18), 1e-12);
    EXPECT_NEAR(lean.alpha_y, 0.2, 1e-12);
    const TexelParameters clean = filtered(Model::ward, MipMethod::clean);
    EXPECT_NEAR(clean.alpha_x, std::sqrt(0.01 + 0.09), 1e-12);
    EXPECT_NEAR(clean.alpha_y, std::sqrt(0.04 + 0.09), 1e-12);
    // Variance alpha^2 / 14 of the lobe with N = 10; its height falls as it widens.
    const TexelParameters power = filtered(Model::abp, MipMethod::lean);
    EXPECT_NEAR(power.alpha_x, std::sqrt(0.01 + 14.0 * 0.09), 1.0) << "at most 1";
    EXPECT_NEAR(power.alpha_x * power.alpha_y * power.ks.x, 0.1 * 0.2 * 0.5, 1e-12);
}

TEST(MomentStorage, ErrorsFallWithBits) {
    std::mt19937 random(3);
    const ParameterGrid level0 = grid(16, 16, [&](int, int) {
        std::uniform_real_distribution<double> any(-1.0, 1.0);
        return texel({0.5 * any(random), 0.5 * any(random)}, 0.0, 0.02, 0.03);
    });
    const LobeShape shape = shape_of(Model::abp);
    const auto exact = mips_of(level0, shape, MipMethod::moments);
    const auto error = [&](int bits) {
        const auto levels = mips_of(level0, shape, MipMethod::moments, bits);
        double most = 0.0;
        for (std::size_t i = 0; i < exact[0].texels.size(); ++i)
            most =
                std::max(most, std::abs(levels[0].texels[i].alpha_x - exact[0].texels[i].alpha_x));
        return most;
    };
    // Variance is the small difference of two squares, so 8 bits leave little of a narrow lobe.
    EXPECT_GT(error(8), 0.01);
    EXPECT_LT(error(16), 0.002);
    EXPECT_LT(error(32), 1e-7);
}

TEST(ParameterMips, OfMoreThanTwoGigabytesAreRefusedBeforeATexelIsRead) {
    const Material material;
    const auto unread = [](int, int) -> TexelParameters { throw std::logic_error("read"); };
    try {
        parameter_mips(unread, 16384, 16384, LobeShape(material), {MipMethod::moments});
        FAIL() << "nothing thrown";
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::limit);
    }
    EXPECT_NO_THROW(require_room(4096, 4096));
}

}  // namespace
}  // namespace burnish::mips
