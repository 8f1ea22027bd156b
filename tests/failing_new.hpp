#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <new>

/// Every form of operator new of the program, of which one may fail: for one source file of a test.
/// All forms, since the sanitizers replace those that are left out by others.
namespace failing_new {

/// How many allocations are left until one fails; below 0 none does.
inline std::atomic<std::int64_t> allocations_left{-1};

inline void* allocate(std::size_t bytes, std::size_t alignment) noexcept {
    if (allocations_left.load(std::memory_order_relaxed) >= 0 &&
        allocations_left.fetch_sub(1, std::memory_order_relaxed) == 0)
        return nullptr;
    const std::size_t whole = (bytes + alignment - 1) / alignment * alignment;
    return std::aligned_alloc(alignment, whole > 0 ? whole : alignment);
}
inline void* allocate(std::size_t bytes, std::align_val_t alignment) noexcept {
    return allocate(bytes, static_cast<std::size_t>(alignment));
}
inline constexpr std::size_t kUsual = __STDCPP_DEFAULT_NEW_ALIGNMENT__;

inline void* require(void* p) {
    if (p == nullptr) throw std::bad_alloc();
    return p;
}

}  // namespace failing_new

// clang-format off
void* operator new(std::size_t n) { return failing_new::require(failing_new::allocate(n, failing_new::kUsual)); }
void* operator new[](std::size_t n) { return operator new(n); }
void* operator new(std::size_t n, std::align_val_t a) { return failing_new::require(failing_new::allocate(n, a)); }
void* operator new[](std::size_t n, std::align_val_t a) { return operator new(n, a); }
void* operator new(std::size_t n, const std::nothrow_t&) noexcept { return failing_new::allocate(n, failing_new::kUsual); }
void* operator new[](std::size_t n, const std::nothrow_t& t) noexcept { return operator new(n, t); }
void* operator new(std::size_t n, std::align_val_t a, const std::nothrow_t&) noexcept { return failing_new::allocate(n, a); }
void* operator new[](std::size_t n, std::align_val_t a, const std::nothrow_t& t) noexcept { return operator new(n, a, t); }

void operator delete(void* p) noexcept { std::free(p); }
void operator delete[](void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }
void operator delete[](void* p, std::size_t) noexcept { std::free(p); }
void operator delete(void* p, std::align_val_t) noexcept { std::free(p); }
void operator delete[](void* p, std::align_val_t) noexcept { std::free(p); }
void operator delete(void* p, std::size_t, std::align_val_t) noexcept { std::free(p); }
void operator delete[](void* p, std::size_t, std::align_val_t) noexcept { std::free(p); }
void operator delete(void* p, const std::nothrow_t&) noexcept { std::free(p); }
void operator delete[](void* p, const std::nothrow_t&) noexcept { std::free(p); }
void operator delete(void* p, std::align_val_t, const std::nothrow_t&) noexcept { std::free(p); }
void operator delete[](void* p, std::align_val_t, const std::nothrow_t&) noexcept { std::free(p); }
// clang-format on
