#include <array>
#include <cmath>
#include <vector>

#include "kernel_test.hpp"

/// From texture coordinates to filtered texels.
namespace burnish {
namespace {

INSTANTIATE_TEST_SUITE_P(Isa, KernelTest, every_table(), isa_name);

/// Coordinates that break careless conversions, and neighbours of whole numbers.
std::vector<float> wild_coordinates() {
    std::vector<float> values{kNan,       -kNan,   kInfinity, -kInfinity, 0.0F,  -0.0F,
                              1e-45F,     -1e-45F, 1e-30F,    -1e-8F,     3e38F, -3e38F,
                              2.1e9F,     -2.2e9F, 1e19F,     -1e19F,     65536, -65536,
                              8388609.0F, 0.5F,    -0.5F,     16777216.0F};
    for (int whole = -2; whole <= 2; ++whole) {
        const auto x = static_cast<float>(whole);
        values.insert(values.end(),
                      {x, std::nextafter(x, kInfinity), std::nextafter(x, -kInfinity)});
    }
    return values;
}

/// A coordinate near the borders between texels, or anything.
float random_coordinate(Random& random, int size, const std::vector<float>& wild) {
    switch (random.below(5)) {
        case 0:
            return random.pick(wild);
        case 1: {
            const auto texel = static_cast<float>(random.between(-size, 2 * size));
            const float x = (texel + (random.chance(2) ? 0.5F : 0.0F)) / static_cast<float>(size);
            return random.chance(2) ? std::nextafter(x, random.chance(2) ? kInfinity : -kInfinity)
                                    : x;
        }
        case 2:
            return random.real(-3.0F, 3.0F);
        case 3:
            return random.real(-1e6F, 1e6F);
        default:
            return random.unit();
    }
}

AddressCtx random_address(Random& random) {
    constexpr std::array kSides{1,   2,   3,   5,    7,    31,   64,   100,
                                255, 256, 511, 1000, 1024, 2048, 4095, 4096};
    AddressCtx ctx{};
    ctx.u = 0;
    ctx.v = 1;
    ctx.q = random.chance(2) ? 2 : -1;
    ctx.width = random.pick(kSides);
    ctx.height = random.pick(kSides);
    ctx.texel_shift = static_cast<std::uint8_t>(random.chance(3) ? 3 : 2);
    ctx.pitch = ((ctx.width + 3) << ctx.texel_shift) + 4 * random.below(33);
    constexpr std::array kModes{AddressMode::clamp_to_edge, AddressMode::clamp_to_border,
                                AddressMode::repeat, AddressMode::mirrored_repeat};
    ctx.rectangle = static_cast<std::uint8_t>(random.chance(6) ? 1 : 0);
    for (AddressMode* mode : {&ctx.mode_s, &ctx.mode_t})
        *mode = kModes[static_cast<std::size_t>(random.below(ctx.rectangle != 0 ? 2 : 4))];
    ctx.linear = static_cast<std::uint8_t>(random.below(2));
    if (random.chance(8)) ctx.v = ctx.u;
    return ctx;
}

/// Every address up to fragment `end` is a texel, or one of the border, with a right neighbour in
/// its row; every weight has 8 bits.
void expect_inside(PacketMemory& packet, int end, const AddressCtx& ctx, const std::string& name) {
    const int left = ctx.mode_s == AddressMode::clamp_to_border ? 1 : 0;
    const int texel_bytes = 1 << ctx.texel_shift;
    const int above = ctx.mode_t == AddressMode::clamp_to_border ? 1 : 0;
    for (int i = 0; i < end; ++i) {
        const auto at = static_cast<std::size_t>(i);
        const std::int32_t offset = packet.texel[at] + above * ctx.pitch + texel_bytes * left;
        {
            ASSERT_TRUE(offset >= 0 && offset / ctx.pitch < ctx.height + 2 * above &&
                        offset % ctx.pitch <= texel_bytes * (ctx.width - 1 + 2 * left) &&
                        offset % ctx.pitch % texel_bytes == 0)
                << name << ", fragment " << i << ": offset " << packet.texel[at] << " in "
                << ctx.width << " x " << ctx.height << ", pitch " << ctx.pitch;
        }
        for (const std::int16_t weight : {packet.weight_x[at], packet.weight_y[at]})
            ASSERT_TRUE(weight >= 0 && weight <= 255)
                << name << ", fragment " << i << ": " << weight;
    }
}

TEST_P(KernelTest, AddressesOfAnyCoordinateStayInTheTexture) {
    const std::vector<float> wild = wild_coordinates();
    const Written written{.addresses = true};
    for (int seed = 0; seed < 1500; ++seed) {
        Random random(static_cast<unsigned>(seed));
        const AddressCtx ctx = random_address(random);
        PacketMemory packet;
        packet.count = random.chance(3) ? kPacketSize : random.between(1, kPacketSize);
        for (int i = 0; i < kPacketSize; ++i) {
            packet.attribute(0)[i] = random_coordinate(random, ctx.width, wild);
            packet.attribute(1)[i] = random_coordinate(random, ctx.height, wild);
            packet.attribute(2)[i] =
                random.chance(3) ? random.pick(wild) : random.real(-2.0F, 2.0F);
        }
        const std::string text =
            stage_difference(table(), &KernelTable::address, packet, ctx, written);
        ASSERT_EQ(text, "") << name("address") << ", seed " << seed << ", " << ctx.width << " x "
                            << ctx.height << ", modes " << static_cast<int>(ctx.mode_s)
                            << static_cast<int>(ctx.mode_t) << ", linear " << int{ctx.linear}
                            << ", q " << ctx.q;
        Packet view = packet.view();
        table().address(view, ctx);
        // Vector kernels fetch the texels of padding fragments, too, whatever their coordinates.
        const int end = table().lanes == 1 ? packet.count : end_of_group(packet.count);
        ASSERT_NO_FATAL_FAILURE(
            expect_inside(packet, end, ctx, name("address") + ", seed " + std::to_string(seed)));
    }
}

TEST_P(KernelTest, AddressesAcrossOneRowAtEveryStep) {
    // 2^-12 steps over [-1/2, 3/2) for a row of 16 texels: every weight, every border, both ways.
    const Written written{.addresses = true};
    for (int variant = 0; variant < 8; ++variant) {
        AddressCtx ctx{0, 1, -1, 16, 16, 68, AddressMode::repeat, AddressMode::clamp_to_edge, 0};
        if ((variant & 1) != 0) std::swap(ctx.mode_s, ctx.mode_t);
        if ((variant & 2) != 0) ctx.mode_s = ctx.mode_t;
        ctx.linear = static_cast<std::uint8_t>(variant / 4);
        for (int first = -2048; first < 6144; first += kPacketSize) {
            PacketMemory packet;
            for (int i = 0; i < kPacketSize; ++i) {
                packet.attribute(0)[i] = static_cast<float>(first + i) * 0x1p-12F;
                packet.attribute(1)[i] = static_cast<float>(4096 - first - i) * 0x1p-12F;
            }
            ASSERT_EQ(stage_difference(table(), &KernelTable::address, packet, ctx, written), "")
                << name("address") << ", variant " << variant << ", u from " << first << " / 4096";
        }
    }
}

using FetchStage = void (*KernelTable::*)(Packet&, const FetchCtx&) noexcept;

constexpr int kTexelPlane = 20;
const Written kFetched{.planes = {kTexelPlane, kTexelPlane + 1, kTexelPlane + 2, kTexelPlane + 3}};

/// A texture of two rows with exactly the bytes that an address may reach.
struct TwoRows {
    std::vector<std::uint8_t> bytes;
    std::int32_t pitch;

