#include "core/aligned.hpp"

#include <sys/mman.h>

#include <algorithm>

namespace burnish {

namespace {

constexpr std::size_t kLine = 64, kHugePage = std::size_t{2} << 20;

/// Bytes in huge pages: the last one is a huge one if at least half of it is used.
std::size_t huge_part(std::size_t bytes) {
    return (bytes + kHugePage / 2) / kHugePage * kHugePage;
}

std::align_val_t alignment_of(std::size_t bytes) {
    return std::align_val_t{huge_part(bytes) == 0 ? kLine : kHugePage};
}

}  // namespace

void* allocate_aligned(std::size_t bytes) {
    const std::size_t huge = huge_part(bytes);
    void* const p = ::operator new(std::max(bytes, huge), alignment_of(bytes));
    // A wish: where there are no huge pages, small ones do.
    if (huge > 0) madvise(p, huge, MADV_HUGEPAGE);
    return p;
}

void free_aligned(void* p, std::size_t bytes) noexcept {
    ::operator delete(p, alignment_of(bytes));
}

}  // namespace burnish
