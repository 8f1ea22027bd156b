#include "shade/output.hpp"

#include <algorithm>
#include <cmath>

#include "machine/interpreter.hpp"

namespace burnish {

namespace {

/// A reference as the code of a register, rounded as colour inputs are.
std::int16_t reference_code(float reference, NumberModel numbers) {
    const auto one = static_cast<float>(code_of_one(numbers));
    const float clamped = reference > 0.0F ? std::min(reference, 1.0F) : 0.0F;
    return static_cast<std::int16_t>(std::floor(clamped * one + 0.5F));
}

BlendFactorCtx factor_ctx(BlendFactor factor) {
    switch (factor) {
        case BlendFactor::zero:
            return {BlendOperand::zero, 0};
        case BlendFactor::one:
            return {BlendOperand::zero, 1};
        case BlendFactor::src_color:
            return {BlendOperand::source_color, 0};
        case BlendFactor::one_minus_src_color:
            return {BlendOperand::source_color, 1};
        case BlendFactor::src_alpha:
            return {BlendOperand::source_alpha, 0};
        case BlendFactor::one_minus_src_alpha:
            return {BlendOperand::source_alpha, 1};
        case BlendFactor::dst_color:
            return {BlendOperand::destination_color, 0};
        case BlendFactor::one_minus_dst_color:
            return {BlendOperand::destination_color, 1};
        case BlendFactor::dst_alpha:
            return {BlendOperand::destination_alpha, 0};
        case BlendFactor::one_minus_dst_alpha:
            return {BlendOperand::destination_alpha, 1};
        case BlendFactor::constant_color:
            return {BlendOperand::constant_color, 0};
        case BlendFactor::one_minus_constant_color:
            return {BlendOperand::constant_color, 1};
    }
    return {BlendOperand::zero, 0};
}

BlendCtx blend_ctx(const Blend& blend) {
    BlendCtx ctx{};
    ctx.sum = static_cast<BlendSum>(blend.equation);
    ctx.source = factor_ctx(blend.src);
    ctx.destination = factor_ctx(blend.dst);
    for (int c = 0; c < 4; ++c) {
        const float x = blend.constant[c];
        ctx.constant[c] = x > 0.0F ? std::min(x, 1.0F) : 0.0F;
    }
    return ctx;
}

}  // namespace

DepthRule comparison_rule(Comparison comparison, bool write) {
    const auto rule = [&](int less, int equal, int greater) {
        return DepthRule{static_cast<std::uint8_t>(less), static_cast<std::uint8_t>(equal),
                         static_cast<std::uint8_t>(greater),
                         static_cast<std::uint8_t>(write ? 1 : 0)};
    };
    switch (comparison) {
        case Comparison::never:
            return rule(0, 0, 0);
        case Comparison::less:
            return rule(1, 0, 0);
        case Comparison::equal:
            return rule(0, 1, 0);
        case Comparison::lequal:
            return rule(1, 1, 0);
        case Comparison::greater:
            return rule(0, 0, 1);
        case Comparison::notequal:
            return rule(1, 0, 1);
        case Comparison::gequal:
            return rule(0, 1, 1);
        case Comparison::always:
            return rule(1, 1, 1);
    }
    return rule(0, 0, 0);
}

FragmentOutput plan_output(const Shading& shading, const std::optional<Blend>& blend,
                           const AlphaTest& alpha_test, const DepthRule& depth) {
    FragmentOutput output{.blend = blend, .alpha_test = {}, .depth = depth};
    if (alpha_test.pass != Comparison::always) output.alpha_test = alpha_test;
    output.late_depth = output.alpha_test.has_value() || shading.keep_attribute >= 0 ||
                        shading.depth_attribute >= 0;
    return output;
}

bool needs_order(const FragmentOutput& output) {
    return output.blend.has_value() || output.late_depth;
}

DepthRule early_rule(const Shading& shading, const FragmentOutput& output) {
    DepthRule rule = output.depth;
    if (!output.late_depth) return rule;
    rule.write = 0;
    // The depths that pending fragments write move one way under <, <=, > and >=: away from what
    // they let pass.
    const bool one_way = rule.pass_less != rule.pass_greater;
    if (shading.depth_attribute < 0 && (output.depth.write == 0 || one_way)) return rule;
    return comparison_rule(Comparison::always, false);
}

void test_fragments(const Shading& shading, const FragmentOutput& output,
                    const KernelTable& kernels, const DepthRun* runs, int run_count,
                    const OutputTile& tile, std::uint16_t* stored, Packet& packet) {
    if (output.alpha_test) {
        const DepthRule pass = comparison_rule(output.alpha_test->pass, false);
        const NumberModel numbers = shading.program.numbers;
        kernels.alpha_test(
            packet, {shading.result[3], reference_code(output.alpha_test->reference, numbers),
                     pass.pass_less, pass.pass_equal, pass.pass_greater, stored});
    }
    if (shading.keep_attribute >= 0) kernels.keep(packet, {shading.keep_attribute, stored});
    if (output.late_depth) {
        const DepthRule& rule = output.depth;
        kernels.late_depth(
            packet, {runs, run_count, shading.depth_attribute, rule.pass_less, rule.pass_equal,
                     rule.pass_greater, rule.write, tile.depth, tile.block_far, stored});
    }
}

void write_pixels(const std::array<std::int16_t, 4>& colors, NumberModel numbers,
                  const std::optional<Blend>& blend, const KernelTable& kernels,
                  const OutputTile& tile, Packet& packet) {
    const bool nine_bit = numbers == NumberModel::nine_bit;
    if (blend) {
        BlendCtx ctx = blend_ctx(*blend);
        std::copy_n(colors.begin(), 4, ctx.plane);
        ctx.format = tile.format;
        ctx.tile = tile.pixels;
        return (nine_bit ? kernels.blend_nine_bit : kernels.blend_wide)(packet, ctx);
    }
    StoreCtx store{};
    std::copy_n(colors.begin(), 4, store.plane);
    store.format = tile.format;
    store.tile = tile.pixels;
    (nine_bit ? kernels.store_nine_bit : kernels.store_wide)(packet, store);
}

}  // namespace burnish
