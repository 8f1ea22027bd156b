#pragma once

#ifndef BURNISH_ISA
#error "only for the per-ISA build of kernels/isa.cpp"
#endif

#include <cstddef>
#include <cstdint>
#include <xsimd/xsimd.hpp>

#if defined(__x86_64__)
#include <immintrin.h>
#elif defined(__aarch64__)
#include <arm_neon.h>
#endif

/// Vectors of one ISA: arithmetic comes from xsimd, and what xsimd 8.1 lacks is here. Everything
/// has internal linkage in that ISA's own namespace.
///
/// "Lane" below is one of the 128-bit parts of a vector: zip_*, widen_*, narrow and shuffle_bytes
/// work inside each lane, so widen and narrow undo each other whatever the width.
namespace burnish::BURNISH_ISA {
namespace {

using Arch = ::xsimd::BURNISH_ARCH;
using I16 = ::xsimd::batch<std::int16_t, Arch>;
using U16 = ::xsimd::batch<std::uint16_t, Arch>;
using I32 = ::xsimd::batch<std::int32_t, Arch>;
using F32 = ::xsimd::batch<float, Arch>;
using F64 = ::xsimd::batch<double, Arch>;
using Mask32 = ::xsimd::batch_bool<std::int32_t, Arch>;
using MaskF = ::xsimd::batch_bool<float, Arch>;

inline constexpr int kLanes = static_cast<int>(I16::size);    // 16-bit
inline constexpr int kLanes32 = static_cast<int>(I32::size);  // 32-bit
inline constexpr int kParts = kLanes / 8;                     // 128-bit lanes
/// Vectors that take the 64 bytes of two texels of 16 words.
inline constexpr int kTexelRowVectors = 32 / kLanes;

/// Number of each lane.
struct LaneNumbers {
    alignas(64) std::int16_t of16[kLanes];
    alignas(64) std::int32_t of32[kLanes32];
};
constexpr LaneNumbers make_lane_numbers() {
    LaneNumbers lanes{};
    for (int i = 0; i < kLanes; ++i) lanes.of16[i] = static_cast<std::int16_t>(i);
    for (int i = 0; i < kLanes32; ++i) lanes.of32[i] = i;
    return lanes;
}
constexpr LaneNumbers kLaneNumbers = make_lane_numbers();

inline I16 load(const std::int16_t* p) {
    return I16::load_unaligned(p);
}
inline I32 load(const std::int32_t* p) {
    return I32::load_unaligned(p);
}
inline F32 load(const float* p) {
    return F32::load_unaligned(p);
}
inline void store(std::int16_t* p, I16 v) {
    v.store_unaligned(p);
}
inline void store(std::int32_t* p, I32 v) {
    v.store_unaligned(p);
}
inline void store(float* p, F32 v) {
    v.store_unaligned(p);
}

inline I16 min(I16 a, I16 b) {
    return ::xsimd::min(a, b);
}
inline I16 max(I16 a, I16 b) {
    return ::xsimd::max(a, b);
}
inline I32 min(I32 a, I32 b) {
    return ::xsimd::min(a, b);
}
inline I32 max(I32 a, I32 b) {
    return ::xsimd::max(a, b);
}

/// Correctly rounded, as IEEE 754 has them: xsimd 8.1 refines estimates on neon64.
inline F32 divide(F32 a, F32 b) {
#if defined(__aarch64__)
    return vdivq_f32(a, b);
#else
    return a / b;
#endif
}
inline F64 divide(F64 a, F64 b) {
#if defined(__aarch64__)
    return vdivq_f64(a, b);
#else
    return a / b;
#endif
}
inline F32 square_root(F32 a) {
#if defined(__aarch64__)
    return vsqrtq_f32(a);
#else
    return ::xsimd::sqrt(a);
#endif
}

/// The next lower whole number, -0 for -0: xsimd 8.1 makes 0 of it on neon64.
inline F32 round_down(F32 a) {
#if defined(__aarch64__)
    return vrndmq_f32(a);
#else
    return ::xsimd::floor(a);
#endif
}

/// Float to int32 towards zero; |v| < 2^31.
inline I32 truncate(F32 v) {
    return ::xsimd::to_int(v);
}
inline F32 to_float(I32 v) {
    return ::xsimd::to_float(v);
}

/// As doubles, kLanes32 of them.
struct Doubles {
    F64 low, high;
};

/// Bytes of a 128-bit vector of four elements that bring those whose bit is set to the front.
struct PackPatterns {
    alignas(16) std::uint8_t row[16][16];
};
constexpr PackPatterns make_pack_patterns() {
    PackPatterns patterns{};
    for (int bits = 0; bits < 16; ++bits) {
        int n = 0;
        for (int i = 0; i < 16; ++i) {
            if ((bits >> i / 4 & 1) != 0) patterns.row[bits][n++] = static_cast<std::uint8_t>(i);
        }
    }
    return patterns;
}
constexpr PackPatterns kPackPatterns = make_pack_patterns();

#if defined(__AVX512BW__)

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
/// load_pairs() from many rows at once, row k beginning row[k] bytes behind `base`: four fragments
/// at a time, whose addresses stay in registers for all rows.
template <int Rows>
[[gnu::always_inline]] inline void load_pairs(std::uintptr_t base,
                                              const std::ptrdiff_t (&row)[Rows],
                                              const std::int32_t* offset, I16 (&pairs)[Rows]) {
    const auto half = [&](const std::int32_t* at, __m256i(&out)[Rows])
        __attribute__((always_inline)) {
        const std::uintptr_t address[4] = {
            base + static_cast<std::uintptr_t>(at[0]), base + static_cast<std::uintptr_t>(at[1]),
            base + static_cast<std::uintptr_t>(at[8]), base + static_cast<std::uintptr_t>(at[9])};
#pragma GCC unroll 8
        for (int k = 0; k < Rows; ++k) {
            const auto behind = static_cast<std::uintptr_t>(row[k]);
            const auto pair = [&](int f) __attribute__((always_inline)) {
                const __m128i low =
                    _mm_loadl_epi64(reinterpret_cast<const __m128i*>(address[f] + behind));
                return _mm_castpd_si128(
                    _mm_loadh_pd(_mm_castsi128_pd(low),
                                 reinterpret_cast<const double*>(address[f + 1] + behind)));
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

#elif defined(__AVX2__)

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

#elif defined(__SSE4_2__)

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

#elif defined(__aarch64__)

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

#else
#error "no vector wrappers for this architecture"
#endif

#if !defined(__AVX512BW__)
struct LaneRows {
    explicit LaneRows(const I16 (&v)[4]) : column{v[0], v[1], v[2], v[3]} {}
    template <int K>
    void store(void* p) const {
        for (int c = 0; c < 4; ++c)
            store_lane<K>(static_cast<unsigned char*>(p) + 16 * c, column[c]);
    }
    I16 column[4];
};
#endif

/// The same bits as other elements.
inline I32 as_i32(I16 v) {
    return ::xsimd::bitwise_cast<I32>(v);
}
inline I32 as_i32(F32 v) {
    return ::xsimd::bitwise_cast<I32>(v);
}
inline F32 as_f32(I32 v) {
    return ::xsimd::bitwise_cast<F32>(v);
}
inline I16 as_i16(I32 v) {
    return ::xsimd::bitwise_cast<I16>(v);
}
inline I16 as_i16(F32 v) {
    return ::xsimd::bitwise_cast<I16>(v);
}

/// Sign-extends the lower or upper half of each lane. Shifting down what was zipped with itself
/// needs no zero register.
inline I32 widen_lo(I16 v) {
    return as_i32(zip_lo16(v, v)) >> 16;
}
inline I32 widen_hi(I16 v) {
    return as_i32(zip_hi16(v, v)) >> 16;
}

#if !defined(__AVX512BW__)
/// Set bits of a byte as 16-bit positions, packed to the front.
struct BitPositions {
    alignas(16) std::uint16_t row[1 << kLanes32][8];
};
constexpr BitPositions make_bit_positions() {
    BitPositions table{};
    for (int lanes = 0; lanes < 1 << kLanes32; ++lanes) {
        int n = 0;
        for (int bit = 0; bit < kLanes32; ++bit) {
            if ((lanes >> bit & 1) != 0) table.row[lanes][n++] = static_cast<std::uint16_t>(bit);
        }
    }
    return table;
}
constexpr BitPositions kBitPositions = make_bit_positions();

/// The sums do not carry from one 16-bit part of a word to the next.
inline std::uint16_t* append_lanes(std::uint16_t* out, int first, Mask32 which) {
    constexpr std::uint64_t kOnes = 0x0001000100010001U;
    const std::uint32_t lanes = bits(which);
    std::uint64_t words[kLanes32 / 4];
    __builtin_memcpy(words, kBitPositions.row[lanes], sizeof words);
    for (std::uint64_t& word : words) word += static_cast<std::uint64_t>(first) * kOnes;
    __builtin_memcpy(out, words, sizeof words);
    return out + __builtin_popcount(lanes);
}
#endif

/// Four vectors of 32-bit numbers.
struct Columns {
    I32 operator[](int c) const { return as_i32(column[c]); }
    F32 floats(int c) const { return as_f32(as_i32(column[c])); }
    I16 column[4];
};
/// Rows of four numbers to columns of them, in each lane, and the way back.
inline Columns transposed(const Columns& m) {
    const I16 a = zip_lo32(m.column[0], m.column[1]), b = zip_hi32(m.column[0], m.column[1]);
    const I16 c = zip_lo32(m.column[2], m.column[3]), d = zip_hi32(m.column[2], m.column[3]);
    return {{zip_lo64(a, c), zip_hi64(a, c), zip_lo64(b, d), zip_hi64(b, d)}};
}
/// Columns of kLanes32 rows of four 32-bit numbers; row(k) says where row k is.
template <class Row>
[[gnu::always_inline]] inline Columns load_columns(Row&& row) {
    Columns rows;
    for (int j = 0; j < 4; ++j) {
        const void* lanes[kParts];
        for (int k = 0; k < kParts; ++k) lanes[k] = row(4 * k + j);
        rows.column[j] = load_lanes(lanes);
    }
    return transposed(rows);
}
/// The way back.
template <class Row>
void store_columns(const Columns& columns, Row&& row) {
    const Columns rows = transposed(columns);
    for (int j = 0; j < 4; ++j) {
        void* lanes[kParts];
        for (int k = 0; k < kParts; ++k) lanes[k] = row(4 * k + j);
        store_lanes(lanes, rows.column[j]);
    }
}

inline I16 as_signed(U16 v) {
    return ::xsimd::bitwise_cast<I16>(v);
}
inline U16 as_unsigned(I16 v) {
    return ::xsimd::bitwise_cast<U16>(v);
}
/// As unsigned numbers, saturating at 65535 and 0.
inline I16 add_saturating_unsigned(I16 a, I16 b) {
    return as_signed(::xsimd::sadd(as_unsigned(a), as_unsigned(b)));
}
inline I16 subtract_saturating_unsigned(I16 a, I16 b) {
    return as_signed(::xsimd::ssub(as_unsigned(a), as_unsigned(b)));
}
/// (a b + 2^13) >> 14, exactly, for 0 <= a, b <= 2^14: 2 a may stop at 2^15 - 1, which for a = 2^14
/// leaves b all the same.
inline I16 mul_14_bits_positive(I16 a, I16 b) {
    return mul_round(::xsimd::sadd(a, a), b);
}
/// The same for |a|, |b| <= 2^14. There a = 2^14 makes of b = -2^14 one too much, and of no other
/// b.
inline I16 mul_14_bits(I16 a, I16 b) {
#if defined(__AVX512BW__)
    return _mm512_mask_mulhrs_epi16(b, _mm512_cmpneq_epi16_mask(a, I16(16384)), a + a, b);
#else
    // (1 - a) (1 + b) >= 0, so that a b <= 1 + b - a, which is -1 there.
    const I16 most = ::xsimd::sadd(::xsimd::ssub(b, a), I16(16384));
    return min(mul_14_bits_positive(a, b), most);
#endif
}
/// All bits where a = b, else none.
inline I16 equal_words(I16 a, I16 b) {
#if defined(__AVX512BW__)
    return _mm512_movm_epi16(_mm512_cmpeq_epi16_mask(a, b));
#elif defined(__aarch64__)
    return vreinterpretq_s16_u16(vceqq_s16(a, b));
#else
    return (a == b).data;
#endif
}
/// Of unsigned numbers.
inline I32 min_unsigned(I32 a, I32 b) {
    using U32 = ::xsimd::batch<std::uint32_t, Arch>;
    return ::xsimd::bitwise_cast<I32>(
        ::xsimd::min(::xsimd::bitwise_cast<U32>(a), ::xsimd::bitwise_cast<U32>(b)));
}
/// Zeros come in from the left.
inline I16 shift_right_logical(I16 v, int n) {
    return as_signed(as_unsigned(v) >> n);
}

#if !defined(__AVX512BW__)
inline void store_narrowed(std::int16_t* p, I32 first, I32 second) {
    store_narrowed(p, first);
    store_narrowed(p + kLanes32, second);
}
template <int Rows>
[[gnu::always_inline]] inline void load_pairs(std::uintptr_t base,
                                              const std::ptrdiff_t (&row)[Rows],
                                              const std::int32_t* offset, I16 (&pairs)[Rows]) {
#pragma GCC unroll 8
    for (int k = 0; k < Rows; ++k) {
        const std::uintptr_t address = base + static_cast<std::uintptr_t>(row[k]);
        pairs[k] = load_pairs(reinterpret_cast<const std::uint8_t*>(address), offset);
    }
}
#endif

#if !defined(__AVX2__)
/// Bits from the first on, and up to the last, which is one less than the index.
struct RowBits {
    std::uint64_t from[65], until[65];
};
constexpr RowBits make_row_bits() {
    RowBits bits{};
    for (int i = 0; i < 64; ++i) {
        bits.from[i] = ~std::uint64_t{0} << i;
        bits.until[i + 1] = ~std::uint64_t{0} >> (63 - i);
    }
    return bits;
}
constexpr RowBits kRowBits = make_row_bits();

inline void store_block_rows(const I32 (&first)[2], const I32 (&last)[2], std::uint64_t* to) {
    static constexpr std::int8_t kPairs[16] = {0, 8,  1, 9,  2, 10, 3, 11,
                                               4, 12, 5, 13, 6, 14, 7, 15};
    std::int32_t from[8], until[8];
    for (int v = 0; v < 2; ++v) {
        store(from + 4 * v, first[v]);
        store(until + 4 * v, last[v]);
    }
    std::uint64_t rows[8];
    for (int k = 0; k < 8; ++k) rows[k] = kRowBits.from[from[k]] & kRowBits.until[until[k] + 1];
    const I16 pairs = broadcast_lane(kPairs);
    I16 two[4];
    for (int k = 0; k < 4; ++k) two[k] = shuffle_bytes(broadcast_lane(rows + 2 * k), pairs);
    const I16 low[2] = {zip_lo16(two[0], two[1]), zip_lo16(two[2], two[3])};
    const I16 high[2] = {zip_hi16(two[0], two[1]), zip_hi16(two[2], two[3])};
    store_lane<0>(to, zip_lo32(low[0], low[1]));
    store_lane<0>(to + 2, zip_hi32(low[0], low[1]));
    store_lane<0>(to + 4, zip_lo32(high[0], high[1]));
    store_lane<0>(to + 6, zip_hi32(high[0], high[1]));
}
#endif

#if !defined(__AVX512BW__)
/// Bit k of word k.
struct LaneBits {
    alignas(64) std::int32_t bit[32];
};
constexpr LaneBits make_lane_bits() {
    LaneBits lanes{};
    for (int i = 0; i < 32; ++i) lanes.bit[i] = static_cast<std::int32_t>(std::uint32_t{1} << i);
    return lanes;
}
constexpr LaneBits kLaneBits = make_lane_bits();

inline Mask32 lanes_of(std::uint32_t lanes) {
    return (I32(static_cast<std::int32_t>(lanes)) & load(kLaneBits.bit)) != I32(0);
}
struct BlockLanes {
    explicit BlockLanes(std::uint64_t pixels)
        : m_half{I32(static_cast<std::int32_t>(pixels)),
                 I32(static_cast<std::int32_t>(pixels >> 32))} {}
    Mask32 operator[](int vector) const {
        const int first = vector * kLanes32;
        return (m_half[first / 32] & load(kLaneBits.bit + first % 32)) != I32(0);
    }
    I32 m_half[2];
};
inline Mask32 equal_words(const std::uint64_t* words, std::uint64_t value) {
    std::int32_t equal[kLanes32];
    for (int k = 0; k < kLanes32; ++k) equal[k] = words[k] == value ? 1 : 0;
    return load(equal) != I32(0);
}
inline void append_words(std::uint64_t* to, const std::uint64_t* words, Mask32 which) {
    const std::uint32_t lanes = bits(which);
    for (int k = 0; k < kLanes32; ++k) {
        *to = words[k];
        to += lanes >> k & 1;
    }
}
#endif

}  // namespace
}  // namespace burnish::BURNISH_ISA
