#include <gtest/gtest.h>
#include <burnish/error.hpp>
#include <burnish/materials.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

#include "models/texel.hpp"

namespace burnish {
namespace {

constexpr double kPi = 3.14159265358979323846;

std::size_t index(const GeneratedSet& set, int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(set.size) +
           static_cast<std::size_t>(x);
}

/// Texel centre from the middle, y upwards.
glm::vec2 place(const GeneratedSet& set, int x, int y) {
    const float half = 0.5F * static_cast<float>(set.size);
    return {static_cast<float>(x) + 0.5F - half, half - static_cast<float>(y) - 0.5F};
}

template <class Value>
void hash(std::uint64_t& h, const std::vector<Value>& values) {
    const auto* bytes = reinterpret_cast<const unsigned char*>(values.data());
    for (std::size_t i = 0; i < values.size() * sizeof(Value); ++i)
        h = (h ^ bytes[i]) * 0x100000001b3U;
}

std::uint64_t hash_of(const GeneratedSet& set) {
    std::uint64_t h = 0xcbf29ce484222325U;
    hash(h, set.direction);
    hash(h, set.normal);
    hash(h, set.alpha_x);
    hash(h, set.alpha_y);
    hash(h, set.exponent);
    hash(h, set.kd);
    hash(h, set.ks);
    for (const Image8* map :
         {&set.direction_map, &set.normal_map, &set.alpha_map, &set.kd_map, &set.ks_map})
        hash(h, map->rgba);
    return h;
}

class EverySet : public testing::TestWithParam<std::string_view> {};

TEST_P(EverySet, NumbersAreInRange) {
    const GeneratedSet set = generated_set(GetParam(), 3, 128);
    EXPECT_EQ(set.name, GetParam());
    ASSERT_EQ(set.direction.size(), 128U * 128U);
    for (std::size_t i = 0; i < set.direction.size(); ++i) {
        ASSERT_NEAR(glm::length(set.direction[i]), 1.0F, 1e-6F);
        ASSERT_NEAR(glm::length(set.normal[i]), 1.0F, 1e-6F);
        ASSERT_GT(set.normal[i].z, 0.5F);
        ASSERT_GE(set.alpha_x[i], 0.125F) << "two scales by 4 reach an eighth";
        ASSERT_LE(set.alpha_x[i], set.alpha_y[i]) << "narrow along the marks";
        ASSERT_LE(set.alpha_y[i], 1.0F);
        ASSERT_GE(set.exponent[i], 1.0F);
        ASSERT_LE(set.exponent[i], 128.0F);
        for (int k = 0; k < 3; ++k) {
            ASSERT_GE(set.kd[i][k], 0.0F);
            ASSERT_GE(set.ks[i][k], 0.0F);
            ASSERT_LE(set.kd[i][k] + set.ks[i][k], 1.3F);
            ASSERT_LE(set.ks[i][k], 1.0F);
        }
    }
}

/// What the maps say, read back by the source that shading uses, is the truth to half a code.
TEST_P(EverySet, MapsSayWhatIsTrue) {
    const GeneratedSet set = generated_set(GetParam(), 2, 64);
    const TexelSource source(generated_material(set));
    ASSERT_EQ(source.width(), 64);
    const auto half_code = [](const CodedRange& range) {
        return 0.5 / 255.0 * static_cast<double>(range.high - range.low) + 1e-6;
    };
    for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 64; ++x) {
            const TexelParameters p = source.at(x, y);
            const std::size_t i = index(set, x, y);
            const glm::dvec2 d(set.direction[i]);
            const glm::dvec3 n(set.normal[i]);
            ASSERT_NEAR(p.alpha_x, static_cast<double>(set.alpha_x[i]),
                        half_code(set.alpha_x_range));
            ASSERT_NEAR(p.alpha_y, static_cast<double>(set.alpha_y[i]),
                        half_code(set.alpha_y_range));
            ASSERT_NEAR(p.exponent, static_cast<double>(set.exponent[i]),
                        half_code(set.exponent_range) + 1e-5);
            for (int k = 0; k < 3; ++k) {
                // Components are off by up to 1/128 at the end of the range, and normalised.
                ASSERT_NEAR(p.n[k], n[k], 2.0 / 128.0);
                ASSERT_NEAR(p.kd[k], static_cast<double>(set.kd[i][k]),
                            0.5 / 255.0 * static_cast<double>(set.kd_scale) + 1e-6);
                ASSERT_NEAR(p.ks[k], static_cast<double>(set.ks[i][k]),
                            0.5 / 255.0 * static_cast<double>(set.ks_scale) + 1e-6);
            }
            // The tangent is the direction lifted onto the facet, whose bitangent has no share of
            // it: d . b = d . (n x t), and with t along d - n (n . d) that is 0.
            ASSERT_NEAR(d.x * p.b.x + d.y * p.b.y, 0.0, 2.0 / 128.0);
            ASSERT_GT(d.x * p.t.x + d.y * p.t.y, 0.5);
        }
    }
}

