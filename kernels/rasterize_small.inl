/// Rows that are looked at together: whole vectors of rows, and whole rows of blocks.
inline constexpr int kSpanRows = kLanes32 >= kBlockSize ? kLanes32 : kBlockSize;
inline constexpr int kSpanVectors = kSpanRows / kLanes32;
inline constexpr int kTileColumns = kTileSize / kBlockSize;  // of blocks

/// Edges of kLanes32 triangles by the side that they bound. Pixels of row y, counted from the
/// tile's first, lie right of q = (step * y + origin) * factor = -(b y + c + 1/2) / a of left edges
/// and left of that of right ones: in whole numbers a x + b y + c >= 0 is a x + b y + c + 1/2 > 0.
/// Every triangle has edges on both sides; one that is alone on its side comes twice.
struct SpanEdges {
    enum : int { kFirstLeft, kLastLeft, kFirstRight, kLastRight, kCount };
    alignas(64) float step[kCount][kLanes32], origin[kCount][kLanes32], factor[kCount][kLanes32];
};

/// Corners from the centre of the tile's first pixel, 1/256 pixel: at most 2^14 apart, and within
/// 2^15. So |a|, |b| <= 2^14, products stay below 2^30 and |c| below 2^23, and floats have
/// b y + c + 1/2 exactly. q is never whole, but 1/2 / |a| >= 2^-15 off at least; where it lies in
/// the tile, the roundings of factor and product move it by less than 2^-16.
inline void set_span_edges(const I32 (&x)[3], const I32 (&y)[3], SpanEdges& edges) {
    const I32 zero(0);
    F32 step[3], origin[3], factor[3];
    MaskF right[3] = {MaskF(false), MaskF(false), MaskF(false)};
    for (int i = 0; i < 3; ++i) {
        const int next = i < 2 ? i + 1 : 0;
        const I32 a = y[i] - y[next], b = x[next] - x[i];
        const I32 c = with_top_left_rule(zero - (a * x[i] + b * y[i]), a, b) >> 8;
        step[i] = to_float(b);
        origin[i] = to_float(c) + F32(0.5F);
        // A level edge is a left one that has all of a row inside, or nothing.
        constexpr float kFarOff = -65536.0F;
        factor[i] =
            ::xsimd::select(as_float(a == zero), F32(kFarOff), divide(F32(-1.0F), to_float(a)));
        right[i] = as_float(a < zero);
    }
    const auto put = [&](const F32(&of)[3], float(&to)[SpanEdges::kCount][kLanes32]) {
        const auto pick = [](MaskF which, F32 a, F32 b) { return ::xsimd::select(which, a, b); };
        store(to[SpanEdges::kFirstLeft], pick(right[0], pick(right[1], of[2], of[1]), of[0]));
        store(to[SpanEdges::kLastLeft], pick(right[2], pick(right[1], of[0], of[1]), of[2]));
        store(to[SpanEdges::kFirstRight], pick(right[0], of[0], pick(right[1], of[1], of[2])));
        store(to[SpanEdges::kLastRight], pick(right[2], of[2], pick(right[1], of[1], of[0])));
    };
    put(step, edges.step);
    put(origin, edges.origin);
    put(factor, edges.factor);
}

/// kLanes32 triangles of a tile's list: their edges, and the rows of the tile that they reach.
struct SmallTriangles {
    SmallTriangles(const RasterizeEntriesCtx& ctx, int first) {
        for (int k = 0; k < kLanes32; ++k) {
            const int at = first + k < ctx.count ? first + k : ctx.count - 1;
            lane[k] = ctx.triangles + ctx.entries[at].triangle;
        }
        const auto numbers = [&](int part) {
            return load_columns([&](int k) {
                return reinterpret_cast<const std::int32_t*>(lane[k]->x) + 4 * part;
            });
        };
        static_assert(offsetof(SetupTriangle, y) == 12 && offsetof(SetupTriangle, box) == 24);
        const Columns upper = numbers(0), lower = numbers(1);
        const I32 centre_x(256 * ctx.left + 128), centre_y(256 * ctx.top + 128);
        const I32 x[3] = {upper[0] - centre_x, upper[1] - centre_x, upper[2] - centre_x};
        const I32 y[3] = {upper[3] - centre_y, lower[0] - centre_y, lower[1] - centre_y};
        set_span_edges(x, y, edges);
        const I32 top(ctx.top);
        store(first_row, max((lower[2] >> 16) - top, I32(0)));
        store(last_row, min((lower[3] >> 16) - top, I32(kTileSize - 1)));
    }
    const SetupTriangle* lane[kLanes32];
    SpanEdges edges;
    alignas(64) std::int32_t first_row[kLanes32], last_row[kLanes32];  ///< of their boxes
};

