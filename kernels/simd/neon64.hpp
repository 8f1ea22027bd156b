#pragma once

#include "kernels/simd/vectors.hpp"

/// 128 bits of aarch64; avx512.hpp says what each wrapper does.
namespace burnish::BURNISH_ISA {
namespace {

inline F32 min(F32 a, F32 b) {
    return ::xsimd::select(a < b, a, b);
}
inline F32 max(F32 a, F32 b) {
    return ::xsimd::select(a > b, a, b);
}
inline Mask32 as_int(MaskF m) {
    return Mask32(m.data);
}
inline MaskF as_float(Mask32 m) {
    return MaskF(m.data);
}
inline std::uint32_t bits(Mask32 m) {
    const uint32_t weights[4] = {1, 2, 4, 8};
    return vaddvq_u32(vandq_u32(m.data, vld1q_u32(weights)));
}
inline I16 mul_round(I16 a, I16 b) {
    return vqrdmulhq_s16(a, b);
}
inline I16 mul_high(I16 a, I16 b) {
    const int32x4_t lo = vmull_s16(vget_low_s16(a), vget_low_s16(b));
    const int32x4_t hi = vmull_high_s16(a, b);
    return vuzp2q_s16(vreinterpretq_s16_s32(lo), vreinterpretq_s16_s32(hi));
}
inline I16 mul_high_unsigned(I16 a, I16 b) {
    const uint16x8_t u = vreinterpretq_u16_s16(a), v = vreinterpretq_u16_s16(b);
    const uint32x4_t lo = vmull_u16(vget_low_u16(u), vget_low_u16(v));
    const uint32x4_t hi = vmull_high_u16(u, v);
    return vreinterpretq_s16_u16(vuzp2q_u16(vreinterpretq_u16_u32(lo), vreinterpretq_u16_u32(hi)));
}
inline I32 mul_add_pairs(I16 a, I16 b) {
    return vpaddq_s32(vmull_s16(vget_low_s16(a), vget_low_s16(b)), vmull_high_s16(a, b));
}
/// Saturates like the x86 instruction, though no caller reaches the ends.
inline I16 mul_add_bytes(I16 u8, I16 s8) {
    const uint8x16_t u = vreinterpretq_u8_s16(u8);
    const int8x16_t s = vreinterpretq_s8_s16(s8);
    const int16x8_t lo =
        vmulq_s16(vreinterpretq_s16_u16(vmovl_u8(vget_low_u8(u))), vmovl_s8(vget_low_s8(s)));
    const int16x8_t hi = vmulq_s16(vreinterpretq_s16_u16(vmovl_high_u8(u)), vmovl_high_s8(s));
    return vqaddq_s16(vuzp1q_s16(lo, hi), vuzp2q_s16(lo, hi));
}
inline I16 average(I16 a, I16 b) {
    return vreinterpretq_s16_u16(vrhaddq_u16(vreinterpretq_u16_s16(a), vreinterpretq_u16_s16(b)));
}
inline I16 zip_lo16(I16 a, I16 b) {
    return vzip1q_s16(a, b);
}
inline I16 zip_hi16(I16 a, I16 b) {
    return vzip2q_s16(a, b);
}
inline I16 zip_lo32(I16 a, I16 b) {
    return vreinterpretq_s16_s32(vzip1q_s32(vreinterpretq_s32_s16(a), vreinterpretq_s32_s16(b)));
}
inline I16 zip_hi32(I16 a, I16 b) {
    return vreinterpretq_s16_s32(vzip2q_s32(vreinterpretq_s32_s16(a), vreinterpretq_s32_s16(b)));
}
inline I16 zip_lo64(I16 a, I16 b) {
    return vreinterpretq_s16_s64(vzip1q_s64(vreinterpretq_s64_s16(a), vreinterpretq_s64_s16(b)));
}
inline I16 zip_hi64(I16 a, I16 b) {
    return vreinterpretq_s16_s64(vzip2q_s64(vreinterpretq_s64_s16(a), vreinterpretq_s64_s16(b)));
}
inline I16 narrow(I32 lo, I32 hi) {
    return vqmovn_high_s32(vqmovn_s32(lo), hi);
}
inline I16 shuffle_bytes(I16 v, I16 pattern) {
    return vreinterpretq_s16_u8(vqtbl1q_u8(vreinterpretq_u8_s16(v), vreinterpretq_u8_s16(pattern)));
}
inline Doubles to_double(F32 v) {
    return {vcvt_f64_f32(vget_low_f32(v)), vcvt_high_f64_f32(v)};
}
inline F32 to_float(const Doubles& v) {
    return vcvt_high_f32_f64(vcvt_f32_f64(v.low), v.high);
}
struct LaneOrder {
    explicit LaneOrder(I32 index)
        : bytes(vreinterpretq_u8_s32(index * I32(0x04040404) + I32(0x03020100))) {}
    F32 operator()(F32 v) const {
        return vreinterpretq_f32_u8(vqtbl1q_u8(vreinterpretq_u8_f32(v), bytes));
    }
    I32 operator()(I32 v) const {
        return vreinterpretq_s32_u8(vqtbl1q_u8(vreinterpretq_u8_s32(v), bytes));
    }
    uint8x16_t bytes;
};
inline I32 load_widened(const std::uint16_t* p) {
    return vreinterpretq_s32_u32(vmovl_u16(vld1_u16(p)));
}
inline I32 load_widened(const std::int16_t* p) {
    return vmovl_s16(vld1_s16(p));
}
inline void store_narrowed(std::int16_t* p, I32 v) {
    vst1_s16(p, vmovn_s32(v));
}
template <int kApart = 8>
inline I16 load_pairs(const std::uint8_t* base, const std::int32_t* offset) {
    return vreinterpretq_s16_u8(vcombine_u8(vld1_u8(base + offset[0]), vld1_u8(base + offset[1])));
}
inline I32 look_up(const std::int32_t* table, I32 index) {
    return I32::gather(table, index);
}
struct ShortTable {
    explicit ShortTable(const std::int32_t (&entries)[16]) : table(entries) {}
    I32 operator()(I32 index) const { return I32::gather(table, index); }
    const std::int32_t* table;
};
inline I16 broadcast_lane(const void* p) {
    return vld1q_s16(static_cast<const int16_t*>(p));
}
template <int Half>
inline F64 to_double(I32 v) {
    return vcvtq_f64_s64(vmovl_s32(Half == 0 ? vget_low_s32(v) : vget_high_s32(v)));
}
template <int Half>
inline F64 to_double(F32 v) {
    return vcvt_f64_f32(Half == 0 ? vget_low_f32(v) : vget_high_f32(v));
}
inline F32 to_float(F64 low, F64 high) {
    return vcvt_high_f32_f64(vcvt_f32_f64(low), high);
}
template <int K>
inline void store_lane(void* p, I16 v) {
    static_assert(K == 0);
    vst1q_s16(static_cast<int16_t*>(p), v);
}
inline void store_packed(std::int32_t* p, I32 v, std::uint32_t bits) {
    const uint8x16_t pattern = vld1q_u8(kPackPatterns.row[bits]);
    vst1q_s32(p, vreinterpretq_s32_u8(vqtbl1q_u8(vreinterpretq_u8_s32(v), pattern)));
}

inline I16 load_lanes(const void* const* p) {
    return vld1q_s16(static_cast<const int16_t*>(p[0]));
}
inline void store_lanes(void* const* p, I16 v) {
    vst1q_s16(static_cast<int16_t*>(p[0]), v);
}

inline I16 even_lanes(I16 a, I16) {
    return a;
}
inline I16 odd_lanes(I16, I16 b) {
    return b;
}
inline I16 zip_lanes_lo(I16 a, I16) {
    return a;
}
inline I16 zip_lanes_hi(I16, I16 b) {
    return b;
}

inline I16 upper_words(I32 a, I32 b) {
    return vtrn2q_s16(vreinterpretq_s16_s32(a), vreinterpretq_s16_s32(b));
}
inline void load_texel_row(const std::uint8_t* p, I16 (&row)[kTexelRowVectors]) {
    const auto* const words = reinterpret_cast<const std::int16_t*>(p);
    for (int half = 0; half < 2; ++half) {
        const I16 left = load(words + 8 * half), right = load(words + 8 * half + 16);
        row[2 * half] = zip_lo16(left, right);
        row[2 * half + 1] = zip_hi16(left, right);
    }
}

inline I32 even_dwords(I32 a, I32 b) {
    return vuzp1q_s32(a, b);
}
inline I32 odd_dwords(I32 a, I32 b) {
    return vuzp2q_s32(a, b);
}

}  // namespace
}  // namespace burnish::BURNISH_ISA
