#pragma once

#include <array>
#include <burnish/combiner.hpp>
#include <burnish/framebuffer.hpp>
#include <burnish/machine.hpp>
#include <burnish/scene.hpp>
#include <burnish/texture.hpp>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

/// How one pixel of a picture got its colour, step by step: what `burnish trace` prints.
///
/// Every number of the machine stands beside the one of exact arithmetic: double precision from the
/// triangle's snapped corners and its vertices' attributes on, bilinear weights of any fineness,
/// combiners that round nothing, take 1/2 as 1/2 and stop where the machine stops. Errors are the
/// machine's number minus the exact one.
namespace burnish {

/// A number of the road beside what it would be without rounding.
struct TracedNumber {
    double value = 0.0;
    double exact = 0.0;
    [[nodiscard]] double error() const { return value - exact; }
};

/// Something that varies over a triangle, at the pixel. Vectors of light are coded x/2 + 1/2, as
/// the machine takes them.
struct TracedInterpolant {
    std::string name;        ///< "uv", "tangent", "half_tangent", "color0", ...
    std::string components;  ///< a letter for each number: "uv", "xyz", "rgba", "stq"
    std::vector<TracedNumber> numbers;
};

/// Four texels of one mip level, face or slice, and how they were weighted.
struct TracedTaps {
    int level = 0;
    int layer = 0;                       ///< cube face or slice
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;  ///< upper left and lower right texel
    int weight_x = 0, weight_y = 0;      ///< of the right and the lower texels: 1/256, 0 .. 255
    /// Bytes or words r, g, b, a of (x0, y0), (x1, y0), (x0, y1), (x1, y1), as images hold them.
    std::array<std::array<std::uint16_t, 4>, 4> taps{};
};

/// A texture fetch of one unit; the first of its taps, which it has with plain textures alone.
struct TracedFetch : TracedTaps {
    int unit = 0;
    int width = 0, height = 0;  ///< texels of level 0
    Sampler sampler;
    TextureTarget target = TextureTarget::two_d;
    TracedNumber u, v;                ///< after the division by q; v grows downward
    std::optional<TracedNumber> r;    ///< of 3D textures, the same
    std::optional<TracedNumber> lod;  ///< level of detail as it was used, where it was looked at
    /// Places along the longer axis of what the pixel covers whose mean the colour is, and how far
    /// in u and v from one to the next. Both numbers are 1 without max_anisotropy.
    TracedNumber probes{1.0, 1.0};
    std::array<TracedNumber, 2> apart{};
    /// Taps of slices behind, of further levels and, probe by probe, of all but the first.
    std::vector<TracedTaps> further;
    std::array<int, 4> codes{};  ///< as the register gets them
    std::array<TracedNumber, 4> color{};
};

/// What a unit of a texture shader did on the way to its texel.
struct TracedUnit {
    int unit = 0;
    std::string text;     ///< "dependent_ar(tex0)"
    std::string problem;  ///< why it is off (check_consistency); empty: it is not
    /// In the order in which they came about: what the previous texel means, dot products, moved
    /// and mirrored coordinates, depth, whether the fragment is kept (1 or 0).
    std::vector<TracedInterpolant> numbers;
};

/// One register at one place of the program.
struct TracedRegister {
    Register reg = Register::zero;
    std::array<int, 4> codes{};           ///< value * 255 (nine_bit) or value * 2^14 (wide)
    std::array<TracedNumber, 4> color{};  ///< r, g, b, a
    /// False where nothing fills the component, because no part of the program reads it.
    std::array<bool, 4> filled{};
    /// Written by the stage; for a constant: another one than before.
    std::array<bool, 4> changed{};
};

/// Registers that the program names, and the constants, colours and spares.
struct TracedStage {
    std::string name;  ///< "inputs", "stage 0", ..., "final"
    std::string text;  ///< what it does, in the language of print_combiners; inputs: empty
    std::vector<TracedRegister> registers;
};

/// What a blended fragment did to the pixel, in the frame's numbers: bytes, words or floats.
struct TracedBlend {
    Blend blend;
    std::array<double, 4> source{};  ///< the fragment's colour, as the frame would store it
    std::array<double, 4> source_factor{};
    std::array<double, 4> destination{};  ///< what the frame held
    std::array<double, 4> destination_factor{};
    std::array<double, 4> result{};
};

/// Where a program runs with FilterOrder::after: at one of the four texels around the sample point
/// of the material's finest map.
struct TracedCorner {
    bool right = false, below = false;
    int level = 0;                    ///< whose texels they are
    TracedNumber u, v;                ///< where it stands, after the division by q
    TracedNumber weight_x, weight_y;  ///< of the right and of the lower texels, whichever it is
    std::optional<TracedNumber> level_weight;  ///< of the upper level, where two are blended
};

/// A fragment that is in a pixel's colour.
struct TracedFragment {
    std::size_t object = 0;    ///< of the scene
    std::string material;      ///< name
    std::size_t triangle = 0;  ///< of the mesh or of the primitive, in the order of submission
    bool clipped = false;
    std::array<std::uint32_t, 3> vertices{};  ///< numbers of its corners
    std::array<double, 3> barycentrics{};     ///< of them, perspective-correct; they sum to 1
    double depth = 0.0;                       ///< window depth, [0, 1]
    TracedNumber one_over_w;
    std::vector<TracedInterpolant> interpolants;
    std::vector<TracedUnit> units;  ///< of the texture shader, if there is one
    std::vector<TracedFetch> fetches;
    std::vector<TracedStage> stages;
    std::array<int, 4> codes{};           ///< of the final combiner's results, all lights together
    std::array<TracedNumber, 4> color{};  ///< the same as numbers
    std::array<int, 4> light_codes{};     ///< of the first light alone
    std::array<TracedNumber, 4> light_color{};
    /// What differs from light to light, for each but the first: interpolants, fetches, stages and
    /// what the final combiner left, in both `codes` and `light_codes`.
    std::vector<TracedFragment> further_lights;
    /// With FilterOrder::after, where a map is filtered: the program at the upper left, upper
    /// right, lower left and lower right texel, and where two levels are blended at those of the
    /// upper level, each with all lights. This fragment then has interpolants, no fetches and
    /// stages of its own, and the codes and color that the filter made of theirs.
    std::vector<TracedFragment> corners;
    std::optional<TracedCorner> corner;  ///< of such a texel
    std::optional<TracedBlend> blend;    ///< nothing: the colour replaced the pixel's
};

struct PixelTrace {
    int x = 0, y = 0;
    Machine machine;
    int one = 0;                             ///< the code of 1 in the machine's registers
    std::optional<TracedFragment> fragment;  ///< the last one; nothing: the background
    /// What shows through it where it was blended, in order: fragments blended before it and,
    /// first, the one that replaced the pixel's colour, if there was one.
    std::vector<TracedFragment> below;
    PixelFormat format = PixelFormat::rgba8;
    std::array<double, 4> stored{};  ///< r, g, b, a as the frame holds them: bytes, words or floats
};

/// Follows pixel (x, y) of `scene`, at the scene's size and in its format, through the scalar
/// kernels and the interpreter of programs. `stored` is what Renderer::render leaves there on any
/// instruction set.
/// @param stop  asked while models are compiled, for every row of a material's texels: true gives
///              the trace up. By one thread at a time; it must not throw
/// Throws Error{bad_option} for a pixel outside the frame, Error{stopped}, and what
/// Renderer::render throws.
PixelTrace trace_pixel(const Scene& scene, int x, int y, const std::function<bool()>& stop = {});

}  // namespace burnish
