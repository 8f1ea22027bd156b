#pragma once

#include "kernels/kernel_table.hpp"

/// The yardstick of bench_yardstick: one program of two general stages and three bilinear textures
/// as a kernel of its own, written by hand for it alone. Contract header: plain data.
namespace burnish {

/// What the program below does, from attributes to pixels, on a nine-bit machine:
///
///     {
///       rgb {
///         spare0 = expand(tex0) . expand(col0);
///         spare1 = expand(tex1) . expand(col0);
///         scale_by_four();
///       }
///       alpha { spare0 = col0 * const0; }
///     }
///     { rgb { discard = spare0 * spare0; discard = spare1 * spare1; spare0 = sum(); } }
///     final_product = tex2 * spare0.a;
///     out.rgb = lerp(spare0, zero, final_product) + const1;
///     out.a = one;
struct FusedLobe {
    int u, v;                       ///< attribute planes
    int color[4];                   ///< attribute planes of col0
    const std::uint8_t* texels[3];  ///< repeating textures of one size
    std::int32_t width, height, pitch;
    std::int16_t const0_alpha, const1[3];  ///< codes
    StoreCtx store;                        ///< four planes that may be written
};

using FusedLobeKernel = void (*)(Packet&, const FusedLobe&) noexcept;

/// Null where there is none for a table.
FusedLobeKernel fused_lobe(const KernelTable& table);

}  // namespace burnish