/// Masks of what triangle k covers in the blocks of kSpanRows rows, 8 to a row of blocks.
inline void span_masks(const SpanEdges& e, int k, int top, std::uint64_t (&masks)[kSpanRows]) {
    const F32 one(1.0F), outside(-1.0F), begin(0.0F), end(static_cast<float>(kTileSize));
    I32 first[kSpanVectors], last[kSpanVectors];
    for (int v = 0; v < kSpanVectors; ++v) {
        const F32 y = to_float(load(kLaneNumbers.of32) + I32(top + v * kLanes32));
        const auto crossing = [&](int edge) {
            return (F32(e.step[edge][k]) * y + F32(e.origin[edge][k])) * F32(e.factor[edge][k]);
        };
        const F32 left = max(crossing(SpanEdges::kFirstLeft), crossing(SpanEdges::kLastLeft));
        const F32 right = min(crossing(SpanEdges::kFirstRight), crossing(SpanEdges::kLastRight));
        first[v] = truncate(min(max(round_down(left) + one, begin), end));
        last[v] = truncate(max(min(round_down(right), end - one), outside));
    }
    store_block_rows(first, last, masks);
}

/// Depth tests as DepthRule has them: the usual one, by which nearer fragments win and leave their
/// depth, and any.
struct UsualDepth : NearerWins {
    static MaskF may_pass(const DepthRule&, F32 low, F32 far) { return low < far; }
    static bool writes(const DepthRule&) { return true; }
    /// Upper bounds of blocks' depths afterwards; `seen`: something may pass in them, `whole`: all
    /// of their pixels are covered.
    static F32 updated_far(const DepthRule&, F32 far, F32 high, MaskF /*seen*/, MaskF whole) {
        return ::xsimd::select(whole, min(high, far), far);
    }
};
struct AnyDepth : AnyRule {
    static MaskF may_pass(const DepthRule& rule, F32 low, F32 far) {
        if (rule.pass_greater != 0) return MaskF(true);
        return rule.pass_equal != 0 ? low <= far : low < far;
    }
    static bool writes(const DepthRule& rule) { return rule.write != 0; }
    static F32 updated_far(const DepthRule& rule, F32 far, F32 high, MaskF seen, MaskF whole) {
        return BURNISH_ISA::updated_far(rule, far, high, seen, whole);
    }
};

/// Rows of pixels counted from one that is at most kMost away, each as often as a block is wide:
/// rows of a block, from any on, are loaded one behind the other.
struct RowNumbers {
    static constexpr int kMost = kSmallSize + kBlockSize;
    static constexpr int kRows = 2 * kMost + kBlockSize;
    alignas(64) float number[kRows][kBlockSize];
};
constexpr RowNumbers make_row_numbers() {
    RowNumbers rows{};
    for (int i = 0; i < RowNumbers::kRows; ++i)
        for (float& number : rows.number[i]) number = static_cast<float>(i - RowNumbers::kMost);
    return rows;
}
constexpr RowNumbers kRowNumbers = make_row_numbers();

/// What a blank block holds.
struct BlankBlock {
    alignas(64) float depth[kBlockPixels];
    alignas(64) std::int32_t id[kBlockPixels];
};
constexpr BlankBlock make_blank_block() {
    BlankBlock block{};
    for (float& depth : block.depth) depth = 1.0F;
    for (std::int32_t& id : block.id) id = static_cast<std::int32_t>(kNoTriangle);
    return block;
}
constexpr BlankBlock kBlankBlock = make_blank_block();

/// Where the words of a block lie: in a blank block or in the tile, without a branch, since there
/// is no telling.
template <class Word>
inline const Word* stored_words(std::uint8_t blank, const Word* of_blank, const Word* of_tile) {
    const auto tile = reinterpret_cast<std::uintptr_t>(of_tile);
    const std::uintptr_t other = reinterpret_cast<std::uintptr_t>(of_blank) ^ tile;
    return reinterpret_cast<const Word*>(tile ^ (other & (std::uintptr_t{0} - blank)));
}

