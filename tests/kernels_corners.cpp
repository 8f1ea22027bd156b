#include <array>
#include <cstdint>

#include "kernel_test.hpp"

/// The four texel centres around a sample point, and the filter over what was shaded there.
namespace burnish {
namespace {

INSTANTIATE_TEST_SUITE_P(Isa, KernelTest, every_table(), isa_name);

constexpr std::array kModes{AddressMode::repeat, AddressMode::clamp_to_edge,
                            AddressMode::clamp_to_border, AddressMode::mirrored_repeat};

constexpr int kCornerS = 4, kWeight = 6, kLevel = 9;

TexelCornerCtx corner_of(int width, int height, AddressMode s, AddressMode t) {
    TexelCornerCtx ctx{};
    ctx.u = 0;
    ctx.v = 1;
    ctx.q = ctx.lambda = ctx.level = -1;
    ctx.to = kCornerS;
    ctx.weight = kWeight;
    ctx.mode_s = s;
    ctx.mode_t = t;
    ctx.choice = LevelChoice::base;
    ctx.mag_linear = 1;
    ctx.level_count = 1;
    ctx.levels[0] = {width, height, 1, 0};
    return ctx;
}

TEST_P(KernelTest, CornersOfEveryKindOfCoordinate) {
    for (int seed = 0; seed < 2000; ++seed) {
        Random random(static_cast<unsigned>(seed));
        TexelCornerCtx ctx = corner_of(1, 1, random.pick(kModes), random.pick(kModes));
        ctx.q = random.chance(3) ? 2 : -1;
        ctx.lambda = random.chance(3) ? -1 : 5;
        ctx.level = random.chance(3) ? -1 : kLevel;
        ctx.choice = static_cast<LevelChoice>(random.below(4));
        for (std::uint8_t* flag : {&ctx.right, &ctx.below, &ctx.mag_linear, &ctx.min_linear})
            *flag = static_cast<std::uint8_t>(random.below(2));
        ctx.rectangle = random.chance(5) ? 1 : 0;
        ctx.level_count = random.between(1, LevelAddressCtx::kMaxLevels);
        for (int k = 0; k < ctx.level_count; ++k)
            ctx.levels[k] = {1 << random.below(15), random.between(1, 16384), 1, 0};
        PacketMemory packet;
        packet.count = random.between(1, kPacketSize);
        for (int k = 0; k < 3; ++k)
            for (int i = 0; i < kPacketSize; ++i)
                packet.attribute(k)[i] =
                    random.chance(4) ? random.pick(kWild) : random.real(-3.0F, 3.0F);
        for (int i = 0; i < kPacketSize; ++i)
            packet.plane(5)[i] = static_cast<std::int16_t>(
                random.chance(4) ? 0 : random.below(256 * (ctx.level_count - 1) + 1));
        Written written{.planes = {kWeight, kWeight + 1}, .attributes = {kCornerS, kCornerS + 1}};
        if (ctx.level >= 0) written.planes.push_back(kLevel);
        ASSERT_EQ(stage_difference(table(), &KernelTable::texel_corner, packet, ctx, written), "")
            << name("texel_corner") << ", seed " << seed;
    }
}

TEST_P(KernelTest, CornersByHand) {
    // 4 texels, u = 0.3: 1.2 texels, less 1/2: texel 0 and 0.7 of the next: 179.2 / 256 -> 179.
    // Centres 0.5 and 1.5 texels, and 1/512: (128 + 1/2) / 1024 and (384 + 1/2) / 1024.
    // u = 5.05, repeated: 0.2 - 0.5 = -0.3: texel -1 with weight 0.7 (179): 5 + (-128 + 1/2) /
    // 1024. u = 1.3, mirrored: as 0.7, 2.8 - 0.5 = 2.3: texels 2 and 3, 76; centres 2 - 640.5 /
    // 1024 ...
    struct Case {
        AddressMode mode;
        float u;
        int weight;
        float left, right;
    };
    constexpr std::array cases{
        Case{AddressMode::clamp_to_edge, 0.3F, 179, 128.5F / 1024, 384.5F / 1024},
        Case{AddressMode::repeat, 5.05F, 179, 5.0F - 127.5F / 1024, 5.0F + 128.5F / 1024},
        Case{AddressMode::mirrored_repeat, 1.3F, 76, 2.0F - 640.5F / 1024, 2.0F - 896.5F / 1024}};
    for (const Case& c : cases) {
        for (const bool right : {false, true}) {
            TexelCornerCtx ctx = corner_of(4, 4, c.mode, c.mode);
            ctx.right = right ? 1 : 0;
            PacketMemory packet;
            packet.count = 1;
            packet.attribute(0)[0] = packet.attribute(1)[0] = c.u;
            Packet view = packet.view();
            table().texel_corner(view, ctx);
            EXPECT_EQ(packet.attribute(kCornerS)[0], right ? c.right : c.left) << c.u;
            EXPECT_EQ(packet.attribute(kCornerS + 1)[0], c.left) << "the upper one of " << c.u;
            EXPECT_EQ(packet.plane(kWeight)[0], c.weight) << c.u;
        }
    }
}

// What a bilinear fetch weights is what stands at the corners: by the same weights, and nothing of
// a neighbour, even where the fetch at the corner is bilinear itself. Beyond the first and the last
// centre of maps that do not repeat both texels are the same, whatever they weigh.
TEST_P(KernelTest, AFetchAtACornerFindsOneTexelOfTheBilinearFetch) {
    constexpr int kPitch = 1 << 16;
    for (int seed = 0; seed < 400; ++seed) {
        Random random(static_cast<unsigned>(seed));
        const AddressMode mode = random.pick(kModes);
        const bool repeats = mode == AddressMode::repeat;
        const int size[2] = {random.between(2, 4096), 1 << random.between(1, 12)};
        PacketMemory packet;
        for (int k = 0; k < 2; ++k) {
            const float end = 0.501F / static_cast<float>(size[k]);
            const float turns = mode == AddressMode::mirrored_repeat ? 2.0F : 0.0F;
            for (int i = 0; i < kPacketSize; ++i)
                packet.attribute(k)[i] =
                    repeats ? random.real(-1.5F, 2.5F) : random.real(end, 1.0F - end) + turns;
        }
        const AddressCtx bilinear{0, 1, -1, size[0], size[1], kPitch, mode, mode, 1};
        Packet view = packet.view();
        table().address(view, bilinear);
        const PacketMemory around = packet;
        TexelCornerCtx ctx = corner_of(size[0], size[1], mode, mode);
        ctx.right = static_cast<std::uint8_t>(random.below(2));
        ctx.below = static_cast<std::uint8_t>(random.below(2));
        table().texel_corner(view, ctx);
        AddressCtx at_corner = bilinear;
        at_corner.u = kCornerS;
        at_corner.v = kCornerS + 1;
        table().address(view, at_corner);
        for (int i = 0; i < kPacketSize; ++i) {
            const auto k = static_cast<std::size_t>(i);
            const int x = around.texel[k] % kPitch / 4 + ctx.right;
            const int y = around.texel[k] / kPitch + ctx.below;
            const int want = x % size[0] * 4 + y % size[1] * kPitch;
            ASSERT_EQ(packet.texel[k], want) << name("texel_corner") << ", seed " << seed;
            ASSERT_EQ(packet.weight_x[k], 0) << name("texel_corner") << ", seed " << seed;
            ASSERT_EQ(packet.weight_y[k], 0) << name("texel_corner") << ", seed " << seed;
            ASSERT_EQ(packet.plane(kWeight)[i], around.weight_x[k]) << "seed " << seed;
            ASSERT_EQ(packet.plane(kWeight + 1)[i], around.weight_y[k]) << "seed " << seed;
        }
    }
}

TEST_P(KernelTest, FiltersEveryWeight) {
    constexpr std::array kNine{-256, 255, 0, 1, 254, -255}, kWide{-32768, 32767, 0, 16384, 1, -1};
    for (int seed = 0; seed < 512; ++seed) {
        Random random(static_cast<unsigned>(seed));
        const bool nine_bit = seed % 2 == 0;
        PacketMemory packet;
        packet.count = random.chance(2) ? kPacketSize : random.between(1, kPacketSize);
        for (int k = 10; k < 26; ++k) {
            for (int i = 0; i < kPacketSize; ++i) {
                const int code =
                    nine_bit ? random.between(-256, 255) : random.between(-32768, 32767);
                packet.plane(k)[i] = static_cast<std::int16_t>(
                    random.chance(2) ? code : random.pick(nine_bit ? kNine : kWide));
            }
        }
        for (int i = 0; i < kPacketSize; ++i) {
            packet.plane(kWeight)[i] = static_cast<std::int16_t>(i % 256);
            packet.plane(kWeight + 1)[i] = static_cast<std::int16_t>(seed / 2);
        }
        ASSERT_EQ(stage_difference(
                      table(), nine_bit ? &KernelTable::filter_nine_bit : &KernelTable::filter_wide,
                      packet, FilterCtx{10, kWeight, 30}, {.planes = {30, 31, 32, 33}}),
                  "")
            << name("filter") << ", seed " << seed;
    }
}

TEST_P(KernelTest, FilterByHand) {
    // wx = 64, wy = 128. Rows: 100 + (3 - 100) / 4 = 75.75 -> 76 and 7 + (250 - 7) / 4 = 67.75 ->
    // 68; 72. In one step: (75.75 + 67.75) / 2 = 71.75 -> 72; -3, -2, -3, -2: -2.75 -> -3.
    PacketMemory packet;
    packet.count = 1;
    constexpr std::array<int, 4> first{100, 3, 7, 250}, second{-3, -2, -3, -2};
    for (int k = 0; k < 4; ++k) {
        packet.plane(10 + 4 * k)[0] = static_cast<std::int16_t>(first.at(std::size_t(k)));
        packet.plane(11 + 4 * k)[0] = static_cast<std::int16_t>(second.at(std::size_t(k)));
    }
    packet.plane(kWeight)[0] = 64;
    packet.plane(kWeight + 1)[0] = 128;
    Packet view = packet.view();
    table().filter_nine_bit(view, {10, kWeight, 30});
    EXPECT_EQ(packet.plane(30)[0], 72);
    EXPECT_EQ(packet.plane(31)[0], -3);
    table().filter_wide(view, {10, kWeight, 30});
    EXPECT_EQ(packet.plane(30)[0], 72);
    EXPECT_EQ(packet.plane(31)[0], -3);
}

}  // namespace
}  // namespace burnish
