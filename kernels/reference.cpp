#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "kernels/kernel_table.hpp"
#include "kernels/log2_steps.hpp"

/// The scalar reference of every stage: one pixel at a time, each line the definition from
/// docs/numbers.md or from the comment of the stage's argument. It decides what the vector kernels
/// must give, bit for bit, so nothing here is written for speed.
namespace burnish {
namespace {

using Int = std::int64_t;

// The minimum and maximum of the contract: a NaN in `a` yields `b`.
float minimum(float a, float b) {
    return a < b ? a : b;
}
float maximum(float a, float b) {
    return a > b ? a : b;
}

Int clamp(Int x, Int low, Int high) {
    return std::min(std::max(x, low), high);
}

/// Quotient rounded to nearest, for divisors that leave no ties. divisor > 0 and odd.
Int divide_to_nearest(Int x, Int divisor) {
    const Int magnitude = ((x < 0 ? -x : x) * 2 + divisor) / (2 * divisor);
    return x < 0 ? -magnitude : magnitude;
}

/// Quotient by 2^bits, rounded half up.
Int shift_half_up(Int x, int bits) {
    return (x + (Int{1} << (bits - 1))) >> bits;
}

#include "kernels/reference/coverage.inl"
#include "kernels/reference/interpolate.inl"

#include "kernels/reference/addresses.inl"  // after interpolate.inl, whose planes they use
#include "kernels/reference/textures.inl"   // after addresses.inl; has the two number models

#include "kernels/reference/combine.inl"
#include "kernels/reference/final.inl"
#include "kernels/reference/fragment_tests.inl"
#include "kernels/reference/texture_shader.inl"

#include "kernels/reference/blend.inl"  // after final.inl: what it blends is what store writes

}  // namespace

const KernelTable& table_reference() noexcept {
    static constexpr KernelTable table{
        .isa = "reference",
        .lanes = 1,
        .transform = transform,
        .light_vertices = light_vertices,
        .setup = setup,
        .clear_words = clear_words,
        .rasterize = rasterize,
        .rasterize_small = rasterize_small,
        .rasterize_tiny = rasterize_tiny,
        .cover = cover,
        .collect = collect,
        .attribute_planes = attribute_planes,
        .attributes = attributes,
        .lighting = lighting,
        .encode_nine_bit = encode<NineBit>,
        .encode_wide = encode<Wide>,
        .address = address,
        .fetch_nine_bit = fetch<NineBit>,
        .fetch_wide = fetch<Wide>,
        .decode_nine_bit = decode<number_nine_bit>,
        .decode_wide = decode<number_wide>,
        .affine = affine,
        .dot_product = dot_product,
        .hemisphere = hemisphere,
        .offset = offset,
        .reflect = reflect,
        .quotient = quotient,
        .angle = angle,
        .cull = cull,
        .dim_nine_bit = dim<NineBit>,
        .dim_wide = dim<Wide>,
        .cube_face = cube_face,
        .plane_footprint = plane_footprint,
        .quad_footprint = quad_footprint,
        .probe_extent = probe_extent,
        .probe_point = probe_point,
        .probe_sum = probe_sum,
        .probe_mean = probe_mean,
        .level_of_detail = level_of_detail,
        .level_address = level_address,
        .texel_corner = texel_corner,
        .fetch_hilo = fetch_hilo,
        .fetch_words = fetch_words,
        .fetch_quartet = fetch_quartet,
        .prefetch_quartet = prefetch_quartet,
        .look_up_table = look_up_table,
        .average_table = average_table,
        .blend_levels = blend_levels,
        .hilo = hilo,
        .portion_nine_bit = portion<NineBit>,
        .portion_wide = portion<Wide>,
        .final_nine_bit = final_combiner<NineBit>,
        .final_wide = final_combiner<Wide>,
        .filter_nine_bit = filter_nine_bit,
        .filter_wide = filter_wide,
        .store_nine_bit = store<NineBit>,
        .store_wide = store<Wide>,
        .blend_nine_bit = blend<NineBit>,
        .blend_wide = blend<Wide>,
        .alpha_test = alpha_test,
        .keep = keep,
        .late_depth = late_depth,
    };
    return table;
}

}  // namespace burnish
