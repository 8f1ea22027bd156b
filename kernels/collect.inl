/// The ids of a block against one triangle's, for every block in which it was drawn.
void collect_by_triangle(const CollectCtx& ctx) {
    std::uint16_t* out = ctx.pixels;
    for (int k = 0; k < ctx.count; ++k) {
        const I32 id(k);
        ctx.first[k] = static_cast<std::uint32_t>(out - ctx.pixels);
        for (std::uint64_t rest = ctx.drawn[k]; rest != 0; rest &= rest - 1) {
            const int block = __builtin_ctzll(rest) * kBlockPixels;
            const auto* const ids = reinterpret_cast<const std::int32_t*>(ctx.id) + block;
            for (int v = 0; v < kBlockPixels; v += kLanes32)
                out = append_lanes(out, block + v, load(ids + v) == id);
        }
    }
    ctx.first[ctx.count] = static_cast<std::uint32_t>(out - ctx.pixels);
}

/// Counting sort of the pixels by their ids; what shows no triangle goes behind the last one.
void collect_by_pixel(const CollectCtx& ctx) {
    const auto count = static_cast<std::uint32_t>(ctx.count);
    const auto triangle = [&](int pixel) {
        const std::uint32_t id = ctx.id[pixel];
        return id < count ? id : count;
    };
    // next[k] first counts triangle k, then runs through its pixels, and ends where the next
    // begins.
    std::uint32_t* const next = ctx.first + 1;
    for (std::uint32_t k = 0; k <= count; ++k) next[k] = 0;
    // Neighbours mostly show one triangle, so those far apart take turns.
    constexpr int kApart = kTilePixels / 4;
    for (int pixel = 0; pixel < kApart; ++pixel)
        for (int k = 0; k < 4; ++k) ++next[triangle(pixel + k * kApart)];
    ctx.first[0] = 0;
    std::uint32_t sum = 0;
    for (std::uint32_t k = 0; k <= count; ++k) {
        const std::uint32_t here = next[k];
        next[k] = sum;
        sum += here;
    }
    for (int pixel = 0; pixel < kTilePixels; ++pixel)
        ctx.pixels[next[triangle(pixel)]++] = static_cast<std::uint16_t>(pixel);
}

void collect(const CollectCtx& ctx) noexcept {
    // A triangle's block takes as long as four pixels.
    constexpr int kManyBlocks = 1000;
    int blocks = 0;
    for (int k = 0; k < ctx.count; ++k) blocks += __builtin_popcountll(ctx.drawn[k]);
    blocks < kManyBlocks ? collect_by_triangle(ctx) : collect_by_pixel(ctx);
}
