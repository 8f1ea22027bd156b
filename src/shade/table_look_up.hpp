#pragma once

#include <burnish/texture.hpp>
#include <cstdint>
#include <vector>

#include "kernels/packet_stages.hpp"

namespace burnish {

/// (coordinate * scale + offset) / divisor brings a coordinate from what the ends of `span` stand
/// for to 0 .. 1 between the outer edges of `size` texels.
struct SpanToEdges {
    float scale, offset, divisor;
};
SpanToEdges to_edges(TexelSpan span, int size);

/// The look-up in a table (Texture::table) by the codes of planes s and, in two dimensions, t;
/// `out` is left open.
LookUpTableCtx table_look_up(const Texture& table, int s, int t);

/// What a table of one dimension gives for every code of a register, at code & 65535.
std::vector<std::int16_t> table_codes(const Texture& table);

}  // namespace burnish
