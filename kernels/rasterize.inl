/// A block is 64 pixels: kBlockVectors vectors of 32-bit lanes, each of them rows or parts of a
/// row.
inline constexpr int kBlockVectors = kBlockPixels / kLanes32;
inline constexpr int kRowVectors = kLanes32 >= kBlockSize ? 1 : kBlockSize / kLanes32;
inline constexpr int kVectorRows = kLanes32 >= kBlockSize ? kLanes32 / kBlockSize : 1;

/// Position of each lane inside its vector.
I32 lane_x() {
    alignas(64) std::int32_t x[kLanes32];
    for (int i = 0; i < kLanes32; ++i) x[i] = i % kBlockSize;
    return load(x);
}
I32 lane_y() {
    alignas(64) std::int32_t y[kLanes32];
    for (int i = 0; i < kLanes32; ++i) y[i] = i / kBlockSize;
    return load(y);
}

/// Range of the depths of a block: the expression is monotone in x and in y even when rounded, so
/// its corners bound it.
struct DepthRange {
    float low, high;
};
DepthRange block_depths(const TileTriangle& t, int x, int y) {
    DepthRange range{t.z_high, t.z_low};
    for (int corner = 0; corner < 4; ++corner) {
        const float dx = static_cast<float>(x + t.offset_x + (corner & 1) * (kBlockSize - 1));
        const float dy = static_cast<float>(y + t.offset_y + (corner >> 1) * (kBlockSize - 1));
        float z = (t.z + dx * t.zx) + dy * t.zy;
        z = z < t.z_low ? t.z_low : z > t.z_high ? t.z_high : z;
        range.low = z < range.low ? z : range.low;
        range.high = z > range.high ? z : range.high;
    }
    return range;
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

/// Edges that cross a block, with their value at its first pixel; count -1: the block is outside.
struct CrossingEdges {
    int count;
    int edge[3];
    std::int32_t base[3];
};
CrossingEdges crossing_edges(const TileTriangle& t, int x, int y) {
    CrossingEdges crossing;
    crossing.count = 0;
    for (int k = 0; k < t.edges; ++k) {
        const std::int32_t base = t.c[k] + t.a[k] * x + t.b[k] * y;
        const std::int32_t across = t.a[k] * (kBlockSize - 1), down = t.b[k] * (kBlockSize - 1);
        const std::int32_t lowest = base + (across < 0 ? across : 0) + (down < 0 ? down : 0);
        const std::int32_t highest = base + (across > 0 ? across : 0) + (down > 0 ? down : 0);
        if (highest < 0) {
            crossing.count = -1;
            return crossing;
        }
        if (lowest < 0) {
            crossing.edge[crossing.count] = k;
            crossing.base[crossing.count] = base;
            ++crossing.count;
        }
    }
    return crossing;
}

/// Coverage, depth test and visibility of one block.
void draw_block(const TileTriangle& t, const EdgeVectors& edges, const CrossingEdges& crossing,
                int x, int y, float* depth, std::uint32_t* id) {
    const F32 zx(t.zx), zy(t.zy), z0(t.z), z_low(t.z_low), z_high(t.z_high);
    const I32 new_id(static_cast<std::int32_t>(t.id));
    const F32 lanes_y = to_float(lane_y());
    F32 z_row[kRowVectors];
    for (int k = 0; k < kRowVectors; ++k) {
        z_row[k] = z0 + to_float(lane_x() + I32(x + t.offset_x + k * kLanes32)) * zx;
    }
    for (int v = 0; v < kBlockVectors; ++v) {
        const float first_row = static_cast<float>(y + t.offset_y + v / kRowVectors * kVectorRows);
        const F32 z =
            min(max(z_row[v % kRowVectors] + (F32(first_row) + lanes_y) * zy, z_low), z_high);
        const F32 old = load(depth + v * kLanes32);
        MaskF pass(false);
        if (t.pass_less != 0) pass = z < old;
        if (t.pass_equal != 0) pass = pass | (z == old);
        if (t.pass_greater != 0) pass = pass | (z > old);
        Mask32 write = as_int(pass);
        if (crossing.count > 0) {
            I32 outside(0);
            for (int k = 0; k < crossing.count; ++k) {
                const int e = crossing.edge[k];
                outside = outside | (edges.lanes[e] + I32(crossing.base[k] + edges.step[e][v]));
            }
            write = write & (outside >= I32(0));
        }
        auto* ids = reinterpret_cast<std::int32_t*>(id) + v * kLanes32;
        store(ids, ::xsimd::select(write, new_id, load(ids)));
        if (t.depth_write != 0) {
            store(depth + v * kLanes32, ::xsimd::select(as_float(write), z, old));
        }
    }
}

void rasterize_triangle(const TileTriangle& t, const RasterizeCtx& ctx) {
    const EdgeVectors edges = edge_vectors(t);
    for (int y = t.y0 / kBlockSize * kBlockSize; y <= t.y1; y += kBlockSize) {
        for (int x = t.x0 / kBlockSize * kBlockSize; x <= t.x1; x += kBlockSize) {
            const CrossingEdges crossing = crossing_edges(t, x, y);
            if (crossing.count < 0) continue;
            const int block = y / kBlockSize * kBlockSize + x / kBlockSize;
            const DepthRange range = block_depths(t, x, y);
            float& far = ctx.block_far[block];
            if (t.pass_greater == 0) {
                const bool hidden = t.pass_equal != 0 ? range.low > far : range.low >= far;
                if (hidden) continue;
            }
            draw_block(t, edges, crossing, x, y, ctx.depth + block * kBlockPixels,
                       ctx.id + block * kBlockPixels);
            if (t.depth_write == 0) continue;
            if (t.pass_greater != 0) {
                far = range.high > far ? range.high : far;
            } else if (crossing.count == 0 && t.pass_less != 0) {
                // Whatever the test left is no farther than the triangle.
                far = range.high < far ? range.high : far;
            }
        }
    }
}

void rasterize(const RasterizeCtx& ctx) noexcept {
    for (int i = 0; i < ctx.count; ++i) rasterize_triangle(ctx.triangles[i], ctx);
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
    for (std::uint64_t rest = ~equal(kNoTriangle); rest != 0; ++count) {
        const std::uint32_t id = ctx.id[__builtin_ctzll(rest)];
        const std::uint64_t mask = equal(id);
        ctx.out->id[count] = id;
        ctx.out->mask[count] = mask;
        rest &= ~mask;
    }
    ctx.out->count = count;
}
