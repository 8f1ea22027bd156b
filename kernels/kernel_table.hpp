#pragma once

#include "kernels/stage_list.hpp"

/// Contract header: no functions but the tables' getters.
namespace burnish {

/// One instruction set's version of every stage. All tables give the same bits.
struct KernelTable {
    const char* isa;  ///< "avx512", "avx2", "sse42", "neon64" or "reference"
    int lanes;        ///< 16-bit lanes of a vector; 1 for the reference
#define X(name, Ctx) void (*name)(const Ctx&) noexcept;
    BURNISH_TILE_STAGES(X)
#undef X
#define X(name, Ctx) void (*name)(Packet&, const Ctx&) noexcept;
    BURNISH_PACKET_STAGES(X)
#undef X
};

const KernelTable& table_reference() noexcept;
const KernelTable& table_sse42() noexcept;
const KernelTable& table_avx2() noexcept;
const KernelTable& table_avx512() noexcept;
const KernelTable& table_neon64() noexcept;

}  // namespace burnish
