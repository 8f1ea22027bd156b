#pragma once

#include <burnish/combiner.hpp>
#include <burnish/framebuffer.hpp>
#include <burnish/scene.hpp>
#include <cstddef>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "core/quantiser.hpp"
#include "core/tile_watch.hpp"
#include "trace/table_grid.hpp"

/// A picture whose numbers are exact but at chosen stages: which of them costs how much.
namespace burnish::lab {

/// How many bits the numbers have that a stage leaves; kExactBits: as many as a double has.
///
/// b bits are 2^b - 1 steps between 0 and 1; of combiners b bits are a sign and 2^(b - 1) - 1 steps
/// to 1. Where numbers are x/2 + 1/2 of a signed x, steps are counted from 1/2 on wide machines,
/// which have a code for it: 0 stays 0. On nine-bit machines they are not, and with their
/// `expand = "hardware"` a combiner stage of b bits takes 2^(b - 2) / (2^(b - 1) - 1) for 1/2.
/// A nine-bit machine has 8, 8, 8, 9, 8, 8 here and `nearest`, or what its `product_rounding` is.
struct StageBits {
    /// Vectors, cosines and colours that the interpolators bring to registers, coded.
    int half_vector = kExactBits;
    int textures = kExactBits;  ///< texels of the material layer
    /// Each lerp between texels, or with FilterOrder::after between the colours at texels; b bits
    /// of its weight, downwards.
    int filter = kExactBits;
    /// Products and outputs of general stages, and their constants: a sign and b - 1 bits.
    int combiners = kExactBits;
    /// General stages one by one, instead of `combiners`; those beyond the end have that.
    std::vector<int> combiner_stages = {};
    /// Dependent tables: 2^b texels along every axis, none between them, of b bits.
    int table = kExactBits;
    /// The same of models' tables in more detail (trace/table_grid.hpp).
    int table_index = kExactBits, table_values = kExactBits;
    TableSpacing table_axis = TableSpacing::lobe;
    bool table_linear = false;
    int frame = kExactBits;  ///< the final combiner: its product, its lerp and what it delivers
    BitRounding rounding = BitRounding::nearest;
};

/// A scene in double precision, prepared once and drawn with any bits, at its size. What the
/// machine says is what a program looks like, where half vectors come from, and at which values
/// registers stop; its own numbers do not count: models are drawn from textures and tables of 16
/// bits.
class BitRenderer {
  public:
    /// @param scene    outlives this object
    /// @param threads  0: one per core; pictures have the same bits with any number
    /// @param stop     asked while models are compiled, for every row of a material's texels: true
    ///                 gives it up, Error{stopped}
    /// Throws Error{bad_program} for blended draws, fragments that may be dropped after shading and
    /// mip levels and sums at computed coordinates, Error{bad_option} for profile double, and what
    /// Renderer::render throws.
    explicit BitRenderer(const Scene& scene, int threads = 0, std::function<bool()> stop = {});
    ~BitRenderer();
    BitRenderer(const BitRenderer&) = delete;
    BitRenderer& operator=(const BitRenderer&) = delete;

    /// rgba32f, alpha 1 where there is a surface, else the scene's background; one sample at the
    /// centre of each pixel. Throws Error{bad_option} for bits outside 1 .. 24, of combiners 2
    /// .. 24, and for details of tables where a material has a program of its own, Error{stopped}
    /// when the hooks say so.
    Framebuffer render(const StageBits& bits, const FrameHooks& hooks = {});
    /// Red, green and blue of pixel (x, y) of the frame; nothing where it shows the background.
    std::optional<glm::dvec3> pixel(const StageBits& bits, int x, int y);

    /// General stages of the longest program.
    [[nodiscard]] std::size_t stage_count() const;
    /// The program of object number `object` in the first light.
    [[nodiscard]] const CombinerProgram& program(std::size_t object) const;

  private:
    struct State;
    std::unique_ptr<State> m_state;
};

/// One picture. Throws what BitRenderer throws.
Framebuffer render_with_bits(const Scene& scene, const StageBits& bits, int threads = 0,
                             const FrameHooks& hooks = {});

}  // namespace burnish::lab
