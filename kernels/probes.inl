/// Anisotropic footprints: how many probes, where each of them looks, and the mean of what they
/// see.

void probe_extent(Packet& packet, const ProbeExtentCtx& ctx) noexcept {
    const FootprintCtx how = ctx.footprint;
    const auto plane = [&](int k) { return packet.attributes + k * kAttributeStride; };
    float *const out = plane(how.out), *const probes = plane(ctx.probes),
                 *const step_u = plane(ctx.step), *const step_v = plane(ctx.step + 1);
    const F32 one(1.0F), zero(0.0F), most(ctx.most), scale_u(how.scale[0]), scale_v(how.scale[1]);
    const FragmentRuns runs(packet, ctx.runs);
    runs.for_each_vector([&](int first, const PixelPositions& pixel, const auto& row) {
        const auto at = equations_at(pixel, row);
        const Changing s = at(how.s), t = at(how.t), d = at(how.q);
        const F32 u_x = moved(s, d, &Changing::dx), v_x = moved(t, d, &Changing::dx),
                  u_y = moved(s, d, &Changing::dy), v_y = moved(t, d, &Changing::dy);
        const auto square = [&](F32 u, F32 v) {
            const F32 x = u * scale_u, y = v * scale_v;
            return x * x + y * y;
        };
        const F32 along_x = square(u_x, v_x), along_y = square(u_y, v_y);
        const F32 longest = max(along_x, along_y), shortest = max(min(along_x, along_y), one);
        const F32 ratio = square_root(divide(longest, shortest)) - F32(0x1p-8F);
        const F32 n = min(max(zero - round_down(zero - ratio), one), most);
        const MaskF on_x = along_x > along_y, several = n > one;
        if (!::xsimd::any(several)) {
            store(out + first, longest);
            store(probes + first, one);
            store(step_u + first, zero);
            store(step_v + first, zero);
            return;
        }
        const auto step = [&](F32 x, F32 y) {
            return ::xsimd::select(several, divide(::xsimd::select(on_x, x, y), n + one), zero);
        };
        store(out + first, divide(longest, n * n));
        store(probes + first, n);
        store(step_u + first, step(u_x, u_y));
        store(step_v + first, step(v_x, v_y));
    });
}

void probe_point(Packet& packet, const ProbePointCtx& ctx) noexcept {
    const auto plane = [&](int k) {
        return packet.attributes + (k < 0 ? 0 : k) * kAttributeStride;
    };
    const float *const u = plane(ctx.u), *const v = plane(ctx.v), *const q = plane(ctx.q),
                       *const step_u = plane(ctx.step), *const step_v = plane(ctx.step + 1),
                       *const probes = plane(ctx.probes);
    float *const to_u = plane(ctx.to), *const to_v = plane(ctx.to + 1);
    const F32 one(1.0F), half(0.5F), probe(static_cast<float>(ctx.probe));
    const int n = group_count(packet);
    for (int i = 0; i < n; i += kLanes32) {
        const F32 last = load(probes + i) - one;
        const F32 steps = min(probe, last) - last * half;
        F32 s = load(u + i), t = load(v + i);
        if (ctx.q >= 0) {
            s = divide(s, load(q + i));
            t = divide(t, load(q + i));
        }
        store(to_u + i, s + load(step_u + i) * steps);
        store(to_v + i, t + load(step_v + i) * steps);
    }
}

void probe_sum(Packet& packet, const ProbeSumCtx& ctx) noexcept {
    const float* const probes = packet.attributes + ctx.probes * kAttributeStride;
    const F32 zero(0.0F), probe(static_cast<float>(ctx.probe));
    const bool first = ctx.probe == 0;
    const int n = group_count(packet);
    for (int c = 0; c < ctx.channels; ++c) {
        const auto* const codes =
            reinterpret_cast<const std::uint16_t*>(packet.planes + ctx.plane[c] * kPacketSize);
        float* const sums = packet.attributes + (ctx.sum + c) * kAttributeStride;
        for (int i = 0; i < n; i += kLanes32) {
            const I32 code = load_widened(codes + i) << 16 >> 16;  // with its sign
            const F32 seen = ::xsimd::select(probe < load(probes + i), to_float(code), zero);
            store(sums + i, first ? seen : load(sums + i) + seen);
        }
    }
}

void probe_mean(Packet& packet, const ProbeSumCtx& ctx) noexcept {
    const float* const probes = packet.attributes + ctx.probes * kAttributeStride;
    const F32 half(0.5F);
    const int n = group_count(packet);
    for (int c = 0; c < ctx.channels; ++c) {
        const float* const sums = packet.attributes + (ctx.sum + c) * kAttributeStride;
        std::int16_t* const codes = packet.planes + ctx.plane[c] * kPacketSize;
        const int doubled = ctx.doubled >> c & 1;
        const F32 unit(doubled != 0 ? 0.5F : 1.0F);
        for (int i = 0; i < n; i += kLanes32) {
            const F32 mean = divide(load(sums + i) * unit, load(probes + i));
            store_narrowed(codes + i, truncate(round_down(mean + half)) << doubled);
        }
    }
}
