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

/// Depth at a tile pixel, as RasterizeCtx defines it.
inline float depth_at(const TileTriangle& t, int x, int y) {
    const float z = (t.z + static_cast<float>(x + t.offset_x) * t.zx) +
                    static_cast<float>(y + t.offset_y) * t.zy;
    return z < t.z_low ? t.z_low : z > t.z_high ? t.z_high : z;
}

/// The expression is monotone in x and in y even when rounded, so its bounds over a block are at
/// the corners that the slopes point to.
inline float farthest_depth(const TileTriangle& t, int x, int y) {
    constexpr int kLast = kBlockSize - 1;
    return depth_at(t, t.zx < 0.0F ? x : x + kLast, t.zy < 0.0F ? y : y + kLast);
}

struct EdgeVectors {
    I32 lanes[3];                         ///< a * lane x + b * lane y
    std::int32_t step[3][kBlockVectors];  ///< from a block's first vector to each of its vectors
};
EdgeVectors edge_vectors(const TileTriangle& t) {
    EdgeVectors e;
    const I32 x = lane_x(), y = lane_y();
    for (int k = 0; k < t.edges; ++k) {
        e.lanes[k] = I32(t.a[k]) * x + I32(t.b[k]) * y;
        for (int v = 0; v < kBlockVectors; ++v) {
            e.step[k][v] =
                t.a[k] * (v % kRowVectors * kLanes32) + t.b[k] * (v / kRowVectors * kVectorRows);
        }
    }
    return e;
}

/// Which blocks of the tile a triangle has to be drawn in: bit k for block k.
struct BlockMasks {
    std::uint64_t touched = 0;      ///< maybe covered, maybe visible
    std::uint64_t crossed[3] = {};  ///< edge k runs through the block
};

/// Classifies the blocks of the bounding box, as many at a time as there are lanes: the tile is 8x8
/// blocks as a block is 8x8 pixels, so lane positions serve for both.
BlockMasks classify_blocks(const TileTriangle& t, const EdgeVectors& edges,
                           const float* block_far) {
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
    const I32 corner_x(t.offset_x + (t.zx < 0.0F ? kLast : 0));
    const I32 corner_y(t.offset_y + (t.zy < 0.0F ? kLast : 0));
    const int first = first_row / kVectorRows * kRowVectors;
    const int end = (last_row / kVectorRows + 1) * kRowVectors;
    for (int v = first; v < end; ++v) {
        const int shift = v * kLanes32;
        const std::uint64_t lanes = (std::uint64_t{1} << kLanes32) - 1;
        std::uint64_t seen = lanes;
        for (int k = 0; k < t.edges; ++k) {
            const std::int32_t across = t.a[k] * kLast, down = t.b[k] * kLast;
            const I32 base = (edges.lanes[k] << 3) + I32(t.c[k] + 8 * edges.step[k][v]);
            const I32 lowest = base + I32((across < 0 ? across : 0) + (down < 0 ? down : 0));
            const I32 highest = base + I32((across > 0 ? across : 0) + (down > 0 ? down : 0));
            seen &= ~static_cast<std::uint64_t>(bits(highest < I32(0)));
            masks.crossed[k] |= static_cast<std::uint64_t>(bits(lowest < I32(0))) << shift;
        }
        if (t.pass_greater == 0) {
            const I32 x = ((lane_x() + I32(v % kRowVectors * kLanes32)) << 3) + corner_x;
            const I32 y = ((lane_y() + I32(v / kRowVectors * kVectorRows)) << 3) + corner_y;
            const F32 nearest = min(max((z0 + to_float(x) * zx) + to_float(y) * zy, low), high);
            const F32 far = load(block_far + shift);
            const MaskF hidden = t.pass_equal != 0 ? nearest > far : nearest >= far;
            seen &= ~static_cast<std::uint64_t>(bits(as_int(hidden)));
        }
        masks.touched |= (seen & lanes) << shift;
    }
    masks.touched &= box;
    return masks;
}

