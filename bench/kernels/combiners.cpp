#include <string>

#include "bench/kernels/stages.hpp"

namespace burnish::bench {
namespace {

Operand operand(int first, int mapping) {
    return {{static_cast<std::int16_t>(first), static_cast<std::int16_t>(first + 1),
             static_cast<std::int16_t>(first + 2)},
            static_cast<std::uint8_t>(mapping)};
}

constexpr int kTrash = 30;

/// Inputs in planes 0 .. 12, outputs from 14 on.
PortionCtx portion(ProductKind ab, ProductKind cd, ThirdKind third) {
    PortionCtx ctx{};
    ctx.a = operand(0, 6);
    ctx.b = operand(3, 6);
    ctx.c = operand(6, 6);
    ctx.d = operand(9, 6);
    ctx.ab = ab;
    ctx.cd = cd;
    ctx.third = third;
    ctx.components = 3;
    ctx.mux_plane = 12;
    for (int c = 0; c < 3; ++c) {
        ctx.ab_out[c] = static_cast<std::int16_t>(14 + c);
        ctx.cd_out[c] = ctx.third_out[c] = kTrash;
        const auto plane = static_cast<std::int16_t>(17 + c);
        if (third != ThirdKind::none)
            ctx.third_out[c] = plane;
        else if (cd != ProductKind::none)
            ctx.cd_out[c] = plane;
    }
    return ctx;
}

void add_portions(const std::string& name, PacketStage<PortionCtx> stage,
                  const PacketMemory& packet, bool bounded = false) {
    const auto add_portion = [&](const char* variant, PortionCtx ctx, Written written) {
        ctx.bounded = bounded ? 1 : 0;
        written.trash_plane = kTrash;
        add_packet_stage(name + "/" + variant, stage, packet, ctx, written);
    };
    const Written first{.planes = {14, 15, 16}};
    const Written both{.planes = {14, 15, 16, 17, 18, 19}};
    add_portion("multiply", portion(ProductKind::multiply, ProductKind::none, ThirdKind::none),
                first);
    PortionCtx bump = portion(ProductKind::dot, ProductKind::none, ThirdKind::none);
    bump.a.mapping = bump.b.mapping = 2;
    bump.components = 1;
    add_portion("dot_of_expanded", bump, {.planes = {14}});
    PortionCtx scalar = portion(ProductKind::multiply, ProductKind::none, ThirdKind::none);
    scalar.components = 1;
    scalar.scale = OutputScale::two;
    add_portion("alpha_scale_two", scalar, {.planes = {14}});
    add_portion("two_products",
                portion(ProductKind::multiply, ProductKind::multiply, ThirdKind::none), both);
    add_portion("sum", portion(ProductKind::multiply, ProductKind::multiply, ThirdKind::sum), both);
    add_portion("mux", portion(ProductKind::multiply, ProductKind::multiply, ThirdKind::mux), both);
    // The two stages of the anisotropic lobe.
    PortionCtx dots = portion(ProductKind::dot, ProductKind::dot, ThirdKind::none);
    dots.a.mapping = dots.b.mapping = dots.c.mapping = dots.d.mapping = 2;
    dots.d = dots.b;
    dots.components = 1;
    dots.scale = OutputScale::four;
    add_portion("two_dots_of_expanded", dots, {.planes = {14, 17}});
    PortionCtx squares = portion(ProductKind::multiply, ProductKind::multiply, ThirdKind::sum);
    squares.b = squares.a;
    squares.d = squares.c;
    squares.components = 1;
    squares.ab_out[0] = kTrash;
    add_portion("sum_of_squares", squares, {.planes = {17}});
}

void add_final(const std::string& name, PacketStage<FinalCtx> stage, const PacketMemory& packet) {
    FinalCtx ctx{};
    ctx.a = operand(0, 0);
    ctx.b = operand(3, 0);
    ctx.c = operand(6, 0);
    ctx.d = operand(9, 0);
    ctx.e = ctx.b;
    ctx.f = ctx.c;
    ctx.g = operand(12, 0);
    for (int c = 0; c < 3; ++c) {
        ctx.spare0[c] = static_cast<std::int16_t>(c);
        ctx.secondary[c] = static_cast<std::int16_t>(3 + c);
    }
    for (int c = 0; c < 4; ++c) ctx.out[c] = static_cast<std::int16_t>(20 + c);
    const Written written{.planes = {20, 21, 22, 23}};
    add_packet_stage(name + "/blend", stage, packet, ctx, written);
    ctx.b.plane[0] = FinalCtx::kColorSum;
    ctx.d.plane[0] = FinalCtx::kFinalProduct;
    ctx.uses_color_sum = ctx.uses_final_product = 1;
    add_packet_stage(name + "/sum_and_product", stage, packet, ctx, written);
    ctx.uses_color_sum = ctx.uses_final_product = 0;
    ctx.b = operand(3, 0);
    ctx.c.plane[0] = ctx.d.plane[0] = FinalCtx::kZero;
    add_packet_stage(name + "/product", stage, packet, ctx, written);
    ctx.b.plane[0] = FinalCtx::kZero;
    ctx.c.plane[0] = FinalCtx::kFinalProduct;
    ctx.uses_final_product = 1;
    add_packet_stage(name + "/product_of_three", stage, packet, ctx, written);
}

}  // namespace

void add_combiners() {
    const PacketMemory nine_bit = registers(255), wide = registers(16384);
    add_portions("portion_nine_bit", &KernelTable::portion_nine_bit, nine_bit);
    add_portions("portion_wide", &KernelTable::portion_wide, wide);
    add_portions("portion_wide/bounded", &KernelTable::portion_wide, wide, true);
    add_final("final_nine_bit", &KernelTable::final_nine_bit, nine_bit);
    add_final("final_wide", &KernelTable::final_wide, wide);
}

}  // namespace burnish::bench
