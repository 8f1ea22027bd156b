#include <array>
#include <vector>

#include "kernel_test.hpp"

/// Numbers worked out by hand, and those measured on an NV2A (H1 .. H10 of docs/numbers.md), for
/// every table: the reference has to be right before anything can be compared with it.
namespace burnish {
namespace {

class ReferenceValues : public KernelTest {};
INSTANTIATE_TEST_SUITE_P(Isa, ReferenceValues, every_table(), isa_name);

using Rgb = std::array<int, 3>;

void fill(PacketMemory& packet, int first, const Rgb& value) {
    for (int c = 0; c < 3; ++c)
        std::fill_n(packet.plane(first + c), kPacketSize,
                    static_cast<std::int16_t>(value[static_cast<std::size_t>(c)]));
}

Rgb result(PacketMemory& packet, int first) {
    return {packet.plane(first)[0], packet.plane(first + 1)[0], packet.plane(first + 2)[0]};
}

Operand operand(int first, int mapping = 6) {
    return {{static_cast<std::int16_t>(first), static_cast<std::int16_t>(first + 1),
             static_cast<std::int16_t>(first + 2)},
            static_cast<std::uint8_t>(mapping)};
}

/// What a portion computes from four colours; spare0.alpha and the rest are the caller's.
struct PortionRun {
    PortionCtx ctx{.a = operand(0),
                   .b = operand(3),
                   .c = operand(6),
                   .d = operand(9),
                   .ab = ProductKind::multiply,
                   .cd = ProductKind::multiply,
                   .third = ThirdKind::sum,
                   .scale = OutputScale::one,
                   .rounding = Rounding::nearest,
                   .halve_down = 0,
                   .mux_lsb = 0,
                   .bias_minus_half = 0,
                   .wide = 0,
                   .components = 3,
                   .bounded = 0,
                   .mux_plane = 12,
                   .ab_out = {14, 15, 16},
                   .cd_out = {17, 18, 19},
                   .third_out = {20, 21, 22}};
    Rgb a{}, b{255, 255, 255}, c{}, d{255, 255, 255};
    int mux_alpha = 0;
    Rgb ab{}, cd{}, third{};

