#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace burnish {

/// Whether addresses and sizes allow copies past the caches.
inline bool can_stream(const std::byte* to, const std::byte* from, std::size_t size) {
#if defined(__SSE2__)
    return ((reinterpret_cast<std::uintptr_t>(to) | reinterpret_cast<std::uintptr_t>(from) | size) &
            15) == 0;
#else
    return true;
#endif
}

/// Size bytes past the caches, where can_stream() says so.
template <std::size_t Size>
inline void stream_aligned(std::byte* to, const std::byte* from) {
#if defined(__SSE2__)
    static_assert(Size % 16 == 0);
    for (std::size_t i = 0; i < Size; i += 16) {
        const __m128i v = _mm_load_si128(reinterpret_cast<const __m128i*>(from + i));
        _mm_stream_si128(reinterpret_cast<__m128i*>(to + i), v);
    }
#else
    std::memcpy(to, from, Size);
#endif
}

/// Copies `size` bytes past the caches where the CPU can and the destination allows it (both
/// aligned to 16 bytes, size a multiple): the frame is written once and not read again before it is
/// whole, so its lines need not be fetched first. Other threads see it after `stream_fence`.
inline void stream_copy(std::byte* to, const std::byte* from, std::size_t size) {
#if defined(__SSE2__)
    if (can_stream(to, from, size)) {
        for (std::size_t i = 0; i < size; i += 16) stream_aligned<16>(to + i, from + i);
        return;
    }
#endif
    std::memcpy(to, from, size);
}

inline void stream_fence() {
#if defined(__SSE2__)
    _mm_sfence();
#endif
}

}  // namespace burnish
