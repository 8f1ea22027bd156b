/// Where pixels of a mask of tiny triangles lie: from the mask's corner, and from the tile index of
/// the first pixel of the block that the corner is in.
struct TinyPositions {
    alignas(64) float x[2 * kTinySize], y[2 * kTinySize];  ///< of the first two rows
    /// By the corner's x inside its block, two rows alike.
    alignas(64) std::uint16_t column[kBlockSize][2 * kTinySize];
    /// By y from the top of the block, the whole row alike.
    alignas(64) std::uint16_t row[2 * kBlockSize][kTinySize];
};
constexpr TinyPositions make_tiny_positions() {
    constexpr int kBlockRow = kTileSize / kBlockSize * kBlockPixels;
    TinyPositions positions{};
    for (int i = 0; i < 2 * kTinySize; ++i) {
        positions.x[i] = static_cast<float>(i % kTinySize);
        positions.y[i] = static_cast<float>(i / kTinySize);
        for (int corner = 0; corner < kBlockSize; ++corner) {
            const int x = corner + i % kTinySize;
            positions.column[corner][i] =
                static_cast<std::uint16_t>(x / kBlockSize * kBlockPixels + x % kBlockSize);
        }
        for (int k = 0; k < kTinySize; ++k) {
            positions.row[i][k] = static_cast<std::uint16_t>(i / kBlockSize * kBlockRow +
                                                             i % kBlockSize * kBlockSize);
        }
    }
    return positions;
}
static_assert(kTinySize == kBlockSize);
constexpr TinyPositions kTinyPositions = make_tiny_positions();

/// Fragments of some triangles, in order: small enough to stay in the L1 cache, large enough that
/// the two loops below do not wait for each other.
struct TinyFragments {
    static constexpr int kEnough = 128;
    static constexpr int kMost = kEnough + kTinySize * kTinySize + kLanes32;
    static constexpr int kQuarters = 4;  ///< blocks that a triangle may reach into: 2 x 2
    std::int32_t depth[kMost];           ///< bits of a float
    /// Tile index, and from bit 16 on 4 x (triangle - first_triangle) + the quarter.
    std::int32_t place[kMost];
    /// By quarters of triangles: 1 if a fragment passed there. The last is for those that did not.
    std::uint8_t passed[kQuarters * kEnough + 1];
    int first_triangle = 0;
};

/// Appends a triangle's fragments behind the first `count`; returns how many there are then. The
/// number is handed on, since what lies in memory would be read again after every store.
inline int append_fragments(const TileEntry& entry, const SetupTriangle& t,
                            const RasterizeEntriesCtx& ctx, int triangle, int count,
                            TinyFragments& out) {
    constexpr int kLast = kBlockSize - 1;
    const F32 z0(t.z), zx(t.zx), zy(t.zy), low(t.z_low), high(t.z_high);
    const F32 corner_x(static_cast<float>(entry.x + ctx.left - t.reference_x));
    F32 dy = F32(static_cast<float>(entry.y + ctx.top - t.reference_y)) + load(kTinyPositions.y);
    const int first_quarter = (triangle - out.first_triangle) * TinyFragments::kQuarters;
    const I32 first_place(((entry.y & ~kLast) + entry.x / kBlockSize) * kBlockPixels +
                          (first_quarter << 16));
    const std::uint16_t* const column = kTinyPositions.column[entry.x & kLast];
    const std::uint16_t* row = kTinyPositions.row[entry.y & kLast];
    std::uint64_t covered = entry.covered;
    do {
        for (int part = 0; part < kRowVectors; ++part) {
            // Whole numbers below 2^24: exact, however they are added.
            const F32 dx = corner_x + load(kTinyPositions.x + part * kLanes32);
            const F32 z = min(max((z0 + dx * zx) + dy * zy, low), high);
            const I32 at = load_widened(column + part * kLanes32) + load_widened(row);
            // Bit 6: the block to the right; bit 9: the one below.
            const I32 quarter = ((at << 10) & I32(1 << 16)) | ((at << 8) & I32(1 << 17));
            const std::uint32_t lanes =
                static_cast<std::uint32_t>(covered) & ((1U << kLanes32) - 1);
            store_packed(out.depth + count, as_i32(z), lanes);
            store_packed(out.place + count, first_place + at + quarter, lanes);
            count += __builtin_popcount(lanes);
            covered >>= kLanes32;
        }
        dy = dy + F32(static_cast<float>(kVectorRows));
        row += kVectorRows * kTinySize;
    } while (covered != 0);
    return count;
}

