/// The yardstick for one instruction set; compiled like kernels/isa.cpp, of whose parts it is made.
#include "bench/fused_lobe.hpp"
#include "kernels/simd.hpp"

namespace burnish::BURNISH_ISA {
namespace {

#include "kernels/groups.inl"
#include "kernels/runs.inl"

#include "kernels/combine.inl"
#include "kernels/fetch.inl"
#include "kernels/final.inl"

struct Texel {
    I16 r, g, b, a;
};

/// Addresses and weights of the fragments of one vector.
struct Addresses {
    alignas(64) std::int32_t texel[kLanes];
    alignas(64) std::int16_t weight_x[kLanes], weight_y[kLanes];

    Addresses(const float* u, const float* v, const FusedLobe& ctx) {
        const F32 one(1.0F);
        const F32 across(static_cast<float>(256 * ctx.width));
        const F32 down(static_cast<float>(256 * ctx.height));
        constexpr AddressMode kRepeat = AddressMode::repeat;
        for (int i = 0; i < kLanes; i += kLanes32) {
            const AxisAddress x = axis_address<kRepeat, true>(load(u + i), ctx.width, one, across);
            const AxisAddress y = axis_address<kRepeat, true>(load(v + i), ctx.height, one, down);
            store(texel + i, y.texel * I32(ctx.pitch) + (x.texel << 2));
            store_narrowed(weight_x + i, x.weight);
            store_narrowed(weight_y + i, y.weight);
        }
    }
};

inline Texel sample(const std::uint8_t* texels, std::int32_t pitch, const std::int32_t* offset,
                    const FilterNineBit* filter, I16 interleave) {
    const auto filtered = [&](int k) __attribute__((always_inline)) {
        const I16 top = shuffle_bytes(load_pairs(texels, offset + 2 * k), interleave);
        const I16 bottom = shuffle_bytes(load_pairs(texels + pitch, offset + 2 * k), interleave);
        return filter[k](top, bottom);
    };
    const I16 v0 = filtered(0), v1 = filtered(1), v2 = filtered(2), v3 = filtered(3);
    const I16 rg01 = zip_lo32(v0, v1), rg23 = zip_lo32(v2, v3);
    const I16 ba01 = zip_hi32(v0, v1), ba23 = zip_hi32(v2, v3);
    const auto code = [](I16 v) { return FilterNineBit::unsigned_code(v); };
    return {code(zip_lo64(rg01, rg23)), code(zip_hi64(rg01, rg23)), code(zip_lo64(ba01, ba23)),
            code(zip_hi64(ba01, ba23))};
}

inline I16 encoded(const float* from) {
    alignas(64) std::int16_t code[kLanes];
    const F32 one(255.0F), half(0.5F), zero(0.0F);
    for (int i = 0; i < kLanes; i += kLanes32)
        store_narrowed(code + i, truncate(min(max(load(from + i) * one + half, zero), one)));
    return load(code);
}

/// clamp(4 (expand(t) . c), -255, 255), c = 114 expand(col0)
inline I16 scaled_dot(const Texel& t, const I16 (&c)[3]) {
    const auto term = [&](I16 x, I16 y) {
        return short_product_255(max(x, I16(0)) * I16(144) - I16(144 * 128), y);
    };
    const I16 dot = (term(t.r, c[0]) + term(t.g, c[1])) + term(t.b, c[2]);
    return min(max(dot << 2, I16(-255)), I16(255));
}

void fused_lobe(Packet& packet, const FusedLobe& ctx) noexcept {
    const FetchPatterns patterns;
    const auto attribute = [&](int k) { return packet.attributes + k * kAttributeStride; };
    const float *const u = attribute(ctx.u), *const v = attribute(ctx.v);
    const float* const color[4] = {attribute(ctx.color[0]), attribute(ctx.color[1]),
                                   attribute(ctx.color[2]), attribute(ctx.color[3])};
    const std::uint8_t* const texels[3] = {ctx.texels[0], ctx.texels[1], ctx.texels[2]};
    const std::int32_t pitch = ctx.pitch;
    std::int16_t* out[4];
    for (int c = 0; c < 4; ++c) out[c] = packet.planes + ctx.store.plane[c] * kPacketSize;
    const I16 factor(ctx.const0_alpha), one(255);
    const I16 ambient[3] = {I16(ctx.const1[0]), I16(ctx.const1[1]), I16(ctx.const1[2])};
    using Final = FinalNineBit<Rounding::nearest, false>;
    const int n = group_count(packet);
    for (int i = 0; i < n; i += kLanes) {
        const Addresses at(u + i, v + i, ctx);
        const FilterWeights weights = FilterNineBit::weights(load(at.weight_x), load(at.weight_y));
        const FilterNineBit filter[4] = {{weights, patterns.word_pair[0]},
                                         {weights, patterns.word_pair[1]},
                                         {weights, patterns.word_pair[2]},
                                         {weights, patterns.word_pair[3]}};
        I16 c[3];
        for (int k = 0; k < 3; ++k) c[k] = encoded(color[k] + i) * I16(228) - I16(228 * 128);
        const Texel t = sample(texels[0], pitch, at.texel, filter, patterns.interleave);
        const I16 along = scaled_dot(t, c);
        const Texel b = sample(texels[1], pitch, at.texel, filter, patterns.interleave);
        const I16 across = scaled_dot(b, c);
        const auto square = [](I16 x) { return short_product_255(x * I16(72), x * I16(114)); };
        const I16 lobe = min(square(along) + square(across), one);
        const I16 strength = Final::product(encoded(color[3] + i), factor);
        const Texel s = sample(texels[2], pitch, at.texel, filter, patterns.interleave);
        const I16 rest = lobe ^ one;
        const auto lit = [&](I16 texel, I16 base) {
            return min(Final::product(rest, Final::product(texel, strength)) + base, one);
        };
        store(out[0] + i, lit(s.r, ambient[0]));
        store(out[1] + i, lit(s.g, ambient[1]));
        store(out[2] + i, lit(s.b, ambient[2]));
        store(out[3] + i, one);
    }
    store_nine_bit(packet, ctx.store);
}

}  // namespace

FusedLobeKernel fused_lobe_kernel() {
    return fused_lobe;
}

}  // namespace burnish::BURNISH_ISA
