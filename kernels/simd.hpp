#pragma once

#include "kernels/simd/vectors.hpp"

#if defined(__AVX512BW__)
#include "kernels/simd/avx512.hpp"
#elif defined(__AVX2__)
#include "kernels/simd/avx2.hpp"
#elif defined(__SSE4_2__)
#include "kernels/simd/sse42.hpp"
#elif defined(__aarch64__)
#include "kernels/simd/neon64.hpp"
#else
#error "no vector wrappers for this architecture"
#endif

#if !defined(__AVX512BW__)
#include "kernels/simd/at_most_256.hpp"
#endif
#if !defined(__AVX2__)
#include "kernels/simd/at_most_128.hpp"
#endif

/// Vectors of one ISA: arithmetic comes from xsimd, what xsimd 8.1 lacks from the file of the
/// instruction set, and what is made of both is here. Everything has internal linkage in that ISA's
/// own namespace.
///
/// "Lane" below and in simd/ is one of the 128-bit parts of a vector: zip_*, widen_*, narrow and
/// shuffle_bytes work inside each lane, so widen and narrow undo each other whatever the width.
namespace burnish::BURNISH_ISA {
namespace {

/// Sign-extends the lower or upper half of each lane. Shifting down what was zipped with itself
/// needs no zero register.
inline I32 widen_lo(I16 v) {
    return as_i32(zip_lo16(v, v)) >> 16;
}
inline I32 widen_hi(I16 v) {
    return as_i32(zip_hi16(v, v)) >> 16;
}

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

}  // namespace
}  // namespace burnish::BURNISH_ISA
