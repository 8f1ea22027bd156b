#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace burnish {

/// Copies `size` bytes past the caches where the CPU can and the destination allows it (both
/// aligned to 16 bytes, size a multiple): the frame is written once and not read again before it is
/// whole, so its lines need not be fetched first. Other threads see it after `stream_fence`.
inline void stream_copy(std::byte* to, const std::byte* from, std::size_t size) {
#if defined(__SSE2__)
    if (((reinterpret_cast<std::uintptr_t>(to) | reinterpret_cast<std::uintptr_t>(from) | size) &
         15) == 0) {
        for (std::size_t i = 0; i < size; i += 16) {
            const __m128i v = _mm_load_si128(reinterpret_cast<const __m128i*>(from + i));
            _mm_stream_si128(reinterpret_cast<__m128i*>(to + i), v);
        }
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