TEST_P(EverySet, SameSeedSameBitsOtherSeedOtherBits) {
    const std::uint64_t one = hash_of(generated_set(GetParam(), 7, 64));
    EXPECT_EQ(one, hash_of(generated_set(GetParam(), 7, 64)));
    EXPECT_NE(one, hash_of(generated_set(GetParam(), 8, 64)));
}

/// Across the edges of a texture that repeats, neighbours differ as much as inside.
TEST_P(EverySet, EdgesMeetWhereItTiles) {
    const GeneratedSet set = generated_set(GetParam(), 1, 256);
    double columns = 0.0, rows = 0.0, inside_columns = 0.0, inside_rows = 0.0;
    const auto differ = [&](int x0, int y0, int x1, int y1) {
        const std::size_t a = index(set, x0, y0), b = index(set, x1, y1);
        return static_cast<double>(
            glm::length(set.direction[a] - set.direction[b]) +
            glm::length(set.normal[a] - set.normal[b]) + glm::length(set.kd[a] - set.kd[b]) +
            glm::length(set.ks[a] - set.ks[b]) + std::abs(set.alpha_y[a] - set.alpha_y[b]));
    };
    const int last = set.size - 1;
    for (int i = 0; i < set.size; ++i) {
        columns += differ(last, i, 0, i);
        rows += differ(i, last, i, 0);
        for (const int at : {15, 63, 127, 191}) {  // where yarns meet, too
            inside_columns += differ(at, i, at + 1, i) / 4.0;
            inside_rows += differ(i, at, i, at + 1) / 4.0;
        }
    }
    if (set.tiles) {
        EXPECT_LT(columns, 1.6 * inside_columns + 4.0);
        EXPECT_LT(rows, 1.6 * inside_rows + 4.0);
    } else {
        EXPECT_GT(columns + rows, 1.6 * (inside_columns + inside_rows) + 8.0)
            << "it does repeat, and should say so";
    }
}

TEST_P(EverySet, MapsAreOnlyWhereSomethingVaries) {
    const GeneratedSet set = generated_set(GetParam(), 1, 64);
    const Material material = generated_material(set);
    EXPECT_EQ(material.direction_map != nullptr, set.direction_varies);
    EXPECT_EQ(material.normal_map != nullptr, set.normal_varies);
    EXPECT_EQ(material.kd_map != nullptr, set.kd_varies);
    EXPECT_TRUE(set.direction_varies || set.direction.front() == glm::vec2(1.0F, 0.0F));
    EXPECT_TRUE(set.normal_varies || set.normal.front() == glm::vec3(0.0F, 0.0F, 1.0F));
    const Wrap wrap = set.tiles ? Wrap::repeat : Wrap::clamp_to_edge;
    EXPECT_EQ(TexelSource(material).sampler().wrap_s, wrap);
}

TEST_P(EverySet, AnySizeFromOneTexelOn) {
    for (const int size : {1, 2, 3, 17})
        EXPECT_EQ(generated_set(GetParam(), 1, size).normal_map.width, size);
}

INSTANTIATE_TEST_SUITE_P(All, EverySet, testing::ValuesIn(generated_set_names()),
                         [](const auto& test) { return std::string(test.param); });

TEST(GeneratedSets, Errors) {
    EXPECT_THROW(generated_set("lathe", 1, 0), Error);
    EXPECT_THROW(generated_set("lathe", 1, kMaxGeneratedSize + 1), Error);
    try {
        generated_set("lath");
        ADD_FAILURE() << "no error";
    } catch (const Error& error) {
        EXPECT_STREQ(error.what(), "unknown generated set 'lath', did you mean 'lathe'?");
    }
}

