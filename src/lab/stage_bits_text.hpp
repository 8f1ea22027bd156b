#pragma once

#include <string>
#include <string_view>

#include "lab/stage_bits.hpp"

/// StageBits in words, as `--bits` and the keys `bits.` of experiments have them.
namespace burnish::lab {

/// Sets one of half_vector, textures, filter, combiners, stage0, stage1, .. (general stages one by
/// one), table, table_index, table_values and frame to a number of bits or `exact`, `table_axis` to
/// lobe, unit or log, `table_filter` to nearest or linear, or `rounding` to nearest, truncate,
/// shift8 or stochastic. Throws Error{bad_option} that names what was expected.
void set_stage_bits(StageBits& bits, std::string_view key, std::string_view value);

/// "8": of everything 8 bits, of combiners one more for the sign; else "KEY=VALUE,KEY=VALUE..",
/// after what is there already.
void set_stage_bits(StageBits& bits, std::string_view text);

/// "exact" or the number.
std::string bits_text(int bits);
std::string_view rounding_name(BitRounding rounding);

}  // namespace burnish::lab
