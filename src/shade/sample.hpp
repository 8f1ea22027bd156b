#pragma once

#include <burnish/machine.hpp>
#include <burnish/texture.hpp>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "shade/input_op.hpp"

namespace burnish {

/// Coordinates as attribute planes, -1 where there is none; q divides s, t (and r of 3D) first.
struct SampleCoordinates {
    int s, t, r, q;
    /// Planes of the interpolators, whose level of detail follows from the triangle; others need
    /// whole 2x2 quads in a packet.
    bool interpolated;
};

/// Where texels go, as they are: DSDT texels, too. Four register planes from `registers` on get the
/// codes of r, g, b, a, of DSDT ds, dt, mag, intensity; for hilo formats two attribute planes from
/// `values` on get n / 65535 or n / 32768. The other one is not looked at.
struct SampleTarget {
    int registers, values;
};

/// Scratch planes of any one sample.
inline constexpr int kSampleAttributes = 6 + ProbeSumCtx::kMaxChannels;
inline constexpr int kSamplePlanes = 27;

/// A sample with levels that others may join: what their addresses have in common, and where the
/// operations are that they add to.
struct SharedLevels {
    static constexpr int kMostTextures = 4;

    LevelAddressCtx address;
    SampleCoordinates coordinates;
    std::int32_t bias;  ///< of the level of detail, 1/256
    int max_anisotropy;
    std::optional<std::size_t> probed;   ///< ProbedCtx
    std::size_t fetch;                   ///< the last one with texels of the first level
    std::optional<std::size_t> blended;  ///< BlendedCtx
    std::size_t ceiling;                 ///< with `blended`: the last with texels of that level
    std::size_t end;                     ///< behind all of them
    int textures = 1;                    ///< so far
};

/// Coordinates that stand at a texel centre of the finest map instead of at the pixel.
struct SampledCorners {
    /// As LevelAddressCtx::lambda: 256 * the level whose texels are taken. Its plane is known when
    /// all programs are planned.
    static constexpr int kLevel = -2;

    const Texture* finest;
    int s, t, q;             ///< planes of the pixel's coordinates, q may be -1
    int corner_s, corner_t;  ///< planes of the corner's

    [[nodiscard]] bool hold(const SampleCoordinates& at) const {
        return at.s == corner_s && (at.t == corner_t || at.t < 0);
    }
};

/// What samples of one shading share. All of them go to one list of operations.
struct SamplePlan {
    NumberModel numbers;
    int attributes;            ///< the first of kSampleAttributes attribute planes
    int planes;                ///< the first of kSamplePlanes register planes
    bool uses_planes = false;  ///< set when one was needed
    /// What the packet's texel addresses are for, if they are of interpolated coordinates.
    std::optional<AddressCtx> last{};
    std::optional<SharedLevels> levels{};  ///< the last sample with levels, if others may join it
    std::optional<SampledCorners> corners{};
};

/// Whether the texture's filter looks at the level of detail.
[[nodiscard]] bool needs_level_of_detail(const Texture& texture);
/// Whether a fetch at computed coordinates looks at how they change from pixel to pixel.
[[nodiscard]] bool needs_quads(const Texture& texture);

/// The stage that finds the corners of `corners.finest`: weights go to two planes from `weight` on,
/// the level to plane `level`. Operations that find the level of detail are added to `ops`.
TexelCornerCtx plan_texel_corner(const SampledCorners& corners, int weight, int level,
                                 SamplePlan& plan, std::vector<InputOp>& ops);

/// Operations that sample a texture, added to `ops`. At a corner, maps that have the sides, levels
/// and filter of the finest one give the texel that is there; others are filtered there, in the
/// pixel's level of detail. Samples in a row with the same interpolated
/// coordinates, sizes and sampler share addresses, levels of detail, probes and, of bytes, up to
/// four textures a fetch; 3D textures and hilo ones with levels are alone. Throws
/// Error{bad_program} for a texture of more coordinates than there are, for rgba16 in nine bits,
/// and for probes at corners or at coordinates that nobody interpolates.
void plan_sample(const Texture& texture, const SampleCoordinates& coordinates,
                 const SampleTarget& target, SamplePlan& plan, std::vector<InputOp>& ops);

}  // namespace burnish