/// Edges that cross a block, with their value at its first pixel.
struct CrossingEdges {
    int count;
    int edge[3];
    std::int32_t base[3];
};
inline CrossingEdges crossing_edges(const TileTriangle& t, const BlockMasks& masks, int block,
                                    int x, int y) {
    CrossingEdges crossing;
    crossing.count = 0;
    for (int k = 0; k < t.edges; ++k) {
        if ((masks.crossed[k] >> block & 1) == 0) continue;
        crossing.edge[crossing.count] = k;
        crossing.base[crossing.count++] = t.c[k] + t.a[k] * x + t.b[k] * y;
    }
    return crossing;
}

/// The usual rule: nearer fragments win and leave their depth.
struct NearerWins {
    static MaskF pass(const TileTriangle&, F32 z, F32 old) { return z < old; }
    static bool writes(const TileTriangle&) { return true; }
};
struct AnyRule {
    static MaskF pass(const TileTriangle& t, F32 z, F32 old) {
        MaskF pass(false);
        if (t.pass_less != 0) pass = z < old;
        if (t.pass_equal != 0) pass = pass | (z == old);
        if (t.pass_greater != 0) pass = pass | (z > old);
        return pass;
    }
    static bool writes(const TileTriangle& t) { return t.depth_write != 0; }
};

/// Coverage, depth test and visibility of one block that `Edges` edges cross.
template <int Edges, class Rule>
void draw_block(const TileTriangle& t, const EdgeVectors& edges, const CrossingEdges& crossing,
                int x, int y, float* depth, std::uint32_t* id) {
    const F32 zx(t.zx), zy(t.zy), z0(t.z), z_low(t.z_low), z_high(t.z_high);
    const I32 new_id(static_cast<std::int32_t>(t.id));
    const F32 lanes_y = to_float(lane_y());
    F32 z_row[kRowVectors];
    for (int k = 0; k < kRowVectors; ++k) {
        z_row[k] = z0 + to_float(lane_x() + I32(x + t.offset_x + k * kLanes32)) * zx;
    }
    I32 base[Edges > 0 ? Edges : 1];
    const std::int32_t* step[Edges > 0 ? Edges : 1];
    for (int k = 0; k < Edges; ++k) {
        base[k] = edges.lanes[crossing.edge[k]] + I32(crossing.base[k]);
        step[k] = edges.step[crossing.edge[k]];
    }
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
        const float row = static_cast<float>(y + t.offset_y + v / kRowVectors * kVectorRows);
        const F32 z = min(max(z_row[v % kRowVectors] + (F32(row) + lanes_y) * zy, z_low), z_high);
        const F32 old = load(depth + v * kLanes32);
        Mask32 write = as_int(Rule::pass(t, z, old));
        if constexpr (Edges > 0) {
            I32 outside = base[0] + I32(step[0][v]);
            for (int k = 1; k < Edges; ++k) outside = outside | (base[k] + I32(step[k][v]));
            write = write & (outside >= I32(0));
        }
        auto* ids = reinterpret_cast<std::int32_t*>(id) + v * kLanes32;
        store(ids, ::xsimd::select(write, new_id, load(ids)));
        if (Rule::writes(t)) {
            store(depth + v * kLanes32, ::xsimd::select(as_float(write), z, old));
        }
    }
}

template <class Rule>
void draw_block(const TileTriangle& t, const EdgeVectors& edges, const CrossingEdges& crossing,
                int x, int y, float* depth, std::uint32_t* id) {
    switch (crossing.count) {
        case 0:
            return draw_block<0, Rule>(t, edges, crossing, x, y, depth, id);
        case 1:
            return draw_block<1, Rule>(t, edges, crossing, x, y, depth, id);
        case 2:
            return draw_block<2, Rule>(t, edges, crossing, x, y, depth, id);
        default:
            return draw_block<3, Rule>(t, edges, crossing, x, y, depth, id);
    }
}

/// Upper bound of a block's depths after the triangle was drawn in it.
inline float updated_far(const TileTriangle& t, int x, int y, bool whole_block, float far) {
    if (t.depth_write == 0) return far;
    if (t.pass_greater != 0) {
        const float farthest = farthest_depth(t, x, y);
        return farthest > far ? farthest : far;
    }
    if (!whole_block || t.pass_less == 0) return far;
    // Whatever the test left is no farther than the triangle.
    const float farthest = farthest_depth(t, x, y);
    return farthest < far ? farthest : far;
}

