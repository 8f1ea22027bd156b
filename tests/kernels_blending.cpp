#include <array>
#include <cmath>
#include <vector>

#include "kernel_test.hpp"

/// Blending with the pixels of a tile, and the tests that follow shading.
namespace burnish {
namespace {

INSTANTIATE_TEST_SUITE_P(Isa, KernelTest, every_table(), isa_name);

using BlendStage = void (*KernelTable::*)(Packet&, const BlendCtx&) noexcept;

constexpr std::array<BlendOperand, 6> kOperands{BlendOperand::zero,
                                                BlendOperand::source_color,
                                                BlendOperand::source_alpha,
                                                BlendOperand::destination_color,
                                                BlendOperand::destination_alpha,
                                                BlendOperand::constant_color};
constexpr std::array<BlendSum, 5> kSums{BlendSum::add, BlendSum::subtract,
                                        BlendSum::reverse_subtract, BlendSum::min, BlendSum::max};

/// A tile of bytes, with its kNoPixel.
using Bytes = AlignedVector<std::uint8_t>;
Bytes random_tile(Random& random, StoreFormat format) {
    const int channels = 4 * (kTilePixels + 1);
    const auto width = format == StoreFormat::rgba8 ? 1U : format == StoreFormat::rgba16 ? 2U : 4U;
    Bytes tile(static_cast<std::size_t>(channels) * width);
    if (format != StoreFormat::rgba32f) {
        for (std::uint8_t& byte : tile) byte = static_cast<std::uint8_t>(random.below(256));
        return tile;
    }
    for (std::size_t i = 0; i < tile.size(); i += sizeof(float)) {
        const float x = random.chance(4) ? static_cast<float>(random.below(2)) : random.unit();
        std::memcpy(tile.data() + i, &x, sizeof x);
    }
    return tile;
}

/// Consecutive pixels, a few exchanged, any order; some that are not stored.
void arrange_pixels(PacketMemory& packet, Random& random) {
    const int way = random.below(3);
    if (way == 0) packet.shuffle_pixels(random);
    const int first = random.between(0, kTilePixels - kPacketSize);
    for (int i = 0; way != 0 && i < kPacketSize; ++i)
        packet.pixels[static_cast<std::size_t>(i)] = static_cast<std::uint16_t>(first + i);
    if (way == 1) return;
    for (int i = 0; i < kPacketSize; ++i)
        if (random.chance(7)) packet.pixels[static_cast<std::size_t>(i)] = kNoPixel;
}

void check_blend(const KernelTable& table, BlendStage stage, int last_code) {
    for (unsigned seed = 0; seed < 3000; ++seed) {
        Random random(seed);
        BlendCtx ctx{};
        for (std::int16_t c = 0; c < 4; ++c) {
            ctx.plane[c] = static_cast<std::int16_t>(5 + c);
            ctx.constant[c] = random.chance(4) ? 1.0F : random.unit();
        }
        ctx.format = static_cast<StoreFormat>(seed % 3);
        ctx.sum = random.pick(kSums);
        ctx.source = {random.pick(kOperands), static_cast<std::uint8_t>(random.below(2))};
        ctx.destination = {random.pick(kOperands), static_cast<std::uint8_t>(random.below(2))};
        PacketMemory packet;
        packet.count = random.chance(3) ? kPacketSize : random.between(1, kPacketSize);
        arrange_pixels(packet, random);
        for (int c = 0; c < 4; ++c)
            for (int i = 0; i < packet.count; ++i)
                packet.plane(5 + c)[i] = static_cast<std::int16_t>(
                    random.chance(5) ? last_code * random.below(2) : random.between(0, last_code));
        Bytes got = random_tile(random, ctx.format);
        Bytes want = got;
        Packet view = packet.view();
        ctx.tile = got.data();
        (table.*stage)(view, ctx);
        ctx.tile = want.data();
        (table_reference().*stage)(view, ctx);
        const std::size_t stored = got.size() / (kTilePixels + 1) * kTilePixels;
        for (std::size_t i = 0; i < stored; ++i)
            ASSERT_EQ(int{got[i]}, int{want[i]})
                << table.isa << ", seed " << seed << ", byte " << i;
    }
}

TEST_P(KernelTest, NineBitBlendsOfEveryKind) {
    check_blend(table(), &KernelTable::blend_nine_bit, 255);
}

TEST_P(KernelTest, WideBlendsOfEveryKind) {
    check_blend(table(), &KernelTable::blend_wide, 16384);
}

// (s a + d (255 - a)) / 255 to nearest, for all s, a and d: H13.
TEST_P(KernelTest, AlphaBlendOfEveryByte) {
    BlendCtx ctx{{0, 1, 2, 3},
                 StoreFormat::rgba8,
                 BlendSum::add,
                 {BlendOperand::source_alpha, 0},
                 {BlendOperand::source_alpha, 1},
                 {},
                 nullptr};
    AlignedVector<std::uint8_t> tile(4 * (kTilePixels + 1));
    ctx.tile = tile.data();
    PacketMemory packet;
    packet.count = PacketMemory::kBytes;
    Packet view = packet.view();
    for (int a = 0; a < 256; ++a) {
        for (int s = 0; s < 256; s += 3) {
            for (int d = 0; d < 256; ++d) {
                const auto i = static_cast<std::size_t>(d);
                for (int c = 0; c < 4; ++c) {
                    packet.plane(c)[d] =
                        static_cast<std::int16_t>(c == 3 ? a : std::min(s + c, 255));
                    tile[4 * i + static_cast<std::size_t>(c)] = static_cast<std::uint8_t>(d);
                }
            }
            table().blend_nine_bit(view, ctx);
            for (int i = 0; i < 4 * packet.count; ++i) {
                const int c = i % 4, source = c == 3 ? a : std::min(s + c, 255);
                const int sum = source * a + i / 4 * (255 - a);
                ASSERT_EQ(tile[static_cast<std::size_t>(i)], (2 * sum + 255) / 510)
                    << name("blend") << ": s " << source << ", a " << a << ", d " << i / 4;
            }
        }
    }
}

// ---- tests after shading

/// Some fragments that are dropped already.
AlignedVector<std::uint16_t> stored_pixels(const PacketMemory& packet, Random& random) {
    AlignedVector<std::uint16_t> stored(packet.pixels.begin(), packet.pixels.begin() + kPacketSize);
    for (std::uint16_t& pixel : stored)
        if (random.chance(5)) pixel = kNoPixel;
    return stored;
}

template <class Ctx>
void expect_same_pixels(const KernelTable& table,
                        void (*KernelTable::*stage)(Packet&, const Ctx&) noexcept,
                        PacketMemory& packet, Ctx ctx, const AlignedVector<std::uint16_t>& before) {
    AlignedVector<std::uint16_t> got = before, want = before;
    Packet view = packet.view();
    ctx.stored = got.data();
    (table.*stage)(view, ctx);
    ctx.stored = want.data();
    (table_reference().*stage)(view, ctx);
    for (int i = 0; i < packet.count; ++i)
        ASSERT_EQ(got[static_cast<std::size_t>(i)], want[static_cast<std::size_t>(i)])
            << table.isa << ", fragment " << i << " of " << packet.count;
}

TEST_P(KernelTest, AlphaTestsOfEveryKind) {
    for (unsigned seed = 0; seed < 400; ++seed) {
        Random random(seed);
        PacketMemory packet;
        packet.count = random.between(1, kPacketSize);
        packet.shuffle_pixels(random);
        const auto reference = static_cast<std::int16_t>(random.between(0, 16384));
        for (int i = 0; i < kPacketSize; ++i)
            packet.plane(2)[i] = static_cast<std::int16_t>(
                random.chance(3) ? reference : reference + random.between(-20, 20));
        for (int pass = 0; pass < 8; ++pass) {
            const auto bit = [&](int k) { return static_cast<std::uint8_t>(pass >> k & 1); };
            ASSERT_NO_FATAL_FAILURE(
                expect_same_pixels(table(), &KernelTable::alpha_test, packet,
                                   AlphaTestCtx{2, reference, bit(0), bit(1), bit(2), nullptr},
                                   stored_pixels(packet, random)));
        }
    }
}

TEST_P(KernelTest, OnlyWhatIsAboveZeroIsKept) {
    Random random(1);
    PacketMemory packet;
    packet.shuffle_pixels(random);
    const std::array<float, 8> values{0.0F, -0.0F, 1e-45F, -1e-45F, 1.0F, -1.0F, kNan, 3e38F};
    for (const int count : {kPacketSize, 255, 33, 1}) {
        packet.count = count;
        for (int i = 0; i < kPacketSize; ++i) packet.attribute(3)[i] = random.pick(values);
        ASSERT_NO_FATAL_FAILURE(expect_same_pixels(table(), &KernelTable::keep, packet,
                                                   KeepCtx{3, nullptr},
                                                   stored_pixels(packet, random)));
        AlignedVector<std::uint16_t> stored(packet.pixels.begin(), packet.pixels.end());
        Packet view = packet.view();
        table().keep(view, {3, stored.data()});
        for (int i = 0; i < count; ++i)
            ASSERT_EQ(stored[static_cast<std::size_t>(i)] != kNoPixel,
                      packet.attribute(3)[i] > 0.0F);
    }
}

struct LateTile {
    AlignedVector<float> depth, block_far;
    explicit LateTile(Random& random) : depth(kTilePixels), block_far(kTileBlocks, 0.0F) {
        for (std::size_t i = 0; i < kTilePixels; ++i) {
            depth[i] = static_cast<float>(random.between(0, 8)) * 0.125F;
            float& far = block_far[i / kBlockPixels];
            far = std::max(far, depth[i]);
        }
    }
};

TEST_P(KernelTest, LateDepthTestsOfEveryKind) {
    const std::array<float, 10> depths{0.0F, 0.125F, 0.25F, 0.5F,  0.75F,
                                       1.0F, -0.1F,  1.1F,  1e30F, kNan};
    for (unsigned seed = 0; seed < 2000; ++seed) {
        Random random(seed);
        PacketMemory packet;
        packet.count = random.between(1, kPacketSize);
        packet.shuffle_pixels(random);
        std::vector<DepthRun> runs;
        for (int first = 0; first < packet.count;) {
            const int count = std::min(random.between(1, 90), packet.count - first);
            DepthRun run{
                0.5F,  random.real(-0.01F, 0.01F), random.real(-0.01F, 0.01F), 0.0F, 1.0F, first,
                count, random.between(-40, 40),    random.between(-40, 40)};
            if (random.chance(2)) run.zx = run.zy = 0.0F;
            run.z_low = random.real(0.0F, 0.5F);
            runs.push_back(run);
            first += count;
        }
        for (int i = 0; i < kPacketSize; ++i) packet.attribute(4)[i] = random.pick(depths);
        LateTile got(random);
        LateTile want = got;
        const auto flag = [&] { return static_cast<std::uint8_t>(random.below(2)); };
        LateDepthCtx ctx{runs.data(),
                         static_cast<int>(runs.size()),
                         random.chance(2) ? 4 : -1,
                         flag(),
                         flag(),
                         flag(),
                         flag(),
                         got.depth.data(),
                         got.block_far.data(),
                         nullptr};
        const AlignedVector<std::uint16_t> before = stored_pixels(packet, random);
        AlignedVector<std::uint16_t> got_pixels = before, want_pixels = before;
        Packet view = packet.view();
        ctx.stored = got_pixels.data();
        table().late_depth(view, ctx);
        ctx.depth = want.depth.data();
        ctx.block_far = want.block_far.data();
        ctx.stored = want_pixels.data();
        table_reference().late_depth(view, ctx);
        for (int i = 0; i < packet.count; ++i)
            ASSERT_EQ(got_pixels[static_cast<std::size_t>(i)],
                      want_pixels[static_cast<std::size_t>(i)])
                << name("late_depth") << ", seed " << seed << ", fragment " << i;
        ASSERT_EQ(got.depth, want.depth) << name("late_depth") << ", seed " << seed;
        ASSERT_EQ(got.block_far, want.block_far) << name("late_depth") << ", seed " << seed;
        for (std::size_t i = 0; i < kTilePixels; ++i)
            ASSERT_GE(got.block_far[i / kBlockPixels], got.depth[i]) << "seed " << seed;
    }
}

}  // namespace
}  // namespace burnish
