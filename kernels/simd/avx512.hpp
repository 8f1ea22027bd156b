#pragma once

#include "kernels/simd/vectors.hpp"

/// 512 bits: AVX-512 F, CD, DQ, BW and VL. What each wrapper does is said here, and holds for the
/// same name in the other files.
namespace burnish::BURNISH_ISA {
namespace {

/// a < b ? a : b and a > b ? a : b on every ISA: a NaN in a yields b. On x86 that is what the
/// instructions do.
inline F32 min(F32 a, F32 b) {
    return _mm512_min_ps(a, b);
}
inline F32 max(F32 a, F32 b) {
    return _mm512_max_ps(a, b);
}
inline Mask32 as_int(MaskF m) {
    return Mask32(m.data);
}
inline MaskF as_float(Mask32 m) {
    return MaskF(m.data);
}
inline std::uint32_t bits(Mask32 m) {
    return static_cast<std::uint32_t>(m.data);
}
/// The way back: lanes whose bits are set.
inline Mask32 lanes_of(std::uint32_t lanes) {
    return Mask32(static_cast<__mmask16>(lanes));
}
/// The bits of a block's 64 pixels, kLanes32 of them at a time.
struct BlockLanes {
    explicit BlockLanes(std::uint64_t pixels) : m_pixels(pixels) {}
    Mask32 operator[](int vector) const {
        return Mask32(static_cast<__mmask16>(m_pixels >> kLanes32 * vector));
    }
    std::uint64_t m_pixels;
};
inline I16 mul_round(I16 a, I16 b) {
    return _mm512_mulhrs_epi16(a, b);
}
inline I16 mul_high(I16 a, I16 b) {
    return _mm512_mulhi_epi16(a, b);
}
inline I16 mul_high_unsigned(I16 a, I16 b) {
    return _mm512_mulhi_epu16(a, b);
}
inline I32 mul_add_pairs(I16 a, I16 b) {
    return _mm512_madd_epi16(a, b);
}
inline I16 mul_add_bytes(I16 u8, I16 s8) {
    return _mm512_maddubs_epi16(u8, s8);
}
/// (a + b + 1) >> 1 of unsigned numbers.
inline I16 average(I16 a, I16 b) {
    return _mm512_avg_epu16(a, b);
}
inline I16 zip_lo16(I16 a, I16 b) {
    return _mm512_unpacklo_epi16(a, b);
}
inline I16 zip_hi16(I16 a, I16 b) {
    return _mm512_unpackhi_epi16(a, b);
}
inline I16 zip_lo32(I16 a, I16 b) {
    return _mm512_unpacklo_epi32(a, b);
}
inline I16 zip_hi32(I16 a, I16 b) {
    return _mm512_unpackhi_epi32(a, b);
}
inline I16 zip_lo64(I16 a, I16 b) {
    return _mm512_unpacklo_epi64(a, b);
}
inline I16 zip_hi64(I16 a, I16 b) {
    return _mm512_unpackhi_epi64(a, b);
}
inline I16 narrow(I32 lo, I32 hi) {
    return _mm512_packs_epi32(lo, hi);
}
inline I16 shuffle_bytes(I16 v, I16 pattern) {
    return _mm512_shuffle_epi8(v, pattern);
}
inline Doubles to_double(F32 v) {
    return {_mm512_cvtps_pd(_mm512_castps512_ps256(v)),
            _mm512_cvtps_pd(_mm512_extractf32x8_ps(v, 1))};
}
/// Rounded to nearest.
inline F32 to_float(const Doubles& v) {
    return _mm512_insertf32x8(_mm512_castps256_ps512(_mm512_cvtpd_ps(v.low)),
                              _mm512_cvtpd_ps(v.high), 1);
}
/// Writes first + k for every lane k of `which`, rising; returns the end. May write kLanes32
/// values.
inline std::uint16_t* append_lanes(std::uint16_t* out, int first, Mask32 which) {
    const __m512i lane = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    const __m512i value = _mm512_add_epi32(lane, _mm512_set1_epi32(first));
    const __m512i packed = _mm512_maskz_compress_epi32(which.data, value);
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(out), _mm512_cvtepi32_epi16(packed));
    return out + __builtin_popcount(which.data);
}
/// Lane k of the result is lane index[k], 0 .. kLanes32 - 1.
struct LaneOrder {
    explicit LaneOrder(I32 index) : order(index) {}
    F32 operator()(F32 v) const { return _mm512_permutexvar_ps(order, v); }
    I32 operator()(I32 v) const { return _mm512_permutexvar_epi32(order, v); }
    __m512i order;
};
/// kLanes32 consecutive unsigned 16-bit values, in order; and the way back, for values that fit.
inline I32 load_widened(const std::uint16_t* p) {
    return _mm512_cvtepu16_epi32(_mm256_loadu_si256(reinterpret_cast<const __m256i*>(p)));
}
/// Signed ones.
inline I32 load_widened(const std::int16_t* p) {
    return _mm512_cvtepi16_epi32(_mm256_loadu_si256(reinterpret_cast<const __m256i*>(p)));
}
inline void store_narrowed(std::int16_t* p, I32 v) {
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(p), _mm512_cvtepi32_epi16(v));
}
/// Of two vectors: one permutation takes half as long as two conversions.
inline void store_narrowed(std::int16_t* p, I32 first, I32 second) {
    const __m512i even_words =
        _mm512_set_epi16(62, 60, 58, 56, 54, 52, 50, 48, 46, 44, 42, 40, 38, 36, 34, 32, 30, 28, 26,
                         24, 22, 20, 18, 16, 14, 12, 10, 8, 6, 4, 2, 0);
    _mm512_storeu_si512(p, _mm512_permutex2var_epi16(first, even_words, second));
}
/// 64-bit loads of texel pairs: lane k gets the pairs at offset[kApart k] (low half) and
/// offset[kApart k + 1].
template <int kApart = 8>
inline I16 load_pairs(const std::uint8_t* base, const std::int32_t* offset) {
    const auto pair = [&](int k) {
        const __m128i low =
            _mm_loadl_epi64(reinterpret_cast<const __m128i*>(base + offset[kApart * k]));
        return _mm_castpd_si128(_mm_loadh_pd(
            _mm_castsi128_pd(low), reinterpret_cast<const double*>(base + offset[kApart * k + 1])));
    };
    const __m256i low = _mm256_inserti128_si256(_mm256_castsi128_si256(pair(0)), pair(1), 1);
    const __m256i high = _mm256_inserti128_si256(_mm256_castsi128_si256(pair(2)), pair(3), 1);
    return _mm512_inserti64x4(_mm512_castsi256_si512(low), high, 1);
}
/// load_pairs() from many rows at once, which begin at addresses row[k]: four fragments at a time,
/// whose offsets stay in registers for all rows.
template <int Rows>
[[gnu::always_inline]] inline void load_pairs(const std::uintptr_t (&row)[Rows],
                                              const std::int32_t* offset, I16 (&pairs)[Rows]) {
    const auto half = [&](const std::int32_t* at, __m256i(&out)[Rows])
        __attribute__((always_inline)) {
        const std::uintptr_t behind[4] = {
            static_cast<std::uintptr_t>(at[0]), static_cast<std::uintptr_t>(at[1]),
            static_cast<std::uintptr_t>(at[8]), static_cast<std::uintptr_t>(at[9])};
#pragma GCC unroll 8
        for (int k = 0; k < Rows; ++k) {
            const auto pair = [&](int f) __attribute__((always_inline)) {
                const __m128i low =
                    _mm_loadl_epi64(reinterpret_cast<const __m128i*>(row[k] + behind[f]));
                return _mm_castpd_si128(
                    _mm_loadh_pd(_mm_castsi128_pd(low),
                                 reinterpret_cast<const double*>(row[k] + behind[f + 1])));
            };
            out[k] = _mm256_inserti128_si256(_mm256_castsi128_si256(pair(0)), pair(2), 1);
        }
    };
    __m256i low[Rows], high[Rows];
    half(offset, low);
    half(offset + 16, high);
#pragma GCC unroll 8
    for (int k = 0; k < Rows; ++k)
        pairs[k] = _mm512_inserti64x4(_mm512_castsi256_si512(low[k]), high[k], 1);
}
/// Entries of a short table. xsimd 8.1 has no gather of its own for AVX-512.
inline I32 look_up(const std::int32_t* table, I32 index) {
    return _mm512_i32gather_epi32(index, table, 4);
}
/// A table of 16 entries, looked up where it lies: in registers if they have a permutation, since a
/// gather takes as long as dozens of them.
struct ShortTable {
    explicit ShortTable(const std::int32_t (&entries)[16]) : all(_mm512_loadu_si512(entries)) {}
    I32 operator()(I32 index) const { return _mm512_permutexvar_epi32(index, all); }
    __m512i all;
};
inline I16 broadcast_lane(const void* p) {
    return _mm512_broadcast_i32x4(_mm_loadu_si128(static_cast<const __m128i*>(p)));
}