template <class Rule>
void rasterize_triangle(const TileTriangle& t, const RasterizeCtx& ctx) {
    const EdgeVectors edges = edge_vectors(t);
    const BlockMasks masks = classify_blocks(t, edges, ctx.block_far);
    for (std::uint64_t rest = masks.touched; rest != 0; rest &= rest - 1) {
        const int block = __builtin_ctzll(rest);
        const int x = block % kBlockSize * kBlockSize, y = block / kBlockSize * kBlockSize;
        const CrossingEdges crossing = crossing_edges(t, masks, block, x, y);
        draw_block<Rule>(t, edges, crossing, x, y, ctx.depth + block * kBlockPixels,
                         ctx.id + block * kBlockPixels);
        float& far = ctx.block_far[block];
        far = updated_far(t, x, y, crossing.count == 0, far);
    }
}

void rasterize(const RasterizeCtx& ctx) noexcept {
    for (int i = 0; i < ctx.count; ++i) {
        const TileTriangle& t = ctx.triangles[i];
        const bool usual =
            t.pass_less != 0 && t.pass_equal == 0 && t.pass_greater == 0 && t.depth_write != 0;
        if (usual) {
            rasterize_triangle<NearerWins>(t, ctx);
        } else {
            rasterize_triangle<AnyRule>(t, ctx);
        }
    }
}

/// Set bits of a byte as 16-bit positions, packed to the front; a table of 256 rows of 16 bytes.
struct BitPositions {
    alignas(16) std::uint16_t row[256][8];
};
constexpr BitPositions make_bit_positions() {
    BitPositions table{};
    for (int byte = 0; byte < 256; ++byte) {
        int n = 0;
        for (int bit = 0; bit < 8; ++bit) {
            if ((byte >> bit & 1) != 0) table.row[byte][n++] = static_cast<std::uint16_t>(bit);
        }
    }
    return table;
}
constexpr BitPositions kBitPositions = make_bit_positions();

/// Appends first_pixel plus the positions of the set bits, row by row; writes up to 8 values past
/// the last. The sums do not carry from one 16-bit part of a word to the next.
std::uint16_t* append_pixels(std::uint64_t mask, std::uint64_t first_pixel, std::uint16_t* out) {
    constexpr std::uint64_t kOnes = 0x0001000100010001U;
    std::uint64_t base = first_pixel * kOnes;
    for (; mask != 0; mask >>= 8, base += 8 * kOnes) {
        const std::uint64_t bits = mask & 255;
        std::uint64_t words[2];
        __builtin_memcpy(words, kBitPositions.row[bits], sizeof words);
        words[0] += base;
        words[1] += base;
        __builtin_memcpy(out, words, sizeof words);
        out += __builtin_popcountll(bits);
    }
    return out;
}

void match(const MatchCtx& ctx) noexcept {
    const auto* ids = reinterpret_cast<const std::int32_t*>(ctx.id);
    const auto equal = [&](std::uint32_t id) {
        std::uint64_t mask = 0;
        for (int v = 0; v < kBlockVectors; ++v) {
            const Mask32 same = load(ids + v * kLanes32) == I32(static_cast<std::int32_t>(id));
            mask |= static_cast<std::uint64_t>(bits(same)) << (v * kLanes32);
        }
        return mask;
    };
    int count = 0;
    std::uint16_t* pixels = ctx.out->pixels;
    for (std::uint64_t rest = ~equal(kNoTriangle) & ctx.inside; rest != 0; ++count) {
        const std::uint32_t id = ctx.id[__builtin_ctzll(rest)];
        const std::uint64_t mask = equal(id) & rest;
        std::uint16_t* const end = append_pixels(mask, ctx.first_pixel, pixels);
        ctx.out->id[count] = id;
        ctx.out->size[count] = static_cast<std::uint8_t>(end - pixels);
        pixels = end;
        rest &= ~mask;
    }
    ctx.out->count = count;
}
