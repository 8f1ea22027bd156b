// What the double-precision renderer looks up, by numbers derived by hand.
#include <gtest/gtest.h>

#include <array>
#include <cstring>

#include "reference/footprint.hpp"
#include "reference/surface_sampler.hpp"
#include "tests/double_scenes.hpp"

namespace burnish {
namespace {

using reference::DoubleScene;
using reference::Surface;

// ---- textures

/// Red of a row of four texels: 0, 1/3, 2/3, 1.
Texture ramp(const Sampler& sampler) {
    Image8 image(4, 1);
    for (int x = 0; x < 4; ++x) image.at(x, 0)[0] = static_cast<std::uint8_t>(85 * x);
    return Texture(image, sampler);
}
double red_at(const Texture& texture, double u, double v = 0.5) {
    return reference::sample_texture(texture, {u, v}, 0, 1).x;
}

TEST(DoubleTextureTest, WrapsAtBothEnds) {
    const std::array<std::pair<Wrap, std::array<int, 8>>, 4> expected{
        {{Wrap::repeat, {1, 2, 0, 1, 2, 0, 1, 2}},
         {Wrap::clamp_to_edge, {0, 0, 0, 1, 2, 2, 2, 2}},
         {Wrap::clamp_to_border, {-1, -1, 0, 1, 2, 3, 3, 3}},
         {Wrap::mirrored_repeat, {1, 0, 0, 1, 2, 2, 1, 0}}}};
    for (const auto& [wrap, texels] : expected) {
        for (int i = 0; i < 8; ++i)
            EXPECT_EQ(reference::wrapped_texel(i - 2, 3, wrap), texels[static_cast<std::size_t>(i)])
                << static_cast<int>(wrap) << " " << i - 2;
    }
    EXPECT_EQ(reference::wrapped_texel(-7, 3, Wrap::repeat), 2);
    EXPECT_EQ(reference::wrapped_texel(-7, 3, Wrap::mirrored_repeat), 0);
}

// u = 0.25 lies half-way between texels 0 and 1, u = 0 half-way between 0 and its left neighbour;
// u = 1.1 is 3.9 texels after the centre of texel 0.
TEST(DoubleTextureTest, WeightsTheTexelsAround) {
    const Texture repeat = ramp({}), edge = ramp({.wrap_s = Wrap::clamp_to_edge}),
                  mirror = ramp({.wrap_s = Wrap::mirrored_repeat}),
                  border = ramp({.wrap_s = Wrap::clamp_to_border, .border = {1.0F, 0, 0, 0}});
    for (const Texture* texture : {&repeat, &edge, &mirror, &border}) {
        EXPECT_NEAR(red_at(*texture, 0.25), 1.0 / 6.0, 1e-15);
        EXPECT_NEAR(red_at(*texture, 0.7), 2.3 / 3.0, 1e-15);
    }
    EXPECT_NEAR(red_at(repeat, 0.0), 0.5, 1e-15);
    EXPECT_NEAR(red_at(edge, 0.0), 0.0, 1e-15);
    EXPECT_NEAR(red_at(mirror, 0.0), 0.0, 1e-15);
    EXPECT_NEAR(red_at(border, 0.0), 0.5, 1e-15);
    EXPECT_NEAR(red_at(repeat, 1.1), 0.1, 1e-14);
    EXPECT_NEAR(red_at(edge, 1.1), 1.0, 1e-15);
    EXPECT_NEAR(red_at(mirror, 1.1), 1.0, 1e-15);
    EXPECT_NEAR(red_at(mirror, 1.25), 2.5 / 3.0, 1e-15);
    EXPECT_NEAR(red_at(border, 1.1), 1.0, 1e-15);
    EXPECT_NEAR(red_at(repeat, -7.75), 1.0 / 6.0, 1e-14);
    EXPECT_EQ(red_at(repeat, std::numeric_limits<double>::quiet_NaN()), red_at(repeat, 0.0));
    EXPECT_NO_THROW(red_at(mirror, 1e300));
}

TEST(DoubleTextureTest, TakesTheNearest) {
    const Texture nearest = ramp({.filter = Filter::nearest});
    EXPECT_EQ(red_at(nearest, 0.0), 0.0);
    EXPECT_EQ(red_at(nearest, 0.2499), 0.0);
    EXPECT_EQ(red_at(nearest, 0.25), 85.0 / 255.0);
    EXPECT_EQ(red_at(nearest, 0.999), 1.0);
    EXPECT_EQ(red_at(nearest, 1.0), 0.0);
    const Texture magnified = ramp({.mag_filter = Filter::nearest});
    EXPECT_EQ(red_at(magnified, 0.2), 0.0);
}

// At (0.5, 0.5) of 2 x 2 all four count alike; a quarter of a texel right and down of the upper
// left centre, 9/16, 3/16, 3/16, 1/16.
TEST(DoubleTextureTest, WeightsRowsAsColumns) {
    Image8 image(2, 2);
    const int values[4] = {16, 32, 64, 128};
    for (int i = 0; i < 4; ++i)
        for (int c = 0; c < 4; ++c)
            image.at(i % 2, i / 2)[c] = static_cast<std::uint8_t>(values[i] / (c + 1));
    const Texture texture(image, {});
    EXPECT_NEAR(red_at(texture, 0.5, 0.5) * 255.0, 60.0, 1e-12);
    const glm::dvec3 three = reference::sample_texture(texture, {0.375, 0.375}, 1, 3);
    const auto mean = [](int a, int b, int c, int d) { return (9 * a + 3 * b + 3 * c + d) / 16.0; };
    EXPECT_NEAR(three.x * 255.0, mean(8, 16, 32, 64), 1e-12);
    EXPECT_NEAR(three.y * 255.0, mean(5, 10, 21, 42), 1e-12);
    EXPECT_NEAR(three.z * 255.0, mean(4, 8, 16, 32), 1e-12);
}

TEST(DoubleTextureTest, DecodesEveryKindOfTexel) {
    Image16 words(1, 1);
    words.at(0, 0)[0] = 65535;
    words.at(0, 0)[1] = 13107;
    const TextureDescription wide{.format = TexelFormat::rgba16};
    const glm::dvec3 w =
        reference::sample_texture(Texture(std::span(&words, 1), wide), {0.3, 0.3}, 0, 3);
    EXPECT_EQ(w, glm::dvec3(1.0, 0.2, 0.0));
    Image8 bytes(1, 1);
    bytes.at(0, 0)[0] = 128;  // -128 in two's complement
    bytes.at(0, 0)[1] = 64;
    const TextureDescription with_sign{.format = TexelFormat::signed_rgba8};
    const glm::dvec3 s =
        reference::sample_texture(Texture(std::span(&bytes, 1), with_sign), {0.3, 0.3}, 0, 3);
    EXPECT_EQ(s, glm::dvec3(-1.0, 0.5, 0.0));
}

// Codes are weighted before they are decoded: half of 0 .. 255 of a quantity 2^(4 x - 2) is 2^0.
TEST(DoubleTextureTest, QuantitiesAreDecodedAfterTheFilter) {
    Image8 image(2, 1);
    image.at(1, 0)[1] = 255;
    LayerQuantity exponent;
    exponent.name = "N";
    exponent.texture = std::make_shared<Texture>(image, Sampler{});
    exponent.channel = 1;
    exponent.scale = glm::dvec3(4.0);
    exponent.offset = glm::dvec3(-2.0);
    std::vector<LayerQuantity> layer(4);
    layer[0].name = "t";
    layer[1].name = "ks";
    layer[2].name = "kd";
    layer[0].components = layer[1].components = layer[2].components = 3;
    layer[1].constant = {0.1, 0.2, 0.3};
    layer[3] = exponent;
    const std::shared_ptr<Material> material = material_of(Model::kajiya_kay);
    const auto middle = [&] { return reference::layer_surface(*material, layer)->at({0.5, 0.0}); };
    EXPECT_EQ(middle().N, glm::dvec3(0.0));
    layer[3].logarithmic = true;
    EXPECT_EQ(middle().N, glm::dvec3(1.0));
    EXPECT_EQ(middle().ks, glm::dvec3(0.1, 0.2, 0.3));
    EXPECT_EQ(middle().t, glm::dvec3(0.0));
    // What the layer does without is the material's own.
    layer.erase(layer.begin());
    EXPECT_EQ(middle().t, glm::dvec3(1.0, 0.0, 0.0));
    EXPECT_EQ(middle().N, glm::dvec3(1.0));
}

// alpha_x is 0.2 and 0.8, alpha_y 0.5, N 10 and 30: quantities are filtered, so half-way t /
// alpha_x is 3.125, which is not 1 / 0.5, and ks / (4 pi alpha_x alpha_y) the mean of 0.7 / (0.4
// pi) and 0.7 / (1.6 pi).
TEST(DoubleTextureTest, ExactMaterialsAreQuantitiesOfTheirTexels) {
    Image8 image(2, 1);
    for (int c = 0; c < 4; ++c) image.at(1, 0)[c] = 255;
    const Sampler sampler{.wrap_s = Wrap::clamp_to_border, .border = {0.5F, 0.5F, 0.5F, 0.5F}};
    const auto map = std::make_shared<Texture>(image, sampler);
    Material material = *material_of(Model::ward);
    material.alpha_x_map = {map, 0, 0.2F, 0.8F};
    material.exponent_map = {map, 3, 10.0F, 30.0F};
    const auto surface = reference::exact_surface(material);
    const Surface middle = surface->at({0.5, 0.5});
    EXPECT_NEAR(middle.X.x, 3.125, 1e-6);
    EXPECT_NEAR(middle.Y.y, 2.0, 1e-6);
    EXPECT_NEAR(middle.N.x, 20.0, 1e-6);
    EXPECT_NEAR(middle.S.z, 0.5 * (0.7 / 0.4 + 0.7 / 1.6) / std::numbers::pi, 1e-6);
    EXPECT_NEAR(middle.P.x, 0.5, 1e-6);
    EXPECT_NEAR(middle.U.x, 3.125 * std::numbers::sqrt2, 1e-6);
    EXPECT_NEAR(surface->at({0.25, 0.5}).X.x, 5.0, 1e-6);
    EXPECT_NEAR(surface->at({-0.5, 0.5}).X.x, 5.0, 1e-6);  // the border's colour is no parameter
    EXPECT_NEAR(surface->at({3.0, 0.5}).X.x, 1.25, 1e-6);
}

}  // namespace
}  // namespace burnish
