// Wraps, formats and targets of textures through the renderer.
// Numbers of the filter are those of captures of the NV2A (docs/numbers.md).
#include <gtest/gtest.h>

#include <burnish/error.hpp>
#include <string>

#include "tests/textured_quad.hpp"

namespace burnish {
namespace {

using Row = std::vector<int>;

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

}  // namespace
}  // namespace burnish
