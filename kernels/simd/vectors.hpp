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

/// The vectors' types, and what xsimd alone gives on every instruction set.
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

}  // namespace
}  // namespace burnish::BURNISH_ISA
