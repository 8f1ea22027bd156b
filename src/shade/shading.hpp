#pragma once

#include <burnish/scene.hpp>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/varyings.hpp"
#include "kernels/kernel_table.hpp"
#include "machine/bind.hpp"
#include "shade/texture_units.hpp"

namespace burnish {

/// Attributes that a mesh's vertices bring themselves: uv and, where light meets the tangent frame
/// at every pixel, T, B, N and the position.
inline constexpr int kUvAttributes = 2;
inline constexpr int kFrameAttributes = 12;
/// All that can be interpolated: the frame, or eight colours and sixteen coordinates; and `lit`.
inline constexpr int kMaxInterpolated = 32;
/// The three vectors, n.l and h.l that the lighting stage adds behind them.
inline constexpr int kLightingAttributes = kMaxInterpolated;
/// Scratch planes of samples.
inline constexpr int kSampleScratch = kLightingAttributes + 11;
/// What texture units compute on the way to their coordinates lies behind these.
inline constexpr int kUnitAttributes = kSampleScratch + kSampleAttributes;
inline constexpr int kMaxAttributes = kUnitAttributes + 118;

/// The input operations of a fetch between portions.
struct StageSampling {
    std::size_t before;  ///< the portion in front of which they run
    std::vector<InputOp> ops;
};

/// A pass that leaves a frame for later ones. A frame is read at the pixel that wrote it, so it
/// need not outlive the packet: four register planes, 0 .. 255 each, are the pixels of an 8-bit
/// frame.
struct EarlierPass {
    std::vector<InputOp> inputs;
    BoundProgram program;
    int frame;  ///< first of the four planes
};

/// How one object's fragments get their colour: what its triangles interpolate, what fills the
/// registers, the program.
struct Shading {
    std::span<const VertexFrame> frames;  ///< of a mesh, else empty
    LightSpace space;
    LitColors lit;
    int frame_attributes = 0;           ///< 0, kUvAttributes, or with kFrameAttributes
    std::vector<Varying> varying_list;  ///< the attributes after those of the frames
    std::vector<float> varyings;        ///< their values, vertex by vertex
    std::vector<InputOp> inputs;
    UnitStates unit_states;
    std::vector<PlannedUnit> units;  ///< first_op counts `inputs`
    /// Attribute plane, computed by the input ops; a fragment lives only where it is > 0. Or -1.
    int keep_attribute = -1;
    /// Attribute plane with the fragment's own window depth; outside [0, 1] or NaN: the fragment is
    /// dropped. Or -1.
    int depth_attribute = -1;
    bool quads = false;  ///< fragments must come as whole 2x2 quads of one triangle
    std::vector<EarlierPass> earlier_passes;  ///< in front of inputs and program, the last pass
    BoundProgram program;
    std::vector<StageSampling> stage_fetches;  ///< of program.fetches, in their order
    std::vector<TexturePtr> textures;          ///< keeps the texels alive

    [[nodiscard]] int interpolated() const {
        return frame_attributes + static_cast<int>(varying_list.size());
    }
};

/// Binds the program and plans its inputs. `space` and `lit` are set before, `frames` and
/// `varyings` afterwards. Throws Error{bad_program} for what `machine` cannot run.
void plan_shading(Shading& shading, const ProgramMaterial& material, const Machine& machine,
                  bool is_mesh, const Wanted& wanted = {});

/// Writes the shading.interpolated() attributes of one vertex.
void vertex_attributes(const Shading& shading, std::uint32_t vertex, float* out);

/// One input operation on a packet; `runs` are those of its fragments.
void feed_input(const InputOp& op, NumberModel numbers, const KernelTable& kernels,
                const AttributesCtx& runs, Packet& packet);

/// General stages with the fetches between them, and the final combiner.
void run_program(const Shading& shading, const KernelTable& kernels, const AttributesCtx& runs,
                 Packet& packet);

/// Input operations and program, pass by pass: colours to the planes `shading.program.result`. The
/// packet's runs, pixels and constant planes are in place.
void shade_packet(const Shading& shading, const KernelTable& kernels, const AttributesCtx& runs,
                  Packet& packet);

}  // namespace burnish