    void run(void (*stage)(Packet&, const PortionCtx&) noexcept) {
        PacketMemory packet;
        fill(packet, 0, a);
        fill(packet, 3, b);
        fill(packet, 6, c);
        fill(packet, 9, d);
        packet.plane(12)[0] = static_cast<std::int16_t>(mux_alpha);
        packet.count = 1;
        Packet view = packet.view();
        stage(view, ctx);
        ab = result(packet, 14);
        cd = result(packet, 17);
        third = result(packet, 20);
    }
};

/// A * 1 under the output operation of a nine-bit portion.
Rgb scaled(const KernelTable& table, const Rgb& x, OutputScale scale, bool bias,
           int components = 3) {
    PortionRun p;
    p.a = x;
    p.ctx.scale = scale;
    p.ctx.bias_minus_half = bias ? 1 : 0;
    p.ctx.components = static_cast<std::uint8_t>(components);
    p.run(table.portion_nine_bit);
    return p.ab;
}

TEST_P(ReferenceValues, ConstantsAndColorsAreEightBitNumbers) {  // H1
    PacketMemory packet;
    const std::array codes{25, 63, 255, 127};
    for (int c = 0; c < 4; ++c)
        packet.attribute(0)[c] = static_cast<float>(codes[static_cast<std::size_t>(c)]) / 255.0F;
    Packet view = packet.view();
    table().encode_nine_bit(view, {0, 1});
    for (int c = 0; c < 4; ++c) EXPECT_EQ(packet.plane(1)[c], codes[static_cast<std::size_t>(c)]);
}

TEST_P(ReferenceValues, BiasSubtracts128BeforeTheScale) {  // H2
    EXPECT_EQ(scaled(table(), {25, 63, 255}, OutputScale::one, true), (Rgb{-103, -65, 127}));
    EXPECT_EQ(scaled(table(), {25, 63, 255}, OutputScale::two, true), (Rgb{-206, -130, 254}));
}

TEST_P(ReferenceValues, HalfScaleRoundsUp) {  // H3
    EXPECT_EQ(scaled(table(), {25, 63, 255}, OutputScale::half, false), (Rgb{13, 32, 128}));
    EXPECT_EQ(scaled(table(), {-25, -1, -255}, OutputScale::half, false), (Rgb{-12, 0, -127}));
}

TEST_P(ReferenceValues, DoublingStopsAtOne) {  // H4
    EXPECT_EQ(scaled(table(), {25, 63, 255}, OutputScale::two, false), (Rgb{50, 126, 255}));
    EXPECT_EQ(scaled(table(), {25, 63, 255}, OutputScale::four, false), (Rgb{100, 252, 255}));
    EXPECT_EQ(scaled(table(), {-25, -63, -64}, OutputScale::four, false), (Rgb{-100, -252, -255}));
}

TEST_P(ReferenceValues, AlphaPortionsScaleAlike) {  // H5
    EXPECT_EQ(scaled(table(), {255, 0, 0}, OutputScale::one, true, 1)[0], 127);
    EXPECT_EQ(scaled(table(), {255, 0, 0}, OutputScale::half, false, 1)[0], 128);
}

TEST_P(ReferenceValues, MappingsOfNineBitRegisters) {  // H6: invert; expand and half-bias follow H2
    const std::array<std::array<int, 5>, 8> wanted{{
        // -256, -1, 0, 128, 255
        {0, 0, 0, 128, 255},
        {255, 255, 255, 127, 0},
        {-255, -255, -255, 0, 254},  // expand(0) = -256 ends at -1 in the output
        {255, 255, 255, 0, -254},
        {-128, -128, -128, 0, 127},
        {128, 128, 128, 0, -127},
        {-255, -1, 0, 128, 255},
        {255, 1, 0, -128, -255},
    }};
    const std::array registers{-256, -1, 0, 128, 255};
    for (std::uint8_t mapping = 0; mapping < 8; ++mapping) {
        for (std::size_t k = 0; k < registers.size(); ++k) {
            PortionRun p;
            p.a = {registers[k], registers[k], 191};
            p.ctx.a.mapping = mapping;
            p.run(table().portion_nine_bit);
            EXPECT_EQ(p.ab[0], wanted[mapping][k])
                << "mapping " << int{mapping} << " of " << registers[k];
            if (mapping == 1) {
                EXPECT_EQ(p.ab[2], 64);
            }
        }
    }
}

TEST_P(ReferenceValues, ProductsRoundToNearest) {
    PortionRun p;
    p.a = {51, 127, -1};
    p.b = {128, 1, 128};  // 25.6, 0.498, -0.502
    p.run(table().portion_nine_bit);
    EXPECT_EQ(p.ab, (Rgb{26, 0, -1}));
}

TEST_P(ReferenceValues, DotRoundsEachProductAndGoesToAllComponents) {
    PortionRun p;
    p.a = {1, 1, 1};
    p.b = {128, 128, 128};  // 3 * 0.502: 1 + 1 + 1, not 2
    p.ctx.ab = ProductKind::dot;
    p.run(table().portion_nine_bit);
    EXPECT_EQ(p.ab, (Rgb{3, 3, 3}));
}

TEST_P(ReferenceValues, SumIsTakenBeforeScaleAndClamp) {
    PortionRun p;
    p.a = {255, 200, -255};
    p.c = {255, -250, -255};
    p.ctx.scale = OutputScale::half;
    p.run(table().portion_nine_bit);
    EXPECT_EQ(p.third, (Rgb{255, -25, -255}));  // 510 / 2, -50 / 2, -510 / 2
    EXPECT_EQ(p.ab, (Rgb{128, 100, -127}));
}

TEST_P(ReferenceValues, MuxTakesCdFromAlpha128On) {
    for (const auto& [alpha, wanted] :
         {std::pair{0, 1}, std::pair{127, 1}, std::pair{128, 2}, std::pair{255, 2}}) {
        PortionRun p;
        p.a = {1, 1, 1};
        p.c = {2, 2, 2};
        p.mux_alpha = alpha;
        p.ctx.third = ThirdKind::mux;
        p.run(table().portion_nine_bit);
        EXPECT_EQ(p.third, (Rgb{wanted, wanted, wanted})) << "alpha " << alpha;
    }
}

TEST_P(ReferenceValues, WideProductsRoundHalfUpAndKeepTheirRange) {
    PortionRun p;
    p.a = {8192, -8192, 32767};
    p.b = {1, 1, 32767};  // 0.5, -0.5, almost 4
    p.c = {-32768, 16384, 100};
    p.d = {-32768, 24576, 8192};  // 4, 1.5, 50 / 2^14
    p.run(table().portion_wide);
    EXPECT_EQ(p.ab, (Rgb{1, 0, 16384}));
    EXPECT_EQ(p.cd, (Rgb{16384, 16384, 50}));
    p.ctx.wide = 1;
    p.run(table().portion_wide);
    EXPECT_EQ(p.ab, (Rgb{1, 0, 32767}));
    EXPECT_EQ(p.cd, (Rgb{32767, 24576, 50}));
}

TEST_P(ReferenceValues, WideMappingsSaturate) {
    PortionRun p;
    p.ctx.wide = 1;
    p.a = {-32768, 32767, 8192};
    p.b = {16384, 16384, 16384};
    const auto mapped = [&](std::uint8_t mapping) {
        p.ctx.a.mapping = mapping;
        p.run(table().portion_wide);
        return p.ab;
    };
    EXPECT_EQ(mapped(2), (Rgb{-16384, 32767, 0}));
    EXPECT_EQ(mapped(3), (Rgb{16384, -32768, 0}));
    EXPECT_EQ(mapped(4), (Rgb{-8192, 24575, 0}));
    EXPECT_EQ(mapped(7), (Rgb{32767, -32767, -8192}));
}

/// Final combiner over colours A, B, C, D, E, F, spare0, secondary; G is 0.
struct FinalRun {
    FinalCtx ctx{};
    std::array<Rgb, 8> colors{};

