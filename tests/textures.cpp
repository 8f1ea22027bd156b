// Textures of every kind through the renderer: formats, targets, wraps, mip levels.
// Numbers of the filter are those of captures of the NV2A (docs/numbers.md).
#include <gtest/gtest.h>

#include <burnish/error.hpp>
#include <burnish/shapes.hpp>
#include <burnish/trace.hpp>
#include <cmath>
#include <string>

#include "tests/kernel_packet.hpp"
#include "tests/textured_quad.hpp"

namespace burnish {
namespace {

using Row = std::vector<int>;

/// Levels of one grey each, from `width` texels a side downwards.
TexturePtr grey_levels(int width, const std::vector<int>& greys, const Sampler& sampler) {
    std::vector<Image8> images;
    for (const int grey : greys) {
        images.push_back(plain_image(width, width, {grey, grey, grey, 255}));
        width = std::max(width / 2, 1);
    }
    return make_texture(images, {.sampler = sampler});
}

Sampler filtered(Filter filter, float lod_bias = 0.0F) {
    Sampler sampler;
    sampler.filter = filter;
    sampler.lod_bias = lod_bias;
    return sampler;
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
        Row greys;
        for (int x = 0; x < width; ++x) greys.push_back(low + x % 2);
        images.push_back(row_image(greys));
    }
    const TexturePtr texture = make_texture(
        images,
        {.target = TextureTarget::one_d, .sampler = filtered(Filter::linear_mipmap_linear, 0.5F)});
    const float shift = 0.5F / 64.0F;
    const Row row = reds(draw(textured_scene(texture, 64, 1, flat(shift, 1.0F + shift))));
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

// ---- wraps

/// Nearest texels of 10 20 30 40 at 12 pixels over s = -1 .. 2, border 99.
Row wrapped(Wrap wrap, Filter filter = Filter::nearest, float shift = 0.0F) {
    Sampler sampler = filtered(filter);
    sampler.wrap_s = wrap;
    sampler.border = {99.0F / 255.0F, 0.0F, 0.0F, 1.0F};
    const TexturePtr texture = make_texture({row_image({10, 20, 30, 40})}, {.sampler = sampler});
    return reds(draw(textured_scene(texture, 12, 1, flat(-1.0F + shift, 2.0F + shift))));
}

TEST(Wraps, OfNearestTexels) {
    EXPECT_EQ(wrapped(Wrap::repeat), (Row{10, 20, 30, 40, 10, 20, 30, 40, 10, 20, 30, 40}));
    EXPECT_EQ(wrapped(Wrap::clamp_to_edge), (Row{10, 10, 10, 10, 10, 20, 30, 40, 40, 40, 40, 40}));
    EXPECT_EQ(wrapped(Wrap::clamp_to_border),
              (Row{99, 99, 99, 99, 10, 20, 30, 40, 99, 99, 99, 99}));
    EXPECT_EQ(wrapped(Wrap::mirrored_repeat),
              (Row{40, 30, 20, 10, 10, 20, 30, 40, 40, 30, 20, 10}));
}

// Half a texel further right: means of neighbours, rounded half up; 99 and 10 give 54.5.
TEST(Wraps, OfBlendedTexels) {
    const auto row = [](Wrap wrap) { return wrapped(wrap, Filter::linear, 0.125F); };
    EXPECT_EQ(row(Wrap::repeat), (Row{15, 25, 35, 25, 15, 25, 35, 25, 15, 25, 35, 25}));
    EXPECT_EQ(row(Wrap::clamp_to_edge), (Row{10, 10, 10, 10, 15, 25, 35, 40, 40, 40, 40, 40}));
    EXPECT_EQ(row(Wrap::clamp_to_border), (Row{99, 99, 99, 55, 15, 25, 35, 70, 99, 99, 99, 99}));
    EXPECT_EQ(row(Wrap::mirrored_repeat), (Row{35, 25, 15, 10, 15, 25, 35, 40, 35, 25, 15, 10}));
}

TEST(Wraps, OfRowsAndLevels) {
    Sampler sampler = filtered(Filter::nearest_mipmap_nearest, 1.0F);
    sampler.wrap_s = Wrap::clamp_to_border;
    sampler.wrap_t = Wrap::mirrored_repeat;
    sampler.border = {1.0F, 0.0F, 0.0F, 1.0F};
    // Level 1 is one column of 10, 20 above each other: 4 x 4 pixels over 4 texels of level 0.
    Image8 base = plain_image(2, 4, {1, 1, 1, 255}), half = plain_image(1, 2, {10, 0, 0, 255});
    half.at(0, 1)[0] = 20;
    const TexturePtr texture = make_texture({base, half}, {.sampler = sampler});
    // s over -1 .. 1 (border, then the column), t over -1 .. 1 (mirrored: 20, 10, 10, 20).
    const Framebuffer frame = draw(textured_scene(texture, 4, 8, flat(-1.0F, 1.0F, -1.0F, 1.0F)));
    for (int y = 0; y < 8; ++y) {
        const int texel = y / 2 == 0 || y / 2 == 3 ? 20 : 10;
        EXPECT_EQ(reds(frame, y), (Row{255, 255, texel, texel})) << y;
    }
}

TEST(Wraps, BordersOfSignedTexelsReachMinus1) {
    Sampler sampler = filtered(Filter::nearest);
    sampler.wrap_s = Wrap::clamp_to_border;
    sampler.border = {-1.0F, -2.0F, 0.5F, 2.0F};
    const TexturePtr texture =
        make_texture({plain_image(1, 1, {0, 0, 0, 0})},
                     {.format = TexelFormat::signed_rgba8, .sampler = sampler});
    // -128 enters as -256, which the stage clamps to -255; 64 as 128; 127 as 254.
    EXPECT_EQ(sampled_signed(texture, {1.5F, 0.5F, 0.0F, 1.0F}), (Bytes{-255, -255, 128, 254}));
}

// ---- formats

Bytes one_texel(TexelFormat format, const Bytes& rgba = {10, 200, 60, 130}) {
    const TexturePtr texture = make_texture({plain_image(1, 1, rgba)}, {.format = format});
    return sampled_signed(texture, {0.5F, 0.5F, 0.0F, 1.0F});
}

TEST(Formats, OfUnsignedBytes) {
    EXPECT_EQ(one_texel(TexelFormat::rgba8), (Bytes{10, 200, 60, 130}));
    EXPECT_EQ(one_texel(TexelFormat::rgb8), (Bytes{10, 200, 60, 255}));
    EXPECT_EQ(one_texel(TexelFormat::luminance8), (Bytes{10, 10, 10, 255}));
    EXPECT_EQ(one_texel(TexelFormat::luminance8_alpha8), (Bytes{10, 10, 10, 130}));
    EXPECT_EQ(one_texel(TexelFormat::intensity8), (Bytes{10, 10, 10, 10}));
    EXPECT_EQ(one_texel(TexelFormat::alpha8), (Bytes{0, 0, 0, 130}));
    EXPECT_EQ(one_texel(TexelFormat::r8), (Bytes{10, 0, 0, 255}));
}

// 200 is -56 and 130 is -126; codes are twice as much.
TEST(Formats, OfSignedBytes) {
    EXPECT_EQ(one_texel(TexelFormat::signed_rgba8), (Bytes{20, -112, 120, -252}));
    EXPECT_EQ(one_texel(TexelFormat::signed_rgb8), (Bytes{20, -112, 120, 255}));
    EXPECT_EQ(one_texel(TexelFormat::signed_rgb8_unsigned_alpha8), (Bytes{20, -112, 120, 130}));
    EXPECT_EQ(one_texel(TexelFormat::signed_luminance8, {200, 0, 0, 0}),
              (Bytes{-112, -112, -112, 255}));
    EXPECT_EQ(one_texel(TexelFormat::signed_luminance8_alpha8), (Bytes{20, 20, 20, -252}));
    EXPECT_EQ(one_texel(TexelFormat::signed_intensity8), (Bytes{20, 20, 20, 20}));
    EXPECT_EQ(one_texel(TexelFormat::signed_alpha8), (Bytes{0, 0, 0, -252}));
}

TEST(Formats, OfOffsetsGiveRegistersNothingButIntensity) {
    for (const TexelFormat format :
         {TexelFormat::hilo16, TexelFormat::signed_hilo16, TexelFormat::hilo8,
          TexelFormat::signed_hilo8, TexelFormat::dsdt8, TexelFormat::dsdt8_mag8})
        EXPECT_EQ(one_texel(format), (Bytes{0, 0, 0, 0})) << static_cast<int>(format);
    EXPECT_EQ(one_texel(TexelFormat::dsdt8_mag8_intensity8), (Bytes{0, 0, 0, 130}));
}

TEST(Formats, HaveClasses) {
    EXPECT_EQ(format_class(TexelFormat::r8), TexelClass::unsigned_rgba);
    EXPECT_EQ(format_class(TexelFormat::signed_alpha8), TexelClass::signed_rgba);
    EXPECT_EQ(format_class(TexelFormat::signed_rgb8_unsigned_alpha8), TexelClass::mixed);
    EXPECT_EQ(format_class(TexelFormat::hilo8), TexelClass::hilo);
    EXPECT_EQ(format_class(TexelFormat::signed_hilo16), TexelClass::signed_hilo);
    EXPECT_EQ(format_class(TexelFormat::dsdt8), TexelClass::dsdt);
    EXPECT_EQ(format_class(TexelFormat::dsdt8_mag8), TexelClass::dsdt_mag);
    EXPECT_EQ(format_class(TexelFormat::dsdt8_mag8_intensity8), TexelClass::dsdt_mag_intensity);
}

// Signed levels blend as signed numbers, then double: halfway from -3 to 4 is 1/2, rounded up to 1,
// code 2; blended codes would give 1.
TEST(Formats, SignedLevelsBlendBeforeTheyDouble) {
    std::vector<Image8> images{plain_image(2, 2, {253, 253, 253, 253}),
                               plain_image(1, 1, {4, 4, 4, 4})};
    const TexturePtr texture =
        make_texture(images, {.format = TexelFormat::signed_rgba8,
                              .sampler = filtered(Filter::linear_mipmap_linear, 0.5F)});
    EXPECT_EQ(bytes_at(draw(textured_scene(texture, 2, 2, flat(0.0F, 1.0F))), 0, 0),
              (Bytes{2, 2, 2, 2}));
}

TEST(Formats, SixteenBitsOnWideMachinesOnly) {
    // One texel of rgba16 on `ideal`, in a frame of 16 bits: (n + 2) >> 2 codes of 1 / 16384, and
    // (65535 v + 2^13) >> 14 back. 65535 -> 16384 -> 65535; 32768 -> 8192 -> 32768 (32767.5 half
    // up); 1 -> 0; 2 -> 1 -> 4.
    Image16 image(1, 1);
    image.rgba = {65535, 32768, 1, 2};
    const auto texture = std::make_shared<const Texture>(
        std::span(&image, 1), TextureDescription{.format = TexelFormat::rgba16});
    Scene scene = textured_scene(texture, 1, 1, everywhere({0.5F, 0.5F, 0.0F, 1.0F}), "ideal");
    scene.format = PixelFormat::rgba16;
    Framebuffer frame(1, 1, PixelFormat::rgba16);
    Renderer().render(scene, frame);
    const auto* words = reinterpret_cast<const std::uint16_t*>(frame.row(0));
    EXPECT_EQ(words[0], 65535);
    EXPECT_EQ(words[1], 32768);
    EXPECT_EQ(words[2], 0);
    EXPECT_EQ(words[3], 4);
    scene.machine = machine_profile("nv2a");
    try {
        Renderer().render(scene, frame);
        FAIL() << "no error";
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("rgba16"), std::string::npos) << error.what();
    }
}

// ---- targets

TEST(Targets, RectanglesTakeTexels) {
    Sampler sampler = filtered(Filter::linear);
    sampler.wrap_s = sampler.wrap_t = Wrap::clamp_to_edge;
    const TexturePtr texture =
        make_texture({row_image({10, 20, 30, 40, 50})},
                     {.target = TextureTarget::rectangle, .sampler = sampler});
    const auto red = [&](float s) { return sampled(texture, {s, 0.5F, 0.0F, 1.0F})[0]; };
    EXPECT_EQ(red(0.5F), 10);
    EXPECT_EQ(red(2.0F), 25);
    EXPECT_EQ(red(4.5F), 50);
    EXPECT_EQ(red(-7.0F), 10);
    EXPECT_EQ(red(1e9F), 50);
    EXPECT_EQ(sampled(texture, {5.0F, 1.0F, 0.0F, 2.0F})[0], 30);  // 2.5 after the division
}

/// Faces of 2 x 2 texels: red 10, 20, 30, 40 (upper left to lower right) plus the face's number.
TexturePtr numbered_cube(Filter filter = Filter::nearest) {
    std::vector<Image8> faces;
    for (int face = 0; face < 6; ++face) {
        Image8 image(2, 2);
        for (int i = 0; i < 4; ++i) {
            image.at(i % 2, i / 2)[0] = static_cast<std::uint8_t>(10 * (i + 1) + face);
            image.at(i % 2, i / 2)[3] = 255;
        }
        faces.push_back(image);
    }
    return make_texture(faces, {.target = TextureTarget::cube, .sampler = filtered(filter)});
}

// The table of OpenGL: +x (-r, -t), -x (r, -t), +y (s, r), -y (s, -r), +z (s, -t), -z (-s, -t).
TEST(Targets, CubeFacesAreThoseOfOpenGl) {
    const TexturePtr cube = numbered_cube();
    const auto red = [&](float s, float t, float r) { return sampled(cube, {s, t, r, 7.0F})[0]; };
    // Upper left of a face: both of the table's coordinates negative.
    EXPECT_EQ(red(1.0F, 0.5F, 0.5F), 10);    // +x: r > 0, t > 0
    EXPECT_EQ(red(1.0F, 0.5F, -0.5F), 20);   // to the right: r < 0
    EXPECT_EQ(red(1.0F, -0.5F, 0.5F), 30);   // below: t < 0
    EXPECT_EQ(red(-1.0F, 0.5F, -0.5F), 11);  // -x
    EXPECT_EQ(red(-1.0F, 0.5F, 0.5F), 21);
    EXPECT_EQ(red(-1.0F, -0.5F, -0.5F), 31);
    EXPECT_EQ(red(-0.5F, 1.0F, -0.5F), 12);  // +y
    EXPECT_EQ(red(0.5F, 1.0F, -0.5F), 22);
    EXPECT_EQ(red(-0.5F, 1.0F, 0.5F), 32);
    EXPECT_EQ(red(-0.5F, -1.0F, 0.5F), 13);  // -y
    EXPECT_EQ(red(0.5F, -1.0F, 0.5F), 23);
    EXPECT_EQ(red(-0.5F, -1.0F, -0.5F), 33);
    EXPECT_EQ(red(-0.5F, 0.5F, 1.0F), 14);  // +z
    EXPECT_EQ(red(0.5F, 0.5F, 1.0F), 24);
    EXPECT_EQ(red(-0.5F, -0.5F, 1.0F), 34);
    EXPECT_EQ(red(0.5F, 0.5F, -1.0F), 15);  // -z
    EXPECT_EQ(red(-0.5F, 0.5F, -1.0F), 25);
    EXPECT_EQ(red(0.5F, -0.5F, -1.0F), 35);
}

TEST(Targets, CubeEdgesBelongToTheEarlierAxis) {
    const TexturePtr cube = numbered_cube();
    const auto face = [&](float s, float t, float r) {
        return sampled(cube, {s, t, r, 1.0F})[0] % 10;
    };
    EXPECT_EQ(face(1.0F, 1.0F, 1.0F), 0);
    EXPECT_EQ(face(-1.0F, 1.0F, -1.0F), 1);
    EXPECT_EQ(face(0.5F, 1.0F, 1.0F), 2);
    EXPECT_EQ(face(0.5F, -1.0F, 1.0F), 3);
    // Lengths do not matter, and blending stays within a face.
    EXPECT_EQ(face(1e-20F, 3e-20F, 0.0F), 2);
    EXPECT_EQ(sampled(numbered_cube(Filter::linear), {1.0F, 1.0F, 1.0F, 1.0F})[0], 10);
}

// A face of 64 texels seen at 8 per pixel has level 3, like a flat texture of half its unit.
TEST(Targets, CubeLevels) {
    std::vector<Image8> images;
    for (int level = 0, side = 64; side >= 1; ++level, side /= 2) {
        for (int face = 0; face < 6; ++face)
            images.push_back(plain_image(side, side, {10 * level + face, 0, 0, 255}));
    }
    const TexturePtr cube = make_texture(
        images, {.target = TextureTarget::cube, .sampler = filtered(Filter::linear_mipmap_linear)});
    // 8 pixels over all of the face -z: s from 1 to -1, t from 1 to -1.
    const Corners corners{{{1.0F, 1.0F, -1.0F, 1.0F},
                           {-1.0F, 1.0F, -1.0F, 1.0F},
                           {-1.0F, -1.0F, -1.0F, 1.0F},
                           {1.0F, -1.0F, -1.0F, 1.0F}}};
    const Framebuffer frame = draw(textured_scene(cube, 8, 8, corners));
    for (int y = 0; y < 8; ++y) {
        for (int x = 0; x < 8; ++x) EXPECT_EQ(bytes_at(frame, x, y)[0], 35) << x << "," << y;
    }
}

TEST(Targets, SlicesBlendLikeLevels) {
    const auto red = [&](Wrap wrap, float r, Filter filter = Filter::linear) {
        Sampler sampler = filtered(filter);
        sampler.wrap_r = wrap;
        sampler.border = {1.0F, 0.0F, 0.0F, 0.0F};
        const TexturePtr texture =
            make_texture({plain_image(2, 2, {10, 0, 0, 255}), plain_image(2, 2, {21, 0, 0, 255}),
                          plain_image(2, 2, {30, 0, 0, 255}), plain_image(2, 2, {40, 0, 0, 255})},
                         {.target = TextureTarget::three_d, .sampler = sampler, .depth = 4});
        return sampled(texture, {0.5F, 0.5F, r, 1.0F})[0];
    };
    // At r = 1/4 lies the middle of the slices 10 and 21: 15.5.
    EXPECT_EQ(red(Wrap::clamp_to_edge, 0.25F), 16);
    EXPECT_EQ(red(Wrap::clamp_to_edge, 0.125F), 10);
    EXPECT_EQ(red(Wrap::clamp_to_edge, 0.0F), 10);
    EXPECT_EQ(red(Wrap::clamp_to_edge, 2.0F), 40);
    EXPECT_EQ(red(Wrap::repeat, 0.0F), 25);
    EXPECT_EQ(red(Wrap::repeat, 1.25F), 16);
    EXPECT_EQ(red(Wrap::mirrored_repeat, -0.25F), 16);
    EXPECT_EQ(red(Wrap::mirrored_repeat, 1.125F), 40);
    EXPECT_EQ(red(Wrap::clamp_to_border, 0.0F), 133);  // (255 + 10) / 2
    EXPECT_EQ(red(Wrap::clamp_to_border, -0.5F), 255);
    EXPECT_EQ(red(Wrap::clamp_to_border, 1.0F), 148);  // (40 + 255) / 2
    EXPECT_EQ(red(Wrap::clamp_to_border, 9.0F), 255);
    EXPECT_EQ(red(Wrap::clamp_to_edge, 0.26F, Filter::nearest), 21);
    EXPECT_EQ(red(Wrap::clamp_to_border, -0.1F, Filter::nearest), 255);
}

TEST(Targets, CoordinatesOf3DAreDividedByQ) {
    const TexturePtr texture = make_texture(
        {plain_image(1, 1, {10, 0, 0, 255}), plain_image(1, 1, {20, 0, 0, 255})},
        {.target = TextureTarget::three_d, .sampler = filtered(Filter::nearest), .depth = 2});
    EXPECT_EQ(sampled(texture, {0.0F, 0.0F, 1.0F, 4.0F})[0], 10);
    EXPECT_EQ(sampled(texture, {0.0F, 0.0F, 3.0F, 4.0F})[0], 20);
}

TEST(Targets, SlicesOfLevelsHalve) {
    std::vector<Image8> images;
    for (int z = 0; z < 4; ++z) images.push_back(plain_image(4, 4, {z, 0, 0, 255}));
    images.push_back(plain_image(2, 2, {100, 0, 0, 255}));
    images.push_back(plain_image(2, 2, {200, 0, 0, 255}));
    const TexturePtr texture =
        make_texture(images, {.target = TextureTarget::three_d,
                              .sampler = filtered(Filter::linear_mipmap_linear, 1.0F),
                              .depth = 4});
    Corners corners = flat(0.0F, 1.0F);
    for (glm::vec4& c : corners) c.z = 0.5F;
    EXPECT_EQ(bytes_at(draw(textured_scene(texture, 4, 4, corners)), 1, 1)[0], 150);
}

TEST(Targets, OfThreeCoordinatesNeedThem) {
    Scene scene = textured_scene(numbered_cube(), 4, 4, flat(0.0F, 1.0F));
    MeshData triangle;
    triangle.positions = {{0.0F, 0.0F, 0.0F}, {1.0F, 0.0F, 0.0F}, {0.0F, 1.0F, 0.0F}};
    triangle.normals.assign(3, {0.0F, 0.0F, 1.0F});
    triangle.uvs.assign(3, {0.0F, 0.0F});
    triangle.tangents.assign(3, {1.0F, 0.0F, 0.0F, 1.0F});
    triangle.indices = {0, 1, 2};
    scene.objects[0].geometry = Mesh(triangle);
    EXPECT_THROW(draw(scene), Error);
}

// ---- box filter and storage

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

// ---- several units

/// A noisy texture of 16 x 16 texels; equal sizes and samplers share their addresses.
TexturePtr noisy(unsigned seed, const Sampler& sampler, TexelFormat format, bool mipmaps) {
    Random random(seed);
    Image8 image(16, 16);
    for (std::uint8_t& byte : image.rgba) byte = static_cast<std::uint8_t>(random.below(256));
    return make_texture({image}, {.format = format, .sampler = sampler, .box_mipmaps = mipmaps});
}

/// Eight units on a machine, which share what they can.
struct Shared {
    const char* machine;
    std::vector<TexturePtr> textures;
};

/// Of seven units with levels five share addresses, one has its own in between and one has no
/// levels. With probes the fifth of six is alone, and another has fewer of them.
std::vector<Shared> shared_units() {
    const Sampler trilinear = filtered(Filter::linear_mipmap_linear);
    const Sampler biased = filtered(Filter::linear_mipmap_linear, 0.4F);
    Sampler probed = trilinear, fewer = trilinear;
    probed.max_anisotropy = 8;
    fewer.max_anisotropy = 2;
    const std::vector<TexturePtr> bytes{
        noisy(1, trilinear, TexelFormat::rgba8, true),
        noisy(2, trilinear, TexelFormat::signed_rgba8, true),
        noisy(3, trilinear, TexelFormat::signed_rgb8_unsigned_alpha8, true),
        noisy(4, filtered(Filter::linear), TexelFormat::rgba8, false),
        noisy(5, trilinear, TexelFormat::rgba8, true),
        noisy(6, trilinear, TexelFormat::rgba8, true),  // the fifth: a fetch of its own
        noisy(7, biased, TexelFormat::rgba8, true),
        noisy(8, filtered(Filter::linear), TexelFormat::rgba8, false)};
    const std::vector<TexturePtr> with_probes{
        noisy(1, probed, TexelFormat::rgba8, true),
        noisy(2, probed, TexelFormat::signed_rgba8, true),
        noisy(3, probed, TexelFormat::signed_rgb8_unsigned_alpha8, true),
        noisy(4, probed, TexelFormat::rgba8, true),
        noisy(5, probed, TexelFormat::rgba8, true),
        noisy(6, fewer, TexelFormat::rgba8, true),
        noisy(7, filtered(Filter::linear), TexelFormat::rgba8, false),
        noisy(8, probed, TexelFormat::rgba8, true)};
    const auto words = [](const Sampler& sampler) {
        std::vector<TexturePtr> textures;
        for (unsigned k = 0; k < 8; ++k)
            textures.push_back(noisy(k, sampler, TexelFormat::rgba16, true));
        const std::vector<TexturePtr> quartet = Texture::quartet(std::span(textures).subspan(5));
        std::copy(quartet.begin(), quartet.end(), textures.begin() + 5);
        return textures;
    };
    return {{"ideal", bytes},
            {"geforce256", bytes},
            {"ideal", with_probes},
            {"geforce256", with_probes},
            {"ideal", words(trilinear)},
            {"ideal", words(probed)}};
}

// Each must give what it gives alone, and the picture must be the one of the trace.
TEST(Units, ThatShareLevelsGiveWhatTheyGiveAlone) {
    Corners corners = flat(-0.4F, 3.0F, 0.1F, 2.7F);
    corners[1].w = 1.5F;
    for (const auto& [machine, textures] : shared_units()) {
        using namespace combine;
        ProgramBuilder p;
        for (int unit = 0; unit < static_cast<int>(textures.size()); ++unit) {
            p.stage()
                .rgb()
                .ab(mul(in(unit == 0 ? Register::col0 : Register::spare0), one()))
                .cd(mul(in(tex(unit)), one()))
                .sum(Register::spare0)
                .scale(Scale::half);
        }
        p.lerp(raw(Register::zero), raw(Register::zero), raw(Register::spare0),
               raw(Register::zero));
        const auto scene_with = [&, name = machine](std::vector<TexturePtr> units) {
            Scene scene = textured_scene(nullptr, 30, 20, corners, name);
            scene.machine.texture_units = scene.machine.general_stages = 8;
            auto material = std::make_shared<Material>();
            material->program.emplace();
            material->program->combiners = p.build();
            material->program->units = std::move(units);
            auto& quad = std::get<RawVertices>(scene.objects[0].geometry);
            for (RawVertex& v : quad.vertices) v.uv.fill(v.uv[0]);
            scene.objects[0].material = material;
            return scene;
        };
        const Scene together = scene_with(textures);
        std::vector<Scene> alone;
        for (std::size_t unit = 0; unit < textures.size(); ++unit) {
            std::vector<TexturePtr> units(textures.size());
            units[unit] = textures[unit];
            alone.push_back(scene_with(units));
        }
        const Framebuffer frame = draw(together);
        for (int y = 0; y < 20; y += 3) {
            for (int x = 0; x < 30; x += 2) {
                const PixelTrace trace = trace_pixel(together, x, y);
                for (int c = 0; c < 4; ++c) {
                    const auto at = static_cast<std::size_t>(c);
                    ASSERT_EQ(bytes_at(frame, x, y)[at], trace.stored[at]) << x << "," << y;
                }
                ASSERT_EQ(trace.fragment->fetches.size(), textures.size());
                for (const TracedFetch& fetch : trace.fragment->fetches) {
                    const auto unit = static_cast<std::size_t>(fetch.unit);
                    const PixelTrace single = trace_pixel(alone[unit], x, y);
                    ASSERT_EQ(fetch.codes, single.fragment->fetches.at(0).codes)
                        << "unit " << unit << " at " << x << "," << y;
                    const bool levels = textures[unit]->levels().size() > 1;
                    ASSERT_EQ(fetch.further.size(), levels ? 2 * fetch.probes.value - 1 : 0);
                }
            }
        }
    }
}

// ---- models

Scene ball(const TexturePtr& normal_map) {
    Scene scene;
    scene.width = 24;
    scene.height = 18;
    scene.machine = machine_profile("nv2a");
    scene.lights.push_back({});
    auto material = std::make_shared<Material>();
    material->normal_map = normal_map;
    scene.objects.push_back({Mesh(shapes::sphere(12, 7)), material, glm::mat4(1.0F), {}});
    return scene;
}

// The maps that a model derives from a normal map with levels have levels, too.
TEST(Models, DerivedMapsHaveLevelsWhereTheNormalMapHas) {
    const Scene scene =
        ball(noisy(1, filtered(Filter::linear_mipmap_linear, 2.0F), TexelFormat::rgba8, true));
    const Framebuffer frame = draw(scene);
    const PixelTrace trace = trace_pixel(scene, 12, 9);
    ASSERT_TRUE(trace.fragment);
    ASSERT_EQ(trace.fragment->fetches.size(), 2U);
    for (const TracedFetch& fetch : trace.fragment->fetches) {
        ASSERT_TRUE(fetch.lod);
        EXPECT_GT(fetch.lod->value, 0.5);
        EXPECT_EQ(fetch.further.at(0).level, fetch.level + 1);
    }
    for (int c = 0; c < 3; ++c) {
        const auto at = static_cast<std::size_t>(c);
        EXPECT_EQ(bytes_at(frame, 12, 9)[at], trace.stored[at]);
    }
}

TEST(Models, TakeFlatMapsOfEveryFormat) {
    const TexturePtr cube = numbered_cube();
    EXPECT_THROW(draw(ball(cube)), Error);
    EXPECT_NO_THROW(draw(ball(noisy(1, {}, TexelFormat::signed_rgba8, false))));
    EXPECT_NO_THROW(draw(ball(noisy(1, {}, TexelFormat::hilo8, false))));
    EXPECT_NO_THROW(draw(ball(noisy(1, {}, TexelFormat::rgb8, false))));
}

// ---- every kind, every instruction set

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

struct Kind {
    const char* name;
    TextureTarget target;
    TexelFormat format;
    Filter filter;
    Wrap wrap;
};
void PrintTo(const Kind& k, std::ostream* out) {
    *out << k.name;
}

const std::vector<Kind>& kinds() {
    using enum TexelFormat;
    using enum TextureTarget;
    static const std::vector<Kind> list{
        {"trilinear", two_d, rgba8, Filter::linear_mipmap_linear, Wrap::repeat},
        {"signed_trilinear", two_d, signed_rgba8, Filter::linear_mipmap_linear,
         Wrap::mirrored_repeat},
        {"mixed", two_d, signed_rgb8_unsigned_alpha8, Filter::nearest_mipmap_linear,
         Wrap::clamp_to_border},
        {"line", one_d, luminance8_alpha8, Filter::linear_mipmap_nearest, Wrap::mirrored_repeat},
        {"rectangle", rectangle, rgba8, Filter::linear, Wrap::clamp_to_border},
        {"cube", cube, rgba8, Filter::linear_mipmap_linear, Wrap::repeat},
        {"slices", three_d, signed_rgba8, Filter::linear_mipmap_linear, Wrap::mirrored_repeat},
        {"border_slices", three_d, rgba8, Filter::linear, Wrap::clamp_to_border},
        {"intensity", two_d, dsdt8_mag8_intensity8, Filter::linear_mipmap_linear, Wrap::repeat},
        {"words", two_d, rgba16, Filter::linear_mipmap_linear, Wrap::clamp_to_border},
        {"word_slices", three_d, rgba16, Filter::linear_mipmap_nearest, Wrap::repeat}};
    return list;
}

/// Noise, in perspective and with a q, from magnified to the last level.
Scene scene_of(const Kind& kind, const char* machine) {
    Random random(static_cast<unsigned>(kind.name[0] + kind.name[1]));
    const int layers = kind.target == TextureTarget::cube      ? 6
                       : kind.target == TextureTarget::three_d ? 5
                                                               : 1;
    const int width = 16, height = kind.target == TextureTarget::one_d  ? 1
                                   : kind.target == TextureTarget::cube ? 16
                                                                        : 11;
    std::vector<Image8> images;
    for (int k = 0; k < layers; ++k) {
        images.emplace_back(width, height);
        for (std::uint8_t& byte : images.back().rgba)
            byte = static_cast<std::uint8_t>(random.below(256));
    }
    TextureDescription d{.target = kind.target, .format = kind.format};
    d.sampler = filtered(kind.filter);
    d.sampler.mag_filter = Filter::linear;
    d.sampler.wrap_s = d.sampler.wrap_r = kind.wrap;
    d.sampler.wrap_t =
        kind.target == TextureTarget::rectangle ? Wrap::clamp_to_edge : Wrap::mirrored_repeat;
    d.sampler.border = {0.3F, 0.9F, -0.2F, 0.5F};
    d.depth = kind.target == TextureTarget::three_d ? 5 : 1;
    d.box_mipmaps = kind.target != TextureTarget::rectangle;
    const float unit = kind.target == TextureTarget::rectangle ? 16.0F : 1.0F;
    const Corners corners{{{-1.5F * unit, -1.0F * unit, -1.0F, 1.0F},
                           {2.0F * unit, -1.0F * unit, 0.8F, 1.5F},
                           {2.5F * unit, 1.7F * unit, 1.6F, 1.0F},
                           {-0.5F * unit, 1.2F * unit, 0.4F, 0.8F}}};
    Scene scene = textured_scene(make_texture(images, d), 36, 24, corners, machine);
    auto& quad = std::get<RawVertices>(scene.objects[0].geometry);
    quad.vertices[0].position.w = quad.vertices[1].position.w = 4.0F;
    return scene;
}

class EveryKind : public testing::TestWithParam<std::tuple<Kind, const char*>> {};

TEST_P(EveryKind, IsTheSameEverywhereAndAsTraced) {
    const auto& [kind, machine] = GetParam();
    if (kind.format == TexelFormat::rgba16 && std::string(machine) != "ideal") return;
    const Scene scene = scene_of(kind, machine);
    std::vector<Framebuffer> frames;
    for (const IsaInfo& isa : instruction_sets()) {
        if (!isa.available) continue;
        frames.emplace_back(scene.width, scene.height);
        Renderer({.threads = 2, .isa = std::string(isa.name)}).render(scene, frames.back());
    }
    int various = 0;
    for (int y = 0; y < scene.height; ++y) {
        for (int x = 0; x < scene.width; ++x) {
            const PixelTrace trace = trace_pixel(scene, x, y);
            const Bytes stored = {
                static_cast<int>(trace.stored[0]), static_cast<int>(trace.stored[1]),
                static_cast<int>(trace.stored[2]), static_cast<int>(trace.stored[3])};
            for (const Framebuffer& frame : frames)
                ASSERT_EQ(bytes_at(frame, x, y), stored) << x << "," << y;
            ASSERT_TRUE(trace.fragment);
            const TracedFetch& fetch = trace.fragment->fetches.at(0);
            for (std::size_t c = 0; c < 4; ++c) {
                // Roundings to 8 bits in both directions, slices and levels; and weights that are
                // up to 1/256 too small in each. A nearest texel or level may be another one.
                if (kind.filter == Filter::linear || kind.filter == Filter::linear_mipmap_linear) {
                    ASSERT_NEAR(fetch.color[c].error(), 0.0, 8.0 / 255.0)
                        << x << "," << y << " channel " << c;
                }
            }
            various += stored != bytes_at(frames[0], 0, 0) ? 1 : 0;
        }
    }
    EXPECT_GT(various, 200);
}

INSTANTIATE_TEST_SUITE_P(
    All, EveryKind, testing::Combine(testing::ValuesIn(kinds()), testing::Values("nv2a", "ideal")),
    [](const testing::TestParamInfo<EveryKind::ParamType>& test) {
        return std::string(std::get<0>(test.param).name) + "_" + std::get<1>(test.param);
    });

}  // namespace
}  // namespace burnish
