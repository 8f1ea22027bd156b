#pragma once

#include <array>
#include <cstdint>

#include "kernels/kernel_table.hpp"
#include "raster/setup.hpp"

namespace burnish {

/// A triangle by itself as the kernel `setup` leaves it, whatever its outcodes. `triangle` and
/// `covered` hold if counts.drawn is 1.
struct OneTriangle {
    SetupCounts counts{};
    SetupTriangle triangle{};
    std::uint64_t covered = 0;
};

inline OneTriangle set_up(const KernelTable& kernels, std::array<ScreenVertex, 3> corners,
                          FrameSize frame) {
    for (ScreenVertex& v : corners) v.outcode = 0;
    constexpr std::uint32_t kIndices[3] = {0, 1, 2};
    SetupTriangle triangles[2]{};
    std::uint64_t covered[2] = {};
    OneTriangle one;
    SetupCtx ctx{};
    ctx.vertices = corners.data();
    ctx.indices = kIndices;
    ctx.count = 1;
    ctx.width = frame.width;
    ctx.height = frame.height;
    ctx.triangles = triangles;
    ctx.covered = covered;
    ctx.counts = &one.counts;
    kernels.setup(ctx);
    one.triangle = triangles[0];
    one.covered = covered[0];
    return one;
}

}  // namespace burnish
