#pragma once

#include "kernels/simd/vectors.hpp"

/// 128 bits of x86; avx512.hpp says what each wrapper does.
namespace burnish::BURNISH_ISA {
namespace {

inline F32 min(F32 a, F32 b) {
    return _mm_min_ps(a, b);
}
inline F32 max(F32 a, F32 b) {
    return _mm_max_ps(a, b);
}
inline Mask32 as_int(MaskF m) {
    return Mask32(_mm_castps_si128(m.data));
}
inline MaskF as_float(Mask32 m) {
    return MaskF(_mm_castsi128_ps(m.data));
}
inline std::uint32_t bits(Mask32 m) {
    return static_cast<std::uint32_t>(_mm_movemask_ps(_mm_castsi128_ps(m.data)));
}
inline I16 mul_round(I16 a, I16 b) {
    return _mm_mulhrs_epi16(a, b);
}
inline I16 mul_high(I16 a, I16 b) {
    return _mm_mulhi_epi16(a, b);
}
inline I16 mul_high_unsigned(I16 a, I16 b) {
    return _mm_mulhi_epu16(a, b);
}
inline I32 mul_add_pairs(I16 a, I16 b) {
    return _mm_madd_epi16(a, b);
}
inline I16 mul_add_bytes(I16 u8, I16 s8) {
    return _mm_maddubs_epi16(u8, s8);
}
inline I16 average(I16 a, I16 b) {
    return _mm_avg_epu16(a, b);
}
inline I16 zip_lo16(I16 a, I16 b) {
    return _mm_unpacklo_epi16(a, b);
}
inline I16 zip_hi16(I16 a, I16 b) {
    return _mm_unpackhi_epi16(a, b);
}
inline I16 zip_lo32(I16 a, I16 b) {
    return _mm_unpacklo_epi32(a, b);
}
inline I16 zip_hi32(I16 a, I16 b) {
    return _mm_unpackhi_epi32(a, b);
}
inline I16 zip_lo64(I16 a, I16 b) {
    return _mm_unpacklo_epi64(a, b);
}
inline I16 zip_hi64(I16 a, I16 b) {
    return _mm_unpackhi_epi64(a, b);
}
inline I16 narrow(I32 lo, I32 hi) {
    return _mm_packs_epi32(lo, hi);
}
inline I16 shuffle_bytes(I16 v, I16 pattern) {
    return _mm_shuffle_epi8(v, pattern);
}
inline Doubles to_double(F32 v) {
    return {_mm_cvtps_pd(v), _mm_cvtps_pd(_mm_movehl_ps(v, v))};
}
inline F32 to_float(const Doubles& v) {
    return _mm_movelh_ps(_mm_cvtpd_ps(v.low), _mm_cvtpd_ps(v.high));
}
struct LaneOrder {
    explicit LaneOrder(I32 index) : bytes(index * I32(0x04040404) + I32(0x03020100)) {}
    F32 operator()(F32 v) const {
        return _mm_castsi128_ps(_mm_shuffle_epi8(_mm_castps_si128(v), bytes));
    }
    I32 operator()(I32 v) const { return _mm_shuffle_epi8(v, bytes); }
    __m128i bytes;
};
inline I32 load_widened(const std::uint16_t* p) {
    return _mm_cvtepu16_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(p)));
}
inline I32 load_widened(const std::int16_t* p) {
    return _mm_cvtepi16_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(p)));
}
inline void store_narrowed(std::int16_t* p, I32 v) {
    _mm_storel_epi64(reinterpret_cast<__m128i*>(p), _mm_packs_epi32(v, v));
}
template <int kApart = 8>
inline I16 load_pairs(const std::uint8_t* base, const std::int32_t* offset) {
    const auto pair = [&](int k) {
        const __m128i low =
            _mm_loadl_epi64(reinterpret_cast<const __m128i*>(base + offset[kApart * k]));
        return _mm_castpd_si128(_mm_loadh_pd(
            _mm_castsi128_pd(low), reinterpret_cast<const double*>(base + offset[kApart * k + 1])));
    };
    return pair(0);
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
    return _mm_loadu_si128(static_cast<const __m128i*>(p));
}

template <int Half>
inline F64 to_double(I32 v) {
    return _mm_cvtepi32_pd(Half == 0 ? v : I32(_mm_unpackhi_epi64(v, v)));
}
template <int Half>
inline F64 to_double(F32 v) {
    return _mm_cvtps_pd(Half == 0 ? v : F32(_mm_movehl_ps(v, v)));
}
inline F32 to_float(F64 low, F64 high) {
    return _mm_movelh_ps(_mm_cvtpd_ps(low), _mm_cvtpd_ps(high));
}
template <int K>
inline void store_lane(void* p, I16 v) {
    static_assert(K == 0);
    _mm_storeu_si128(static_cast<__m128i*>(p), v);
}
inline void store_packed(std::int32_t* p, I32 v, std::uint32_t bits) {
    const __m128i* const pattern = reinterpret_cast<const __m128i*>(kPackPatterns.row[bits]);
    _mm_storeu_si128(reinterpret_cast<__m128i*>(p), _mm_shuffle_epi8(v, _mm_load_si128(pattern)));
}

inline I16 load_lanes(const void* const* p) {
    return _mm_loadu_si128(static_cast<const __m128i*>(p[0]));
}
inline void store_lanes(void* const* p, I16 v) {
    _mm_storeu_si128(static_cast<__m128i*>(p[0]), v);
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
    return _mm_blend_epi16(_mm_srli_epi32(a, 16), b, 0xaa);
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
    return _mm_castps_si128(_mm_shuffle_ps(_mm_castsi128_ps(a), _mm_castsi128_ps(b), 0x88));
}
inline I32 odd_dwords(I32 a, I32 b) {
    return _mm_castps_si128(_mm_shuffle_ps(_mm_castsi128_ps(a), _mm_castsi128_ps(b), 0xdd));
}

}  // namespace
}  // namespace burnish::BURNISH_ISA
