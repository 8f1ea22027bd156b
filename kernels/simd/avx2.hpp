#pragma once

#include "kernels/simd/vectors.hpp"

/// 256 bits; avx512.hpp says what each wrapper does.
namespace burnish::BURNISH_ISA {
namespace {

inline F32 min(F32 a, F32 b) {
    return _mm256_min_ps(a, b);
}
inline F32 max(F32 a, F32 b) {
    return _mm256_max_ps(a, b);
}
inline Mask32 as_int(MaskF m) {
    return Mask32(_mm256_castps_si256(m.data));
}
inline MaskF as_float(Mask32 m) {
    return MaskF(_mm256_castsi256_ps(m.data));
}
inline std::uint32_t bits(Mask32 m) {
    return static_cast<std::uint32_t>(_mm256_movemask_ps(_mm256_castsi256_ps(m.data)));
}
inline I16 mul_round(I16 a, I16 b) {
    return _mm256_mulhrs_epi16(a, b);
}
inline I16 mul_high(I16 a, I16 b) {
    return _mm256_mulhi_epi16(a, b);
}
inline I16 mul_high_unsigned(I16 a, I16 b) {
    return _mm256_mulhi_epu16(a, b);
}
inline I32 mul_add_pairs(I16 a, I16 b) {
    return _mm256_madd_epi16(a, b);
}
inline I16 mul_add_bytes(I16 u8, I16 s8) {
    return _mm256_maddubs_epi16(u8, s8);
}
inline I16 average(I16 a, I16 b) {
    return _mm256_avg_epu16(a, b);
}
inline I16 zip_lo16(I16 a, I16 b) {
    return _mm256_unpacklo_epi16(a, b);
}
inline I16 zip_hi16(I16 a, I16 b) {
    return _mm256_unpackhi_epi16(a, b);
}
inline I16 zip_lo32(I16 a, I16 b) {
    return _mm256_unpacklo_epi32(a, b);
}
inline I16 zip_hi32(I16 a, I16 b) {
    return _mm256_unpackhi_epi32(a, b);
}
inline I16 zip_lo64(I16 a, I16 b) {
    return _mm256_unpacklo_epi64(a, b);
}
inline I16 zip_hi64(I16 a, I16 b) {
    return _mm256_unpackhi_epi64(a, b);
}
inline I16 narrow(I32 lo, I32 hi) {
    return _mm256_packs_epi32(lo, hi);
}
inline I16 shuffle_bytes(I16 v, I16 pattern) {
    return _mm256_shuffle_epi8(v, pattern);
}
inline Doubles to_double(F32 v) {
    return {_mm256_cvtps_pd(_mm256_castps256_ps128(v)),
            _mm256_cvtps_pd(_mm256_extractf128_ps(v, 1))};
}
inline F32 to_float(const Doubles& v) {
    return _mm256_insertf128_ps(_mm256_castps128_ps256(_mm256_cvtpd_ps(v.low)),
                                _mm256_cvtpd_ps(v.high), 1);
}
struct LaneOrder {
    explicit LaneOrder(I32 index) : order(index) {}
    F32 operator()(F32 v) const { return _mm256_permutevar8x32_ps(v, order); }
    I32 operator()(I32 v) const { return _mm256_permutevar8x32_epi32(v, order); }
    __m256i order;
};
inline I32 load_widened(const std::uint16_t* p) {
    return _mm256_cvtepu16_epi32(_mm_loadu_si128(reinterpret_cast<const __m128i*>(p)));
}
inline I32 load_widened(const std::int16_t* p) {
    return _mm256_cvtepi16_epi32(_mm_loadu_si128(reinterpret_cast<const __m128i*>(p)));
}
inline void store_narrowed(std::int16_t* p, I32 v) {
    const __m256i pairs = _mm256_permute4x64_epi64(_mm256_packs_epi32(v, v), 0x08);
    _mm_storeu_si128(reinterpret_cast<__m128i*>(p), _mm256_castsi256_si128(pairs));
}
template <int kApart = 8>
inline I16 load_pairs(const std::uint8_t* base, const std::int32_t* offset) {
    const auto pair = [&](int k) {
        const __m128i low =
            _mm_loadl_epi64(reinterpret_cast<const __m128i*>(base + offset[kApart * k]));
        return _mm_castpd_si128(_mm_loadh_pd(
            _mm_castsi128_pd(low), reinterpret_cast<const double*>(base + offset[kApart * k + 1])));
    };
    return _mm256_inserti128_si256(_mm256_castsi128_si256(pair(0)), pair(1), 1);
}
inline I32 look_up(const std::int32_t* table, I32 index) {
    return _mm256_i32gather_epi32(table, index, 4);
}
struct ShortTable {
    explicit ShortTable(const std::int32_t (&entries)[16])
        : low(_mm256_loadu_si256(reinterpret_cast<const __m256i*>(entries))),
          high(_mm256_loadu_si256(reinterpret_cast<const __m256i*>(entries + 8))) {}
    I32 operator()(I32 index) const {
        const __m256i is_high = _mm256_cmpgt_epi32(index, _mm256_set1_epi32(7));
        return _mm256_blendv_epi8(_mm256_permutevar8x32_epi32(low, index),
                                  _mm256_permutevar8x32_epi32(high, index), is_high);
    }
    __m256i low, high;
};
inline I16 broadcast_lane(const void* p) {
    return _mm256_broadcastsi128_si256(_mm_loadu_si128(static_cast<const __m128i*>(p)));
}

template <int Half>
inline F64 to_double(I32 v) {
    return _mm256_cvtepi32_pd(_mm256_extracti128_si256(v, Half));
}
template <int Half>
inline F64 to_double(F32 v) {
    return _mm256_cvtps_pd(_mm256_extractf128_ps(v, Half));
}
inline F32 to_float(F64 low, F64 high) {
    return _mm256_insertf128_ps(_mm256_castps128_ps256(_mm256_cvtpd_ps(low)), _mm256_cvtpd_ps(high),
                                1);
}
template <int K>
inline void store_lane(void* p, I16 v) {
    _mm_storeu_si128(static_cast<__m128i*>(p), _mm256_extracti128_si256(v, K));
}
inline void store_packed(std::int32_t* p, I32 v, std::uint32_t bits) {
    const auto pattern = [](std::uint32_t four) {
        return _mm_load_si128(reinterpret_cast<const __m128i*>(kPackPatterns.row[four]));
    };
    const std::uint32_t low = bits & 15, high = bits >> 4;
    _mm_storeu_si128(reinterpret_cast<__m128i*>(p),
                     _mm_shuffle_epi8(_mm256_castsi256_si128(v), pattern(low)));
    _mm_storeu_si128(reinterpret_cast<__m128i*>(p + __builtin_popcount(low)),
                     _mm_shuffle_epi8(_mm256_extracti128_si256(v, 1), pattern(high)));
}

inline I16 load_lanes(const void* const* p) {
    const auto lane = [&](int k) { return _mm_loadu_si128(static_cast<const __m128i*>(p[k])); };
    return _mm256_inserti128_si256(_mm256_castsi128_si256(lane(0)), lane(1), 1);
}
inline void store_lanes(void* const* p, I16 v) {
    _mm_storeu_si128(static_cast<__m128i*>(p[0]), _mm256_castsi256_si128(v));
    _mm_storeu_si128(static_cast<__m128i*>(p[1]), _mm256_extracti128_si256(v, 1));
}

inline I16 even_lanes(I16 a, I16 b) {
    return _mm256_permute2x128_si256(a, b, 0x20);
}
inline I16 odd_lanes(I16 a, I16 b) {
    return _mm256_permute2x128_si256(a, b, 0x31);
}
inline I16 zip_lanes_lo(I16 a, I16 b) {
    return even_lanes(a, b);
}
inline I16 zip_lanes_hi(I16 a, I16 b) {
    return odd_lanes(a, b);
}

inline I16 upper_words(I32 a, I32 b) {
    return _mm256_blend_epi16(_mm256_srli_epi32(a, 16), b, 0xaa);
}
inline void load_texel_row(const std::uint8_t* p, I16 (&row)[kTexelRowVectors]) {
    const __m256i left = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(p));
    const __m256i right = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(p + 32));
    row[0] = _mm256_unpacklo_epi16(left, right);
    row[1] = _mm256_unpackhi_epi16(left, right);
}

