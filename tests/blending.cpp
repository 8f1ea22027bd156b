// Blending by hand: layers of raw vertices whose colours are codes, and what the frame keeps.
#include <gtest/gtest.h>

#include <array>
#include <burnish/renderer.hpp>
#include <cmath>
#include <cstring>
#include <optional>
#include <vector>

#include "tests/vertex_color.hpp"

namespace burnish {
namespace {

using Codes = std::array<int, 4>;

/// One colour over the whole frame, as codes of a byte.
Object layer(const Codes& color, const std::optional<Blend>& blend, float depth = 0.5F) {
    RawVertices raw{Space::window, Topology::quads, {}};
    for (const auto& [x, y] : {std::pair{0.0F, 0.0F}, {9.0F, 0.0F}, {9.0F, 9.0F}, {0.0F, 9.0F}}) {
        RawVertex v;
        v.position = {x, y, depth, 1.0F};
        for (int c = 0; c < 4; ++c)
            v.color0[c] = static_cast<float>(color[static_cast<std::size_t>(c)]) / 255.0F;
        raw.vertices.push_back(v);
    }
    return {std::move(raw),
            vertex_color(),
            glm::mat4(1.0F),
            {.depth_test = DepthTest::always, .blend = blend}};
}

Scene layers(std::vector<Object> objects, const char* machine = "nv2a") {
    Scene scene;
    scene.machine = machine_profile(machine);
    scene.background = glm::vec4(0.0F);
    scene.objects = std::move(objects);
    return scene;
}

template <class Channel>
std::array<Channel, 4> pixel(const Scene& scene, PixelFormat format) {
    Framebuffer frame(8, 8, format);
    Renderer({.threads = 1}).render(scene, frame);
    std::array<Channel, 4> channels{};
    std::memcpy(channels.data(), frame.row(3) + 3 * pixel_size(format), sizeof channels);
    return channels;
}
Codes blended(const Codes& over, const Codes& below, const Blend& blend) {
    const auto p =
        pixel<std::uint8_t>(layers({layer(below, {}), layer(over, blend)}), PixelFormat::rgba8);
    return {p[0], p[1], p[2], p[3]};
}

constexpr Codes kOver{200, 100, 50, 64}, kBelow{30, 90, 250, 160};

TEST(Blending, EveryFactor) {
    // Source alone: channel times factor over 255, to nearest.
    const auto source = [](BlendFactor factor) {
        return blended(kOver, kBelow,
                       {factor, BlendFactor::zero, BlendEquation::add, {0.2F, 0.4F, 0.6F, 0.8F}});
    };
    EXPECT_EQ(source(BlendFactor::zero), (Codes{0, 0, 0, 0}));
    EXPECT_EQ(source(BlendFactor::one), kOver);
    // 40000, 10000, 2500, 4096 over 255: 156.9, 39.2, 9.8, 16.1
    EXPECT_EQ(source(BlendFactor::src_color), (Codes{157, 39, 10, 16}));
    // 200 55, 100 155, 50 205, 64 191: 43.1, 60.8, 40.2, 47.9
    EXPECT_EQ(source(BlendFactor::one_minus_src_color), (Codes{43, 61, 40, 48}));
    // times 64: 50.2, 25.1, 12.5 (12.549), 16.1
    EXPECT_EQ(source(BlendFactor::src_alpha), (Codes{50, 25, 13, 16}));
    // times 191: 149.8, 74.9, 37.45, 47.9
    EXPECT_EQ(source(BlendFactor::one_minus_src_alpha), (Codes{150, 75, 37, 48}));
    // 200 30, 100 90, 50 250, 64 160: 23.5 (23.53), 35.3, 49.0, 40.2
    EXPECT_EQ(source(BlendFactor::dst_color), (Codes{24, 35, 49, 40}));
    // 200 225, 100 165, 50 5, 64 95: 176.5 (176.47), 64.7, 0.98, 23.8
    EXPECT_EQ(source(BlendFactor::one_minus_dst_color), (Codes{176, 65, 1, 24}));
    // times 160: 125.5 (125.49), 62.7, 31.4, 40.2
    EXPECT_EQ(source(BlendFactor::dst_alpha), (Codes{125, 63, 31, 40}));
    // times 95: 74.5 (74.51), 37.3, 18.6, 23.8
    EXPECT_EQ(source(BlendFactor::one_minus_dst_alpha), (Codes{75, 37, 19, 24}));
    // 51, 102, 153, 204: 40, 40, 30, 51.2
    EXPECT_EQ(source(BlendFactor::constant_color), (Codes{40, 40, 30, 51}));
    EXPECT_EQ(source(BlendFactor::one_minus_constant_color), (Codes{160, 60, 20, 13}));
}

TEST(Blending, EveryEquation) {
    const auto with = [](BlendEquation equation) {
        return blended(kOver, kBelow, {BlendFactor::one, BlendFactor::one, equation});
    };
    EXPECT_EQ(with(BlendEquation::add), (Codes{230, 190, 255, 224}));
    EXPECT_EQ(with(BlendEquation::subtract), (Codes{170, 10, 0, 0}));
    EXPECT_EQ(with(BlendEquation::reverse_subtract), (Codes{0, 0, 200, 96}));
    EXPECT_EQ(with(BlendEquation::min), (Codes{30, 90, 50, 64}));
    EXPECT_EQ(with(BlendEquation::max), (Codes{200, 100, 250, 160}));
    // The factors of min and max do not matter.
    EXPECT_EQ(blended(kOver, kBelow, {BlendFactor::zero, BlendFactor::zero, BlendEquation::max}),
              (Codes{200, 100, 250, 160}));
}

TEST(Blending, BothProductsAreRoundedTogether) {
    // 1 * 127 and 1 * 128: each alone rounds to 0 and 1, both to 255 / 255.
    EXPECT_EQ(blended({1, 1, 1, 127}, {1, 1, 1, 0}, Blend::alpha()), (Codes{1, 1, 1, 63}));
    // 100 * 51 + 101 * 204 = 25704 = 100.8 * 255; apart, 20 + 81.
    EXPECT_EQ(blended({100, 100, 100, 51}, {101, 101, 101, 255}, Blend::alpha())[0], 101);
    // 3 * 42 + 0 = 126: 0.494; 127: 0.498; 128: 0.502
    EXPECT_EQ(blended({3, 1, 1, 42}, {0, 0, 0, 0}, Blend::alpha())[0], 0);
    EXPECT_EQ(blended({1, 1, 1, 127}, {0, 0, 0, 0}, Blend::alpha())[0], 0);
    EXPECT_EQ(blended({1, 1, 1, 128}, {0, 0, 0, 0}, Blend::alpha())[0], 1);
}

TEST(Blending, NamesAreTheirFactors) {
    // 200 64 + 30 191 = 18530: 72.7; 100 64 + 90 191 = 23590: 92.5 (92.51); 50 64 + 250 191 =
    // 50950: 199.8; 64 64 + 160 191 = 34656: 135.9
    EXPECT_EQ(blended(kOver, kBelow, Blend::alpha()), (Codes{73, 93, 200, 136}));
    EXPECT_EQ(blended(kOver, kBelow, Blend::add()), (Codes{230, 190, 255, 224}));
    EXPECT_EQ(blended(kOver, kBelow, Blend::multiply()), (Codes{24, 35, 49, 40}));
    // 30 191 / 255 = 22.5 (22.47); with the source in one sum: 200 255 + 5730 = 56730: 222.5
    // (222.47) 100 + 67.4, 50 + 187.3, 64 + 119.8
    EXPECT_EQ(blended(kOver, kBelow, Blend::premultiplied()), (Codes{222, 167, 237, 184}));
}

TEST(Blending, SixteenBitsRoundOnce) {
    const Scene scene = layers({layer(kBelow, {}), layer(kOver, Blend::alpha())});
    const auto p = pixel<std::uint16_t>(scene, PixelFormat::rgba16);
    for (std::size_t c = 0; c < 4; ++c) {
        const std::int64_t s = kOver[c] * 257, d = kBelow[c] * 257, a = kOver[3] * 257;
        const std::int64_t sum = s * a + d * (65535 - a);
        EXPECT_EQ(p[c], (2 * sum + 65535) / (2 * 65535)) << "channel " << c;
    }
}

TEST(Blending, FloatsRoundEachOperation) {
    const Scene scene = layers({layer(kBelow, {}), layer(kOver, Blend::alpha())});
    const auto p = pixel<float>(scene, PixelFormat::rgba32f);
    const auto value = [](int code) { return static_cast<float>(code) / 255.0F; };
    for (std::size_t c = 0; c < 4; ++c) {
        const float a = value(kOver[3]);
        const float source = value(kOver[c]) * a, below = value(kBelow[c]) * (1.0F - a);
        EXPECT_EQ(p[c], source + below) << "channel " << c;
    }
}

TEST(Blending, StaysWithinOneInEveryFormat) {
    const Scene sum = layers({layer(kBelow, {}), layer({255, 255, 255, 255}, Blend::add())});
    const Scene difference = layers(
        {layer(kBelow, {}), layer({255, 255, 255, 255}, Blend{BlendFactor::one, BlendFactor::one,
                                                              BlendEquation::reverse_subtract})});
    EXPECT_EQ(pixel<float>(sum, PixelFormat::rgba32f), (std::array{1.0F, 1.0F, 1.0F, 1.0F}));
    EXPECT_EQ(pixel<float>(difference, PixelFormat::rgba32f), (std::array{0.0F, 0.0F, 0.0F, 0.0F}));
    EXPECT_EQ(pixel<std::uint16_t>(sum, PixelFormat::rgba16)[0], 65535);
    EXPECT_EQ(pixel<std::uint16_t>(difference, PixelFormat::rgba16)[0], 0);
}

// A wide register becomes a byte first: 0.3 is code 4915, byte 76 (76.49), and alpha 1/2 byte 128:
// 76 * 128 = 9728: 38.1; 76.49 * 127.5 would be 38.2 as well, so the halves: 255 * 0.7 = 178.5.
TEST(Blending, WideRegistersAreRoundedToTheFrameFirst) {
    Object over = layer({0, 0, 0, 0}, Blend::alpha());
    for (RawVertex& v : std::get<RawVertices>(over.geometry).vertices)
        v.color0 = {1.0F, 0.3F, 0.5F, 0.5F};
    const auto p =
        pixel<std::uint8_t>(layers({layer({0, 0, 0, 0}, {}), over}, "ideal"), PixelFormat::rgba8);
    // alpha: 16384 / 2 = 8192: 127.5 and half up 128; 128 * 128 / 255 = 64.25
    EXPECT_EQ(p, (std::array<std::uint8_t, 4>{128, 38, 64, 64}));
}

TEST(Blending, LayersFollowTheOrderOfSubmission) {
    const Codes red{255, 0, 0, 128}, blue{0, 0, 255, 128};
    const auto stack = [&](const Codes& first, const Codes& second) {
        return pixel<std::uint8_t>(layers({layer({0, 0, 0, 255}, {}), layer(first, Blend::alpha()),
                                           layer(second, Blend::alpha())}),
                                   PixelFormat::rgba8);
    };
    // 255 128 / 255 = 128; then 128 127 / 255 = 63.7 under 128.
    EXPECT_EQ(stack(red, blue)[0], 64);
    EXPECT_EQ(stack(red, blue)[2], 128);
    EXPECT_EQ(stack(blue, red)[0], 128);
    EXPECT_EQ(stack(blue, red)[2], 64);
}

}  // namespace
}  // namespace burnish