    explicit TwoRows(int width) : pitch(4 * (width + 1)) {
        bytes.resize(std::size_t(2) * static_cast<std::size_t>(pitch));
    }
    void set(int x, int y, int channel, int value) {
        bytes[static_cast<std::size_t>(y * pitch + 4 * x + channel)] =
            static_cast<std::uint8_t>(value);
    }
};

void point_at(PacketMemory& packet, int i, std::int32_t texel, int wx, int wy) {
    const auto at = static_cast<std::size_t>(i);
    packet.texel[at] = 4 * texel;
    packet.weight_x[at] = static_cast<std::int16_t>(wx);
    packet.weight_y[at] = static_cast<std::int16_t>(wy);
}

// All 65,536 pairs of weights for the 16 ways to be black or white at the four corners.
void check_weights(const KernelTable& table, FetchStage stage, std::uint8_t is_signed = 0) {
    TwoRows texture(4);
    // Texels x and x + 1 of both rows are the corners; channel c adds three more arrangements.
    for (int c = 0; c < 4; ++c) {
        for (int x = 0; x <= 4; ++x) {
            texture.set(x, 0, c, (x * 7 + c * 3) % 4 < 2 ? 0 : 255);
            texture.set(x, 1, c, (x * 5 + c) % 4 < 2 ? 255 : 0);
        }
    }
    PacketMemory packet;
    packet.count = PacketMemory::kBytes;
    const FetchCtx ctx{{texture.bytes.data()}, {kTexelPlane}, {is_signed}, 1, texture.pitch};
    for (int wx = 0; wx < 256; ++wx) {
        for (int x = 0; x < 4; ++x) {
            for (int i = 0; i < packet.count; ++i) point_at(packet, i, x, wx, i);
            ASSERT_EQ(stage_difference(table, stage, packet, ctx, kFetched), "")
                << table.isa << " fetch, weight " << wx << ", texel " << x;
        }
    }
}

TEST_P(KernelTest, NineBitFetchWithEveryPairOfWeights) {
    check_weights(table(), &KernelTable::fetch_nine_bit);
}

TEST_P(KernelTest, WideFetchWithEveryPairOfWeights) {
    check_weights(table(), &KernelTable::fetch_wide);
}

// Every lerp of two bytes with every weight: across (four values of the left texel at a time, one
// per channel, all weights of a packet) and, with equal columns, down.
void check_every_lerp(const KernelTable& table, FetchStage stage, std::uint8_t is_signed = 0) {
    TwoRows texture(511);
    PacketMemory packet;
    packet.count = PacketMemory::kBytes;
    const FetchCtx ctx{{texture.bytes.data()}, {kTexelPlane}, {is_signed}, 1, texture.pitch};
    for (int left = 0; left < 256; left += 4) {
        for (int c = 0; c < 4; ++c) {
            for (int x = 0; x < 512; ++x) {
                texture.set(x, 0, c, x % 2 == 0 ? left + c : x / 2);
                texture.set(x, 1, c, x % 2 == 0 ? x / 2 : left + c);
            }
        }
        for (int right = 0; right < 256; ++right) {
            for (int i = 0; i < packet.count; ++i)
                point_at(packet, i, 2 * right, i, right & 1 ? i : 0);
            ASSERT_EQ(stage_difference(table, stage, packet, ctx, kFetched), "")
                << table.isa << " fetch, left " << left << ", right " << right;
        }
        for (int below = 0; below < 256; ++below) {
            for (int i = 0; i < packet.count; ++i) point_at(packet, i, 2 * below, 0, i);
            ASSERT_EQ(stage_difference(table, stage, packet, ctx, kFetched), "")
                << table.isa << " fetch, above " << left << ", below " << below;
        }
    }
}

TEST_P(KernelTest, NineBitFetchOfEveryLerp) {
    check_every_lerp(table(), &KernelTable::fetch_nine_bit);
}

TEST_P(KernelTest, NineBitFetchOfSignedTexels) {
    check_weights(table(), &KernelTable::fetch_nine_bit, FetchCtx::kAllSigned);
    check_every_lerp(table(), &KernelTable::fetch_nine_bit, FetchCtx::kAllSigned);
}

TEST_P(KernelTest, WideFetchOfSignedTexels) {
    check_weights(table(), &KernelTable::fetch_wide, FetchCtx::kAllSigned);
    check_every_lerp(table(), &KernelTable::fetch_wide, FetchCtx::kAllSigned);
}

TEST_P(KernelTest, WideFetchOfEveryLerp) {
    check_every_lerp(table(), &KernelTable::fetch_wide);
}

void check_random_fetch(const KernelTable& table, FetchStage stage) {
    for (int seed = 0; seed < 300; ++seed) {
        Random random(static_cast<unsigned>(seed));
        const int width = random.between(1, 40);
        const int height = random.between(1, 40);
        const std::int32_t pitch = 4 * (width + 1 + random.below(9));
        std::vector<std::uint8_t> texels(
            static_cast<std::size_t>(pitch * (height + 1) + 4 * FetchCtx::kMaxTextures));
        for (std::uint8_t& t : texels)
            t = static_cast<std::uint8_t>(random.chance(4) ? (random.chance(2) ? 0 : 255)
                                                           : random.below(256));
        PacketMemory packet;
        packet.count = random.chance(3) ? kPacketSize : random.between(1, kPacketSize);
        for (std::size_t i = 0; i < kPacketSize; ++i) {
            const int x = 4 * random.below(width);
            packet.texel[i] = random.below(height) * pitch + x;
            packet.weight_x[i] = static_cast<std::int16_t>(random.below(256));
            packet.weight_y[i] = static_cast<std::int16_t>(random.below(256));
        }
        FetchCtx ctx{{}, {}, {}, random.between(1, FetchCtx::kMaxTextures), pitch};
        Written written;
        for (int k = 0; k < ctx.count; ++k) {  // overlapping textures are textures, too
            ctx.texels[k] = texels.data() + 4 * k;
            ctx.plane[k] = kTexelPlane - 5 * k;
            ctx.is_signed[k] = static_cast<std::uint8_t>(random.pick(std::array{0, 15, 3, 8, 7}));
            for (int c = 0; c < 4; ++c) written.planes.push_back(ctx.plane[k] + c);
        }
        ASSERT_EQ(stage_difference(table, stage, packet, ctx, written), "")
            << table.isa << " fetch, seed " << seed << ", " << width << " x " << height;
    }
}

TEST_P(KernelTest, NineBitFetchFromTexturesOfAnySize) {
    check_random_fetch(table(), &KernelTable::fetch_nine_bit);
}

TEST_P(KernelTest, WideFetchFromTexturesOfAnySize) {
    check_random_fetch(table(), &KernelTable::fetch_wide);
}

}  // namespace
}  // namespace burnish
