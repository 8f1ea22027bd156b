/// A block is 64 pixels: kBlockVectors vectors of 32-bit lanes, each of them rows or parts of a
/// row.
inline constexpr int kBlockVectors = kBlockPixels / kLanes32;
inline constexpr int kRowVectors = kLanes32 >= kBlockSize ? 1 : kBlockSize / kLanes32;
inline constexpr int kVectorRows = kLanes32 >= kBlockSize ? kLanes32 / kBlockSize : 1;

/// Position of each lane inside its vector.
struct LanePositions {
    alignas(64) std::int32_t x[16], y[16];
};
constexpr LanePositions make_lane_positions() {
    LanePositions lanes{};
    for (int i = 0; i < 16; ++i) {
        lanes.x[i] = i % kBlockSize;
        lanes.y[i] = i / kBlockSize;
    }
    return lanes;
}
constexpr LanePositions kLanePositions = make_lane_positions();
inline I32 lane_x() {
    return load(kLanePositions.x);
}
inline I32 lane_y() {
    return load(kLanePositions.y);
}
/// What of a triangle's edges is the same in every block. A triangle with fewer than three edges
/// has edges with a = b = c = 0 in their place, which have everything inside.
struct TriangleEdges {
    std::int32_t a[3] = {}, b[3] = {}, c[3] = {};
    I32 lanes[3][kBlockVectors];  ///< a * x + b * y for the pixels of a block
};
inline void set_edges(const TileTriangle& t, TriangleEdges& e) {
    const I32 x = lane_x(), y = lane_y();
    for (int k = 0; k < 3; ++k) {
        if (k < t.edges) {
            e.a[k] = t.a[k];
            e.b[k] = t.b[k];
            e.c[k] = t.c[k];
        }
        const I32 first = I32(e.a[k]) * x + I32(e.b[k]) * y;
        for (int v = 0; v < kBlockVectors; ++v) {
            e.lanes[k][v] = first + I32(e.a[k] * (v % kRowVectors * kLanes32) +
                                        e.b[k] * (v / kRowVectors * kVectorRows));
        }
    }
}

/// Which blocks of the tile a triangle has to be drawn in: bit k for block k.
struct BlockMasks {
    std::uint64_t touched = 0;  ///< maybe covered, maybe visible
    std::uint64_t crossed = 0;  ///< an edge runs through it
    std::uint64_t clamped = 0;  ///< the plane leaves the range of the depths
};

inline DepthRule depth_rule(const TileTriangle& t) {
    return {t.pass_less, t.pass_equal, t.pass_greater, t.depth_write};
}
/// The usual rule: nearer fragments win and leave their depth.
inline bool nearer_wins(const DepthRule& rule) {
    return rule.pass_less != 0 && rule.pass_equal == 0 && rule.pass_greater == 0 && rule.write != 0;
}

/// Upper bounds of blocks' depths after a triangle was drawn in them; `touched`: something may pass
/// there, `whole`: all of their pixels are covered.
inline F32 updated_far(const DepthRule& rule, F32 far, F32 farthest, MaskF touched, MaskF whole) {
    if (rule.write == 0) return far;
    if (rule.pass_greater != 0) return ::xsimd::select(touched, max(farthest, far), far);
    if (rule.pass_less == 0) return far;
    // Whatever the test left is no farther than the triangle.
    return ::xsimd::select(touched & whole, min(farthest, far), far);
}