/// Numbers 0 .. kLanes32 / 2 - 1 (Half = 0) or the other ones in double, and the way back.
template <int Half>
inline F64 to_double(I32 v) {
    return _mm512_cvtepi32_pd(_mm512_extracti64x4_epi64(v, Half));
}
template <int Half>
inline F64 to_double(F32 v) {
    return _mm512_cvtps_pd(_mm512_extractf32x8_ps(v, Half));
}
inline F32 to_float(F64 low, F64 high) {
    return _mm512_insertf32x8(_mm512_castps256_ps512(_mm512_cvtpd_ps(low)), _mm512_cvtpd_ps(high),
                              1);
}
/// Lane K to memory.
template <int K>
inline void store_lane(void* p, I16 v) {
    _mm_storeu_si128(static_cast<__m128i*>(p), _mm512_extracti32x4_epi32(v, K));
}
/// The elements whose bit is set, one after the other; the rest of a vector behind them may be
/// written as well.
inline void store_packed(std::int32_t* p, I32 v, std::uint32_t bits) {
    const __m512i packed = _mm512_maskz_compress_epi32(static_cast<__mmask16>(bits), v);
    // Half a vector crosses half as many cache lines.
    if (__builtin_popcount(bits) <= 8) {
        _mm256_storeu_si256(reinterpret_cast<__m256i*>(p), _mm512_castsi512_si256(packed));
    } else {
        _mm512_storeu_si512(p, packed);
    }
}
/// Four vectors, and lane K of each, one behind the other, to memory.
struct LaneRows {
    explicit LaneRows(const I16 (&v)[4]) {
        const __m512i low01 = _mm512_shuffle_i32x4(v[0], v[1], 0x44);
        const __m512i low23 = _mm512_shuffle_i32x4(v[2], v[3], 0x44);
        const __m512i high01 = _mm512_shuffle_i32x4(v[0], v[1], 0xee);
        const __m512i high23 = _mm512_shuffle_i32x4(v[2], v[3], 0xee);
        row[0] = _mm512_shuffle_i32x4(low01, low23, 0x88);
        row[1] = _mm512_shuffle_i32x4(low01, low23, 0xdd);
        row[2] = _mm512_shuffle_i32x4(high01, high23, 0x88);
        row[3] = _mm512_shuffle_i32x4(high01, high23, 0xdd);
    }
    template <int K>
    void store(void* p) const {
        _mm512_storeu_si512(p, row[K]);
    }
    __m512i row[4];
};

