#include <gtest/gtest.h>
#include <burnish/anisotropy.hpp>
#include <burnish/error.hpp>

#include <cmath>
#include <memory>

#include "models/texel.hpp"

namespace burnish {
namespace {

constexpr double kPi = 3.14159265358979323846;

Image8 filled(int width, int height, const std::uint8_t (&texel)[4]) {
    Image8 image(width, height);
    for (std::size_t i = 0; i < image.rgba.size(); ++i) image.rgba[i] = texel[i % 4];
    return image;
}

TEST(Anisotropy, WidthsByHand) {
    // roughness 0.5: alpha 0.25; strength 0.6: 0.25 * 0.64 + 0.36 = 0.52 along the direction.
    const LobeWidths w = widths_from_gltf({0.5, 0.6, 0.3});
    EXPECT_NEAR(w.alpha_x, 0.52, 1e-15);
    EXPECT_NEAR(w.alpha_y, 0.25, 1e-15);
    EXPECT_EQ(w.direction, 0.3);
    // Without strength round, at full strength as wide as can be along the direction.
    EXPECT_EQ(widths_from_gltf({0.5, 0.0, 0.0}).alpha_x, 0.25);
    EXPECT_EQ(widths_from_gltf({0.5, 1.0, 0.0}).alpha_x, 1.0);
}

TEST(Anisotropy, RolledBrassByHand) {
    // 0.05 along the marks and 0.16 across: roughness sqrt(0.05), strength sqrt(0.11 / 0.95), and
    // the direction of the extension lies across the marks, 90 degrees from our tangent.
    const GltfAnisotropy g = gltf_from_widths({0.05, 0.16, 0.0});
    EXPECT_NEAR(g.roughness, 0.2236067977, 1e-10);
    EXPECT_NEAR(g.strength, 0.3402785, 1e-6);
    EXPECT_NEAR(g.rotation, kPi / 2.0, 1e-15);
    // With the tangent across the marks there is nothing to turn.
    EXPECT_EQ(gltf_from_widths({0.16, 0.05, 0.0}).rotation, 0.0);
}

TEST(Anisotropy, ThereAndBack) {
    for (int i = 0; i <= 20; ++i) {
        for (int j = 0; j <= 20; ++j) {
            for (const double rotation : {-1.5, -0.4, 0.0, 0.7, kPi / 2.0}) {
                const GltfAnisotropy g{i / 20.0, j / 20.0, rotation};
                const LobeWidths w = widths_from_gltf(g);
                const GltfAnisotropy again = gltf_from_widths(w);
                ASSERT_NEAR(again.roughness, g.roughness, 1e-12);
                // A lobe that is as wide as can be has no strength left, a round one no direction.
                if (i == 20) continue;
                ASSERT_NEAR(again.strength, g.strength, 1e-7);
                if (j > 0) {
                    ASSERT_NEAR(again.rotation, g.rotation, 1e-12);
                }
            }
        }
    }
}

/// Swapping both widths and turning by 90 degrees is the same surface.
TEST(Anisotropy, NamesOfTheAxesDoNotMatter) {
    for (const double angle : {-3.0, -1.0, 0.0, 0.2, 1.5, 3.0, 7.0}) {
        const GltfAnisotropy a = gltf_from_widths({0.3, 0.1, angle});
        const GltfAnisotropy b = gltf_from_widths({0.1, 0.3, angle + kPi / 2.0});
        EXPECT_NEAR(std::sin(a.rotation - b.rotation), 0.0, 1e-12);
        EXPECT_EQ(a.strength, b.strength);
        EXPECT_GT(a.rotation, -kPi / 2.0);
        EXPECT_LE(a.rotation, kPi / 2.0);
        // A line, not an arrow: half a turn more or less is the same.
        EXPECT_NEAR(std::sin(a.rotation - angle), 0.0, 1e-12);
    }
}

TEST(Anisotropy, RotationRunsAgainstTheClock) {
    // Direction along u, turned by 30 degrees: up and to the right, that is green above 128.
    const Image8 texture = filled(1, 1, {255, 128, 255, 255});
    const AnisotropyMaps maps = anisotropy_maps_from_gltf(texture, {}, {0.5, 0.6, kPi / 6.0});
    Material m;
    m.direction_map = std::make_shared<const Texture>(maps.direction, Sampler{});
    const TexelParameters p = TexelSource(m).at(0, 0);
    EXPECT_NEAR(p.t.x, std::cos(kPi / 6.0), 0.01);  // codes of 1/128
    EXPECT_NEAR(p.t.y, std::sin(kPi / 6.0), 0.01);
    EXPECT_GT(maps.direction.at(0, 0)[1], 180);
    EXPECT_NEAR(static_cast<double>(maps.alpha_x_range.high), 0.52, 1e-6);
    EXPECT_NEAR(static_cast<double>(maps.alpha_y_range.high), 0.25, 1e-6);
}

TEST(Anisotropy, GreenIsUpwards) {
    const Image8 texture = filled(1, 1, {128, 255, 255, 255});
    const AnisotropyMaps maps = anisotropy_maps_from_gltf(texture, {}, {});
    EXPECT_EQ(maps.direction.at(0, 0)[1], 255);
    EXPECT_LE(std::abs(maps.direction.at(0, 0)[0] - 128), 1);
}

TEST(Anisotropy, TexturesMultiplyTheFactors) {
    Image8 texture(2, 1), roughness(2, 1);
    const std::uint8_t texels[] = {255, 128, 255, 255, 255, 128, 51, 255};
    std::copy(std::begin(texels), std::end(texels), texture.rgba.begin());
    const std::uint8_t rough[] = {0, 255, 0, 255, 0, 102, 0, 255};
    std::copy(std::begin(rough), std::end(rough), roughness.rgba.begin());
    const AnisotropyMaps maps = anisotropy_maps_from_gltf(texture, roughness, {0.5, 0.8, 0.0});
    // alpha: (0.5)^2 = 0.25 and (0.5 * 0.4)^2 = 0.04; strength 0.8 and 0.16.
    EXPECT_NEAR(static_cast<double>(maps.alpha_y_range.high), 0.25, 1e-7);
    EXPECT_NEAR(static_cast<double>(maps.alpha_y_range.low), 0.04, 1e-7);
    EXPECT_NEAR(static_cast<double>(maps.alpha_x_range.high), 0.25 + 0.75 * 0.64, 1e-7);
    EXPECT_NEAR(static_cast<double>(maps.alpha_x_range.low), 0.04 + 0.96 * 0.0256, 1e-7);
    EXPECT_EQ(maps.alpha.at(0, 0)[0], 255);
    EXPECT_EQ(maps.alpha.at(1, 0)[0], 0);
    EXPECT_THROW(anisotropy_maps_from_gltf(texture, filled(1, 1, {0, 0, 0, 0}), {}), Error);
    EXPECT_THROW(anisotropy_maps_from_gltf({}, {}, {}), Error);
}

/// The mistake that everybody makes once: a turned disc's direction is radial in glTF, since the
/// lobe is wide across the marks, which run around.
TEST(Anisotropy, OfATurnedDiscPointsOutwards) {
    const GeneratedSet set = generated_set("lathe", 1, 32);
    const GltfAnisotropyMaps maps = gltf_anisotropy_maps(generated_material(set));
    for (int y = 0; y < 32; ++y) {
        for (int x = 0; x < 32; ++x) {
            const glm::dvec2 outward = glm::normalize(glm::dvec2(x - 15.5, 15.5 - y));
            const std::uint8_t* texel = maps.anisotropy.at(x, y);
            const glm::dvec2 d =
                glm::normalize(glm::dvec2(texel[0] / 127.5 - 1.0, texel[1] / 127.5 - 1.0));
            ASSERT_NEAR(std::abs(glm::dot(d, outward)), 1.0, 1e-3);
            const auto i = static_cast<std::size_t>(y * 32 + x);
            const double r = maps.roughness.at(x, y)[1] / 255.0, s = texel[2] / 255.0;
            // Half a code of r at 0.4 and of s at 0.6, each times about 1 in alpha.
            ASSERT_NEAR(r * r, static_cast<double>(set.alpha_x[i]), 0.003);
            ASSERT_NEAR(r * r * (1.0 - s * s) + s * s, static_cast<double>(set.alpha_y[i]), 0.006);
        }
    }
    // And back: the same lobes, with the names of the axes exchanged.
    const AnisotropyMaps ours =
        anisotropy_maps_from_gltf(maps.anisotropy, maps.roughness, {1.0, 1.0, 0.0});
    Sampler nearest;
    nearest.filter = Filter::nearest;
    Material m;
    m.direction_map = std::make_shared<const Texture>(ours.direction, nearest);
    const auto alpha = std::make_shared<const Texture>(ours.alpha, nearest);
    m.alpha_x_map = {alpha, 0, ours.alpha_x_range.low, ours.alpha_x_range.high};
    m.alpha_y_map = {alpha, 1, ours.alpha_y_range.low, ours.alpha_y_range.high};
    const TexelParameters p = TexelSource(m).at(31, 16);  // right of the middle
    EXPECT_NEAR(std::abs(p.t.x), 1.0, 0.01) << "outwards";
    EXPECT_NEAR(p.alpha_x, static_cast<double>(set.alpha_y[16 * 32 + 31]), 0.01);
    EXPECT_NEAR(p.alpha_y, static_cast<double>(set.alpha_x[16 * 32 + 31]), 0.005);
}

}  // namespace
}  // namespace burnish
