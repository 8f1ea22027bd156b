/// Every kernel for one instruction set. Compiled once per ISA with that ISA's flags and
///   BURNISH_ISA    name of the namespace and of the table, e.g. avx2
///   BURNISH_ARCH   xsimd's architecture, e.g. avx2
///   BURNISH_TABLE  the one function that leaves this file, e.g. table_avx2
#include <type_traits>
#include <utility>

#include "kernels/kernel_table.hpp"
#include "kernels/log2_steps.hpp"
#include "kernels/simd.hpp"

namespace burnish::BURNISH_ISA {
namespace {

#include "kernels/groups.inl"
#include "kernels/runs.inl"

#include "kernels/attribute_planes.inl"
#include "kernels/clear.inl"
#include "kernels/collect.inl"
#include "kernels/combine.inl"
#include "kernels/fetch.inl"
#include "kernels/final.inl"  // after combine.inl, whose products it uses
#include "kernels/interpolate.inl"
#include "kernels/levels.inl"          // after fetch.inl, whose AxisAddress it uses
#include "kernels/light_vertices.inl"  // after interpolate.inl, whose vectors it uses
#include "kernels/rasterize.inl"
#include "kernels/rasterize_small.inl"  // after rasterize.inl, whose lanes it uses
#include "kernels/rasterize_tiny.inl"
#include "kernels/setup.inl"
#include "kernels/texture_shader.inl"
#include "kernels/transform.inl"
#include "kernels/words.inl"

#include "kernels/corners.inl"  // after levels.inl, whose choice of a level it uses
#include "kernels/probes.inl"   // after levels.inl, whose steps it uses

#include "kernels/blend.inl"  // after final.inl: what it blends is what store writes
#include "kernels/fragment_tests.inl"

#define BURNISH_STRINGIFY_(x) #x
#define BURNISH_STRINGIFY(x) BURNISH_STRINGIFY_(x)

constinit const KernelTable kTable{BURNISH_STRINGIFY(BURNISH_ISA), kLanes,
#define X(name, Ctx) name,
                                   BURNISH_TILE_STAGES(X) BURNISH_PACKET_STAGES(X)
#undef X
};

}  // namespace
}  // namespace burnish::BURNISH_ISA

const burnish::KernelTable& burnish::BURNISH_TABLE() noexcept {
    return burnish::BURNISH_ISA::kTable;
}
