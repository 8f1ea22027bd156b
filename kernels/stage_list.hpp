#pragma once

#include "kernels/packet_stages.hpp"
#include "kernels/texture_stages.hpp"
#include "kernels/tile_stages.hpp"

/// Every stage with the type of its argument, once. Enumerations, tables, tests and benchmarks come
/// from these two lists. Contract header: no functions.

/// Stages before shading: void stage(const Ctx&) noexcept.
#define BURNISH_TILE_STAGES(X)              \
    X(transform, TransformCtx)              \
    X(light_vertices, LightVerticesCtx)     \
    X(setup, SetupCtx)                      \
    X(clear_words, ClearWordsCtx)           \
    X(rasterize, RasterizeCtx)              \
    X(rasterize_small, RasterizeEntriesCtx) \
    X(rasterize_tiny, RasterizeEntriesCtx)  \
    X(cover, CoverCtx)                      \
    X(collect, CollectCtx)                  \
    X(attribute_planes, AttributePlanesCtx)

/// Stages on a packet: void stage(Packet&, const Ctx&) noexcept.
#define BURNISH_PACKET_STAGES(X)            \
    X(attributes, AttributesCtx)            \
    X(lighting, LightingCtx)                \
    X(encode_nine_bit, EncodeCtx)           \
    X(encode_wide, EncodeCtx)               \
    X(address, AddressCtx)                  \
    X(fetch_nine_bit, FetchCtx)             \
    X(fetch_wide, FetchCtx)                 \
    X(decode_nine_bit, DecodeCtx)           \
    X(decode_wide, DecodeCtx)               \
    X(affine, AffineCtx)                    \
    X(dot_product, DotCtx)                  \
    X(hemisphere, HemisphereCtx)            \
    X(offset, OffsetCtx)                    \
    X(reflect, ReflectCtx)                  \
    X(quotient, QuotientCtx)                \
    X(angle, AngleCtx)                      \
    X(cull, CullCtx)                        \
    X(dim_nine_bit, MagnitudeCtx)           \
    X(dim_wide, MagnitudeCtx)               \
    X(cube_face, CubeFaceCtx)               \
    X(plane_footprint, PlaneFootprintCtx)   \
    X(quad_footprint, QuadFootprintCtx)     \
    X(probe_extent, ProbeExtentCtx)         \
    X(probe_point, ProbePointCtx)           \
    X(probe_sum, ProbeSumCtx)               \
    X(probe_mean, ProbeSumCtx)              \
    X(level_of_detail, LevelOfDetailCtx)    \
    X(level_address, LevelAddressCtx)       \
    X(texel_corner, TexelCornerCtx)         \
    X(fetch_hilo, FetchHiloCtx)             \
    X(fetch_words, FetchWordsCtx)           \
    X(fetch_quartet, FetchQuartetCtx)       \
    X(prefetch_quartet, PrefetchQuartetCtx) \
    X(look_up_table, LookUpTableCtx)        \
    X(average_table, AverageTableCtx)       \
    X(blend_levels, BlendLevelsCtx)         \
    X(hilo, HiloCtx)                        \
    X(portion_nine_bit, PortionCtx)         \
    X(portion_wide, PortionCtx)             \
    X(final_nine_bit, FinalCtx)             \
    X(final_wide, FinalCtx)                 \
    X(filter_nine_bit, FilterCtx)           \
    X(filter_wide, FilterCtx)               \
    X(store_nine_bit, StoreCtx)             \
    X(store_wide, StoreCtx)                 \
    X(blend_nine_bit, BlendCtx)             \
    X(blend_wide, BlendCtx)                 \
    X(alpha_test, AlphaTestCtx)             \
    X(keep, KeepCtx)                        \
    X(late_depth, LateDepthCtx)