/// Classifies the blocks of the bounding box, as many at a time as there are lanes: the tile is 8x8
/// blocks as a block is 8x8 pixels, so lane positions serve for both.
inline BlockMasks classify_blocks(const TileTriangle& t, const TriangleEdges& edges,
                                  float* block_far) {
    constexpr int kLast = kBlockSize - 1;
    constexpr int kSide = kTileSize / kBlockSize;
    const int first_row = t.y0 / kBlockSize, last_row = t.y1 / kBlockSize;
    const int first_column = t.x0 / kBlockSize, last_column = t.x1 / kBlockSize;
    const std::uint64_t columns = (0xffU >> (kSide - 1 - last_column)) & (0xffU << first_column);
    const std::uint64_t rows = (~std::uint64_t{0} >> (kSide * (kSide - 1 - last_row))) &
                               (~std::uint64_t{0} << (kSide * first_row));
    const std::uint64_t box = columns * 0x0101010101010101U & rows;
    BlockMasks masks;
    const F32 z0(t.z), zx(t.zx), zy(t.zy), low(t.z_low), high(t.z_high);
    const I32 near_x(t.offset_x + (t.zx < 0.0F ? kLast : 0)),
        near_y(t.offset_y + (t.zy < 0.0F ? kLast : 0));
    const I32 far_x(t.offset_x + (t.zx < 0.0F ? 0 : kLast)),
        far_y(t.offset_y + (t.zy < 0.0F ? 0 : kLast));
    const int first = first_row / kVectorRows * kRowVectors;
    const int end = (last_row / kVectorRows + 1) * kRowVectors;
    for (int v = first; v < end; ++v) {
        const int shift = v * kLanes32;
        const std::uint64_t lanes = (std::uint64_t{1} << kLanes32) - 1;
        std::uint64_t seen = lanes;
        I32 any_low(0);
        for (int k = 0; k < t.edges; ++k) {
            const std::int32_t across = edges.a[k] * kLast, down = edges.b[k] * kLast;
            const I32 base = (edges.lanes[k][v] << 3) + I32(edges.c[k]);
            const I32 highest = base + I32((across > 0 ? across : 0) + (down > 0 ? down : 0));
            seen &= ~static_cast<std::uint64_t>(bits(highest < I32(0)));
            any_low = any_low | (base + I32((across < 0 ? across : 0) + (down < 0 ? down : 0)));
        }
        const Mask32 whole = any_low >= I32(0);
        const I32 x = (lane_x() + I32(v % kRowVectors * kLanes32)) << 3;
        const I32 y = (lane_y() + I32(v / kRowVectors * kVectorRows)) << 3;
        const auto plane = [&](I32 dx, I32 dy) {
            return (z0 + to_float(x + dx) * zx) + to_float(y + dy) * zy;
        };
        const F32 near_plane = plane(near_x, near_y), far_plane = plane(far_x, far_y);
        const F32 nearest = min(max(near_plane, low), high),
                  farthest = min(max(far_plane, low), high);
        const F32 far = load(block_far + shift);
        if (t.pass_greater == 0) {
            const MaskF hidden = t.pass_equal != 0 ? nearest > far : nearest >= far;
            seen &= ~static_cast<std::uint64_t>(bits(as_int(hidden)));
        }
        seen &= lanes & (box >> shift);
        masks.touched |= seen << shift;
        masks.crossed |= static_cast<std::uint64_t>(bits(any_low < I32(0))) << shift;
        masks.clamped |=
            static_cast<std::uint64_t>(bits(as_int((near_plane < low) | (far_plane > high))))
            << shift;
        store(block_far + shift,
              updated_far(depth_rule(t), far, farthest,
                          as_float(lanes_of(static_cast<std::uint32_t>(seen))), as_float(whole)));
    }
    return masks;
}

struct NearerWins {
    template <class Tested>
    static MaskF pass(const Tested&, F32 z, F32 old) {
        return z < old;
    }
    static bool writes(const TileTriangle&) { return true; }
};
struct AnyRule {
    template <class Tested>
    static MaskF pass(const Tested& t, F32 z, F32 old) {
        MaskF pass(false);
        if (t.pass_less != 0) pass = z < old;
        if (t.pass_equal != 0) pass = pass | (z == old);
        if (t.pass_greater != 0) pass = pass | (z > old);
        return pass;
    }
    static bool writes(const TileTriangle& t) { return t.depth_write != 0; }
};

