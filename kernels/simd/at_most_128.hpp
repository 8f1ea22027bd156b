#pragma once

#include "kernels/simd/vectors.hpp"

/// What SSE4.2 and NEON share: no shifts by as many numbers as there are lanes. Included behind the
/// file of the instruction set; avx512.hpp says what each wrapper does.
namespace burnish::BURNISH_ISA {
namespace {

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

}  // namespace
}  // namespace burnish::BURNISH_ISA
