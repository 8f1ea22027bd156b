#pragma once

#include <burnish/scene.hpp>
#include <cstdint>
#include <span>
#include <variant>
#include <vector>

#include "geometry/varyings.hpp"
#include "kernels/kernel_table.hpp"
#include "machine/bind.hpp"

namespace burnish {

/// Attributes that a mesh's vertices bring themselves: uv and, where light meets the tangent frame
/// at every pixel, T, B, N and the position.
inline constexpr int kUvAttributes = 2;
inline constexpr int kFrameAttributes = 12;
/// All that can be interpolated: the frame, or eight colours and sixteen coordinates; and `lit`.
inline constexpr int kMaxInterpolated = 32;
/// With the three vectors and n.l that the lighting stage adds, and scratch planes of samples.
inline constexpr int kSampleScratch = kMaxInterpolated + 10;
inline constexpr int kMaxAttributes = kSampleScratch + 3;

/// A register plane that nothing feeds.
struct ClearCtx {
    int plane;
};

/// Fills registers of a packet before the program runs.
using InputOp = std::variant<ClearCtx, LightingCtx, EncodeCtx, AddressCtx, FetchCtx, CubeFaceCtx,
                             PlaneFootprintCtx, QuadFootprintCtx, LevelOfDetailCtx, LevelAddressCtx,
                             FetchHiloCtx, FetchWordsCtx, BlendLevelsCtx, HiloCtx>;

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
    BoundProgram program;
    std::vector<TexturePtr> textures;  ///< keeps the texels alive
    /// Attribute plane, computed by the input ops; a fragment lives only where it is > 0. Or -1.
    int keep_attribute = -1;
    /// Attribute plane with the fragment's own window depth; outside [0, 1] or NaN: the fragment is
    /// dropped. Or -1.
    int depth_attribute = -1;
    bool quads = false;  ///< fragments must come as whole 2x2 quads of one triangle

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

/// Input operations and program: colours to the planes `shading.program.result`. The packet's runs,
/// pixels and constant planes are in place.
void shade_packet(const Shading& shading, const KernelTable& kernels, const AttributesCtx& runs,
                  Packet& packet);

}  // namespace burnish