TEST(GeneratedSets, LatheMarksRunAroundAndSunburstMarksOutwards) {
    const GeneratedSet lathe = generated_set("lathe", 1, 128);
    const GeneratedSet dial = generated_set("sunburst", 1, 128);
    for (int y = 0; y < 128; ++y) {
        for (int x = 0; x < 128; ++x) {
            const glm::vec2 outward = glm::normalize(place(lathe, x, y));
            const std::size_t i = index(lathe, x, y);
            ASSERT_NEAR(glm::dot(lathe.direction[i], outward), 0.0F, 1e-6F);
            // Against the clock: the outward direction turned by 90 degrees.
            ASSERT_NEAR(lathe.direction[i].x, -outward.y, 1e-6F);
            ASSERT_NEAR(glm::dot(dial.direction[i], outward), 1.0F, 1e-6F);
            // Facets tilt across the marks, never along them.
            ASSERT_NEAR(glm::dot(glm::vec2(lathe.normal[i]), lathe.direction[i]), 0.0F, 1e-6F);
            ASSERT_NEAR(glm::dot(glm::vec2(dial.normal[i]), dial.direction[i]), 0.0F, 1e-6F);
        }
    }
    // Right of the middle a turned disc's marks run upwards: green.
    const std::uint8_t* right = lathe.direction_map.at(127, 64);
    EXPECT_EQ(right[0], 129);  // half a texel below the middle: sine 0.5 / 63.5 of a code of 128
    EXPECT_EQ(right[1], 255);
}

TEST(GeneratedSets, CrossHatchHasTwoFamilies) {
    const GeneratedSet set = generated_set("cross_hatch", 1, 256);
    int up = 0, down = 0;
    for (const glm::vec2& d : set.direction) {
        const double angle =
            std::atan2(static_cast<double>(d.y), static_cast<double>(d.x)) * 180.0 / kPi;
        up += angle > 31.9 && angle < 38.1 ? 1 : 0;
        down += angle < -31.9 && angle > -38.1 ? 1 : 0;
    }
    const int all = 256 * 256;
    EXPECT_GT(up, all * 4 / 10);
    EXPECT_GT(down, all * 4 / 10);
    EXPECT_GT(up + down, all * 99 / 100) << "strokes cover the surface";
}

TEST(GeneratedSets, FacetsTiltAcrossTheMarks) {
    for (const char* name : {"brushed", "cross_hatch", "orbital", "lathe", "sunburst"}) {
        const GeneratedSet set = generated_set(name, 1, 256);
        double along = 0.0, across = 0.0;
        for (std::size_t i = 0; i < set.normal.size(); ++i) {
            const glm::vec2 d = set.direction[i], tilt(set.normal[i]);
            along += std::pow(static_cast<double>(glm::dot(tilt, d)), 2.0);
            across += std::pow(static_cast<double>(tilt.y * d.x - tilt.x * d.y), 2.0);
        }
        // Grooves have walls, whose fall is across; a brush also leaves the ends of its marks.
        EXPECT_GT(across, (std::string(name) == "brushed" ? 9.0 : 1e9) * along) << name;
        const double tilt = std::sqrt(across / static_cast<double>(set.normal.size()));
        EXPECT_GT(tilt, 0.02) << name;
        EXPECT_LT(tilt, 0.35) << name;
    }
}

TEST(GeneratedSets, OrbitalMarksRunEverywhere) {
    const GeneratedSet set = generated_set("orbital", 1, 256);
    // The mean of cos 2a and sin 2a over lines of all directions is 0.
    double c = 0.0, s = 0.0;
    for (const glm::vec2& d : set.direction) {
        c += static_cast<double>(d.x * d.x - d.y * d.y);
        s += static_cast<double>(2.0F * d.x * d.y);
    }
    const double count = 256.0 * 256.0;
    EXPECT_LT(std::abs(c / count), 0.05);
    EXPECT_LT(std::abs(s / count), 0.05);
}