/// Fragments that pass leave the triangle's id; whether there were any.
struct LeaveId {
    LeaveId(const TileTriangle& t, const RasterizeCtx& ctx, int block)
        : new_id(static_cast<std::int32_t>(t.id)),
          any(false),
          id(reinterpret_cast<std::int32_t*>(ctx.id + block * kBlockPixels)) {}
    void take(int v, Mask32 write) {
        any = any | write;
        std::int32_t* const ids = id + v * kLanes32;
        store(ids, ::xsimd::select(write, new_id, load(ids)));
    }
    [[nodiscard]] std::uint64_t passed() const { return bits(any) != 0 ? 1 : 0; }
    I32 new_id;
    Mask32 any;
    std::int32_t* id;
};
/// Depths alone.
struct LeaveNothing {
    LeaveNothing(const TileTriangle&, const RasterizeCtx&, int) {}
    void take(int, Mask32) {}
    [[nodiscard]] static std::uint64_t passed() { return 0; }
};
/// Fragments that pass leave a bit.
struct LeaveBit {
    void take(int v, Mask32 write) {
        passed |= static_cast<std::uint64_t>(bits(write)) << (v * kLanes32);
    }
    std::uint64_t passed = 0;
};

/// Coverage and depth test of one block; `Crossed`: an edge runs through it; `Clamped`: the plane
/// may leave the range of the depths.
template <bool Crossed, bool Clamped, class Rule, class Trace>
inline void draw_block(const TileTriangle& t, const TriangleEdges& edges, int x, int y,
                       float* depth, Trace& trace) {
    const F32 zx(t.zx), zy(t.zy), z0(t.z), z_low(t.z_low), z_high(t.z_high);
    const F32 lanes_y = to_float(lane_y()) + F32(static_cast<float>(y + t.offset_y));
    F32 z_row[kRowVectors];
    for (int k = 0; k < kRowVectors; ++k) {
        z_row[k] = z0 + to_float(lane_x() + I32(x + t.offset_x + k * kLanes32)) * zx;
    }
    I32 base[3];
    for (int k = 0; k < 3; ++k) base[k] = I32(edges.c[k] + edges.a[k] * x + edges.b[k] * y);
    // Vectors that hold no row of the bounding box cannot be covered. Where four vectors make a
    // block the mispredicted end of the loop costs more than they do.
    int first = 0, end = kBlockVectors;
    if constexpr (kBlockVectors > 4) {
        const int above = t.y0 > y ? t.y0 - y : 0;
        const int last_row = t.y1 - y < kBlockSize - 1 ? t.y1 - y : kBlockSize - 1;
        first = above / kVectorRows * kRowVectors;
        end = (last_row / kVectorRows + 1) * kRowVectors;
    }
    for (int v = first; v < end; ++v) {
        // Whole numbers below 2^24: exact, however they are added.
        const F32 dy = lanes_y + F32(static_cast<float>(v / kRowVectors * kVectorRows));
        F32 z = z_row[v % kRowVectors] + dy * zy;
        if constexpr (Clamped) z = min(max(z, z_low), z_high);
        const F32 old = load(depth + v * kLanes32);
        Mask32 write = as_int(Rule::pass(t, z, old));
        if constexpr (Crossed) {
            const I32 outside = (base[0] + edges.lanes[0][v]) | (base[1] + edges.lanes[1][v]) |
                                (base[2] + edges.lanes[2][v]);
            write = write & (outside >= I32(0));
        }
        trace.take(v, write);
        if (Rule::writes(t)) {
            store(depth + v * kLanes32, ::xsimd::select(as_float(write), z, old));
        }
    }
}

