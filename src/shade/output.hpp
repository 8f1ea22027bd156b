#pragma once

#include <array>
#include <burnish/scene.hpp>
#include <cstdint>
#include <optional>

#include "geometry/triangle.hpp"
#include "kernels/kernel_table.hpp"
#include "shade/shading.hpp"

namespace burnish {

/// What becomes of a draw's fragments once they have their colours.
struct FragmentOutput {
    std::optional<Blend> blend;
    std::optional<AlphaTest> alpha_test;
    DepthRule depth{};        ///< of the draw
    bool late_depth = false;  ///< the depth test follows shading, since shading may drop fragments
};

/// Where they go, all in the order of kernels/packet.hpp: pixels of the frame's format and, for
/// late depth tests, the depths and their bounds.
struct OutputTile {
    StoreFormat format;
    void* pixels;  ///< null: nothing but depths is kept
    float* depth;
    float* block_far;
};

/// `comparison` as the kernels take it.
DepthRule comparison_rule(Comparison comparison, bool write);

/// The draw's blending and alpha test as `shading` and the depth test `depth` call for them.
FragmentOutput plan_output(const Shading& shading, const std::optional<Blend>& blend,
                           const AlphaTest& alpha_test, const DepthRule& depth);

/// Whether fragments must be shaded in the order of submission: what lies behind shows through, or
/// whether one shows is known only after shading.
bool needs_order(const FragmentOutput& output);

/// The depth rule for triangles before they are shaded. A late depth test repeats the test; what
/// fails here fails there, whatever pending fragments of the same draw write in between.
DepthRule early_rule(const Shading& shading, const FragmentOutput& output);

/// Takes kNoPixel to `stored` where a fragment fails the tests that follow shading.
void test_fragments(const Shading& shading, const FragmentOutput& output,
                    const KernelTable& kernels, const DepthRun* runs, int run_count,
                    const OutputTile& tile, std::uint16_t* stored, Packet& packet);

/// Colours of the planes `colors` to the pixels `packet.pixels`, blended if `blend` says how.
void write_pixels(const std::array<std::int16_t, 4>& colors, NumberModel numbers,
                  const std::optional<Blend>& blend, const KernelTable& kernels,
                  const OutputTile& tile, Packet& packet);

}  // namespace burnish
