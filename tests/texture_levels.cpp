// Mip levels through the renderer: which one, how they blend, and levels made by the box filter.
#include <gtest/gtest.h>

#include <burnish/trace.hpp>
#include <cmath>

#include "tests/textured_quad.hpp"

namespace burnish {
namespace {

/// Levels of one grey each, from `width` texels a side downwards.
TexturePtr grey_levels(int width, const std::vector<int>& greys, const Sampler& sampler) {
    std::vector<Image8> images;
    for (const int grey : greys) {
        images.push_back(plain_image(width, width, {grey, grey, grey, 255}));
        width = std::max(width / 2, 1);
    }
    return make_texture(images, {.sampler = sampler});
}

/// 512 texels on 64 pixels, whose levels 0 .. 9 are `greys`; every pixel alike, so one is returned.
int grey_of_512_on_64(const std::vector<int>& greys, const Sampler& sampler) {
    const Framebuffer frame =
        draw(textured_scene(grey_levels(512, greys, sampler), 64, 64, flat(0.0F, 1.0F)));
    for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 64; ++x) EXPECT_EQ(bytes_at(frame, x, y), bytes_at(frame, 0, 0));
    }
    return bytes_at(frame, 0, 0)[0];
}

const std::vector<int> kTens{10, 20, 30, 40, 50, 60, 70, 80, 90, 100};

TEST(MipLevels, Of512TexelsOn64PixelsIsExactlyThree) {
    EXPECT_EQ(grey_of_512_on_64(kTens, filtered(Filter::linear_mipmap_linear)), 40);
    EXPECT_EQ(grey_of_512_on_64(kTens, filtered(Filter::linear_mipmap_nearest)), 40);
    // Black and white around level 3: another 1/256 of level 2 or 4 would show as 1.
    EXPECT_EQ(grey_of_512_on_64({255, 255, 255, 0, 255}, filtered(Filter::linear_mipmap_linear)),
              0);
}

TEST(MipLevels, BlendWith8FractionBitsRoundedHalfUp) {
    const std::vector<int> levels{0, 0, 0, 0, 255};
    const auto grey = [&](float bias) {
        return grey_of_512_on_64(levels, filtered(Filter::linear_mipmap_linear, bias));
    };
    // (255 * n + 128) >> 8: 51 -> 51.3, 128 -> 128, 1 -> 1.5, 255 -> 254.5.
    EXPECT_EQ(grey(51.0F / 256.0F), 51);
    EXPECT_EQ(grey(0.5F), 128);
    EXPECT_EQ(grey(1.0F / 256.0F), 1);
    EXPECT_EQ(grey(255.0F / 256.0F), 254);
    // 0.2 is 51.2 / 256, kept as 51; 0.2 of 255 would be 51, too, so 90 of 255: 0.3515 -> 90.
    EXPECT_EQ(grey(0.2F), 51);
    EXPECT_EQ(grey(0.35F), 90);
}

TEST(MipLevels, BiasMovesThemAndTheLastOneStays) {
    const auto at = [&](float bias) {
        return grey_of_512_on_64(kTens, filtered(Filter::linear_mipmap_linear, bias));
    };
    EXPECT_EQ(at(2.0F), 60);
    EXPECT_EQ(at(-2.0F), 20);
    EXPECT_EQ(at(6.0F), 100);
    EXPECT_EQ(at(15.5F), 100);
    EXPECT_EQ(at(-16.0F), 10);
    EXPECT_EQ(grey_of_512_on_64({10, 20}, filtered(Filter::linear_mipmap_linear)), 20);
    EXPECT_EQ(grey_of_512_on_64({10, 20}, filtered(Filter::nearest_mipmap_nearest)), 20);
}

TEST(MipLevels, NearestLevelTakesTheFinerOneOfATie) {
    const auto at = [&](float bias) {
        return grey_of_512_on_64(kTens, filtered(Filter::nearest_mipmap_nearest, bias));
    };
    EXPECT_EQ(at(0.5F), 40);             // 3.5
    EXPECT_EQ(at(129.0F / 256.0F), 50);  // 3.5 + 1/256
    EXPECT_EQ(at(-0.5F), 30);            // 2.5
    EXPECT_EQ(at(-127.0F / 256.0F), 40);
}

TEST(MipLevels, WithoutMipmapsInTheFilterLevel0IsTaken) {
    EXPECT_EQ(grey_of_512_on_64(kTens, filtered(Filter::linear)), 10);
    EXPECT_EQ(grey_of_512_on_64(kTens, filtered(Filter::nearest)), 10);
}

