void alpha_test(Packet& packet, const AlphaTestCtx& ctx) noexcept {
    for (int i = 0; i < packet.count; ++i) {
        const std::int16_t alpha = plane(packet, ctx.plane)[i];
        const bool pass = alpha < ctx.reference   ? ctx.pass_less != 0
                          : alpha > ctx.reference ? ctx.pass_greater != 0
                                                  : ctx.pass_equal != 0;
        if (!pass) ctx.stored[i] = kNoPixel;
    }
}

void keep(Packet& packet, const KeepCtx& ctx) noexcept {
    for (int i = 0; i < packet.count; ++i) {
        if (!(attribute(packet, ctx.attribute)[i] > 0.0F)) ctx.stored[i] = kNoPixel;
    }
}

void late_depth(Packet& packet, const LateDepthCtx& ctx) noexcept {
    for (int r = 0; r < ctx.run_count; ++r) {
        const DepthRun& run = ctx.runs[r];
        for (int i = run.first; i < run.first + run.count; ++i) {
            const int pixel = ctx.stored[i];
            if (pixel == kNoPixel) continue;
            float depth = depth_at(run, tile_x(pixel), tile_y(pixel));
            bool lives = true;
            if (ctx.attribute >= 0) {
                depth = attribute(packet, ctx.attribute)[i];
                lives = depth >= 0.0F && depth <= 1.0F;
            }
            if (!lives || !passes(ctx, depth, ctx.depth[pixel])) {
                ctx.stored[i] = kNoPixel;
                continue;
            }
            if (ctx.write == 0) continue;
            ctx.depth[pixel] = depth;
            float& far = ctx.block_far[pixel / kBlockPixels];
            far = maximum(depth, far);
        }
    }
}
