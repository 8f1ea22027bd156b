#include "models/texel.hpp"

#include <gtest/gtest.h>
#include <burnish/error.hpp>
#include <burnish/materials.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <memory>
#include <span>
#include <vector>

#include "models/model_texts.hpp"
#include "models/terms.hpp"
#include "models/texel_quantities.hpp"

namespace burnish {
namespace {

using Texel = std::array<int, 4>;

TexturePtr map_of(int width, int height, const std::vector<Texel>& texels, Sampler sampler = {}) {
    Image8 image(width, height);
    for (std::size_t i = 0; i < texels.size(); ++i) {
        for (std::size_t c = 0; c < 4; ++c)
            image.rgba[4 * i + c] = static_cast<std::uint8_t>(texels[i][c]);
    }
    return std::make_shared<const Texture>(image, sampler);
}

void expect_near(const glm::dvec3& a, const glm::dvec3& b, double tolerance) {
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(a[k], b[k], tolerance) << "component " << k;
}

void expect_orthonormal(const TexelParameters& p) {
    EXPECT_NEAR(glm::dot(p.n, p.n), 1.0, 1e-14);
    EXPECT_NEAR(glm::dot(p.t, p.t), 1.0, 1e-14);
    EXPECT_NEAR(glm::dot(p.n, p.t), 0.0, 1e-14);
    expect_near(p.b, glm::cross(p.n, p.t), 1e-14);
}

TEST(Texel, OfAConstantMaterialIsTheMaterial) {
    Material m;
    m.kd = {0.25F, 0.5F, 0.75F};
    m.ks = {0.125F, 1.0F, 0.0F};
    m.alpha_x = 0.0625F;
    m.alpha_y = 0.5F;
    m.exponent = 128.0F;
    const TexelSource source(m);
    EXPECT_FALSE(source.varies());
    EXPECT_EQ(source.width(), 1);
    EXPECT_EQ(source.height(), 1);
    const TexelParameters p = source.at(0, 0);
    EXPECT_EQ(p.kd, glm::dvec3(0.25, 0.5, 0.75));
    EXPECT_EQ(p.ks, glm::dvec3(0.125, 1.0, 0.0));
    EXPECT_EQ(p.alpha_x, 0.0625);
    EXPECT_EQ(p.alpha_y, 0.5);
    EXPECT_EQ(p.exponent, 128.0);
    EXPECT_EQ(p.n, glm::dvec3(0.0, 0.0, 1.0));
    EXPECT_EQ(p.t, glm::dvec3(1.0, 0.0, 0.0));
    EXPECT_EQ(p.b, glm::dvec3(0.0, 1.0, 0.0));
}

TEST(Texel, ParameterMapsRunFromLowToHigh) {
    Material m;
    m.alpha_x_map = {map_of(1, 1, {{0, 51, 102, 255}}), 1, 0.2F, 0.7F};
    m.alpha_y_map = {map_of(1, 1, {{0, 51, 102, 255}}), 2, 0.5F, 0.0F};
    m.exponent_map = {map_of(1, 1, {{0, 51, 102, 255}}), 3, 2.0F, 128.0F};
    const TexelParameters p = TexelSource(m).at(0, 0);
    EXPECT_NEAR(p.alpha_x, 0.3, 1e-7);  // 51 / 255 = 1/5 of the way from 0.2 to 0.7
    EXPECT_NEAR(p.alpha_y, 0.3, 1e-7);  // 2/5 of the way from 0.5 down to 0
    EXPECT_EQ(p.exponent, 128.0);
    m.alpha_y_map.channel = 3;
    EXPECT_EQ(TexelSource(m).at(0, 0).alpha_y, kLeastAlpha) << "0 is not a width";
}

TEST(Texel, ColourMapsMultiplyAndAreDecodedOnlyIfAsked) {
    Material m;
    m.kd = {0.5F, 0.5F, 0.5F};
    m.ks = {1.0F, 0.5F, 0.0F};
    m.kd_map = m.specular_map = map_of(1, 1, {{255, 51, 0, 255}});
    m.alpha_x_map = {m.kd_map, 1, 0.0F, 1.0F};
    const TexelParameters raw = TexelSource(m).at(0, 0);
    expect_near(raw.kd, {0.5, 0.1, 0.0}, 1e-15);
    expect_near(raw.ks, {1.0, 0.1, 0.0}, 1e-15);
    m.srgb_colors = true;
    const TexelParameters decoded = TexelSource(m).at(0, 0);
    // ((0.2 + 0.055) / 1.055)^2.4 = 0.0331047665
    expect_near(decoded.kd, {0.5, 0.5 * 0.0331047665, 0.0}, 1e-10);
    EXPECT_EQ(decoded.alpha_x, raw.alpha_x) << "a width is no colour";
}

TEST(Texel, FlatNormalTiltsInEncodingAAlone) {
    Material m;
    m.normal_map = map_of(1, 1, {{128, 128, 255, 255}});
    for (const VectorEncoding e : {VectorEncoding::b, VectorEncoding::d}) {
        m.encoding = e;
        EXPECT_EQ(TexelSource(m).at(0, 0).n, glm::dvec3(0.0, 0.0, 1.0));
    }
    m.encoding = VectorEncoding::a;
    const TexelParameters p = TexelSource(m).at(0, 0);
    // x = y = 128 / 127.5 - 1 = 1/255, z = 1: atan(sqrt(2) / 255) = 0.318 degrees.
    EXPECT_NEAR(std::acos(p.n.z) * 180.0 / 3.14159265358979, 0.3178, 1e-4);
    expect_orthonormal(p);
    m.encoding = VectorEncoding::c;
    m.normal_map = map_of(1, 1, {{0, 0, 127, 255}});
    EXPECT_EQ(TexelSource(m).at(0, 0).n, glm::dvec3(0.0, 0.0, 1.0));
}

TEST(Texel, GreenUpOrDown) {
    Material m;
    m.normal_map = map_of(1, 1, {{128, 188, 208, 255}});  // (0, 60, 80) / 128: (0, 0.6, 0.8)
    expect_near(TexelSource(m).at(0, 0).n, {0.0, 0.6, 0.8}, 1e-15);
    expect_near(TexelSource(m).at(0, 0).b, {0.0, 0.8, -0.6}, 1e-15);
    m.normal_y_up = false;
    expect_near(TexelSource(m).at(0, 0).n, {0.0, -0.6, 0.8}, 1e-15);
}

TEST(Texel, DirectionTurnsTheTangentAgainstTheClock) {
    Material m;
    m.direction_map = map_of(1, 1, {{128, 255, 0, 255}});  // cosine 0, sine 127/128: 90 degrees
    const TexelParameters flat = TexelSource(m).at(0, 0);
    EXPECT_EQ(flat.t, glm::dvec3(0.0, 1.0, 0.0));
    EXPECT_EQ(flat.b, glm::dvec3(-1.0, 0.0, 0.0));
    m.direction_map = map_of(1, 1, {{128 + 60, 128 - 80, 0, 255}});
    expect_near(TexelSource(m).at(0, 0).t, {0.6, -0.8, 0.0}, 1e-15);
    // A tilt about the tangent leaves it; another one lifts it out of the plane.
    m.direction_map = map_of(1, 1, {{128, 255, 0, 255}});
    m.normal_map = map_of(1, 1, {{188, 128, 208, 255}});
    expect_near(TexelSource(m).at(0, 0).t, {0.0, 1.0, 0.0}, 1e-15);
    m.normal_map = map_of(1, 1, {{128, 188, 208, 255}});
    const TexelParameters p = TexelSource(m).at(0, 0);
    expect_near(p.t, {0.0, 0.8, -0.6}, 1e-15);
    expect_orthonormal(p);
    m.direction_map = map_of(1, 1, {{128, 128, 0, 255}});
    expect_near(TexelSource(m).at(0, 0).t, {1.0, 0.0, 0.0}, 1e-15);
}

TEST(Texel, ANormalAlongTheTangentStillHasAFrame) {
    Material m;
    m.normal_map = map_of(2, 1, {{255, 128, 128, 255}, {0, 128, 128, 255}});
    for (int x = 0; x < 2; ++x) {
        const TexelParameters p = TexelSource(m).at(x, 0);
        expect_orthonormal(p);
        expect_near(p.t, {0.0, 0.0, x == 0 ? -1.0 : 1.0}, 1e-15);
    }
}

TEST(Texel, VectorMapsSayFrameAndWidths) {
    Material m;
    // t = (0.6, 0.8, 0) * 0.25 / 0.5 and b = (-0.8, 0.6, 0) * 0.25 / 0.25, over 128.
    m.tangent_map = map_of(1, 1, {{128 + 38, 128 + 51, 128, 255}});
    m.bitangent_map = map_of(1, 1, {{128 - 102, 128 + 77, 128, 255}});
    m.map_scale = 0.25F;
    m.alpha_x = m.alpha_y = 1.0F;
    const TexelParameters p = TexelSource(m).at(0, 0);
    EXPECT_NEAR(p.alpha_x, 0.5, 0.5 / 51.0);  // half a code of 128, of a vector 64 codes long
    EXPECT_NEAR(p.alpha_y, 0.25, 0.25 / 102.0);
    expect_near(p.t, {0.6, 0.8, 0.0}, 0.5 / 64.0 * 1.5);
    EXPECT_EQ(p.n, glm::dvec3(0.0, 0.0, 1.0));
    expect_orthonormal(p);
}

TEST(Texel, GridIsTheFinestMapAndOthersAreFiltered) {
    Material m;
    Sampler sampler;
    sampler.wrap_t = Wrap::clamp_to_edge;
    m.specular_map = map_of(4, 4, std::vector<Texel>(16, {255, 255, 255, 255}), sampler);
    m.ks = glm::vec3(1.0F);
    // Two columns 0 and 1: of four columns, centres lie 3/4, 1/4, 1/4, 3/4 of the way across.
    m.alpha_x_map = {map_of(2, 1, {{0, 0, 0, 0}, {255, 0, 0, 0}}), 0, 0.0F, 1.0F};
    const TexelSource source(m);
    EXPECT_TRUE(source.varies());
    EXPECT_EQ(source.width(), 4);
    EXPECT_EQ(source.height(), 4);
    EXPECT_EQ(source.sampler().wrap_t, Wrap::clamp_to_edge);
    const double expected[] = {0.25, 0.25, 0.75, 0.75};  // repeating: the first mixes with the last
    for (int x = 0; x < 4; ++x) EXPECT_EQ(source.at(x, 2).alpha_x, expected[x]);
    Sampler clamped;
    clamped.wrap_s = Wrap::clamp_to_edge;
    m.alpha_x_map.texture = map_of(2, 1, {{51, 0, 0, 0}, {255, 0, 0, 0}}, clamped);
    const TexelSource edge(m);
    EXPECT_EQ(edge.at(0, 0).alpha_x, 0.2);
    EXPECT_EQ(edge.at(3, 0).alpha_x, 1.0);
    clamped.filter = Filter::nearest;
    m.alpha_x_map.texture = map_of(2, 1, {{51, 0, 0, 0}, {255, 0, 0, 0}}, clamped);
    EXPECT_EQ(TexelSource(m).at(1, 0).alpha_x, 0.2);
    EXPECT_EQ(TexelSource(m).at(2, 0).alpha_x, 1.0);
}

TEST(Texel, WordsAndSignedTexelsKeepTheirPrecision) {
    Image16 image(1, 1);
    image.rgba = {32768, 32768 + 19661, 32768 + 26214, 65535};
    TextureDescription description;
    description.format = TexelFormat::rgba16;
    Material m;
    m.normal_map = std::make_shared<const Texture>(std::span(&image, 1), description);
    expect_near(TexelSource(m).at(0, 0).n, {0.0, 0.6, 0.8}, 1.0 / 32768);
    Image8 bytes(1, 1);
    bytes.rgba = {0, 60, 80, 0};
    description.format = TexelFormat::signed_rgba8;
    m.normal_map = std::make_shared<const Texture>(std::span(&bytes, 1), description);
    expect_near(TexelSource(m).at(0, 0).n, {0.0, 0.6, 0.8}, 1e-15);
}

TEST(Texel, TwoChannelsLeaveTheThirdToTheLength) {
    Image16 image(1, 1);
    image.rgba = {0, 19661, 0, 0};  // 0.6 as two's complement of 15 bits
    TextureDescription description;
    description.format = TexelFormat::signed_hilo16;
    Material m;
    m.normal_map = std::make_shared<const Texture>(std::span(&image, 1), description);
    expect_near(TexelSource(m).at(0, 0).n, {0.0, 0.6, 0.8}, 1.0 / 32768);
    Material other;
    other.alpha_x_map = {m.normal_map, 3, 0.0F, 0.5F};
    other.kd_map = m.normal_map;
    other.kd = glm::vec3(1.0F);
    EXPECT_EQ(TexelSource(other).at(0, 0).alpha_x, 0.5) << "a fourth channel is 1";
    EXPECT_EQ(TexelSource(other).at(0, 0).kd.b, 0.0) << "and a third 0";
}

TEST(Texel, BrushedSteelHasTheWidthsThatItsMapsSay) {
    const TexelSource source(brushed_steel(1));
    ASSERT_EQ(source.width(), 512);
    for (int i = 0; i < 512; i += 7) {
        const TexelParameters p = source.at(i, (i * 37) % 512);
        expect_orthonormal(p);
        EXPECT_GT(p.alpha_x, 0.25);
        EXPECT_LT(p.alpha_x, 0.34);
        EXPECT_GT(p.alpha_y, 0.54);
        EXPECT_LT(p.alpha_y, 1.0);
        EXPECT_GT(p.t.x, 0.95) << "marks run along u";
    }
}

/// Whether rows are kept or not, and in whatever order they are asked for.
TEST(Texel, QuantitiesOfARowAreThoseOfItsTexels) {
    Material m = generated_material("orbital", 1, 16);
    m.model = Model::ward;
    const TexelSource source(m);
    ExprBuilder builder;
    const ExprPtr value = model_expression(m, builder);
    const std::vector<const Expr*> quantities = quantities_of(*value);
    TexelTape tape(quantities);
    std::vector<glm::dvec3> want(quantities.size());
    for (const std::size_t most_kept : {std::size_t{0}, std::size_t{5000}, std::size_t{1} << 20}) {
        TexelQuantities texels(quantities, source, most_kept);
        for (const int y : {9, 0, 15, 9, 1, 0}) {
            texels.seek(0, y);
            double tilt = 0.0;
            for (int x = 0; x < source.width(); ++x) {
                const TexelParameters p = source.at(x, y);
                tilt = std::max({tilt, std::abs(p.n.x), std::abs(p.n.y)});
                tape.run(p, want.data());
                for (std::size_t i = 0; i < quantities.size(); ++i) {
                    for (int c = 0; c < 3; ++c) {
                        ASSERT_EQ(texels.component(*quantities[i], c)[static_cast<std::size_t>(x)],
                                  want[i][c])
                            << quantities[i]->name << " at " << x << ", " << y;
                    }
                }
            }
            EXPECT_EQ(texels.tilt(), tilt);
        }
    }
}

TEST(Texel, BitsDoNotDependOnTheMachine) {
    // Filtered vectors, decoded colours, ranges: made once and written down.
    Material m = generated_material("lathe", 1, 16);
    m.normal_map = generated_material("cross_hatch", 1, 24).normal_map;
    m.kd_map = generated_material("weave", 1, 10).kd_map;
    m.srgb_colors = true;
    const TexelSource source(m);
    ASSERT_EQ(source.width(), 24);
    std::uint64_t h = 0xcbf29ce484222325U;
    const auto add = [&h](double x) {
        h = (h ^ std::bit_cast<std::uint64_t>(x)) * 0x100000001b3U;
        h ^= h >> 29;
    };
    for (int i = 0; i < 24 * 24; ++i) {
        const TexelParameters p = source.at(i % 24, i / 24);
        for (const glm::dvec3& v : {p.n, p.t, p.b, p.kd, p.ks}) {
            for (int k = 0; k < 3; ++k) add(v[k]);
        }
        for (const double x : {p.alpha_x, p.alpha_y, p.exponent}) add(x);
    }
    EXPECT_EQ(h, 3931617320484351092U);
}

TEST(Texel, RefusesMapsThatAreNotSurfaces) {
    TextureDescription cube;
    cube.target = TextureTarget::cube;
    const std::vector<Image8> faces(6, Image8(1, 1));
    Material m;
    m.kd_map = std::make_shared<const Texture>(std::span<const Image8>(faces), cube);
    EXPECT_THROW(TexelSource{m}, Error);
    Material half;
    half.tangent_map = map_of(1, 1, {{255, 128, 128, 255}});
    half.map_scale = 1.0F;
    EXPECT_THROW(TexelSource{half}, Error);
    Material fifth;
    fifth.alpha_x_map = {map_of(1, 1, {{1, 2, 3, 4}}), 4, 0.0F, 1.0F};
    EXPECT_THROW(TexelSource{fifth}, Error);
}

}  // namespace
}  // namespace burnish
