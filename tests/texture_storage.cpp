// What a texture keeps and refuses, and the levels that it makes.
#include <gtest/gtest.h>

#include <burnish/error.hpp>
#include <string>

#include "tests/kernel_packet.hpp"
#include "tests/textured_quad.hpp"

namespace burnish {
namespace {

int texel_of(const TexturePtr& t, std::size_t level, int x, int y, int layer = 0) {
    return t->texel(level, layer, x, y, 0);
}

TEST(BoxLevels, AverageWhatTheyCover) {
    const TexturePtr even = make_texture({row_image({1, 2, 10, 21})}, {.box_mipmaps = true});
    ASSERT_EQ(even->levels().size(), 3U);
    EXPECT_EQ(texel_of(even, 1, 0, 0), 2);   // 1.5
    EXPECT_EQ(texel_of(even, 1, 1, 0), 16);  // 15.5
    EXPECT_EQ(texel_of(even, 2, 0, 0), 9);
    // Five texels to two, 2.5 each: (2 * 10 + 2 * 20 + 40) / 5 = 20, (40 + 2 * 7 + 2 * 9) / 5
    // = 14.4.
    const TexturePtr odd = make_texture({row_image({10, 20, 40, 7, 9})}, {.box_mipmaps = true});
    EXPECT_EQ(texel_of(odd, 1, 0, 0), 20);
    EXPECT_EQ(texel_of(odd, 1, 1, 0), 14);
    EXPECT_EQ(odd->levels()[1].width, 2);
    EXPECT_EQ(odd->levels()[2].width, 1);
    EXPECT_EQ(odd->levels().size(), 3U);
}

TEST(BoxLevels, OfSignedNumbersRoundHalfUpToo) {
    const TexturePtr t = make_texture({row_image({255, 0, 253, 254})},  // -1 0 -3 -2
                                      {.format = TexelFormat::signed_rgba8, .box_mipmaps = true});
    EXPECT_EQ(texel_of(t, 1, 0, 0), 0);   // -1/2
    EXPECT_EQ(texel_of(t, 1, 1, 0), -2);  // -5/2
}

TEST(BoxLevels, OfSlicesAndFaces) {
    const TexturePtr slices =
        make_texture({plain_image(2, 2, {0, 0, 0, 0}), plain_image(2, 2, {255, 0, 0, 0}),
                      plain_image(2, 2, {10, 0, 0, 0})},
                     {.target = TextureTarget::three_d, .depth = 3, .box_mipmaps = true});
    EXPECT_EQ(slices->levels()[1].depth, 1);
    EXPECT_EQ(texel_of(slices, 1, 0, 0), 88);  // 265 / 3
    std::vector<Image8> faces;
    for (int f = 0; f < 6; ++f) faces.push_back(plain_image(4, 4, {f * 10, 0, 0, 0}));
    const TexturePtr cube =
        make_texture(faces, {.target = TextureTarget::cube, .box_mipmaps = true});
    for (int f = 0; f < 6; ++f) EXPECT_EQ(texel_of(cube, 2, 0, 0, f), 10 * f);
}

TEST(Storage, OfWordsKeepsThem) {
    Image16 image(2, 1);
    image.rgba = {0, 65535, 5, 6, 32767, 32768, 7, 8};
    const Texture hilo(std::span(&image, 1), {.format = TexelFormat::hilo16});
    EXPECT_EQ(hilo.texel(0, 0, 0, 0, 0), 0);
    EXPECT_EQ(hilo.texel(0, 0, 0, 0, 1), 65535);
    EXPECT_EQ(hilo.texel(0, 0, 1, 0, 0), 32767);
    EXPECT_EQ(hilo.texel(0, 0, 2, 0, 1), 65535);  // repeats
    const Texture negative(std::span(&image, 1), {.format = TexelFormat::signed_hilo16});
    EXPECT_EQ(negative.texel(0, 0, 0, 0, 1), -1);
    EXPECT_EQ(negative.texel(0, 0, 1, 0, 1), -32768);
    // Bytes: 255 / 255 is 65535 / 65535; -128 / 128 is -32768 / 32768.
    const Image8 bytes = plain_image(1, 1, {255, 128, 0, 0});
    EXPECT_EQ(Texture(bytes, {}, TexelFormat::hilo8).texel(0, 0, 0, 0, 1), 128 * 257);
    EXPECT_EQ(Texture(bytes, {}, TexelFormat::signed_hilo8).texel(0, 0, 0, 0, 0), -256);
    EXPECT_EQ(Texture(bytes, {}, TexelFormat::signed_hilo8).texel(0, 0, 0, 0, 1), -32768);
}

TEST(Storage, RefusesWhatDoesNotFit) {
    const auto complaint = [](const std::vector<Image8>& images, const TextureDescription& d) {
        try {
            make_texture(images, d);
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string("no error");
    };
    const Image8 two = plain_image(2, 2, {}), one = plain_image(1, 1, {}),
                 wide = plain_image(2, 1, {});
    EXPECT_EQ(complaint({two}, {.target = TextureTarget::one_d}),
              "1D texture of 2x2 texels, expected height 1");
    EXPECT_EQ(complaint({two}, {.target = TextureTarget::cube}), "texture of 1 images, expected 6");
    EXPECT_EQ(complaint({6, wide}, {.target = TextureTarget::cube}),
              "cube face of 2x1 texels, expected a square");
    EXPECT_EQ(complaint({two}, {.target = TextureTarget::rectangle}),
              "rectangle texture that repeats, expected clamp_to_edge or clamp_to_border");
    EXPECT_EQ(complaint({two, two}, {}),
              "mip level 1 with an image of 2x2 texels, expected 1x1 texels");
    EXPECT_EQ(complaint({two, one, one}, {}), "a mip level after the one of a single texel");
    EXPECT_EQ(complaint({two, one}, {.box_mipmaps = true}),
              "mip levels both given and to be made, expected one of them");
    EXPECT_EQ(complaint({two}, {.depth = 2}), "depth of a texture that is not 3D, expected 1");
    EXPECT_EQ(complaint({two}, {.sampler = filtered(Filter::linear, 16.0F)}),
              "lod_bias 16, expected at least -16, less than 16");
    EXPECT_EQ(complaint({two, two, one, one}, {.target = TextureTarget::three_d, .depth = 2}),
              "a mip level after the one of a single texel");
    EXPECT_EQ(complaint({}, {}), "texture of 0 images, expected 1");
}

// Every texel of every level, with the neighbours around it, is where it says.
TEST(Texture, AQuartetHoldsTheTexelsOfItsTextures) {
    std::vector<TexturePtr> singles;
    for (unsigned seed = 0; seed < 4; ++seed) {
        Random random(seed);
        Image16 image(9, 6);
        for (std::uint16_t& word : image.rgba)
            word = static_cast<std::uint16_t>(random.below(65536));
        TextureDescription d{.format = TexelFormat::rgba16, .box_mipmaps = true};
        d.sampler.wrap_s = Wrap::clamp_to_border;
        d.sampler.border = {0.1F, 0.2F, 0.3F, 0.4F};
        singles.push_back(std::make_shared<const Texture>(std::span(&image, 1), d));
    }
    const std::vector<TexturePtr> quartet = Texture::quartet(singles);
    ASSERT_EQ(quartet.size(), 4U);
    for (std::size_t k = 0; k < 4; ++k) {
        EXPECT_EQ(quartet[k]->place(), static_cast<int>(k));
        EXPECT_EQ(singles[k]->place(), -1);
        EXPECT_EQ(quartet[k]->texels(), quartet[0]->texels() + 8 * k);
        EXPECT_EQ(quartet[k]->pitch() / 64 % 2, 1);
        const std::span<const TextureLevel> levels = singles[k]->levels();
        ASSERT_EQ(quartet[k]->levels().size(), levels.size());
        for (std::size_t level = 0; level < levels.size(); ++level)
            for (int y = 0; y <= levels[level].height; ++y)
                for (int x = -1; x <= levels[level].width; ++x)
                    for (int c = 0; c < 4; ++c)
                        ASSERT_EQ(quartet[k]->texel(level, 0, x, y, c),
                                  singles[k]->texel(level, 0, x, y, c))
                            << k << ", level " << level << ", texel " << x << ' ' << y;
    }
}

}  // namespace
}  // namespace burnish