inline I32 even_dwords(I32 a, I32 b) {
    return _mm256_castps_si256(
        _mm256_shuffle_ps(_mm256_castsi256_ps(a), _mm256_castsi256_ps(b), 0x88));
}
inline I32 odd_dwords(I32 a, I32 b) {
    return _mm256_castps_si256(
        _mm256_shuffle_ps(_mm256_castsi256_ps(a), _mm256_castsi256_ps(b), 0xdd));
}

inline void store_block_rows(const I32 (&first)[1], const I32 (&last)[1], std::uint64_t* to) {
    const __m256i all = _mm256_set1_epi64x(-1), end = _mm256_set1_epi64x(63);
    const __m256i pairs = _mm256_broadcastsi128_si256(
        _mm_setr_epi8(0, 8, 1, 9, 2, 10, 3, 11, 4, 12, 5, 13, 6, 14, 7, 15));
    const auto rows = [&](__m128i from, __m128i until) {
        const __m256i bits = _mm256_and_si256(
            _mm256_sllv_epi64(all, _mm256_cvtepi32_epi64(from)),
            _mm256_srlv_epi64(all, _mm256_sub_epi64(end, _mm256_cvtepi32_epi64(until))));
        return _mm256_shuffle_epi8(bits, pairs);
    };
    const __m256i upper = rows(_mm256_castsi256_si128(first[0]), _mm256_castsi256_si128(last[0]));
    const __m256i lower =
        rows(_mm256_extracti128_si256(first[0], 1), _mm256_extracti128_si256(last[0], 1));
    // Pairs of rows 0, 1 and 2, 3 to those of 4, 5 and 6, 7.
    const __m256i low = _mm256_unpacklo_epi16(upper, lower),
                  high = _mm256_unpackhi_epi16(upper, lower);
    const __m256i even = _mm256_permute2x128_si256(low, high, 0x20);
    const __m256i odd = _mm256_permute2x128_si256(low, high, 0x31);
    const __m256i outer = _mm256_unpacklo_epi16(even, odd),
                  inner = _mm256_unpackhi_epi16(even, odd);
    auto* const out = reinterpret_cast<__m256i*>(to);
    _mm256_storeu_si256(out, _mm256_permute2x128_si256(outer, inner, 0x20));
    _mm256_storeu_si256(out + 1, _mm256_permute2x128_si256(outer, inner, 0x31));
}

}  // namespace
}  // namespace burnish::BURNISH_ISA