template <class Rule, class Trace>
inline void draw_block(const TileTriangle& t, const TriangleEdges& edges, const BlockMasks& masks,
                       int block, float* tile_depth, Trace& trace) {
    const int x = block % kBlockSize * kBlockSize, y = block / kBlockSize * kBlockSize;
    float* const depth = tile_depth + block * kBlockPixels;
    if ((masks.crossed >> block & 1) != 0) {
        draw_block<true, true, Rule>(t, edges, x, y, depth, trace);
    } else if ((masks.clamped >> block & 1) != 0) {
        draw_block<false, true, Rule>(t, edges, x, y, depth, trace);
    } else {
        draw_block<false, false, Rule>(t, edges, x, y, depth, trace);
    }
}

/// Returns the blocks in which a fragment passed, as far as `Trace` knows.
template <class Rule, class Trace>
std::uint64_t rasterize_triangle(const TileTriangle& t, const RasterizeCtx& ctx) {
    std::uint64_t drawn = 0;
    TriangleEdges edges;
    set_edges(t, edges);
    const BlockMasks masks = classify_blocks(t, edges, ctx.block_far);
    for (std::uint64_t rest = masks.touched; rest != 0; rest &= rest - 1) {
        const int block = __builtin_ctzll(rest);
        Trace trace(t, ctx, block);
        draw_block<Rule>(t, edges, masks, block, ctx.depth, trace);
        drawn |= trace.passed() << block;
    }
    return drawn;
}

template <class Trace>
std::uint64_t rasterize_by_rule(const TileTriangle& t, const RasterizeCtx& ctx) {
    return nearer_wins(depth_rule(t)) ? rasterize_triangle<NearerWins, Trace>(t, ctx)
                                      : rasterize_triangle<AnyRule, Trace>(t, ctx);
}

void rasterize(const RasterizeCtx& ctx) noexcept {
    if (ctx.id == nullptr) {
        for (int i = 0; i < ctx.count; ++i) {
            rasterize_by_rule<LeaveNothing>(ctx.triangles[i], ctx);
        }
        return;
    }
    for (int i = 0; i < ctx.count; ++i) {
        ctx.drawn[i] = rasterize_by_rule<LeaveId>(ctx.triangles[i], ctx);
    }
}

/// Pixels of the block at (x, y) that lie in the triangle's bounding box: what of the block lies
/// outside the frame does not.
inline std::uint64_t box_pixels(const TileTriangle& t, int x, int y) {
    constexpr int kLast = kBlockSize - 1;
    const int x0 = t.x0 > x ? t.x0 - x : 0, x1 = t.x1 - x < kLast ? t.x1 - x : kLast;
    const int y0 = t.y0 > y ? t.y0 - y : 0, y1 = t.y1 - y < kLast ? t.y1 - y : kLast;
    const std::uint64_t columns = (0xffU >> (kLast - x1)) & (0xffU << x0);
    const std::uint64_t rows = (~std::uint64_t{0} >> (kBlockSize * (kLast - y1))) &
                               (~std::uint64_t{0} << (kBlockSize * y0));
    return (columns & 0xffU) * 0x0101010101010101U & rows;
}

template <class Rule>
void cover_by(const CoverCtx& ctx) {
    const TileTriangle& t = *ctx.triangle;
    TriangleEdges edges;
    set_edges(t, edges);
    const BlockMasks masks = classify_blocks(t, edges, ctx.block_far);
    std::uint64_t blocks = 0;
    for (std::uint64_t rest = masks.touched; rest != 0; rest &= rest - 1) {
        const int block = __builtin_ctzll(rest);
        const int x = block % kBlockSize * kBlockSize, y = block / kBlockSize * kBlockSize;
        LeaveBit trace;
        draw_block<Rule>(t, edges, masks, block, ctx.depth, trace);
        const std::uint64_t passed = trace.passed & box_pixels(t, x, y);
        if (passed == 0) continue;
        ctx.passed[block] = passed;
        blocks |= std::uint64_t{1} << block;
    }
    *ctx.blocks = blocks;
}
void cover(const CoverCtx& ctx) noexcept {
    nearer_wins(depth_rule(*ctx.triangle)) ? cover_by<NearerWins>(ctx) : cover_by<AnyRule>(ctx);
}