/// Depths of covered pixels: tested and written.
template <class Depth, bool HasIds>
inline void draw_covered(int triangle, int block, std::uint64_t pixels,
                         const RasterizeEntriesCtx& ctx) {
    const SetupTriangle& t = ctx.triangles[ctx.entries[triangle].triangle];
    const int x = block % kTileColumns * kBlockSize + ctx.left - t.reference_x;
    const int y = block / kTileColumns * kBlockSize + ctx.top - t.reference_y;
    const F32 z0(t.z), zx(t.zx), zy(t.zy), low(t.z_low), high(t.z_high);
    const float* const rows = kRowNumbers.number[y + RowNumbers::kMost];
    F32 row[kRowVectors];
    for (int k = 0; k < kRowVectors; ++k)
        row[k] = z0 + to_float(lane_x() + I32(x + k * kLanes32)) * zx;
    const BlockLanes covered(pixels);
    float* const depth = ctx.depth + block * kBlockPixels;
    const float* old_depth = depth;
    bool is_blank = false;
    std::int32_t* id = nullptr;
    const std::int32_t* old_id = nullptr;
    if constexpr (HasIds) {
        id = reinterpret_cast<std::int32_t*>(ctx.id) + block * kBlockPixels;
        const std::uint8_t blank_depth = ctx.blank_depths[block], blank_id = ctx.blank_ids[block];
        old_depth = stored_words<float>(blank_depth, kBlankBlock.depth, depth);
        old_id = stored_words<std::int32_t>(blank_id, kBlankBlock.id, id);
        is_blank = (blank_depth | blank_id) != 0;
        if (Depth::writes(ctx.rule)) ctx.blank_depths[block] = 0;
        ctx.blank_ids[block] = 0;
    }
    const I32 new_id(static_cast<std::int32_t>(ctx.first_id) + triangle);
    Mask32 any(false);
    // Where four vectors make a block the mispredicted end of the loop costs more than they do.
    int first = 0, end = kBlockVectors;
    if (kBlockVectors > 4 && !is_blank) {
        first = __builtin_ctzll(pixels) / kLanes32;
        end = (63 - __builtin_clzll(pixels)) / kLanes32 + 1;
    }
    for (int v = first; v < end; ++v) {
        const int at = v * kLanes32;
        const F32 z = min(max(row[v % kRowVectors] + load(rows + at) * zy, low), high);
        const F32 old = load(old_depth + at);
        const Mask32 write = covered[v] & as_int(Depth::pass(ctx.rule, z, old));
        if (Depth::writes(ctx.rule)) store(depth + at, ::xsimd::select(as_float(write), z, old));
        if constexpr (HasIds) {
            any = any | write;
            store(id + at, ::xsimd::select(write, new_id, load(old_id + at)));
        }
    }
    if constexpr (HasIds)
        ctx.drawn[triangle] |= static_cast<std::uint64_t>(bits(any) != 0 ? 1 : 0) << block;
}

/// Blocks in which triangles cover pixels and may pass, of many triangles: their number is hard to
/// predict.
template <class Depth, bool HasIds>
class CoveredBlocks {
  public:
    explicit CoveredBlocks(const RasterizeEntriesCtx& ctx) : m_ctx(ctx) {}

    /// The blocks of triangle k of those from number `first` on.
    void add(const SmallTriangles& triangles, int first, int k) {
        const F32 low(triangles.lane[k]->z_low), high(triangles.lane[k]->z_high);
        const I16 number(static_cast<std::int16_t>(first + k));
        // As many rows as it takes, but none behind the tile.
        const int first_row = triangles.first_row[k] & ~(kBlockSize - 1);
        const int rows = (triangles.last_row[k] - first_row + kSpanRows) & ~(kSpanRows - 1);
        const int begin = first_row + rows > kTileSize ? kTileSize - rows : first_row;
        for (int top = begin; top < begin + rows; top += kSpanRows) {
            // A row of blocks has as many blocks as rows of pixels.
            std::uint64_t masks[kSpanRows];
            span_masks(triangles.edges, k, top, masks);
            for (int part = 0; part < kSpanRows; part += kLanes32) {
                const std::uint64_t* const pixels = masks + part;
                float* const block_far = m_ctx.block_far + top + part;
                const F32 far = load(block_far);
                const Mask32 seen =
                    ~equal_words(pixels, 0) & as_int(Depth::may_pass(m_ctx.rule, low, far));
                store(block_far,
                      Depth::updated_far(m_ctx.rule, far, high, as_float(seen),
                                         as_float(equal_words(pixels, ~std::uint64_t{0}))));
                append_words(m_pixels + m_count, pixels, seen);
                store(m_triangle + m_count, number);
                m_count =
                    static_cast<int>(append_lanes(m_block + m_count, top + part, seen) - m_block);
            }
        }
        if (m_count > kEnough) draw();
    }
    void draw() {
        for (int i = 0; i < m_count; ++i)
            draw_covered<Depth, HasIds>(m_triangle[i], m_block[i], m_pixels[i], m_ctx);
        m_count = 0;
    }

  private:
    static constexpr int kEnough = 128;
    static constexpr int kMost = kEnough + kTileBlocks + kLanes;
    const RasterizeEntriesCtx& m_ctx;
    int m_count = 0;
    std::uint64_t m_pixels[kMost];
    std::uint16_t m_block[kMost];
    std::int16_t m_triangle[kMost];
};

template <class Depth, bool HasIds>
void rasterize_small(const RasterizeEntriesCtx& ctx) {
    CoveredBlocks<Depth, HasIds> blocks(ctx);
    if constexpr (HasIds)
        for (int i = 0; i < ctx.count; ++i) ctx.drawn[i] = 0;
    for (int first = 0; first < ctx.count; first += kLanes32) {
        const SmallTriangles triangles(ctx, first);
        const int count = ctx.count - first < kLanes32 ? ctx.count - first : kLanes32;
        for (int k = 0; k < count; ++k) blocks.add(triangles, first, k);
    }
    blocks.draw();
}

void rasterize_small(const RasterizeEntriesCtx& ctx) noexcept {
    const bool usual = nearer_wins(ctx.rule);
    if (ctx.id != nullptr) {
        usual ? rasterize_small<UsualDepth, true>(ctx) : rasterize_small<AnyDepth, true>(ctx);
    } else {
        usual ? rasterize_small<UsualDepth, false>(ctx) : rasterize_small<AnyDepth, false>(ctx);
    }
}
