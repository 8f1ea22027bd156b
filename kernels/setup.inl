/// Corners of one triangle per lane.
struct CornerLanes {
    I32 x, y;
    F32 z;
    I32 outcode;
};

/// Corner `which` of kLanes32 triangles.
inline CornerLanes load_corners(const ScreenVertex* vertices, const std::uint32_t* indices,
                                int which) {
    const Columns corner = load_columns([&](int k) { return vertices + indices[3 * k + which]; });
    return {corner[0], corner[1], corner.floats(2), corner[3]};
}

/// Edges at pixel centres of the box, for triangles in lanes: tiny ones' values stay below 2^25.
struct EdgeLanes {
    I32 value, right, down;  ///< at the current pixel; steps to the next ones
};
inline EdgeLanes edge_lanes(const CornerLanes& from, const CornerLanes& to, I32 centre_x,
                            I32 centre_y) {
    const I32 a = from.y - to.y, b = to.x - from.x;
    const I32 value = a * (centre_x - from.x) + b * (centre_y - from.y);
    return {with_top_left_rule(value, a, b), a << 8, b << 8};
}

/// A mask of coverage per lane: rows 0 .. 3 and 4 .. 7.
struct CoverageLanes {
    I32 rows[2];
};

/// The greatest number of a vector of numbers from 0 on.
inline int greatest(I32 v) {
    int n = 0;
    while (bits(v > I32(n)) != 0) ++n;
    return n;
}

/// Coverage of tiny triangles, all of them at once and pixel after pixel: of `columns` and `rows`
/// pixels from (x, y) on. Beside a triangle's box nothing is inside, but beyond the frame.
inline CoverageLanes tiny_coverage(const CornerLanes (&v)[3], I32 x, I32 y, int columns, int rows) {
    const I32 centre_x = (x << 8) + I32(128), centre_y = (y << 8) + I32(128);
    EdgeLanes edge[3] = {edge_lanes(v[0], v[1], centre_x, centre_y),
                         edge_lanes(v[1], v[2], centre_x, centre_y),
                         edge_lanes(v[2], v[0], centre_x, centre_y)};
    const I32 all_columns((1 << columns) - 1);
    CoverageLanes covered{{I32(0), I32(0)}};
    for (int row = 0; row < rows; ++row) {
        I32 value[3] = {edge[0].value, edge[1].value, edge[2].value};
        I32 bit(1), outside(0);
        for (int column = 0; column < columns; ++column) {
            outside = outside | (((value[0] | value[1] | value[2]) >> 31) & bit);
            for (int e = 0; e < 3; ++e) value[e] = value[e] + edge[e].right;
            bit = bit + bit;
        }
        I32& four_rows = covered.rows[row / 4];
        four_rows = four_rows | (outside ^ all_columns) << row % 4 * kTinySize;
        for (EdgeLanes& e : edge) e.value = e.value + e.down;
    }
    return covered;
}

/// Pixels of a box within a mask of tiny triangles; sizes less one, below kTinySize.
inline CoverageLanes box_mask(I32 right, I32 bottom) {
    CoverageLanes mask{{I32(0), I32(0)}};
    I32 row(0);
    for (int column = 0; column < kTinySize; ++column)
        row = row | ::xsimd::select(right >= I32(column), I32(1 << column), I32(0));
    for (int y = 0; y < kTinySize; ++y) {
        I32& four_rows = mask.rows[y / 4];
        four_rows = four_rows | ::xsimd::select(bottom >= I32(y), row << y % 4 * kTinySize, I32(0));
    }
    return mask;
}

