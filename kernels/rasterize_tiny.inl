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
    std::int32_t depth[kMost];  ///< bits of a float
    std::int32_t pixel[kMost];
    std::int32_t triangle[kMost];
    int count = 0;
};

inline void append_fragments(const TileEntry& entry, const SetupTriangle& t,
                             const RasterizeTinyCtx& ctx, int number, TinyFragments& out) {
    constexpr int kLast = kBlockSize - 1;
    const F32 z0(t.z), zx(t.zx), zy(t.zy), low(t.z_low), high(t.z_high);
    const F32 corner_x(static_cast<float>(entry.x + ctx.left - t.reference_x));
    F32 dy = F32(static_cast<float>(entry.y + ctx.top - t.reference_y)) + load(kTinyPositions.y);
    const I32 first_pixel(((entry.y & ~kLast) + entry.x / kBlockSize) * kBlockPixels);
    const std::uint16_t* const column = kTinyPositions.column[entry.x & kLast];
    const std::uint16_t* row = kTinyPositions.row[entry.y & kLast];
    std::uint64_t covered = entry.covered;
    do {
        for (int part = 0; part < kRowVectors; ++part) {
            // Whole numbers below 2^24: exact, however they are added.
            const F32 dx = corner_x + load(kTinyPositions.x + part * kLanes32);
            const F32 z = min(max((z0 + dx * zx) + dy * zy, low), high);
            const I32 pixel =
                first_pixel + load_widened(column + part * kLanes32) + load_widened(row);
            const std::uint32_t lanes =
                static_cast<std::uint32_t>(covered) & ((1U << kLanes32) - 1);
            store_packed(out.depth + out.count, as_i32(z), lanes);
            store_packed(out.pixel + out.count, pixel, lanes);
            store(out.triangle + out.count, I32(number));
            out.count += __builtin_popcount(lanes);
            covered >>= kLanes32;
        }
        dy = dy + F32(static_cast<float>(kVectorRows));
        row += kVectorRows * kTinySize;
    } while (covered != 0);
}

/// Tests and writes fragments one by one. Whether one passes cannot be foretold, so what fails is
/// written, too, where nobody looks.
template <bool Usual, bool HasIds>
inline void draw_fragments(const TinyFragments& fragments, const RasterizeTinyCtx& ctx) {
    const DepthRule rule = ctx.rule;
    float* const depth = ctx.depth;
    std::uint32_t* const id = ctx.id;
    std::uint64_t* const drawn = ctx.drawn;
    for (int i = 0; i < fragments.count; ++i) {
        float z = 0.0F;
        __builtin_memcpy(&z, fragments.depth + i, sizeof z);
        const std::int32_t pixel = fragments.pixel[i];
        const float old = depth[pixel];
        bool pass = z < old;
        if constexpr (!Usual) {
            pass = z < old   ? rule.pass_less != 0
                   : z > old ? rule.pass_greater != 0
                             : rule.pass_equal != 0;
        }
        const std::int32_t place = pass ? pixel : kTilePixels;
        if constexpr (HasIds) {
            const std::int32_t triangle = fragments.triangle[i];
            id[place] = ctx.first_id + static_cast<std::uint32_t>(triangle);
            drawn[triangle] |= static_cast<std::uint64_t>(pass ? 1 : 0) << pixel / kBlockPixels;
        }
        if (Usual || rule.write != 0) depth[place] = z;
        if constexpr (!Usual) {
            float& far = ctx.block_far[pixel / kBlockPixels];
            if (pass && rule.write != 0 && z > far) far = z;
        }
    }
}

template <bool Usual, bool HasIds>
void rasterize_tiny(const RasterizeTinyCtx& ctx) {
    TinyFragments fragments;
    for (int k = 0; k < ctx.count; ++k) {
        const TileEntry& entry = ctx.entries[k];
        constexpr int kAhead = 8;  // a mesh's triangles lie far apart along a tile
        if (k + kAhead < ctx.count)
            __builtin_prefetch(ctx.triangles + ctx.entries[k + kAhead].triangle);
        if constexpr (HasIds) ctx.drawn[k] = 0;
        append_fragments(entry, ctx.triangles[entry.triangle], ctx, k, fragments);
        if (fragments.count < TinyFragments::kEnough && k + 1 < ctx.count) continue;
        draw_fragments<Usual, HasIds>(fragments, ctx);
        fragments.count = 0;
    }
}

void rasterize_tiny(const RasterizeTinyCtx& ctx) noexcept {
    const DepthRule& rule = ctx.rule;
    const bool usual =
        rule.pass_less != 0 && rule.pass_equal == 0 && rule.pass_greater == 0 && rule.write != 0;
    if (ctx.id != nullptr) {
        usual ? rasterize_tiny<true, true>(ctx) : rasterize_tiny<false, true>(ctx);
    } else {
        usual ? rasterize_tiny<true, false>(ctx) : rasterize_tiny<false, false>(ctx);
    }
}