TEST(GeneratedSets, CorrosionIsMetalAndRust) {
    const GeneratedSet set = generated_set("corrosion", 1, 256);
    int metal = 0, rust = 0;
    for (std::size_t i = 0; i < set.ks.size(); ++i) {
        metal += set.ks[i].r > 0.5F && set.alpha_x[i] < 0.2F && set.exponent[i] > 20.0F ? 1 : 0;
        if (set.ks[i].r > 0.1F) continue;
        ++rust;
        ASSERT_EQ(set.alpha_x[i], set.alpha_y[i]) << "rust has no grain";
        ASSERT_GE(set.alpha_x[i], 0.3F);
        ASSERT_GT(set.kd[i].r, 2.0F * set.kd[i].b) << "and is red";
    }
    const int all = 256 * 256;
    EXPECT_GT(metal, all / 4);
    EXPECT_GT(rust, all / 20);
    EXPECT_LT(rust, all / 2);
}

TEST(GeneratedSets, WeaveHasTwoDirectionsAtRightAngles) {
    const GeneratedSet set = generated_set("weave", 1, 256);
    int warp = 0;
    for (int y = 0; y < 256; ++y) {
        for (int x = 0; x < 256; ++x) {
            const std::size_t i = index(set, x, y);
            const bool up = (x / 16 + y / 16) % 2 == 0;
            ASSERT_EQ(set.direction[i], up ? glm::vec2(0.0F, 1.0F) : glm::vec2(1.0F, 0.0F));
            warp += up ? 1 : 0;
        }
    }
    EXPECT_EQ(warp, 256 * 128);
    // Left of a warp yarn's middle, facets look to the left; above a weft yarn's, upwards.
    EXPECT_LT(set.normal[index(set, 2, 8)].x, -0.3F);
    EXPECT_GT(set.normal[index(set, 24, 2)].y, 0.3F);
}

TEST(GeneratedSets, FingerprintRidgesFollowTheirDirection) {
    const GeneratedSet set = generated_set("fingerprint", 1, 256);
    // In the middle of the finger: how much alpha_y changes along the ridges and across them.
    double along = 0.0, across = 0.0;
    int grease = 0, clean = 0;
    for (int y = 80; y < 170; ++y) {
        for (int x = 80; x < 176; ++x) {
            const glm::vec2 d = set.direction[index(set, x, y)];
            const auto step = [&](float dx, float dy) {
                return set.alpha_y[index(set, x + static_cast<int>(std::lround(2.0F * dx)),
                                         y - static_cast<int>(std::lround(2.0F * dy)))] -
                       set.alpha_y[index(set, x, y)];
            };
            along += static_cast<double>(std::abs(step(d.x, d.y)));
            across += static_cast<double>(std::abs(step(-d.y, d.x)));
            grease += set.alpha_y[index(set, x, y)] > 0.40F ? 1 : 0;
            clean += set.alpha_y[index(set, x, y)] < 0.20F ? 1 : 0;
        }
    }
    EXPECT_GT(across, 3.0 * along);
    EXPECT_GT(grease, 90 * 96 / 5);
    EXPECT_GT(clean, 90 * 96 / 5);
    // Where t jumps to -t, a filter mixes both: on the seam between the cores alone, which lie at
    // most 0.16 of the side apart in height and 0.06 in width.
    int seam = 0;
    for (int y = 40; y < 200; ++y) {
        for (int x = 40; x < 216; ++x) {
            const glm::vec2 d = set.direction[index(set, x, y)];
            seam += glm::dot(d, set.direction[index(set, x + 1, y)]) < 0.0F ? 1 : 0;
            seam += glm::dot(d, set.direction[index(set, x, y + 1)]) < 0.0F ? 1 : 0;
        }
    }
    EXPECT_LE(seam, 60);  // (0.16 + 0.06) * 256, and the cores themselves
    // Outside the finger nothing but polished metal.
    EXPECT_EQ(set.alpha_y[index(set, 2, 2)], 0.15F);
}

TEST(GeneratedSets, BitsDoNotDependOnTheMachine) {
    // Made once and written down; every compiler and CPU has to repeat them.
    const std::pair<const char*, std::uint64_t> expected[] = {
        {"brushed", 14522764900500129185U},     {"lathe", 3051002919932246737U},
        {"cross_hatch", 12256718386804500968U}, {"sunburst", 11770892654416647241U},
        {"orbital", 850334911237438309U},       {"corrosion", 4232670430689645975U},
        {"fingerprint", 9091000755017063359U},  {"weave", 648605029679579845U}};
    for (const auto& [name, bits] : expected)
        EXPECT_EQ(hash_of(generated_set(name, 1, 64)), bits) << name;
}

}  // namespace
}  // namespace burnish