// Level 3 is 100, 101, 100, ... and level 4 is 1, 2, 1, ...; coordinates are half a texel of level
// 3 off, so that odd pixels see 100.5 and 1.5, rounded to 101 and 2: half of both is 51.5, so 52,
// where half of the unrounded ones is 51. Even pixels see 101, and 1 or 2.
TEST(MipLevels, BlendRoundedResults) {
    std::vector<Image8> images;
    for (int level = 0, width = 512; level < 5; ++level, width /= 2) {
        const int low = level == 3 ? 100 : level == 4 ? 1 : 0;
        std::vector<int> greys;
        for (int x = 0; x < width; ++x) greys.push_back(low + x % 2);
        images.push_back(row_image(greys));
    }
    const TexturePtr texture = make_texture(
        images,
        {.target = TextureTarget::one_d, .sampler = filtered(Filter::linear_mipmap_linear, 0.5F)});
    const float shift = 0.5F / 64.0F;
    const std::vector<int> row =
        reds(draw(textured_scene(texture, 64, 1, flat(shift, 1.0F + shift))));
    for (int x = 0; x < 63; ++x) {
        const auto at = static_cast<std::size_t>(x);
        // Level 3 between texels x and x + 1: always 100.5. Level 4 at x / 2: odd x between two.
        const int level4 = x % 2 == 1 ? 2 : 1 + x / 2 % 2;
        EXPECT_EQ(row[at], (101 + level4 + 1) / 2) << x;
    }
}

// 8 texels on 64 pixels: lambda = -3. With a bias of 3 it is 0, still the mag filter's; 1/256 more
// is the min filter's.
TEST(MipLevels, LambdaUpTo0IsTheMagFilters) {
    const Image8 image = row_image({0, 255, 0, 255, 0, 255, 0, 255});
    const auto kinds = [&](Filter min, Filter mag, float bias) {
        Sampler sampler = filtered(min, bias);
        sampler.mag_filter = mag;
        const TexturePtr texture =
            make_texture({image}, {.target = TextureTarget::one_d, .sampler = sampler});
        int greys = 0;
        for (const int red : reds(draw(textured_scene(texture, 64, 1, flat(0.0F, 1.0F)))))
            greys += red != 0 && red != 255 ? 1 : 0;
        return greys;
    };
    EXPECT_EQ(kinds(Filter::linear, Filter::nearest, 0.0F), 0);
    EXPECT_EQ(kinds(Filter::linear, Filter::nearest, 3.0F), 0);
    EXPECT_GT(kinds(Filter::linear, Filter::nearest, 3.0F + 1.0F / 256.0F), 50);
    EXPECT_GT(kinds(Filter::nearest, Filter::linear, 0.0F), 50);
    EXPECT_GT(kinds(Filter::nearest, Filter::linear, 3.0F), 50);
    EXPECT_EQ(kinds(Filter::nearest, Filter::linear, 3.0F + 1.0F / 256.0F), 0);
    EXPECT_EQ(kinds(Filter::nearest_mipmap_linear, Filter::nearest, 0.0F), 0);
}

TEST(MipLevels, CoordinatesOverQHaveTheSameLevel) {
    Corners corners = flat(0.0F, 1.0F);
    for (glm::vec4& c : corners) c *= 4.0F;
    const TexturePtr texture =
        grey_levels(512, {255, 255, 255, 0, 255}, filtered(Filter::linear_mipmap_linear));
    EXPECT_EQ(bytes_at(draw(textured_scene(texture, 64, 64, corners)), 40, 9)[0], 0);
}

// The longer side of the footprint: 512 texels across 64 pixels, down only 64 on 64, and the other
// way round.
TEST(MipLevels, FollowTheLargerOfBothDirections) {
    const TexturePtr texture = grey_levels(512, kTens, filtered(Filter::linear_mipmap_linear));
    const auto grey = [&](const Corners& corners) {
        return bytes_at(draw(textured_scene(texture, 64, 64, corners)), 31, 31)[0];
    };
    EXPECT_EQ(grey(flat(0.0F, 1.0F, 0.0F, 0.125F)), 40);
    EXPECT_EQ(grey(flat(0.0F, 0.25F, 0.0F, 0.5F)), 30);
    // Diagonal: 4 texels of both along x, none along y: sqrt(32) = 2^2.5.
    const Corners diagonal{{{0.0F, 0.0F, 0.0F, 1.0F},
                            {0.5F, 0.5F, 0.0F, 1.0F},
                            {0.5F, 0.5F, 0.0F, 1.0F},
                            {0.0F, 0.0F, 0.0F, 1.0F}}};
    EXPECT_EQ(grey(diagonal), 35);
}

// A floor in perspective: the level follows from the planes to the nearest 1/256.
TEST(MipLevels, InPerspectiveAreThoseOfExactDerivatives) {
    Scene scene = textured_scene(grey_levels(256, {0, 50, 100, 150, 200, 250, 20, 40, 60},
                                             filtered(Filter::linear_mipmap_linear)),
                                 40, 30, flat(0.0F, 3.0F, 0.0F, 2.0F));
    auto& quad = std::get<RawVertices>(scene.objects[0].geometry);
    quad.vertices[0].position.w = quad.vertices[1].position.w = 5.0F;
    double least = 100.0, most = 0.0;
    for (int y = 0; y < scene.height; ++y) {
        for (int x = 0; x < scene.width; x += 3) {
            const PixelTrace trace = trace_pixel(scene, x, y);
            const TracedNumber lod = *trace.fragment->fetches.at(0).lod;
            ASSERT_NEAR(lod.error(), 0.0, 0.51 / 256.0) << x << "," << y;
            least = std::min(least, lod.value);
            most = std::max(most, lod.value);
        }
    }
    EXPECT_GT(most - least, 1.5);
}

}  // namespace
}  // namespace burnish
