#pragma once

#include <burnish/framebuffer.hpp>
#include <burnish/scene.hpp>
#include <vector>

#include "core/quantiser.hpp"

/// A picture whose numbers are exact but at chosen stages: which of them costs how much.
namespace burnish::lab {

/// How many bits the numbers have that a stage leaves, kExactBits: as many as a double has.
///
/// b bits are 2^b - 1 steps between 0 and 1; a sign comes on top where it says "and a sign", and
/// takes a bit where numbers are coded x/2 + 1/2, 1/2 being code 2^(b - 1). A machine of nine bits
/// has 8, 8, 8, 9, 8, 8 here, and `nearest`.
struct StageBits {
    /// Vectors, cosines and colours that the interpolators bring to registers, coded.
    int half_vector = kExactBits;
    int textures = kExactBits;  ///< texels of the material layer
    int filter = kExactBits;    ///< each of the lerps between texels
    /// Products and outputs of general stages, and their constants: a sign and b - 1 bits.
    int combiners = kExactBits;
    /// General stages one by one, instead of `combiners`; those beyond the end have that.
    std::vector<int> combiner_stages = {};
    /// Dependent tables: 2^b texels along every axis, none between them, of b bits.
    int table = kExactBits;
    int frame = kExactBits;  ///< the final combiner: its product, its lerp and what it delivers
    BitRounding rounding = BitRounding::nearest;
};

/// Draws `scene`, at its size, as its machine does but in double precision, with numbers rounded
/// where `bits` says so: rgba32f, alpha 1 where there is a surface, one sample at the pixel's
/// centre. The machine says what a program looks like, where the half vector comes from, and at
/// which values registers stop; its own numbers do not count, and models are drawn from textures
/// and tables of 16 bits. The same bits for any number of threads (0: one per core).
/// Throws Error{bad_program} for blended draws, fragments that may be dropped and mip levels at
/// computed coordinates, Error{bad_option} for bits outside 1 .. 24, for profile double, and what
/// Renderer::render throws.
Framebuffer render_with_bits(const Scene& scene, const StageBits& bits, int threads = 0);

}  // namespace burnish::lab
