#pragma once

#include <cstddef>
#include <new>
#include <utility>
#include <vector>

namespace burnish {

/// Memory on a cache line border. What is as large as a huge page begins at the border of one, and
/// the system is asked to use them: rows of a texture, of a frame or of planes then need few
/// entries of the TLB. Throws std::bad_alloc.
void* allocate_aligned(std::size_t bytes);
/// @param bytes  as allocated
void free_aligned(void* p, std::size_t bytes) noexcept;

/// allocate_aligned() for containers.
template <class T>
struct CacheLineAllocator {
    using value_type = T;

    CacheLineAllocator() = default;
    template <class U>
    CacheLineAllocator(const CacheLineAllocator<U>&) {}

    T* allocate(std::size_t n) { return static_cast<T*>(allocate_aligned(n * sizeof(T))); }
    void deallocate(T* p, std::size_t n) noexcept { free_aligned(p, n * sizeof(T)); }
    friend bool operator==(const CacheLineAllocator&, const CacheLineAllocator&) { return true; }
};

template <class T>
using AlignedVector = std::vector<T, CacheLineAllocator<T>>;

/// What `resize` adds holds anything, so pages that are never written take no memory.
template <class T>
struct UnsetAllocator : CacheLineAllocator<T> {
    template <class U>
    struct rebind {
        using other = UnsetAllocator<U>;
    };
    UnsetAllocator() = default;
    template <class U>
    UnsetAllocator(const UnsetAllocator<U>&) {}

    template <class U>
    void construct(U* p) noexcept {
        ::new (static_cast<void*>(p)) U;
    }
    template <class U, class... Arguments>
    void construct(U* p, Arguments&&... arguments) {
        ::new (static_cast<void*>(p)) U(std::forward<Arguments>(arguments)...);
    }
};

template <class T>
using UnsetVector = std::vector<T, UnsetAllocator<T>>;

}  // namespace burnish