/// Lane k from p[k].
inline I16 load_lanes(const void* const* p) {
    const auto lane = [&](int k) { return _mm_loadu_si128(static_cast<const __m128i*>(p[k])); };
    const __m256i low = _mm256_inserti128_si256(_mm256_castsi128_si256(lane(0)), lane(1), 1);
    const __m256i high = _mm256_inserti128_si256(_mm256_castsi128_si256(lane(2)), lane(3), 1);
    return _mm512_inserti64x4(_mm512_castsi256_si512(low), high, 1);
}
/// Lane k to p[k].
inline void store_lanes(void* const* p, I16 v) {
    _mm_storeu_si128(static_cast<__m128i*>(p[0]), _mm512_castsi512_si128(v));
    _mm_storeu_si128(static_cast<__m128i*>(p[1]), _mm512_extracti32x4_epi32(v, 1));
    _mm_storeu_si128(static_cast<__m128i*>(p[2]), _mm512_extracti32x4_epi32(v, 2));
    _mm_storeu_si128(static_cast<__m128i*>(p[3]), _mm512_extracti32x4_epi32(v, 3));
}

inline I16 even_lanes(I16 a, I16 b) {
    return _mm512_shuffle_i64x2(a, b, 0x88);
}
inline I16 odd_lanes(I16 a, I16 b) {
    return _mm512_shuffle_i64x2(a, b, 0xdd);
}
inline I16 zip_lanes_lo(I16 a, I16 b) {
    return _mm512_permutex2var_epi64(a, _mm512_setr_epi64(0, 1, 8, 9, 2, 3, 10, 11), b);
}
inline I16 zip_lanes_hi(I16 a, I16 b) {
    return _mm512_permutex2var_epi64(a, _mm512_setr_epi64(4, 5, 12, 13, 6, 7, 14, 15), b);
}