/// Half of the lanes, in double: what becomes of depths.
struct DepthPlaneLanes {
    F64 z, zx, zy;
};
template <int Half>
inline DepthPlaneLanes depth_plane(const CornerLanes (&v)[3], F64 area, I32 reference_x,
                                   I32 reference_y) {
    const F64 z0 = to_double<Half>(v[0].z);
    const F64 dz1 = to_double<Half>(v[1].z) - z0, dz2 = to_double<Half>(v[2].z) - z0;
    const F64 x1 = to_double<Half>(v[1].x - v[0].x), y1 = to_double<Half>(v[1].y - v[0].y);
    const F64 x2 = to_double<Half>(v[2].x - v[0].x), y2 = to_double<Half>(v[2].y - v[0].y);
    const F64 scale = divide(F64(256.0), area), half(0.5), pixels(1.0 / 256.0);
    const F64 zx = (dz1 * y2 - dz2 * y1) * scale, zy = (dz2 * x1 - dz1 * x2) * scale;
    // A power of two: the product is the quotient.
    const F64 dx = (to_double<Half>(reference_x) + half) - to_double<Half>(v[0].x) * pixels;
    const F64 dy = (to_double<Half>(reference_y) + half) - to_double<Half>(v[0].y) * pixels;
    return {(z0 + dx * zx) + dy * zy, zx, zy};
}

/// Twice the area: differences below 2^24, so products and their difference are exact in double.
template <int Half>
inline F64 twice_area(const CornerLanes (&v)[3]) {
    return to_double<Half>(v[1].x - v[0].x) * to_double<Half>(v[2].y - v[0].y) -
           to_double<Half>(v[1].y - v[0].y) * to_double<Half>(v[2].x - v[0].x);
}

/// The fields of kLanes32 triangles in the order of SetupTriangle, four at a time.
struct SetupLanes {
    Columns chunk[4];
};

/// Writes triangles one after the other; those whose bit is not set are overwritten by the next.
/// Row j of four holds triangles 4 k + j in lanes k.
template <int Lane = 0>
inline void write_triangles(const LaneRows (&rows)[4], std::uint32_t drawn, unsigned char* out) {
    if constexpr (Lane < kParts) {
        for (int j = 0; j < 4; ++j) {
            rows[j].store<Lane>(out);
            out += (drawn >> (4 * Lane + j) & 1) * sizeof(SetupTriangle);
        }
        write_triangles<Lane + 1>(rows, drawn, out);
    }
}
inline LaneRows triangle_row(const SetupLanes& lanes, int j) {
    return LaneRows({lanes.chunk[0].column[j], lanes.chunk[1].column[j], lanes.chunk[2].column[j],
                     lanes.chunk[3].column[j]});
}

/// The same for places.
template <int Lane = 0>
inline void write_places(const Columns& place, std::uint32_t drawn, unsigned char* out) {
    if constexpr (Lane < kParts) {
        for (int j = 0; j < 4; ++j) {
            store_lane<Lane>(out, place.column[j]);
            out += (drawn >> (4 * Lane + j) & 1) * sizeof(SetupPlace);
        }
        write_places<Lane + 1>(place, drawn, out);
    }
}

/// Around boxes, whose corners are pairs of 16-bit numbers.
struct BoundsLanes {
    I16 first = I16(32767), last = I16(-1);

    void add(I32 from, I32 to, Mask32 lanes) {
        first = min(first, as_i16(::xsimd::select(lanes, from, I32(0x7fff7fff))));
        last = max(last, as_i16(::xsimd::select(lanes, to, I32(-1))));
    }
    PixelRect rect() const {
        std::int16_t from[kLanes], to[kLanes];
        store(from, first);
        store(to, last);
        PixelRect rect{32767, 32767, -1, -1};
        for (int i = 0; i < kLanes; i += 2) {
            rect = {from[i] < rect.x0 ? from[i] : rect.x0,
                    from[i + 1] < rect.y0 ? from[i + 1] : rect.y0,
                    to[i] > rect.x1 ? to[i] : rect.x1, to[i + 1] > rect.y1 ? to[i + 1] : rect.y1};
        }
        return rect;
    }
};

