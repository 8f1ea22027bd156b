/// Zero stays zero.
Vector3 unit_or_zero(const Vector3& a) {
    const F32 length = square_root(dot(a, a));
    const F32 scale = ::xsimd::select(length > F32(0.0F), divide(F32(1.0F), length), F32(1.0F));
    return {a.x * scale, a.y * scale, a.z * scale};
}
Vector3 cross(const Vector3& a, const Vector3& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Frames of kLanes32 vertices, component by component; the lanes past `used` repeat the last one.
struct FrameLanes {
    FrameLanes(const float* frames, int used) {
        for (int k = 0; k < kLanes32; ++k) {
            const float* from = frames + (k < used ? k : used - 1) * LightVerticesCtx::kFrameFloats;
            for (int c = 0; c < kComponents; ++c) lanes[c][k] = from[c];
        }
    }
    F32 operator()(int c) const { return load(lanes[c]); }
    Vector3 vector(int c) const { return {load(lanes[c]), load(lanes[c + 1]), load(lanes[c + 2])}; }

    static constexpr int kComponents = 10;  // no uv
    alignas(64) float lanes[kComponents][kLanes32];
};

/// Formulas: LightVerticesCtx.
void light_vertices(const LightVerticesCtx& ctx) noexcept {
    bool wants_half = false, wants_light = false, wants_view = false;
    for (int k = 0; k < ctx.stride; ++k) {
        const int value = ctx.values[k];
        wants_half |= (value >= VertexValue::half && value < VertexValue::half + 3) ||
                      (value >= VertexValue::half_sum && value < VertexValue::half_sum + 3) ||
                      value == VertexValue::h_dot_l;
        wants_light |= value >= VertexValue::light && value < VertexValue::light + 3;
        wants_view |= value >= VertexValue::view && value < VertexValue::view + 3;
    }
    const Vector3 light{F32(ctx.light[0]), F32(ctx.light[1]), F32(ctx.light[2])};
    const Vector3 eye{F32(ctx.eye[0]), F32(ctx.eye[1]), F32(ctx.eye[2])};
    const F32 half(0.5F), zero(0.0F);
    alignas(64) float values[VertexValue::count][kLanes32];
    for (int i = 0; i < ctx.count; i += kLanes32) {
        const int used = ctx.count - i < kLanes32 ? ctx.count - i : kLanes32;
        const FrameLanes frame(ctx.frames + i * LightVerticesCtx::kFrameFloats, used);
        const Vector3 position = frame.vector(0), normal = frame.vector(3);
        Vector3 n = normal, t = frame.vector(6), b = cross(n, t);
        const F32 sign = frame(9);
        b = {b.x * sign, b.y * sign, b.z * sign};
        if (ctx.orthonormal != 0) {
            n = unit_or_zero(n);
            const F32 along = dot(n, t);
            t = unit_or_zero({t.x - n.x * along, t.y - n.y * along, t.z - n.z * along});
            const Vector3 c = cross(n, t);
            const F32 side = ::xsimd::select(dot(c, b) < zero, F32(-1.0F), F32(1.0F));
            b = {c.x * side, c.y * side, c.z * side};
        }
        const auto towards = [&](const Vector3& to, float at_infinity) {
            const F32 w(at_infinity);
            return unit_or_zero(
                {to.x - position.x * w, to.y - position.y * w, to.z - position.z * w});
        };
        const auto write = [&](int value, F32 x) { store(values[value], x); };
        const auto write_coded = [&](int first, const Vector3& x) {
            write(first, dot(t, x) * half + half);
            write(first + 1, dot(b, x) * half + half);
            write(first + 2, dot(n, x) * half + half);
        };
        const Vector3 l = towards(light, ctx.light_w);
        if (wants_half || wants_view) {
            const Vector3 v = towards(eye, ctx.eye_w);
            const Vector3 sum{l.x + v.x, l.y + v.y, l.z + v.z};
            const Vector3 middle{sum.x * half, sum.y * half, sum.z * half};
            const Vector3 h = ctx.raw_half != 0 ? middle : unit_or_zero(sum);
            write_coded(VertexValue::half, h);
            if (wants_view) write_coded(VertexValue::view, v);
            write(VertexValue::half_sum, dot(t, middle));
            write(VertexValue::half_sum + 1, dot(b, middle));
            write(VertexValue::half_sum + 2, dot(n, middle));
            write(VertexValue::h_dot_l, max(dot(h, l), zero));
        }
        if (wants_light) write_coded(VertexValue::light, l);
        const F32 n_dot_l = max(dot(n, l), zero);
        write(VertexValue::n_dot_l, n_dot_l);
        for (int c = 0; c < 3; ++c)
            write(VertexValue::lit + c, n_dot_l * F32(ctx.tint[c]) + F32(ctx.base[c]));
        write(VertexValue::normal, normal.x * half + half);
        write(VertexValue::normal + 1, normal.y * half + half);
        write(VertexValue::normal + 2, normal.z * half + half);
        for (int k = 0; k < ctx.stride; ++k) {
            if (ctx.values[k] == VertexValue::none) continue;
            const float* const from = values[ctx.values[k]];
            float* const to = ctx.out + static_cast<std::ptrdiff_t>(i) * ctx.stride + k;
            for (int j = 0; j < used; ++j) to[j * ctx.stride] = from[j];
        }
    }
}
