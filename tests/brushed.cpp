#include "models/generators/brushed.hpp"

#include <gtest/gtest.h>
#include <burnish/error.hpp>
#include <burnish/materials.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace burnish {
namespace {

struct Decoded {
    double x, y, z;
};

Decoded decode(const Image8& image, int x, int y) {
    const std::uint8_t* texel = image.at(x, y);
    return {(texel[0] - 128) / 127.5, (texel[1] - 128) / 127.5, (texel[2] - 128) / 127.5};
}

double dot(const Decoded& a, const Decoded& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
double length(const Decoded& v) {
    return std::sqrt(dot(v, v));
}

std::uint64_t fnv1a(const Image8& image) {
    std::uint64_t h = 0xcbf29ce484222325U;
    for (const std::uint8_t byte : image.rgba) h = (h ^ byte) * 0x100000001b3U;
    return h;
}

/// Mean absolute difference of green between texels that are (dx, dy) apart, around the edges too.
double roughness(const Image8& image, int dx, int dy) {
    double sum = 0.0;
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x)
            sum += std::abs(image.at(x, y)[1] -
                            image.at((x + dx) % image.width, (y + dy) % image.height)[1]);
    }
    return sum / (image.width * image.height);
}

TEST(Brushed, SameSeedSameBytesOtherSeedOtherBytes) {
    const BrushedMaps one = brushed_maps(7, 128);
    const BrushedMaps again = brushed_maps(7, 128);
    const BrushedMaps other = brushed_maps(8, 128);
    EXPECT_EQ(one.normal.rgba, again.normal.rgba);
    EXPECT_EQ(one.tangent.rgba, again.tangent.rgba);
    EXPECT_EQ(one.bitangent.rgba, again.bitangent.rgba);
    EXPECT_EQ(one.specular.rgba, again.specular.rgba);
    EXPECT_NE(one.normal.rgba, other.normal.rgba);
    EXPECT_NE(one.specular.rgba, other.specular.rgba);
}

TEST(Brushed, MarksRunAlongU) {
    // A brush leaves neighbours along its way alike and across its way different.
    const BrushedMaps maps = brushed_maps(1, 256);
    EXPECT_GT(roughness(maps.normal, 0, 1), 5.0 * roughness(maps.normal, 1, 0));
}

TEST(Brushed, EdgesMeetWhenTiled) {
    const BrushedMaps maps = brushed_maps(1, 256);
    double seam = 0.0;
    double inside = 0.0;
    for (int y = 0; y < 256; ++y) {
        seam += std::abs(maps.normal.at(255, y)[1] - maps.normal.at(0, y)[1]);
        inside += std::abs(maps.normal.at(127, y)[1] - maps.normal.at(128, y)[1]);
    }
    EXPECT_LT(seam, 2.0 * inside + 256.0);
}

TEST(Brushed, FramesAreOrthogonalAndWidthsStayInRange) {
    const BrushedMaps maps = brushed_maps(3, 256);
    const auto m = static_cast<double>(maps.map_scale);
    ASSERT_EQ(m, 0.25);  // the largest power of 1/2 below alpha_x, about 0.3
    double narrowest = 1.0;
    double widest = 0.0;
    for (int y = 0; y < 256; ++y) {
        for (int x = 0; x < 256; ++x) {
            const Decoded n = decode(maps.normal, x, y);
            const Decoded t = decode(maps.tangent, x, y);
            const Decoded b = decode(maps.bitangent, x, y);
            // A code is up to 1/127.5 low in each component: 0.0136 of a unit vector, more of the
            // shorter ones, |t| >= 0.7 and |b| >= 0.25.
            ASSERT_NEAR(length(n), 1.0, 0.0136);
            ASSERT_NEAR(dot(n, t) / length(t), 0.0, 0.0136 + 0.0136 / 0.7);
            ASSERT_NEAR(dot(n, b) / length(b), 0.0, 0.0136 + 0.0136 / 0.25);
            ASSERT_NEAR(dot(t, b) / (length(t) * length(b)), 0.0, 0.0136 / 0.7 + 0.0136 / 0.25);
            const double alpha_x = m / length(t);
            const double alpha_y = m / length(b);
            ASSERT_GT(alpha_x, 0.25);
            ASSERT_LT(alpha_x, 0.34);
            ASSERT_GT(alpha_y, 0.54);
            ASSERT_LT(alpha_y, 0.99);
            narrowest = std::min(narrowest, alpha_y);
            widest = std::max(widest, alpha_y);
        }
    }
    EXPECT_GT(widest / narrowest, 1.2) << "the widths should vary from texel to texel";
}

TEST(Brushed, NormalsAreTiltedAcrossTheMarksMoreThanAlong) {
    const BrushedMaps maps = brushed_maps(1, 256);
    double along = 0.0;
    double across = 0.0;
    for (int y = 0; y < 256; ++y) {
        for (int x = 0; x < 256; ++x) {
            const Decoded n = decode(maps.normal, x, y);
            ASSERT_GT(n.z, 0.0);
            along += n.x * n.x;
            across += n.y * n.y;
        }
    }
    EXPECT_GT(across, 9.0 * along);
    const double tilt = std::sqrt(across / (256.0 * 256.0));
    EXPECT_GT(tilt, 0.03);
    EXPECT_LT(tilt, 0.35);
}

TEST(Brushed, GreySpecularIsWhereTwoUnitsCanReadIt) {
    const BrushedMaps maps = brushed_maps(1, 64);
    for (int i = 0; i < 64; ++i) {
        const std::uint8_t* texel = maps.specular.at(i, i);
        EXPECT_EQ(texel[3], texel[0]);
        EXPECT_EQ(texel[3], maps.tangent.at(i, i)[3]);
        EXPECT_LE(texel[2], texel[1]);
    }
}

TEST(Brushed, AnySizeFromOneTexelOn) {
    for (const int size : {1, 2, 3, 100}) EXPECT_EQ(brushed_maps(1, size).normal.width, size);
    EXPECT_THROW(brushed_maps(1, 0), Error);
    EXPECT_THROW(brushed_maps(1, 4097), Error);
}

TEST(Brushed, BytesDoNotDependOnTheMachine) {
    // Made once and written down; every compiler and CPU has to repeat them.
    const BrushedMaps maps = brushed_maps(1, 64);
    EXPECT_EQ(fnv1a(maps.normal), 4810512179505822356U);
    EXPECT_EQ(fnv1a(maps.tangent), 3412048061675047895U);
    EXPECT_EQ(fnv1a(maps.bitangent), 692114746769246336U);
    EXPECT_EQ(fnv1a(maps.specular), 12704622184339677729U);
}

TEST(BrushedSteel, IsACompleteMaterial) {
    const Material steel = brushed_steel(1);
    EXPECT_EQ(steel.model, Model::abp_modified);
    EXPECT_FALSE(steel.program.has_value());
    for (const TexturePtr& map :
         {steel.normal_map, steel.tangent_map, steel.bitangent_map, steel.specular_map}) {
        ASSERT_NE(map, nullptr);
        EXPECT_EQ(map->width(), 512);
        EXPECT_EQ(map->height(), 512);
    }
    EXPECT_EQ(steel.map_scale, 0.25F);
    EXPECT_LT(steel.alpha_x, steel.alpha_y) << "narrow along the marks";
}

}  // namespace
}  // namespace burnish
