/// Fragments whose lanes of `lives` are 0 lose their pixel.
inline void keep_pixels(std::uint16_t* stored, I16 lives) {
    auto* const pixels = reinterpret_cast<std::int16_t*>(stored);
    const I16 none(static_cast<std::int16_t>(kNoPixel));
    store(pixels, (load(pixels) & lives) | (none & ~lives));
}

void alpha_test(Packet& packet, const AlphaTestCtx& ctx) noexcept {
    const std::int16_t* const plane = packet.planes + ctx.plane * kPacketSize;
    std::uint16_t* const stored = ctx.stored;
    const auto all_if = [](std::uint8_t passes) {
        return I16(passes != 0 ? std::int16_t{-1} : std::int16_t{0});
    };
    const I16 reference(ctx.reference), less = all_if(ctx.pass_less),
                                        equal = all_if(ctx.pass_equal),
                                        greater = all_if(ctx.pass_greater);
    const int n = group_count(packet);
    for (int i = 0; i < n; i += kLanes) {
        const I16 alpha = load(plane + i);
        const I16 above = ::xsimd::select(alpha > reference, greater, equal);
        keep_pixels(stored + i, ::xsimd::select(alpha < reference, less, above));
    }
}

void keep(Packet& packet, const KeepCtx& ctx) noexcept {
    const float* const plane = packet.attributes + ctx.attribute * kAttributeStride;
    std::uint16_t* const stored = ctx.stored;
    const I32 all(-1), none(0);
    const int n = group_count(packet);
    for (int i = 0; i < n; i += kLanes) {
        alignas(64) std::int16_t lives[kLanes];
        for (int k = 0; k < kLanes; k += kLanes32) {
            const Mask32 positive = as_int(load(plane + i + k) > F32(0.0F));
            store_narrowed(lives + k, ::xsimd::select(positive, all, none));
        }
        keep_pixels(stored + i, load(lives));
    }
}

/// Depths of a packet's fragments, as the triangles have them.
void triangle_depths(const Packet& packet, const LateDepthCtx& ctx, float* out) {
    for (int r = 0; r < ctx.run_count; ++r) {
        const DepthRun run = ctx.runs[r];
        const I32 offset_x(run.offset_x), offset_y(run.offset_y);
        const F32 z(run.z), zx(run.zx), zy(run.zy), z_low(run.z_low), z_high(run.z_high);
        for (int i = run.first; i < run.first + run.count; i += kLanes32) {
            const PixelPositions pixel = positions(packet.pixels + i, offset_x, offset_y);
            store(out + i, min(max((z + pixel.x * zx) + pixel.y * zy, z_low), z_high));
        }
    }
}

/// Scattered pixels have to be taken one by one.
void late_depth(Packet& packet, const LateDepthCtx& ctx) noexcept {
    alignas(64) float own[kAttributeStride];
    const float* depths = own;
    if (ctx.attribute >= 0) {
        depths = packet.attributes + ctx.attribute * kAttributeStride;
    } else {
        triangle_depths(packet, ctx, own);
    }
    for (int i = 0; i < packet.count; ++i) {
        const int pixel = ctx.stored[i];
        if (pixel == kNoPixel) continue;
        const float depth = depths[i], old = ctx.depth[pixel];
        const bool lives = ctx.attribute < 0 || (depth >= 0.0F && depth <= 1.0F);
        const std::uint8_t pass = depth < old   ? ctx.pass_less
                                  : depth > old ? ctx.pass_greater
                                                : ctx.pass_equal;
        if (!lives || pass == 0) {
            ctx.stored[i] = kNoPixel;
            continue;
        }
        if (ctx.write == 0) continue;
        ctx.depth[pixel] = depth;
        float& far = ctx.block_far[pixel / kBlockPixels];
        far = depth > far ? depth : far;
    }
}
