#include <array>
#include <vector>

#include "kernel_test.hpp"

/// General combiner portions: products, mappings, scales and the three outputs.
namespace burnish {
namespace {

INSTANTIATE_TEST_SUITE_P(Isa, KernelTest, every_table(), isa_name);

using PortionStage = void (*KernelTable::*)(Packet&, const PortionCtx&) noexcept;

/// Planes of the tests: operands 0 .. 11, the mux plane, nine outputs, a place for unused ones.
constexpr std::int16_t kMuxPlane = 12;
constexpr std::int16_t kOutputs = 14;
constexpr std::int16_t kTrash = 30;
constexpr int kMappings = 8;

struct ScaleBias {
    OutputScale scale;
    std::uint8_t bias;
};
constexpr std::array<ScaleBias, 6> kScales{{{OutputScale::one, 0},
                                            {OutputScale::one, 1},
                                            {OutputScale::two, 0},
                                            {OutputScale::two, 1},
                                            {OutputScale::four, 0},
                                            {OutputScale::half, 0}}};

Operand operand(int first, int mapping) {
    return {{static_cast<std::int16_t>(first), static_cast<std::int16_t>(first + 1),
             static_cast<std::int16_t>(first + 2)},
            static_cast<std::uint8_t>(mapping)};
}

PortionCtx portion(ProductKind kind, ThirdKind third, ScaleBias scale, int components) {
    PortionCtx ctx{};
    ctx.a = operand(0, 6);
    ctx.b = operand(3, 6);
    ctx.c = operand(6, 6);
    ctx.d = operand(9, 6);
    ctx.ab = ctx.cd = kind;
    ctx.third = third;
    ctx.scale = scale.scale;
    ctx.bias_minus_half = scale.bias;
    ctx.components = static_cast<std::uint8_t>(components);
    ctx.mux_plane = kMuxPlane;
    for (int c = 0; c < 3; ++c) {
        ctx.ab_out[c] = static_cast<std::int16_t>(kOutputs + c);
        ctx.cd_out[c] = static_cast<std::int16_t>(kOutputs + 3 + c);
        ctx.third_out[c] = static_cast<std::int16_t>(kOutputs + 6 + c);
    }
    return ctx;
}

/// The planes that a portion writes; unused outputs go to the trash plane as the contract says.
Written outputs_of(PortionCtx& ctx) {
    Written written;
    written.trash_plane = kTrash;
    for (int c = 0; c < 3; ++c) {
        if (ctx.cd == ProductKind::none) ctx.cd_out[c] = kTrash;
        if (ctx.third == ThirdKind::none) ctx.third_out[c] = kTrash;
    }
    for (int c = 0; c < ctx.components; ++c)
        for (const int k : {ctx.ab_out[c], ctx.cd_out[c], ctx.third_out[c]})
            if (k != kTrash) written.planes.push_back(k);
    return written;
}

void fill(PacketMemory& packet, int plane, int value) {
    std::fill_n(packet.plane(plane), kPacketSize, static_cast<std::int16_t>(value));
}

// The claim "no ties, nearest" covers every pair of mapped operands: 512^2 pairs of registers under
// all 64 pairs of mappings contain all 513^2 products.
void check_every_nine_bit_product(const KernelTable& table, ProductKind kind,
                                  Rounding rounding = Rounding::nearest) {
    PacketMemory packet;
    packet.count = PacketMemory::kBytes;
    fill(packet, kMuxPlane, 0);
    for (int pair = 0; pair < kMappings * kMappings; ++pair) {
        PortionCtx ctx = portion(kind, ThirdKind::sum, kScales[0], 3);
        ctx.rounding = rounding;
        ctx.a.mapping = ctx.d.mapping = static_cast<std::uint8_t>(pair / kMappings);
        ctx.b.mapping = ctx.c.mapping = static_cast<std::uint8_t>(pair % kMappings);
        const Written written = outputs_of(ctx);
        for (int y = 0; y < 2; ++y) {
            for (int k : {3, 4, 5, 6, 7, 8})
                for (int i = 0; i < packet.count; ++i)
                    packet.plane(k)[i] = static_cast<std::int16_t>(y * 256 + i - 256);
            for (int x = -256; x < 256; x += 3) {
                for (int k = 0; k < 3; ++k) {
                    fill(packet, k, std::min(x + k, 255));
                    fill(packet, 9 + k, std::min(x + k, 255));
                }
                const std::string text =
                    stage_difference(table, &KernelTable::portion_nine_bit, packet, ctx, written);
                ASSERT_EQ(text, "") << table.isa << " portion_nine_bit, mappings " << pair / 8
                                    << ", " << pair % 8 << ", register " << x;
            }
        }
    }
}

TEST_P(KernelTest, NineBitMultiplyOfEveryPairOfOperands) {
    check_every_nine_bit_product(table(), ProductKind::multiply);
}

TEST_P(KernelTest, NineBitDotOfEveryPairOfOperands) {
    check_every_nine_bit_product(table(), ProductKind::dot);
}

TEST_P(KernelTest, NineBitTruncatedMultiplyOfEveryPairOfOperands) {
    check_every_nine_bit_product(table(), ProductKind::multiply, Rounding::truncate);
}

TEST_P(KernelTest, NineBitShiftedMultiplyOfEveryPairOfOperands) {
    check_every_nine_bit_product(table(), ProductKind::multiply, Rounding::shift8);
}

// expand and half_bias with 1/2 = 127.5, of every register, whatever products do.
TEST_P(KernelTest, NineBitIdealHalvesOfEveryRegister) {
    PacketMemory packet;
    packet.count = PacketMemory::kBytes;
    fill(packet, kMuxPlane, 0);
    for (int k = 3; k < 12; ++k) fill(packet, k, 255);
    for (const Rounding rounding : {Rounding::nearest, Rounding::truncate, Rounding::shift8}) {
        for (int mapping = 2; mapping < 6; ++mapping) {
            PortionCtx ctx = portion(ProductKind::multiply, ThirdKind::none, kScales[0], 3);
            ctx.rounding = rounding;
            ctx.a.mapping = ctx.d.mapping =
                static_cast<std::uint8_t>(Operand::kIdealHalf + mapping);
            const Written written = outputs_of(ctx);
            for (const int first : {-256, 0}) {
                for (const int k : {0, 1, 2, 9, 10, 11})
                    for (int i = 0; i < packet.count; ++i)
                        packet.plane(k)[i] = static_cast<std::int16_t>(first + i);
                ASSERT_EQ(
                    stage_difference(table(), &KernelTable::portion_nine_bit, packet, ctx, written),
                    "")
                    << name("portion_nine_bit") << ", mapping " << mapping << ", from " << first;
            }
        }
    }
}

// Squares have a short product of their own: every register under every mapping.
TEST_P(KernelTest, NineBitSquareOfEveryOperand) {
    PacketMemory packet;
    packet.count = PacketMemory::kBytes;
    for (int mapping = 0; mapping < kMappings; ++mapping) {
        for (const ProductKind kind : {ProductKind::multiply, ProductKind::dot}) {
            PortionCtx ctx = portion(kind, ThirdKind::none, kScales[1], 1);
            ctx.a.mapping = static_cast<std::uint8_t>(mapping);
            ctx.b = ctx.a;
            ctx.cd = ProductKind::none;
            const Written written = outputs_of(ctx);
            for (const int first : {-256, 0}) {
                for (int k = 0; k < 3; ++k)
                    for (int i = 0; i < packet.count; ++i)
                        packet.plane(k)[i] = static_cast<std::int16_t>(first + i);
                ASSERT_EQ(
                    stage_difference(table(), &KernelTable::portion_nine_bit, packet, ctx, written),
                    "")
                    << name("portion_nine_bit") << ", mapping " << mapping << ", from " << first;
            }
        }
    }
}

/// Sets one fragment so that the sum of six products with one is `sum`, as far as registers reach.
void set_sum(PacketMemory& packet, int i, int sum, int low, int high, int one) {
    for (int k = 0; k < 6; ++k) {
        const int part = std::clamp(sum / (6 - k), low, high);
        sum -= part;
        const int plane = k < 3 ? k : k + 3;
        packet.plane(plane)[i] = static_cast<std::int16_t>(part);
        packet.plane(plane + 3)[i] = static_cast<std::int16_t>(one);
    }
}

// Two dots of registers with one reach every sum from 6 * low to 6 * high.
void check_every_sum(const KernelTable& table, PortionStage stage, int low, int high, int one) {
    PacketMemory packet;
    fill(packet, kMuxPlane, one);
    for (int first = 6 * low; first <= 6 * high; first += kPacketSize) {
        for (int i = 0; i < kPacketSize; ++i) set_sum(packet, i, first + i, low, high, one);
        for (const ScaleBias& scale : kScales) {
            for (const bool wide : {false, true}) {
                if (wide && one == 255) continue;
                PortionCtx ctx = portion(ProductKind::dot, ThirdKind::sum, scale, 1);
                ctx.wide = wide ? 1 : 0;
                const Written written = outputs_of(ctx);
                ASSERT_EQ(stage_difference(table, stage, packet, ctx, written), "")
                    << table.isa << " portion, one " << one << ", sums from " << first << ", scale "
                    << static_cast<int>(scale.scale) << ", bias " << int{scale.bias} << ", wide "
                    << wide;
            }
        }
    }
}

TEST_P(KernelTest, NineBitScaleAndBiasOfEverySum) {
    check_every_sum(table(), &KernelTable::portion_nine_bit, -256, 255, 255);
}

TEST_P(KernelTest, WideScaleAndBiasOfEverySum) {
    check_every_sum(table(), &KernelTable::portion_wide, -32768, 32767, 16384);
}

TEST_P(KernelTest, WideMappingsOfEveryRegister) {
    PacketMemory packet;
    fill(packet, kMuxPlane, 0);
    for (int k = 3; k < 12; ++k) fill(packet, k, 16384);
    for (int mapping = 0; mapping < kMappings; ++mapping) {
        for (const std::size_t scale : {0U, 1U, 5U}) {
            PortionCtx ctx = portion(ProductKind::multiply, ThirdKind::sum, kScales[scale], 3);
            ctx.a.mapping = static_cast<std::uint8_t>(mapping);
            ctx.wide = 1;
            const Written written = outputs_of(ctx);
            for (int first = -32768; first < 32768; first += kPacketSize) {
                for (int k = 0; k < 3; ++k)
                    for (int i = 0; i < kPacketSize; ++i)
                        packet.plane(k)[i] = static_cast<std::int16_t>(first + i);
                ASSERT_EQ(
                    stage_difference(table(), &KernelTable::portion_wide, packet, ctx, written), "")
                    << name("portion_wide") << ", mapping " << mapping << ", register " << first;
            }
        }
    }
}

/// Ends and middles of the range, and what makes ties of a product: odd multiples of powers of 2.
std::vector<std::int16_t> wide_extremes() {
    std::vector<std::int16_t> values{-32768, -32767, 32766, 32767, 0, 3, -3, 12345, -12345, 24575};
    for (int bit = 0; bit < 15; ++bit) {
        for (const int nearby : {-1, 0, 1}) {
            values.push_back(static_cast<std::int16_t>((1 << bit) + nearby));
            values.push_back(static_cast<std::int16_t>(-(1 << bit) + nearby));
        }
    }
    return values;
}

// Every register times every extreme: 16 ties per even power of two, both signs.
TEST_P(KernelTest, WideProductsOfEveryRegisterWithExtremes) {
    PacketMemory packet;
    fill(packet, kMuxPlane, 8192);
    const std::vector<std::int16_t> extremes = wide_extremes();
    for (std::size_t e = 0; e + 2 < extremes.size(); e += 3) {
        for (int k = 0; k < 3; ++k) {
            fill(packet, 3 + k, extremes[e + static_cast<std::size_t>(k)]);
            fill(packet, 6 + k, extremes[e + static_cast<std::size_t>(k)]);
        }
        for (int first = -32768; first < 32768; first += kPacketSize) {
            for (const int k : {0, 1, 2, 9, 10, 11})
                for (int i = 0; i < kPacketSize; ++i)
                    packet.plane(k)[i] = static_cast<std::int16_t>(first + i);
            PortionCtx ctx = portion(ProductKind::multiply, ThirdKind::mux, kScales[0], 3);
            ctx.cd = ProductKind::dot;
            ctx.wide = 1;
            const Written written = outputs_of(ctx);
            ASSERT_EQ(stage_difference(table(), &KernelTable::portion_wide, packet, ctx, written),
                      "")
                << name("portion_wide") << ", register " << first << ", extreme " << extremes[e];
        }
    }
}

PortionCtx random_portion(Random& random) {
    constexpr std::array kKinds{ProductKind::multiply, ProductKind::dot, ProductKind::none};
    constexpr std::array kThirds{ThirdKind::none, ThirdKind::sum, ThirdKind::mux};
    PortionCtx ctx = portion(kKinds[static_cast<std::size_t>(random.below(2))],
                             random.pick(kThirds), random.pick(kScales), random.chance(2) ? 1 : 3);
    ctx.cd = random.pick(kKinds);
    if (ctx.cd == ProductKind::none) ctx.third = ThirdKind::none;
    ctx.wide = static_cast<std::uint8_t>(random.below(2));
    for (Operand* o : {&ctx.a, &ctx.b, &ctx.c, &ctx.d}) {
        o->mapping = static_cast<std::uint8_t>(random.below(kMappings));
        // Inputs may share planes in every way: a colour with itself, one component three times.
        for (std::int16_t& plane : o->plane)
            plane = static_cast<std::int16_t>(random.chance(4) ? o->plane[0] : random.below(13));
    }
    if (random.chance(4)) ctx.b = ctx.a;
    if (random.chance(4)) ctx.d = ctx.b;  // two vectors by one
    return ctx;
}

/// The choices that only the nine-bit model has.
void choose(Random& random, PortionCtx& ctx) {
    ctx.halve_down = static_cast<std::uint8_t>(random.below(2));
    ctx.mux_lsb = static_cast<std::uint8_t>(random.below(2));
    if (random.chance(2)) return;
    ctx.rounding = random.pick(std::array{Rounding::nearest, Rounding::truncate, Rounding::shift8});
    for (Operand* o : {&ctx.a, &ctx.b, &ctx.c, &ctx.d}) {
        const bool has_half = o->mapping >= 2 && o->mapping <= 5;
        if (has_half && random.chance(2))
            o->mapping = static_cast<std::uint8_t>(o->mapping + Operand::kIdealHalf);
    }
}

void check_random_portions(const KernelTable& table, PortionStage stage, int rounds,
                           const std::vector<std::int16_t>& extremes, int low, int high,
                           bool bounded = false) {
    for (int seed = 0; seed < rounds; ++seed) {
        Random random(static_cast<unsigned>(seed));
        PacketMemory packet;
        packet.count = random.chance(3) ? kPacketSize : random.between(1, kPacketSize);
        for (int k = 0; k <= kMuxPlane; ++k) {
            for (int i = 0; i < packet.count; ++i) {
                packet.plane(k)[i] = random.chance(3)
                                         ? random.pick(extremes)
                                         : static_cast<std::int16_t>(random.between(low, high));
            }
        }
        for (int variant = 0; variant < 40; ++variant) {
            PortionCtx ctx = random_portion(random);
            ctx.bounded = bounded ? 1 : 0;
            if (stage == &KernelTable::portion_nine_bit) {
                ctx.wide = 0;
                choose(random, ctx);
            }
            const Written written = outputs_of(ctx);
            ASSERT_EQ(stage_difference(table, stage, packet, ctx, written), "")
                << table.isa << " portion, seed " << seed << ", variant " << variant << ", ab "
                << static_cast<int>(ctx.ab) << ", cd " << static_cast<int>(ctx.cd) << ", third "
                << static_cast<int>(ctx.third) << ", scale " << static_cast<int>(ctx.scale)
                << ", rounding " << static_cast<int>(ctx.rounding) << ", halve down "
                << int{ctx.halve_down} << ", lsb " << int{ctx.mux_lsb} << ", bias "
                << int{ctx.bias_minus_half} << ", components " << int{ctx.components}
                << ", mappings " << int{ctx.a.mapping} << int{ctx.b.mapping} << int{ctx.c.mapping}
                << int{ctx.d.mapping};
        }
    }
}

TEST_P(KernelTest, NineBitPortionsOfEveryKind) {
    check_random_portions(table(), &KernelTable::portion_nine_bit, 400,
                          {-256, -255, -128, -1, 0, 1, 127, 128, 129, 254, 255}, -256, 255);
}

TEST_P(KernelTest, WidePortionsOfEveryKind) {
    check_random_portions(table(), &KernelTable::portion_wide, 400, wide_extremes(), -32768, 32767);
}

/// The extremes that are not beyond 1.
std::vector<std::int16_t> bounded_extremes() {
    std::vector<std::int16_t> values = wide_extremes();
    std::erase_if(values, [](int x) { return x < -16384 || x > 16384; });
    return values;
}

// Ones of both signs are frequent, since they are what leaves the 16 bits.
TEST_P(KernelTest, BoundedPortionsOfEveryKind) {
    check_random_portions(table(), &KernelTable::portion_wide, 60, bounded_extremes(), -16384,
                          16384, true);
    check_random_portions(table(), &KernelTable::portion_wide, 60, {-16384, 0, 8192, 16384}, -16384,
                          16384, true);
}

// Every register times every extreme, either way round.
TEST_P(KernelTest, BoundedProductsOfEveryRegisterWithExtremes) {
    PacketMemory packet;
    for (const std::int16_t extreme : bounded_extremes()) {
        for (int k = 3; k < 9; ++k) fill(packet, k, extreme);
        for (int first = -16384; first <= 16384; first += kPacketSize) {
            for (const int k : {0, 1, 2, 9, 10, 11})
                for (int i = 0; i < kPacketSize; ++i)
                    packet.plane(k)[i] = static_cast<std::int16_t>(std::min(first + i, 16384));
            PortionCtx ctx = portion(ProductKind::multiply, ThirdKind::none, kScales[0], 1);
            ctx.bounded = ctx.wide = 1;
            const Written written = outputs_of(ctx);
            ASSERT_EQ(stage_difference(table(), &KernelTable::portion_wide, packet, ctx, written),
                      "")
                << name("portion_wide") << ", register " << first << ", extreme " << extreme;
        }
    }
}

// The mux looks at spare0.alpha >= 1/2: 127 and 128, 8191 and 8192.
TEST_P(KernelTest, MuxOfEveryAlpha) {
    PacketMemory packet;
    packet.count = PacketMemory::kBytes;
    for (int k = 0; k < 6; ++k) fill(packet, k, 255);
    for (int k = 6; k < 12; ++k) fill(packet, k, 100);
    for (int first = -32768; first < 32768; first += packet.count) {
        for (int i = 0; i < packet.count; ++i)
            packet.plane(kMuxPlane)[i] = static_cast<std::int16_t>(first + i);
        PortionCtx ctx = portion(ProductKind::multiply, ThirdKind::mux, kScales[0], 3);
        const Written written = outputs_of(ctx);
        ASSERT_EQ(stage_difference(table(), &KernelTable::portion_wide, packet, ctx, written), "")
            << name("portion_wide") << ", alpha " << first;
        if (first != -256 && first != 0) continue;
        ASSERT_EQ(stage_difference(table(), &KernelTable::portion_nine_bit, packet, ctx, written),
                  "")
            << name("portion_nine_bit") << ", alpha " << first;
    }
}

}  // namespace
}  // namespace burnish
