#include <array>
#include <vector>

#include "kernel_test.hpp"

/// The final combiner of both number models, and codes to pixels.
namespace burnish {
namespace {

INSTANTIATE_TEST_SUITE_P(Isa, KernelTest, every_table(), isa_name);

using FinalStage = void (*KernelTable::*)(Packet&, const FinalCtx&) noexcept;

/// Planes: A 0, B 3, C 6, D 9, E 12, F 15, spare0 18, secondary 21, G 24, results 28 .. 31.
constexpr int kSpare0 = 18;
constexpr int kSecondary = 21;
constexpr int kG = 24;
constexpr int kInputs = 25;
constexpr std::int16_t kResults = 28;

Operand operand(int first, int mapping) {
    return {{static_cast<std::int16_t>(first), static_cast<std::int16_t>(first + 1),
             static_cast<std::int16_t>(first + 2)},
            static_cast<std::uint8_t>(mapping)};
}

FinalCtx final_combiner() {
    FinalCtx ctx{};
    ctx.a = operand(0, 0);
    ctx.b = operand(3, 0);
    ctx.c = operand(6, 0);
    ctx.d = operand(9, 0);
    ctx.e = operand(12, 0);
    ctx.f = operand(15, 0);
    ctx.g = operand(kG, 0);
    for (int c = 0; c < 3; ++c) {
        ctx.spare0[c] = static_cast<std::int16_t>(kSpare0 + c);
        ctx.secondary[c] = static_cast<std::int16_t>(kSecondary + c);
    }
    for (int c = 0; c < 4; ++c) ctx.out[c] = static_cast<std::int16_t>(kResults + c);
    return ctx;
}

void read_instead(FinalCtx& ctx, Operand& operand, std::int16_t pseudo) {
    operand.plane[0] = pseudo;
    if (pseudo == FinalCtx::kColorSum) ctx.uses_color_sum = 1;
    if (pseudo == FinalCtx::kFinalProduct) ctx.uses_final_product = 1;
}

const Written kFinalWrites{.planes = {kResults, kResults + 1, kResults + 2, kResults + 3}};

void fill(PacketMemory& packet, int plane, int value) {
    std::fill_n(packet.plane(plane), kPacketSize, static_cast<std::int16_t>(value));
}

void count_up(PacketMemory& packet, int plane, int first, int step = 1) {
    for (int i = 0; i < kPacketSize; ++i)
        packet.plane(plane)[i] = static_cast<std::int16_t>(first + i * step);
}

PacketMemory quiet_packet() {
    PacketMemory packet;
    for (int k = 0; k < kInputs; ++k) fill(packet, k, 0);
    return packet;
}

// All 2^24 of A * B + (1 - A) * C; three values of B at a time, one per component.
TEST_P(KernelTest, NineBitBlendOfAllOperands) {
    PacketMemory packet = quiet_packet();
    packet.count = PacketMemory::kBytes;
    const FinalCtx ctx = final_combiner();
    for (int k = 6; k < 9; ++k) count_up(packet, k, 0);
    for (int a = 0; a < 256; ++a) {
        for (int k = 0; k < 3; ++k) fill(packet, k, a);
        for (int b = 0; b < 256; b += 3) {
            for (int k = 0; k < 3; ++k) fill(packet, 3 + k, std::min(b + k, 255));
            ASSERT_EQ(
                stage_difference(table(), &KernelTable::final_nine_bit, packet, ctx, kFinalWrites),
                "")
                << name("final_nine_bit") << ", A " << a << ", B " << b;
        }
    }
}

// The colour sum is the one operand above 1: all 511 of its values as B, C or D, against each A.
TEST_P(KernelTest, NineBitBlendWithEveryColorSum) {
    PacketMemory packet = quiet_packet();
    packet.count = PacketMemory::kBytes;
    for (int slot = 0; slot < 3; ++slot) {
        FinalCtx ctx = final_combiner();
        Operand* const places[] = {&ctx.b, &ctx.c, &ctx.d};
        read_instead(ctx, *places[slot], FinalCtx::kColorSum);
        for (int mapping = 0; mapping < 2; ++mapping) {
            places[slot]->mapping = static_cast<std::uint8_t>(mapping);
            for (int part = 0; part < 512; ++part) {
                // Both addends up to 255; the other operands differ between components.
                const int half = part / 256;
                for (int k = 0; k < 3; ++k) {
                    count_up(packet, kSpare0 + k, 0);
                    fill(packet, kSecondary + k, half == 0 ? 0 : 255);
                    fill(packet, k, part % 256);
                    fill(packet, 3 + k, k * 127 + 1);
                    fill(packet, 6 + k, 255 - k * 127);
                }
                ctx.clamp_color_sum = static_cast<std::uint8_t>(part % 7 == 0);
                ASSERT_EQ(stage_difference(table(), &KernelTable::final_nine_bit, packet, ctx,
                                           kFinalWrites),
                          "")
                    << name("final_nine_bit") << ", slot " << slot << ", part " << part;
            }
        }
    }
}

TEST_P(KernelTest, NineBitFinalProductOfAllOperands) {
    PacketMemory packet = quiet_packet();
    packet.count = PacketMemory::kBytes;
    for (int mapping = 0; mapping < 4; ++mapping) {
        FinalCtx ctx = final_combiner();
        read_instead(ctx, ctx.d, FinalCtx::kFinalProduct);
        ctx.e.mapping = static_cast<std::uint8_t>(mapping % 2);
        ctx.f.mapping = static_cast<std::uint8_t>(mapping / 2);
        for (int e = -256; e < 256; e += 3) {
            for (int first = -256; first <= 0; first += 256) {
                for (int k = 0; k < 3; ++k) {
                    fill(packet, 12 + k, std::min(e + k, 255));
                    count_up(packet, 15 + k, first);
                }
                ASSERT_EQ(stage_difference(table(), &KernelTable::final_nine_bit, packet, ctx,
                                           kFinalWrites),
                          "")
                    << name("final_nine_bit") << ", E " << e << ", F from " << first;
            }
        }
    }
}

/// A * B + (1 - A) * C with A, B from the extremes and C everything from 0 to 1 and a bit beyond.
TEST_P(KernelTest, WideBlendOfEveryRegisterWithExtremes) {
    constexpr std::array kExtremes{0,     1,     2,     3,     63,    64,    127,
                                   128,   4095,  8191,  8192,  8193,  12287, 16321,
                                   16382, 16383, 16384, 16385, 32767, -1};
    PacketMemory packet = quiet_packet();
    const FinalCtx ctx = final_combiner();
    for (const int a : kExtremes) {
        for (const int b : kExtremes) {
            for (int first = -2 * kPacketSize; first < 17000; first += 3 * kPacketSize) {
                for (int k = 0; k < 3; ++k) {
                    fill(packet, k, a);
                    fill(packet, 3 + k, b);
                    count_up(packet, 6 + k, first + k * kPacketSize);
                }
                ASSERT_EQ(
                    stage_difference(table(), &KernelTable::final_wide, packet, ctx, kFinalWrites),
                    "")
                    << name("final_wide") << ", A " << a << ", B " << b << ", C from " << first;
            }
        }
    }
}

FinalCtx random_final(Random& random) {
    FinalCtx ctx = final_combiner();
    for (Operand* o : {&ctx.a, &ctx.b, &ctx.c, &ctx.d, &ctx.e, &ctx.f, &ctx.g}) {
        o->mapping = static_cast<std::uint8_t>(random.below(2));
        for (std::int16_t& plane : o->plane)
            plane =
                static_cast<std::int16_t>(random.chance(4) ? o->plane[0] : random.below(kInputs));
    }
    for (std::int16_t& plane : ctx.spare0) plane = static_cast<std::int16_t>(random.below(kInputs));
    for (std::int16_t& plane : ctx.secondary)
        plane = static_cast<std::int16_t>(random.below(kInputs));
    ctx.clamp_color_sum = static_cast<std::uint8_t>(random.below(2));
    ctx.complement_spare0 = static_cast<std::uint8_t>(random.chance(3) ? 1 : 0);
    ctx.complement_secondary = static_cast<std::uint8_t>(random.chance(3) ? 1 : 0);
    for (Operand* o : {&ctx.b, &ctx.c, &ctx.d})
        if (random.chance(3)) read_instead(ctx, *o, FinalCtx::kColorSum);
    for (Operand* o : {&ctx.a, &ctx.b, &ctx.c, &ctx.d})
        if (random.chance(4)) read_instead(ctx, *o, FinalCtx::kFinalProduct);
    for (Operand* o : {&ctx.b, &ctx.c, &ctx.d})
        if (random.chance(3)) read_instead(ctx, *o, FinalCtx::kZero);
    const auto reads = [&](std::int16_t pseudo) {
        for (const Operand* o : {&ctx.a, &ctx.b, &ctx.c, &ctx.d})
            if (o->plane[0] == pseudo) return true;
        return false;
    };
    ctx.uses_color_sum = reads(FinalCtx::kColorSum) ? 1 : 0;
    ctx.uses_final_product = reads(FinalCtx::kFinalProduct) ? 1 : 0;
    return ctx;
}

void check_random_finals(const KernelTable& table, FinalStage stage,
                         const std::vector<std::int16_t>& extremes, int low, int high) {
    for (int seed = 0; seed < 400; ++seed) {
        Random random(static_cast<unsigned>(seed));
        PacketMemory packet;
        packet.count = random.chance(3) ? kPacketSize : random.between(1, kPacketSize);
        for (int k = 0; k < kInputs; ++k) {
            for (int i = 0; i < packet.count; ++i)
                packet.plane(k)[i] = static_cast<std::int16_t>(
                    random.chance(3) ? random.pick(extremes) : random.between(low, high));
        }
        for (int variant = 0; variant < 25; ++variant) {
            FinalCtx ctx = random_final(random);
            if (stage == &KernelTable::final_nine_bit && random.chance(2)) {
                ctx.rounding = random.pick(
                    std::array{Rounding::nearest, Rounding::truncate, Rounding::shift8});
                ctx.round_each = static_cast<std::uint8_t>(random.below(2));
            }
            ASSERT_EQ(stage_difference(table, stage, packet, ctx, kFinalWrites), "")
                << table.isa << " final, seed " << seed << ", variant " << variant;
        }
    }
}

TEST_P(KernelTest, NineBitFinalCombinersOfEveryKind) {
    check_random_finals(table(), &KernelTable::final_nine_bit,
                        {-256, -255, -1, 0, 1, 127, 128, 254, 255}, -256, 255);
}

TEST_P(KernelTest, WideFinalCombinersOfEveryKind) {
    check_random_finals(table(), &KernelTable::final_wide,
                        {-32768, -1, 0, 1, 8191, 8192, 16383, 16384, 16385, 32766, 32767}, -32768,
                        32767);
}

/// In any order, one after the other, or so but for a few that changed places.
void arrange_pixels(PacketMemory& packet, Random& random, int way) {
    if (way % 3 == 0) return packet.shuffle_pixels(random);
    const int first = random.between(0, kTilePixels - kPacketSize);
    for (int i = 0; i < kPacketSize; ++i)
        packet.pixels[static_cast<std::size_t>(i)] = static_cast<std::uint16_t>(first + i);
    if (way % 3 == 1) return;
    for (int n = 0; n < 10; ++n) {
        const auto i = static_cast<std::size_t>(random.below(kPacketSize));
        std::swap(packet.pixels[i], packet.pixels[std::min<std::size_t>(i + 3, kPacketSize - 1)]);
    }
}

/// Bytes of a tile before and after: only the packet's pixels may change.
template <class Codes>
void check_store(const KernelTable& table,
                 void (*KernelTable::*stage)(Packet&, const StoreCtx&) noexcept, int last_code,
                 const Codes& code_of) {
    Random random(1);
    for (const StoreFormat format :
         {StoreFormat::rgba8, StoreFormat::rgba16, StoreFormat::rgba32f}) {
        for (int first = 0; first <= last_code; first += 64) {
            PacketMemory packet;
            packet.count = first % 3 == 0 ? kPacketSize : random.between(1, kPacketSize);
            arrange_pixels(packet, random, first / 64);
            for (int c = 0; c < 4; ++c)
                for (int i = 0; i < packet.count; ++i)
                    packet.plane(5 + c)[i] =
                        static_cast<std::int16_t>(std::min(last_code, code_of(first + i, c)));
            AlignedVector<std::uint8_t> got(std::size_t{16} * kTilePixels, 0xa5);
            AlignedVector<std::uint8_t> want = got;
            StoreCtx ctx{{5, 6, 7, 8}, format, got.data()};
            Packet view = packet.view();
            (table.*stage)(view, ctx);
            ctx.tile = want.data();
            (table_reference().*stage)(view, ctx);
            for (std::size_t i = 0; i < got.size(); ++i)
                ASSERT_EQ(int{got[i]}, int{want[i]})
                    << table.isa << " store, format " << static_cast<int>(format) << ", byte " << i
                    << ", codes from " << first;
        }
    }
}

TEST_P(KernelTest, NineBitStoreOfEveryCode) {
    check_store(table(), &KernelTable::store_nine_bit, 255,
                [](int i, int c) { return c == 1 ? 255 - i % 256 : (i + 85 * c) % 256; });
}

TEST_P(KernelTest, WideStoreOfEveryCode) {
    check_store(table(), &KernelTable::store_wide, 16384,
                [](int i, int c) { return c == 1 ? 16384 - i % 16385 : (i + 4096 * c) % 16385; });
}

/// Floats take whole registers, signs included.
void check_float_store(const KernelTable& table,
                       void (*KernelTable::*stage)(Packet&, const StoreCtx&) noexcept, int low,
                       int high) {
    Random random(1);
    for (int first = low; first <= high; first += kPacketSize / 2) {
        PacketMemory packet;
        packet.count = kPacketSize - 1;
        packet.shuffle_pixels(random);
        for (int c = 0; c < 4; ++c)
            for (int i = 0; i < packet.count; ++i)
                packet.plane(5 + c)[i] = static_cast<std::int16_t>(std::min(first + i, high));
        AlignedVector<float> got(std::size_t{4} * kTilePixels), want = got;
        StoreCtx ctx{{5, 6, 7, 8}, StoreFormat::rgba32f, got.data()};
        Packet view = packet.view();
        (table.*stage)(view, ctx);
        ctx.tile = want.data();
        (table_reference().*stage)(view, ctx);
        for (std::size_t i = 0; i < got.size(); ++i)
            ASSERT_EQ(got[i], want[i]) << table.isa << ", channel " << i << ", from " << first;
    }
}

TEST_P(KernelTest, FloatStoreOfEveryRegisterCode) {
    check_float_store(table(), &KernelTable::store_nine_bit, -256, 255);
    check_float_store(table(), &KernelTable::store_wide, -32768, 32767);
}

}  // namespace
}  // namespace burnish
