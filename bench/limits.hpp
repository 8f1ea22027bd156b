#pragma once

#include "kernels/kernel_table.hpp"

/// What the processor does at most, for the roofline. Contract header: plain data.
namespace burnish {

/// Loops that keep one part of a core busy, for one instruction set.
struct LimitLoops {
    int lanes16, lanes32;
    /// `count` times 16 vector operations on 16-bit lanes, multiplications and additions in turn,
    /// in eight chains that begin with data[0 .. 8 * lanes16 - 1] and end there.
    void (*shorts)(std::int16_t* data, long count) noexcept;
    /// The same on floats.
    void (*floats)(float* data, long count) noexcept;
    /// `count` times 256 loads of 8 bytes from texels + offset[i] + 8 * (0 .. 7), two to each
    /// 128 bits of a vector; the xor of all goes to out[0 .. lanes16 - 1].
    void (*pairs)(std::int16_t* out, const std::uint8_t* texels, const std::int32_t* offset,
                  long count) noexcept;
    /// Copies `size` bytes, a multiple of 256, by vectors.
    void (*copy)(std::int16_t* to, const std::int16_t* from, long size) noexcept;
};

/// Null where there are none for a table.
const LimitLoops* limit_loops(const KernelTable& table);

}  // namespace burnish
