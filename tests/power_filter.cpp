#include "reference/power_filter.hpp"

#include <gtest/gtest.h>
#include <burnish/materials.hpp>
#include <burnish/renderer.hpp>
#include <burnish/shapes.hpp>

#include <cmath>
#include <cstring>

#include "tests/scene_file.hpp"

namespace burnish {
namespace {

using reference::mean_power;
using reference::mip_power;

double sampled_mean(double low, double high, double m) {
    constexpr int steps = 20000;
    double sum = 0.0;
    for (int i = 0; i < steps; ++i)
        sum += std::pow(std::max(low + (high - low) * (i + 0.5) / steps, 0.0), m);
    return sum / steps;
}

TEST(MeanPower, IsTheMeanOfManySamples) {
    for (const double m : {0.0, 0.5, 1.0, 8.0, 256.0}) {
        EXPECT_NEAR(mean_power(0.2, 0.9, m), sampled_mean(0.2, 0.9, m), 1e-6);
        EXPECT_NEAR(mean_power(0.99, 1.0, m), sampled_mean(0.99, 1.0, m), 1e-6);
        EXPECT_EQ(mean_power(0.7, 0.7, m), std::pow(0.7, m));
        EXPECT_NEAR(mean_power(0.7, 0.7 + 1e-6, m), std::pow(0.7, m), 1e-6 * (m + 1.0));
        // 0^0 is 1, so of m = 0 the sum is another one below 0.
        if (m == 0.0) continue;
        EXPECT_NEAR(mean_power(-0.5, 0.5, m), sampled_mean(-0.5, 0.5, m), 1e-4);
    }
    EXPECT_EQ(mean_power(-0.5, -0.1, 3.0), 0.0);
}

TEST(MipPower, LevelsAreMeansOfTwo) {
    EXPECT_EQ(mip_power(51.0 / 255.0, 0.0, 3.0), std::pow(51.0 / 255.0, 3.0)) << "a texel";
    EXPECT_NEAR(mip_power(0.5, 1.0 / 256.0, 1.0), 0.5, 1e-12) << "magnified: between two";
    // Level 4: 16 texels. Between texel centres, s = 7.5 / 255 is the middle of its first one.
    EXPECT_NEAR(mip_power(7.5 / 255.0, 16.0 / 256.0, 2.0), sampled_mean(0.0, 15.0 / 255.0, 2.0),
                1e-4);
    EXPECT_NEAR(mip_power(0.3, 1e9, 1.0), 0.5, 1e-12) << "one texel for all";
    EXPECT_EQ(mip_power(-3.0, 0.0, 2.0), 0.0);
    for (const double s : {0.1, 0.5, 0.95})
        EXPECT_NEAR(mip_power(s, 0.05, 4.0), mean_power(s - 0.025, s + 0.025, 4.0), 0.02);
}

/// A sphere with a lobe narrower than a pixel.
Framebuffer glint(TableFilter filter, int samples, float turn = 0.0F) {
    Scene scene;
    scene.machine = machine_profile("double");
    scene.machine.table_filter = filter;
    scene.background = glm::vec4(0.0F);
    Light light;
    light.position = {0.4F + turn, 0.5F, 0.8F};
    scene.lights.push_back(light);
    Material material;
    material.model = Model::abp;
    material.alpha_x = 0.3F;
    material.alpha_y = 0.6F;
    material.exponent = 1024.0F;
    Object object;
    object.geometry = Mesh(shapes::sphere(48, 24));
    object.material = std::make_shared<const Material>(material);
    scene.objects.push_back(std::move(object));
    Framebuffer frame(32, 32, PixelFormat::rgba32f);
    Renderer({.threads = 1, .double_samples = samples}).render(scene, frame);
    return frame;
}

double error(const Framebuffer& a, const Framebuffer& b) {
    double sum = 0.0;
    for (int y = 0; y < 32; ++y) {
        for (int x = 0; x < 32; ++x) {
            float p, q;
            std::memcpy(&p, a.row(y) + 16 * x, sizeof p);
            std::memcpy(&q, b.row(y) + 16 * x, sizeof q);
            sum += static_cast<double>(p - q) * static_cast<double>(p - q);
        }
    }
    return std::sqrt(sum / 1024.0);
}

// N = 1024 from pixels of 1/32 of the picture: the exact integral is nearer to the truth; a mip
// level is wider than the lobe and is not.
TEST(TableFilter, TheExactMeanComesNearerToManySamples) {
    double point = 0.0, mip = 0.0, exact = 0.0;
    for (const float turn : {0.0F, 0.02F, 0.05F, 0.09F}) {
        const Framebuffer truth = glint(TableFilter::point, 256, turn);
        point += error(glint(TableFilter::point, 1, turn), truth);
        mip += error(glint(TableFilter::mip, 1, turn), truth);
        exact += error(glint(TableFilter::exact, 1, turn), truth);
    }
    EXPECT_LT(exact, 0.8 * point);
    EXPECT_LT(exact, 0.8 * mip);
}

class TableFilterKey : public SceneFile {};

TEST_F(TableFilterKey, IsOfProfileDouble) {
    const std::string exact = "table_filter = \"exact\"\n";
    EXPECT_EQ(scene("[machine]\nprofile = \"double\"\n" + exact).machine.table_filter,
              TableFilter::exact);
    EXPECT_SAYS(complaint_of([&] { scene("[machine]\n" + exact); }), "expected profile = double");
}

}  // namespace
}  // namespace burnish