/// The upper words of a and of b in turn.
inline I16 upper_words(I32 a, I32 b) {
    return _mm512_mask_blend_epi16(0xaaaaaaaaU, _mm512_srli_epi32(a, 16), b);
}
/// Two texels of 16 words at p, word by word left and right: lane k of vector j has words
/// 4 (kTexelRowVectors k + j) and the three behind it.
inline void load_texel_row(const std::uint8_t* p, I16 (&row)[kTexelRowVectors]) {
    alignas(64) static constexpr std::int16_t kSides[32] = {
        0, 16, 1, 17, 2,  18, 3,  19, 4,  20, 5,  21, 6,  22, 7,  23,
        8, 24, 9, 25, 10, 26, 11, 27, 12, 28, 13, 29, 14, 30, 15, 31};
    row[0] = _mm512_permutexvar_epi16(_mm512_load_si512(kSides), _mm512_loadu_si512(p));
}

/// Dwords 0, 2 of each lane of a, then of b; and dwords 1, 3.
inline I32 even_dwords(I32 a, I32 b) {
    return _mm512_castps_si512(
        _mm512_shuffle_ps(_mm512_castsi512_ps(a), _mm512_castsi512_ps(b), 0x88));
}
inline I32 odd_dwords(I32 a, I32 b) {
    return _mm512_castps_si512(
        _mm512_shuffle_ps(_mm512_castsi512_ps(a), _mm512_castsi512_ps(b), 0xdd));
}

/// Which of kLanes32 words are `value`.
inline Mask32 equal_words(const std::uint64_t* words, std::uint64_t value) {
    const __m512i wanted = _mm512_set1_epi64(static_cast<long long>(value));
    const __mmask8 low = _mm512_cmpeq_epi64_mask(_mm512_loadu_si512(words), wanted);
    const __mmask8 high = _mm512_cmpeq_epi64_mask(_mm512_loadu_si512(words + 8), wanted);
    return Mask32(_mm512_kunpackb(high, low));
}
/// Words k of lanes k of `which`, rising; may write kLanes32 of them.
inline void append_words(std::uint64_t* to, const std::uint64_t* words, Mask32 which) {
    const auto low = static_cast<__mmask8>(which.data),
               high = static_cast<__mmask8>(which.data >> 8);
    _mm512_storeu_si512(to, _mm512_maskz_compress_epi64(low, _mm512_loadu_si512(words)));
    _mm512_storeu_si512(to + __builtin_popcount(low),
                        _mm512_maskz_compress_epi64(high, _mm512_loadu_si512(words + 8)));
}
/// Bits first .. last, 0 .. 63, of kLanes32 rows of 64; none where first > last, which may be 64
/// and -1. Word 8 r + j of `to` is the 8 x 8 block of rows 8 r .. and bits 8 j .., a row in each
/// byte.
inline void store_block_rows(const I32 (&first)[1], const I32 (&last)[1], std::uint64_t* to) {
    const __m512i all = _mm512_set1_epi64(-1), end = _mm512_set1_epi64(63);
    const __m512i pairs =
        _mm512_broadcast_i32x4(_mm_setr_epi8(0, 8, 1, 9, 2, 10, 3, 11, 4, 12, 5, 13, 6, 14, 7, 15));
    alignas(64) static constexpr std::int16_t kWords[32] = {
        0, 8,  16, 24, 1, 9,  17, 25, 2, 10, 18, 26, 3, 11, 19, 27,
        4, 12, 20, 28, 5, 13, 21, 29, 6, 14, 22, 30, 7, 15, 23, 31};
    const __m512i words = _mm512_load_si512(kWords);
    const auto blocks = [&](__m256i from, __m256i until) {
        const __m512i rows = _mm512_and_si512(
            _mm512_sllv_epi64(all, _mm512_cvtepi32_epi64(from)),
            _mm512_srlv_epi64(all, _mm512_sub_epi64(end, _mm512_cvtepi32_epi64(until))));
        return _mm512_permutexvar_epi16(words, _mm512_shuffle_epi8(rows, pairs));
    };
    _mm512_storeu_si512(to,
                        blocks(_mm512_castsi512_si256(first[0]), _mm512_castsi512_si256(last[0])));
    _mm512_storeu_si512(to + 8, blocks(_mm512_extracti64x4_epi64(first[0], 1),
                                       _mm512_extracti64x4_epi64(last[0], 1)));
}

}  // namespace
}  // namespace burnish::BURNISH_ISA
