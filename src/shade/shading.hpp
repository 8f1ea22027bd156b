#pragma once

#include <array>
#include <burnish/scene.hpp>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "geometry/varyings.hpp"
#include "kernels/kernel_table.hpp"
#include "machine/bind.hpp"
#include "shade/corners.hpp"
#include "shade/texture_units.hpp"

namespace burnish {

/// Lights of a scene, at most: what their vectors and colours take of kMaxInterpolated.
inline constexpr std::size_t kMaxLights = 8;
/// All that can be interpolated: uv; of vertices view vector and normal, and of every light half
/// and light vector, two cosines and `lit`. Frames of pixels and raw vertices need less.
inline constexpr int kMaxInterpolated = kUvAttributes + 6 + static_cast<int>(kMaxLights) * 11;
/// The three vectors, n.l and h.l that the lighting stage adds behind them.
inline constexpr int kLightingAttributes = kMaxInterpolated;
/// Coordinates at a texel centre, s and t.
inline constexpr int kCornerAttributes = kLightingAttributes + 11;
/// Scratch planes of samples.
inline constexpr int kSampleScratch = kCornerAttributes + 2;
/// What texture units compute on the way to their coordinates lies behind these.
inline constexpr int kUnitAttributes = kSampleScratch + kSampleAttributes;
inline constexpr int kMaxAttributes = kUnitAttributes + 121;

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

/// How fragments get the colour that one light gives them: what fills the registers, the program.
struct LightShading {
    std::vector<EarlierPass> earlier_passes;  ///< in front of inputs and program, the last pass
    std::vector<InputOp> inputs;
    std::size_t fixed_inputs = 0;  ///< the first ones, which no texture has part in
    BoundProgram program;
    std::vector<StageSampling> stage_fetches;  ///< of program.fetches, in their order
};

/// Another light than the first. Lights come one after the other in a packet and leave nothing to
/// each other but their sum.
struct FurtherLight : LightShading {
    PortionCtx add;  ///< its colour to those of the lights before it
};

/// How one object's fragments get their colour: what its triangles interpolate, and how its first
/// light, which comes last, is computed; its tests and its alpha are the fragment's.
struct Shading : LightShading {
    std::span<const VertexFrame> frames;                            ///< of a mesh, else empty
    std::vector<LightInputs> lights = std::vector<LightInputs>(1);  ///< one for each program
    int frame_attributes = 0;           ///< 0, kUvAttributes, or with kFrameAttributes
    bool frames_from_uv = false;        ///< T and B are the triangle's dP/du and dP/dv
    std::vector<Varying> varying_list;  ///< the attributes after those of the frames
    VertexRows rows;                    ///< all of them, of the vertices
    UnitStates unit_states;
    std::vector<PlannedUnit> units;  ///< first_op counts `inputs`
    /// Attribute plane, computed by the input ops; a fragment lives only where it is > 0. Or -1.
    int keep_attribute = -1;
    /// Attribute plane with the fragment's own window depth; outside [0, 1] or NaN: the fragment is
    /// dropped. Or -1.
    int depth_attribute = -1;
    bool quads = false;            ///< fragments must come as whole 2x2 quads of one triangle
    bool quads_of_pixels = false;  ///< the quads' pixels instead may be of several triangles
    bool reads_light = false;      ///< the inputs depend on the light
    bool reads_frame = false;      ///< or on attributes of the frames
    /// `inputs` as packets run them where there is one light.
    std::vector<InputOp> packet_inputs;
    std::vector<FurtherLight> further_lights;
    PortionCtx add_first{};                ///< the first light to the further ones
    int zero_plane = -1;                   ///< for sums of lights: must hold 0
    std::optional<CornerShading> corners;  ///< of FilterOrder::after, where a map is filtered
    std::array<std::int16_t, 4> result;    ///< planes of r, g, b, a
    TexturePtr half_cube;                  ///< of HalfVector::cube; null: made when it is needed
    std::vector<TexturePtr> textures;      ///< keeps the texels alive

    [[nodiscard]] int interpolated() const {
        return frame_attributes + static_cast<int>(varying_list.size());
    }
};

/// Binds the programs, one for each of shading.lights, and plans their inputs; if more is wanted
/// than their sum there must be one. `lights` is set before, `frames` and `rows` afterwards.
/// Throws Error{bad_program} for what `machine` cannot run.
void plan_shading(Shading& shading, std::span<const ProgramMaterial> programs,
                  const Machine& machine, bool is_mesh, const Wanted& wanted = {});

/// One input operation on a packet; `runs` are those of its fragments.
void feed_input(const InputOp& op, NumberModel numbers, const KernelTable& kernels,
                const AttributesCtx& runs, Packet& packet);

/// One after the other, but for those that a packet without blended levels does without, and those
/// that bring probes, which come again for each of them.
void feed_inputs(std::span<const InputOp> ops, NumberModel numbers, const KernelTable& kernels,
                 const AttributesCtx& runs, Packet& packet);

/// General stages with the fetches between them, and the final combiner.
void run_program(const LightShading& shading, const KernelTable& kernels, const AttributesCtx& runs,
                 Packet& packet);

/// Input operations and program, light by light and pass by pass: colours to the planes
/// `shading.result`. The packet's runs, pixels and constant planes are in place.
void shade_packet(const Shading& shading, const KernelTable& kernels, const AttributesCtx& runs,
                  Packet& packet);

}  // namespace burnish
