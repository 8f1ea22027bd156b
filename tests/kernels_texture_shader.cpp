#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include "kernel_test.hpp"

/// The stages between two texture fetches: numbers worked out by hand on every table, then each
/// table against the reference.
namespace burnish {
namespace {

INSTANTIATE_TEST_SUITE_P(Isa, KernelTest, every_table(), isa_name);

constexpr std::array kSpecials{0.0F,   -0.0F, 1.0F,   -1.0F, kInfinity, -kInfinity, kNan,
                               1e-45F, 3e38F, -3e38F, 0.5F,  127.5F,    1e-20F,     -1e20F};

template <class Ctx>
using Stage = void (*KernelTable::*)(Packet&, const Ctx&) noexcept;

/// Plane `to` of fragment 0 after a stage on attribute planes 0, 1, ... of these values.
template <class Ctx>
float one_result(const KernelTable& table, Stage<Ctx> stage, const Ctx& ctx,
                 const std::vector<float>& values, int to) {
    PacketMemory packet;
    packet.count = 1;
    for (std::size_t k = 0; k < values.size(); ++k)
        packet.attribute(static_cast<int>(k))[0] = values[k];
    Packet view = packet.view();
    (table.*stage)(view, ctx);
    return packet.attribute(to)[0];
}

/// Random numbers in attribute planes 0 .. 11, one in `one_in` of them special.
PacketMemory random_packet(Random& random, int one_in) {
    PacketMemory packet;
    packet.count = random.chance(3) ? kPacketSize : random.between(1, kPacketSize);
    for (int k = 0; k < 12; ++k) {
        for (int i = 0; i < packet.count; ++i)
            packet.attribute(k)[i] =
                random.chance(one_in) ? random.pick(kSpecials) : random.real(-3.0F, 3.0F);
    }
    return packet;
}

template <class Ctx>
void check(const KernelTable& table, const char* name, Stage<Ctx> stage, const Ctx& ctx,
           const std::vector<int>& written) {
    for (unsigned seed = 0; seed < 300; ++seed) {
        Random random(seed);
        const PacketMemory packet = random_packet(random, 1 + static_cast<int>(seed % 7) * 5);
        ASSERT_EQ(stage_difference(table, stage, packet, ctx, {.attributes = written}), "")
            << table.isa << ' ' << name << ", seed " << seed;
    }
}

// --- by hand

float decoded(const KernelTable& table, Stage<DecodeCtx> stage, Reading reading, int code) {
    PacketMemory packet;
    packet.count = 1;
    packet.plane(5)[0] = static_cast<std::int16_t>(code);
    Packet view = packet.view();
    (table.*stage)(view, {5, 3, reading});
    return packet.attribute(3)[0];
}

TEST_P(KernelTest, NineBitCodesAsNumbers) {
    const auto number = [&](Reading reading, int code) {
        return decoded(table(), &KernelTable::decode_nine_bit, reading, code);
    };
    EXPECT_EQ(number(Reading::unsigned_texel, 255), 1.0F);
    EXPECT_EQ(number(Reading::unsigned_texel, 51), 0.2F);
    EXPECT_EQ(number(Reading::signed_texel, 254), 127.0F / 128.0F);  // 2 n for n = 127
    EXPECT_EQ(number(Reading::signed_texel, -256), -1.0F);
    EXPECT_EQ(number(Reading::expanded, 0), -1.0F);
    EXPECT_EQ(number(Reading::expanded, 255), 1.0F);
    EXPECT_EQ(number(Reading::expanded, 128), 0.5F / 127.5F);
    EXPECT_EQ(number(Reading::expanded, -9), -1.0F);
    EXPECT_EQ(number(Reading::two_complement, 127), 127.0F / 128.0F);
    EXPECT_EQ(number(Reading::two_complement, 128), -1.0F);
    EXPECT_EQ(number(Reading::two_complement, 255), -1.0F / 128.0F);
    EXPECT_EQ(number(Reading::nv2a_d3d, 255), 1.0F);
    EXPECT_EQ(number(Reading::nv2a_d3d, 0), -128.0F / 127.0F);
    EXPECT_EQ(number(Reading::nv2a_gl, 127), 1.0F);
    EXPECT_EQ(number(Reading::nv2a_gl, 128), -1.0F);
    EXPECT_EQ(number(Reading::nv2a_signed, 127), 1.0F);
    EXPECT_EQ(number(Reading::nv2a_signed, 129), -1.0F);
}

TEST_P(KernelTest, WideCodesAsNumbers) {
    const auto number = [&](Reading reading, int code) {
        return decoded(table(), &KernelTable::decode_wide, reading, code);
    };
    EXPECT_EQ(number(Reading::unsigned_texel, 16384), 1.0F);
    EXPECT_EQ(number(Reading::signed_texel, -16384), -1.0F);
    EXPECT_EQ(number(Reading::unsigned_texel, -32768), -2.0F);
    EXPECT_EQ(number(Reading::expanded, 8192), 0.0F);
    EXPECT_EQ(number(Reading::expanded, 16384), 1.0F);
    EXPECT_EQ(number(Reading::expanded, -100), -1.0F);
}

TEST_P(KernelTest, DotsOffsetsAndQuotientsByHand) {
    // 2 * 3 + 4 * 5 - 6 * 7
    EXPECT_EQ(one_result(table(), &KernelTable::dot_product, DotCtx{{0, 2, 4}, {1, 3, 5}, 6},
                         {2.0F, 3.0F, 4.0F, 5.0F, -6.0F, 7.0F}, 6),
              -16.0F);
    // The order: (1e8 - 1e8) + 1, not 1e8 + (1 - 1e8), which is 0.
    EXPECT_EQ(one_result(table(), &KernelTable::dot_product, DotCtx{{0, 1, 2}, {3, 3, 3}, 6},
                         {1e8F, -1e8F, 1.0F, 1.0F}, 6),
              1.0F);
    EXPECT_EQ(
        one_result(table(), &KernelTable::affine, AffineCtx{0, 1, 2.0F, -1.0F, 4.0F}, {5.0F}, 1),
        2.25F);
    // s = 6 / 2 + 0.5 * 4 - 1 * 8, t = 10 / 2 + 0.25 * 4 + 2 * 8
    const OffsetCtx projective{0, 1, 2, 3, 4, {0.5F, 0.25F, -1.0F, 2.0F}, 6};
    const std::vector<float> at{6.0F, 10.0F, 2.0F, 4.0F, 8.0F};
    EXPECT_EQ(one_result(table(), &KernelTable::offset, projective, at, 6), -3.0F);
    EXPECT_EQ(one_result(table(), &KernelTable::offset, projective, at, 7), 22.0F);
    OffsetCtx plain = projective;
    plain.q = -1;
    EXPECT_EQ(one_result(table(), &KernelTable::offset, plain, at, 6), 0.0F);
    EXPECT_EQ(one_result(table(), &KernelTable::quotient, QuotientCtx{0, 1, 2}, {3.0F, 4.0F}, 2),
              0.75F);
    // A quarter of a turn minus three quarters is half a turn; 0.75 - 0.25 too.
    EXPECT_EQ(one_result(table(), &KernelTable::angle, AngleCtx{0, 1, 2}, {0.25F, 0.75F}, 2), 0.5F);
    EXPECT_EQ(one_result(table(), &KernelTable::angle, AngleCtx{0, 1, 2}, {0.75F, 0.25F}, 2), 0.5F);
}

TEST_P(KernelTest, HemispheresByHand) {
    const auto z = [&](float x, float y) {
        return one_result(table(), &KernelTable::hemisphere, HemisphereCtx{0, 1, 2}, {x, y}, 2);
    };
    EXPECT_EQ(z(0.0F, 0.0F), 1.0F);
    EXPECT_EQ(z(0.5F, 0.5F), std::sqrt(0.5F));
    EXPECT_EQ(z(1.0F, 0.5F), 0.0F);
    EXPECT_EQ(z(kNan, 0.5F), 0.0F);
}

// Mirrored at the diagonal of the xz plane, of any length: (0, 0, 1) goes to (1, 0, 0).
TEST_P(KernelTest, ReflectionsByHand) {
    for (const float length : {1.0F, 3.0F}) {
        for (int c = 0; c < 3; ++c) {
            EXPECT_EQ(
                one_result(table(), &KernelTable::reflect, ReflectCtx{{0, 1, 2}, {3, 4, 5}, 6},
                           {length, 0.0F, length, 0.0F, 0.0F, 1.0F}, 6 + c),
                c == 0 ? 1.0F : 0.0F);
        }
    }
}

TEST_P(KernelTest, CullingByHand) {
    const auto kept = [&](const std::array<float, 4>& x, const std::array<int, 4>& less,
                          float also = 1.0F) {
        CullCtx ctx{{0, 1, 2, 3}, {}, 4, 5};
        for (std::size_t c = 0; c < 4; ++c) ctx.less[c] = static_cast<std::uint8_t>(less[c]);
        return one_result(table(), &KernelTable::cull, ctx, {x[0], x[1], x[2], x[3], also}, 5);
    };
    EXPECT_EQ(kept({0.0F, -0.0F, 1.0F, kInfinity}, {0, 0, 0, 0}), 1.0F);
    EXPECT_EQ(kept({0.0F, -1e-45F, 1.0F, 1.0F}, {0, 0, 0, 0}), 0.0F);
    EXPECT_EQ(kept({0.0F, -1e-45F, 1.0F, 1.0F}, {0, 1, 0, 0}), 1.0F);
    EXPECT_EQ(kept({-1.0F, -1.0F, -1.0F, -0.0F}, {1, 1, 1, 1}), 0.0F);
    EXPECT_EQ(kept({kNan, 0.0F, 0.0F, 0.0F}, {0, 0, 0, 0}), 0.0F);
    EXPECT_EQ(kept({kNan, 0.0F, 0.0F, 0.0F}, {1, 0, 0, 0}), 0.0F);
    EXPECT_EQ(kept({0.0F, 0.0F, 0.0F, 0.0F}, {0, 0, 0, 0}, 0.0F), 0.0F);
}

// --- against the reference

TEST_P(KernelTest, DecodesEveryRegister) {
    for (int reading = 0; reading <= static_cast<int>(Reading::nv2a_signed); ++reading) {
        for (int base = -32768; base < 32768; base += PacketMemory::kBytes) {
            PacketMemory packet;
            packet.count = PacketMemory::kBytes;
            for (int i = 0; i < packet.count; ++i)
                packet.plane(7)[i] = static_cast<std::int16_t>(base + i);
            const DecodeCtx ctx{7, 4, static_cast<Reading>(reading)};
            const Written written{.attributes = {4}};
            if (base >= -256 && base < 256) {
                ASSERT_EQ(
                    stage_difference(table(), &KernelTable::decode_nine_bit, packet, ctx, written),
                    "")
                    << table().isa << " reading " << reading;
            }
            if (ctx.reading > Reading::expanded) continue;
            ASSERT_EQ(stage_difference(table(), &KernelTable::decode_wide, packet, ctx, written),
                      "")
                << table().isa << " reading " << reading << ", codes from " << base;
        }
    }
}

TEST_P(KernelTest, ArithmeticOfRandomNumbers) {
    check(table(), "affine", &KernelTable::affine, AffineCtx{2, 15, 1.7F, -0.3F, 0.9F}, {15});
    check(table(), "affine in place", &KernelTable::affine, AffineCtx{2, 2, 2.0F, -1.0F, 1.0F},
          {2});
    check(table(), "dot_product", &KernelTable::dot_product, DotCtx{{0, 4, 2}, {5, 1, 0}, 15},
          {15});
    check(table(), "hemisphere", &KernelTable::hemisphere, HemisphereCtx{3, 8, 15}, {15});
    check(table(), "offset", &KernelTable::offset,
          OffsetCtx{0, 1, -1, 2, 3, {0.1F, -2.0F, 0.7F, 1.3F}, 15}, {15, 16});
    check(table(), "projective offset", &KernelTable::offset,
          OffsetCtx{0, 1, 7, 2, 3, {0.1F, -2.0F, 0.7F, 1.3F}, 15}, {15, 16});
    check(table(), "reflect", &KernelTable::reflect, ReflectCtx{{0, 1, 2}, {9, 4, 5}, 15},
          {15, 16, 17});
    check(table(), "quotient", &KernelTable::quotient, QuotientCtx{6, 3, 15}, {15});
    check(table(), "angle", &KernelTable::angle, AngleCtx{6, 3, 15}, {15});
}

TEST_P(KernelTest, CullingOfRandomNumbers) {
    for (int tests = 0; tests < 16; ++tests) {
        CullCtx ctx{{3, 0, 5, 1}, {}, -1, 15};
        for (int c = 0; c < 4; ++c) ctx.less[c] = static_cast<std::uint8_t>(tests >> c & 1);
        check(table(), "cull", &KernelTable::cull, ctx, {15});
        ctx.also = 2;
        check(table(), "cull further", &KernelTable::cull, ctx, {15});
        ctx.keep = 2;
        check(table(), "cull in place", &KernelTable::cull, ctx, {2});
    }
}

void check_dim(const KernelTable& table, Stage<MagnitudeCtx> stage, int low, int high, int one) {
    for (unsigned seed = 0; seed < 600; ++seed) {
        Random random(seed);
        PacketMemory packet;
        packet.count = random.chance(3) ? kPacketSize : random.between(1, kPacketSize);
        for (int i = 0; i < packet.count; ++i) {
            packet.plane(20)[i] = static_cast<std::int16_t>(random.between(0, one));
            for (int c = 0; c < 4; ++c)
                packet.plane(4 + c)[i] = static_cast<std::int16_t>(random.between(low, high));
        }
        MagnitudeCtx ctx{20, 4, 9, random.real(-3.0F, 3.0F), random.real(-1.0F, 1.0F), 0};
        ctx.clamp_factor = random.chance(2) ? 1 : 0;
        if (random.chance(9)) ctx.scale = random.pick(kSpecials);
        Written written{.planes = {9, 10, 11, 12}};
        if (random.chance(2)) {
            ctx.to = ctx.from;
            written.planes = {4, 5, 6};
        }
        ASSERT_EQ(stage_difference(table, stage, packet, ctx, written), "")
            << table.isa << ", seed " << seed;
    }
}

TEST_P(KernelTest, DimmedTexels) {
    check_dim(table(), &KernelTable::dim_nine_bit, -256, 255, 255);
    check_dim(table(), &KernelTable::dim_wide, -32768, 32767, 16384);
}

}  // namespace
}  // namespace burnish