/// Tests and writes fragments one by one. Whether one passes cannot be foretold, so what fails is
/// written, too, where nobody looks.
template <bool Usual, bool HasIds>
inline void draw_fragments(TinyFragments& fragments, int count, const RasterizeEntriesCtx& ctx) {
    constexpr std::uint32_t kNowhere = TinyFragments::kQuarters * TinyFragments::kEnough;
    const DepthRule rule = ctx.rule;
    float* const depth = ctx.depth;
    std::uint32_t* const id = ctx.id;
    const std::uint32_t first_id =
        ctx.first_id + static_cast<std::uint32_t>(fragments.first_triangle);
    for (int i = 0; i < count; ++i) {
        float z = 0.0F;
        __builtin_memcpy(&z, fragments.depth + i, sizeof z);
        const auto place = static_cast<std::uint32_t>(fragments.place[i]);
        const std::uint32_t pixel = place & 0xffff, quarter = place >> 16;
        const float old = depth[pixel];
        bool pass = z < old;
        if constexpr (!Usual) {
            pass = z < old   ? rule.pass_less != 0
                   : z > old ? rule.pass_greater != 0
                             : rule.pass_equal != 0;
        }
        const std::uint32_t to = pass ? pixel : kTilePixels;
        if constexpr (HasIds) {
            fragments.passed[pass ? quarter : kNowhere] = 1;
            id[to] = first_id + quarter / TinyFragments::kQuarters;
        }
        if (Usual || rule.write != 0) depth[to] = z;
        if constexpr (!Usual) {
            float& far = ctx.block_far[pixel / kBlockPixels];
            if (pass && rule.write != 0 && z > far) far = z;
        }
    }
}

/// Blocks of the 2 x 2 from the mask's corner on in which a fragment passed.
inline std::uint64_t drawn_blocks(const TileEntry& entry, const std::uint8_t* passed) {
    const auto blocks =
        static_cast<std::uint64_t>(passed[0] | passed[1] << 1 | passed[2] << 8 | passed[3] << 9);
    return blocks << (entry.y / kBlockSize * kBlockSize + entry.x / kBlockSize);
}

template <bool Usual, bool HasIds>
void rasterize_tiny(const RasterizeEntriesCtx& ctx) {
    constexpr int kQuarters = TinyFragments::kQuarters;
    TinyFragments fragments;
    for (int next = 0; next < ctx.count;) {
        const int first = fragments.first_triangle = next;
        int count = 0;
        for (; count < TinyFragments::kEnough && next < ctx.count; ++next) {
            constexpr int kAhead = 8;  // a mesh's triangles lie far apart along a tile
            if (next + kAhead < ctx.count)
                __builtin_prefetch(ctx.triangles + ctx.entries[next + kAhead].triangle);
            __builtin_memset(fragments.passed + kQuarters * (next - first), 0, kQuarters);
            const TileEntry& entry = ctx.entries[next];
            count =
                append_fragments(entry, ctx.triangles[entry.triangle], ctx, next, count, fragments);
        }
        draw_fragments<Usual, HasIds>(fragments, count, ctx);
        if constexpr (!HasIds) continue;
        for (int k = first; k < next; ++k) {
            ctx.drawn[k] = drawn_blocks(ctx.entries[k], fragments.passed + kQuarters * (k - first));
        }
    }
}

void rasterize_tiny(const RasterizeEntriesCtx& ctx) noexcept {
    const bool usual = nearer_wins(ctx.rule);
    if (ctx.id != nullptr) {
        usual ? rasterize_tiny<true, true>(ctx) : rasterize_tiny<false, true>(ctx);
    } else {
        usual ? rasterize_tiny<true, false>(ctx) : rasterize_tiny<false, false>(ctx);
    }
}