    FinalRun() {
        ctx.a = operand(0, 0);
        ctx.b = operand(3, 0);
        ctx.c = operand(6, 0);
        ctx.d = operand(9, 0);
        ctx.e = operand(12, 0);
        ctx.f = operand(15, 0);
        ctx.g = operand(9, 0);
        for (int c = 0; c < 3; ++c) {
            ctx.spare0[c] = static_cast<std::int16_t>(18 + c);
            ctx.secondary[c] = static_cast<std::int16_t>(21 + c);
        }
        for (int c = 0; c < 4; ++c) ctx.out[c] = static_cast<std::int16_t>(24 + c);
    }
    Rgb run(void (*stage)(Packet&, const FinalCtx&) noexcept) const {
        PacketMemory packet;
        for (int k = 0; k < 8; ++k) fill(packet, 3 * k, colors[static_cast<std::size_t>(k)]);
        packet.count = 1;
        Packet view = packet.view();
        stage(view, ctx);
        return result(packet, 24);
    }
};

TEST_P(ReferenceValues, ColorSumKeepsNineBitsUnlessClamped) {  // H7
    FinalRun f;
    f.ctx.b.plane[0] = FinalCtx::kColorSum;
    f.ctx.uses_color_sum = 1;
    f.colors[0] = {127, 127, 255};
    f.colors[6] = {255, 255, 63};
    f.colors[7] = {255, -1, 178};
    EXPECT_EQ(f.run(table().final_nine_bit), (Rgb{254, 127, 241}));
    f.ctx.clamp_color_sum = 1;
    EXPECT_EQ(f.run(table().final_nine_bit), (Rgb{127, 127, 241}));
}

TEST_P(ReferenceValues, FinalProduct) {  // H8
    FinalRun f;
    f.ctx.d.plane[0] = FinalCtx::kFinalProduct;
    f.ctx.uses_final_product = 1;
    f.colors[4] = {255, 191, 127};
    f.colors[5] = {127, 127, 127};
    EXPECT_EQ(f.run(table().final_nine_bit), (Rgb{127, 95, 63}));
}

TEST_P(ReferenceValues, FinalBlendRoundsToNearest) {  // H9: 25.6, 30.6, 35.6, 40.8, 45.8
    const std::array<std::array<int, 2>, 5> measured{
        {{128, 26}, {153, 31}, {178, 36}, {204, 41}, {229, 46}}};
    for (const auto& [b, wanted] : measured) {
        FinalRun f;
        f.colors[0] = {51, 51, 51};
        f.colors[1] = {b, b, b};
        EXPECT_EQ(f.run(table().final_nine_bit)[0], wanted);
    }
}

TEST_P(ReferenceValues, FinalBlendRoundsOnce) {  // H10
    FinalRun f;
    f.colors[0] = {1, 1, 1};
    f.colors[1] = {255, 255, 255};
    f.colors[2] = {48, 32, 127};  // 48.81, 32.87, 127.50
    EXPECT_EQ(f.run(table().final_nine_bit), (Rgb{49, 33, 128}));
    f.colors[0] = {100, 100, 0};
    f.colors[1] = {1, 255, 0};
    f.colors[2] = {4, 255, 9};  // 0.39 + 2.43 = 2.82: 3, not 0 + 2
    f.colors[3] = {0, 7, 250};
    EXPECT_EQ(f.run(table().final_nine_bit), (Rgb{3, 255, 255}));
}

TEST_P(ReferenceValues, WideFinalCombinerStopsAtOne) {
    FinalRun f;
    f.ctx.c.plane[0] = FinalCtx::kColorSum;
    f.ctx.uses_color_sum = 1;
    f.colors[0] = {8192, 8192, 16384};
    f.colors[1] = {32767, 100, 3};
    f.colors[6] = {16384, 32767, 0};
    f.colors[7] = {16384, -5, 0};  // sums: 32767, 16384, 0
    EXPECT_EQ(f.run(table().final_wide), (Rgb{16384, 8242, 3}));
    f.ctx.c.mapping = 1;
    EXPECT_EQ(f.run(table().final_wide), (Rgb{8192, 50, 3}));
}

}  // namespace
}  // namespace burnish
