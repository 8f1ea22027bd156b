/// Vertices to the screen. Formulas: TransformCtx.
void transform(const TransformCtx& ctx) noexcept {
    F32 m[16];
    for (int i = 0; i < 16; ++i) m[i] = F32(ctx.m[i]);
    const Viewport& view = ctx.viewport;
    const F32 half_width(view.half_width), half_height(view.half_height), half(0.5F), zero(0.0F);
    const F32 width(view.width), height(view.height), low(kGuardLow), high(kGuardHigh);
    const F32 subpixels(view.subpixels), bias(view.snap_bias);
    const I32 step(static_cast<std::int32_t>(256.0F / view.subpixels));
    const auto flag = [](MaskF mask, std::uint32_t bit) {
        const I32 value(static_cast<std::int32_t>(bit));
        return ::xsimd::select(as_int(mask), value, I32(0));
    };
    for (int i = 0; i < ctx.count; i += kLanes32) {
        const F32 x = load(ctx.x + i), y = load(ctx.y + i), z = load(ctx.z + i);
        const auto clip = [&](int row) {
            return ((x * m[row] + y * m[4 + row]) + z * m[8 + row]) + m[12 + row];
        };
        const F32 w = clip(3);
        const F32 hx = clip(0) * half_width + w * half_width;
        const F32 hy = w * half_height - clip(1) * half_height;
        const F32 hz = clip(2) * half + w * half;
        // A difference with itself is 0 for finite numbers only.
        const MaskF finite =
            (hx - hx == zero) & (hy - hy == zero) & (hz - hz == zero) & (w - w == zero);
        const F32 wx = divide(hx, w), wy = divide(hy, w);
        const MaskF inside = (w > zero) & (wx >= low) & (wx <= high) & (wy >= low) & (wy <= high);
        I32 code = flag(hx < zero, Outcode::left) | flag(hx > w * width, Outcode::right) |
                   flag(hy < zero, Outcode::above) | flag(hy > w * height, Outcode::below) |
                   flag(hz < zero, Outcode::near) | flag(hz > w, Outcode::far) |
                   flag(!inside, Outcode::guard);
        code = ::xsimd::select(as_int(finite), code,
                               I32(static_cast<std::int32_t>(Outcode::nonfinite)));
        const MaskF usable = finite & inside & (hz >= zero) & (hz <= w);
        const auto snap = [&](F32 window) {
            const F32 steps = ::xsimd::floor(window * subpixels + bias);
            return truncate(::xsimd::select(usable, steps, zero)) * step;
        };
        const Columns screen{{as_i16(snap(wx)), as_i16(snap(wy)),
                              as_i16(::xsimd::select(usable, divide(hz, w), zero)), as_i16(code)}};
        const Columns homogeneous{{as_i16(hx), as_i16(hy), as_i16(hz), as_i16(w)}};
        const int left = ctx.count - i;
        if (left >= kLanes32) {
            store_columns(screen, [&](int k) { return ctx.screen + i + k; });
            store_columns(homogeneous, [&](int k) { return ctx.homogeneous + i + k; });
            continue;
        }
        ScreenVertex last_screen[kLanes32];
        HomogeneousVertex last_homogeneous[kLanes32];
        store_columns(screen, [&](int k) { return last_screen + k; });
        store_columns(homogeneous, [&](int k) { return last_homogeneous + k; });
        for (int k = 0; k < left; ++k) {
            ctx.screen[i + k] = last_screen[k];
            ctx.homogeneous[i + k] = last_homogeneous[k];
        }
    }
}
