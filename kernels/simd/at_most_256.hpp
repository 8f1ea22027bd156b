#pragma once

#include "kernels/simd/vectors.hpp"

/// What AVX2, SSE4.2 and NEON share: neither masks of bits nor stores that compress. Included
/// behind the file of the instruction set; avx512.hpp says what each wrapper does.
namespace burnish::BURNISH_ISA {
namespace {

struct LaneRows {
    explicit LaneRows(const I16 (&v)[4]) : column{v[0], v[1], v[2], v[3]} {}
    template <int K>
    void store(void* p) const {
        for (int c = 0; c < 4; ++c)
            store_lane<K>(static_cast<unsigned char*>(p) + 16 * c, column[c]);
    }
    I16 column[4];
};

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

template <int Rows>
[[gnu::always_inline]] inline void load_pairs(const std::uintptr_t (&row)[Rows],
                                              const std::int32_t* offset, I16 (&pairs)[Rows]) {
#pragma GCC unroll 8
    for (int k = 0; k < Rows; ++k)
        pairs[k] = load_pairs(reinterpret_cast<const std::uint8_t*>(row[k]), offset);
}

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

}  // namespace
}  // namespace burnish::BURNISH_ISA