/// Triangles for tiles. Formulas: SetupCtx. A triangle per lane; what follows the last one, or the
/// first that needs clipping, is computed and dropped.
void setup(const SetupCtx& ctx) noexcept {
    static_assert(offsetof(SetupTriangle, box) == 24 && offsetof(SetupTriangle, z) == 32 &&
                  offsetof(SetupTriangle, reference_x) == 52);
    SetupTriangle* out = ctx.triangles;
    SetupPlace* out_places = ctx.places;
    BoundsLanes bounds;
    SetupCounts counts{ctx.count, 0, 0, 0, {}};
    const I32 zero(0), last_x(ctx.width - 1), last_y(ctx.height - 1);
    for (int first = 0; first < ctx.count; first += kLanes32) {
        const int left = ctx.count - first;
        const std::uint32_t* indices = ctx.indices + std::ptrdiff_t{3} * first;
        std::uint32_t lanes = (1U << kLanes32) - 1;
        std::uint32_t tail[3 * kLanes32] = {};
        if (left < kLanes32) {
            for (int i = 0; i < 3 * left; ++i) tail[i] = indices[i];
            indices = tail;
            lanes = (1U << left) - 1;
        }
        CornerLanes v[3] = {load_corners(ctx.vertices, indices, 0),
                            load_corners(ctx.vertices, indices, 1),
                            load_corners(ctx.vertices, indices, 2)};

        const I32 any = v[0].outcode | v[1].outcode | v[2].outcode;
        const I32 all = v[0].outcode & v[1].outcode & v[2].outcode;
        const auto has = [&](I32 outcode, std::uint32_t wanted) {
            return bits((outcode & I32(static_cast<std::int32_t>(wanted))) != zero);
        };
        const std::uint32_t nonfinite = has(any, Outcode::nonfinite);
        const std::uint32_t gone = nonfinite | has(all, Outcode::frustum);
        const std::uint32_t clip = has(any, Outcode::needs_clip) & ~gone & lanes;
        if (clip != 0) {
            lanes = (clip & (0U - clip)) - 1;
            counts.taken = first + __builtin_ctz(clip);
        }
        counts.nonfinite += __builtin_popcount(nonfinite & lanes);
        lanes &= ~gone;

        const F64 area_low = twice_area<0>(v), area_high = twice_area<1>(v);
        const F32 area = to_float(area_low, area_high);  // keeps signs, and whole numbers from 0
        const MaskF negative = area < F32(0.0F);
        const std::uint32_t degenerate = bits(as_int(area == F32(0.0F))) & lanes;
        counts.degenerate += __builtin_popcount(degenerate);
        lanes &= ~degenerate;
        const std::uint32_t backwards = bits(as_int(negative));
        if (ctx.drop_negative != 0) lanes &= ~backwards;
        if (ctx.drop_positive != 0) lanes &= backwards;

        const I32 low_x = min(min(v[0].x, v[1].x), v[2].x),
                  high_x = max(max(v[0].x, v[1].x), v[2].x);
        const I32 low_y = min(min(v[0].y, v[1].y), v[2].y),
                  high_y = max(max(v[0].y, v[1].y), v[2].y);
        const I32 from_x = (low_x + I32(127)) >> 8, to_x = (high_x - I32(128)) >> 8;
        const I32 from_y = (low_y + I32(127)) >> 8, to_y = (high_y - I32(128)) >> 8;
        const I32 x0 = max(from_x, zero), x1 = min(to_x, last_x);
        const I32 y0 = max(from_y, zero), y1 = min(to_y, last_y);
        lanes &= bits((x0 <= x1) & (y0 <= y1));
        if (lanes != 0) {
            const Mask32 swap = as_int(negative);
            const CornerLanes second = v[1];
            v[1].x = ::xsimd::select(swap, v[2].x, second.x);
            v[1].y = ::xsimd::select(swap, v[2].y, second.y);
            v[1].z = ::xsimd::select(negative, v[2].z, second.z);
            v[2].x = ::xsimd::select(swap, second.x, v[2].x);
            v[2].y = ::xsimd::select(swap, second.y, v[2].y);
            v[2].z = ::xsimd::select(negative, second.z, v[2].z);

            const I32 most(kTinySize - 1);
            const Mask32 tiny = (to_x - from_x <= most) & (to_y - from_y <= most) & lanes_of(lanes);
            CoverageLanes covered{{zero, zero}};
            if (bits(tiny) != 0) {
                const auto size = [&](I32 from, I32 to) {
                    return greatest(::xsimd::select(tiny, to - from + I32(1), zero));
                };
                covered = tiny_coverage(v, x0, y0, size(x0, to_x), size(y0, to_y));
                if (bits((to_x > last_x) | (to_y > last_y)) != 0) {
                    const CoverageLanes box = box_mask(x1 - x0, y1 - y0);
                    for (int i = 0; i < 2; ++i) covered.rows[i] = covered.rows[i] & box.rows[i];
                }
                for (I32& rows : covered.rows) rows = ::xsimd::select(tiny, rows, zero);
                lanes &= ~bits(tiny & ((covered.rows[0] | covered.rows[1]) == zero));
            }
            if (lanes != 0) {
                const F32 z01 = max(v[1].z, v[0].z);
                const Mask32 second_far = as_int(v[1].z > v[0].z), third_far = as_int(v[2].z > z01);
                const auto farthest = [&](I32 a, I32 b, I32 c) {
                    return ::xsimd::select(third_far, c, ::xsimd::select(second_far, b, a));
                };
                const I32 reference_x =
                    min(max(farthest(v[0].x, v[1].x, v[2].x) >> 8, zero), last_x);
                const I32 reference_y =
                    min(max(farthest(v[0].y, v[1].y, v[2].y) >> 8, zero), last_y);
                const DepthPlaneLanes low =
                    depth_plane<0>(v, ::xsimd::abs(area_low), reference_x, reference_y);
                const DepthPlaneLanes high =
                    depth_plane<1>(v, ::xsimd::abs(area_high), reference_x, reference_y);
                const F32 z_low = min(v[2].z, min(v[1].z, v[0].z)), z_high = max(v[2].z, z01);
                const I32 number =
                    load(kLaneNumbers.of32) +
                    I32(static_cast<std::int32_t>(ctx.number + static_cast<std::uint32_t>(first)));
                const I32 flags = ::xsimd::select(swap, I32(1 << 30), zero) |
                                  I32(static_cast<std::int32_t>(ctx.draw));
                const I32 corner = x0 | y0 << 16, opposite = x1 | y1 << 16;
                SetupLanes fields{
                    Columns{{as_i16(v[0].x), as_i16(v[1].x), as_i16(v[2].x), as_i16(v[0].y)}},
                    Columns{{as_i16(v[1].y), as_i16(v[2].y), as_i16(corner), as_i16(opposite)}},
                    Columns{{as_i16(to_float(low.z, high.z)), as_i16(to_float(low.zx, high.zx)),
                             as_i16(to_float(low.zy, high.zy)), as_i16(z_low)}},
                    Columns{{as_i16(z_high), as_i16(reference_x | reference_y << 16),
                             as_i16(number), as_i16(flags)}}};
                for (Columns& chunk : fields.chunk) chunk = transposed(chunk);
                const LaneRows rows[4] = {triangle_row(fields, 0), triangle_row(fields, 1),
                                          triangle_row(fields, 2), triangle_row(fields, 3)};
                write_triangles(rows, lanes, reinterpret_cast<unsigned char*>(out));
                const I32 most_apart(256 * kSmallSize);
                const Mask32 large = (high_x - low_x > most_apart) | (high_y - low_y > most_apart);
                const I32 tiles =
                    ::xsimd::select(large, I32(static_cast<std::int32_t>(SetupPlace::kLarge)),
                                    ((x0 ^ x1) | (y0 ^ y1)) & I32(-kTileSize));
                const Columns place = transposed({{as_i16(covered.rows[0]), as_i16(covered.rows[1]),
                                                   as_i16(corner), as_i16(tiles)}});
                write_places(place, lanes, reinterpret_cast<unsigned char*>(out_places));
                bounds.add(corner, opposite, lanes_of(lanes));
                const int drawn = __builtin_popcount(lanes);
                out += drawn;
                out_places += drawn;
            }
        }
        if (clip != 0) break;
    }
    counts.drawn = static_cast<std::int32_t>(out - ctx.triangles);
    counts.bounds = bounds.rect();
    *ctx.counts = counts;
}
