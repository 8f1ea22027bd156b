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
class FrameLanes {
  public:
    FrameLanes(const float* frames, int used) {
        const auto columns = [&](int first) {
            return load_columns([&](int k) {
                return frames + (k < used ? k : used - 1) * LightVerticesCtx::kFrameFloats + first;
            });
        };
        for (int part = 0; part < 3; ++part) m_columns[part] = columns(4 * part);
    }
    F32 operator()(int c) const { return m_columns[c / 4].floats(c % 4); }
    Vector3 vector(int c) const { return {(*this)(c), (*this)(c + 1), (*this)(c + 2)}; }

  private:
    Columns m_columns[3];
};

/// Which of the VertexValues are asked for.
struct WantedValues {
    explicit WantedValues(const LightVerticesCtx& ctx) {
        std::uint64_t all = 0;
        for (int k = 0; k < ctx.stride; ++k)
            if (ctx.values[k] != VertexValue::none) all |= std::uint64_t{1} << ctx.values[k];
        const auto any = [&](int first, int count) {
            return (all >> first & ((std::uint64_t{1} << count) - 1)) != 0;
        };
        half = any(VertexValue::half, 3) || any(VertexValue::half_sum, 3) ||
               any(VertexValue::h_dot_l, 1);
        light = any(VertexValue::light, 3);
        view = any(VertexValue::view, 3);
        lighting = any(0, VertexValue::normal);
        normal = any(VertexValue::normal, 3);
        own = any(VertexValue::uv, VertexValue::count - VertexValue::uv);
    }
    bool half, light, view;
    bool lighting;  ///< these or others that the light changes
    bool normal;
    bool own;  ///< what the vertex brings
};

/// Values of kLanes32 vertices by their numbers.
struct ValueLanes {
    void write(int value, F32 x) { store(lanes[value], x); }
    void write(int first, const Vector3& x) {
        write(first, x.x);
        write(first + 1, x.y);
        write(first + 2, x.z);
    }
    alignas(64) float lanes[VertexValue::count][kLanes32];
};

void light_lanes(const LightVerticesCtx& ctx, const WantedValues& wanted, const FrameLanes& frame,
                 ValueLanes& values) {
    const F32 half(0.5F), zero(0.0F), sign = frame(9);
    const Vector3 position = frame.vector(0);
    Vector3 n = frame.vector(3), t = frame.vector(6), b = cross(n, t);
    b = {b.x * sign, b.y * sign, b.z * sign};
    if (ctx.orthonormal != 0) {
        n = unit_or_zero(n);
        const F32 along = dot(n, t);
        t = unit_or_zero({t.x - n.x * along, t.y - n.y * along, t.z - n.z * along});
        const Vector3 c = cross(n, t);
        const F32 side = ::xsimd::select(dot(c, b) < zero, F32(-1.0F), F32(1.0F));
        b = {c.x * side, c.y * side, c.z * side};
    }
    const auto towards = [&](const float(&to)[3], float at_infinity) {
        const F32 w(at_infinity);
        return unit_or_zero({F32(to[0]) - position.x * w, F32(to[1]) - position.y * w,
                             F32(to[2]) - position.z * w});
    };
    const auto write_coded = [&](int first, const Vector3& x) {
        values.write(first,
                     {dot(t, x) * half + half, dot(b, x) * half + half, dot(n, x) * half + half});
    };
    const Vector3 l = towards(ctx.light, ctx.light_w);
    if (wanted.half || wanted.view) {
        const Vector3 v = towards(ctx.eye, ctx.eye_w);
        const Vector3 sum{l.x + v.x, l.y + v.y, l.z + v.z};
        const Vector3 middle{sum.x * half, sum.y * half, sum.z * half};
        const Vector3 h = ctx.raw_half != 0 ? middle : unit_or_zero(sum);
        write_coded(VertexValue::half, h);
        if (wanted.view) write_coded(VertexValue::view, v);
        values.write(VertexValue::half_sum, {dot(t, middle), dot(b, middle), dot(n, middle)});
        values.write(VertexValue::h_dot_l, max(dot(h, l), zero));
    }
    if (wanted.light) write_coded(VertexValue::light, l);
    const F32 n_dot_l = max(dot(n, l), zero);
    values.write(VertexValue::n_dot_l, n_dot_l);
    for (int c = 0; c < 3; ++c)
        values.write(VertexValue::lit + c, n_dot_l * F32(ctx.tint[c]) + F32(ctx.base[c]));
}

void own_lanes(const FrameLanes& frame, ValueLanes& values) {
    const Vector3 normal = frame.vector(3), tangent = frame.vector(6);
    const Vector3 side = cross(normal, tangent);
    const F32 sign = frame(9);
    values.write(VertexValue::uv, frame(10));
    values.write(VertexValue::uv + 1, F32(1.0F) - frame(11));
    values.write(VertexValue::frame, tangent);
    values.write(VertexValue::frame + 3, {side.x * sign, side.y * sign, side.z * sign});
    values.write(VertexValue::frame + 6, normal);
    values.write(VertexValue::frame + 9, frame.vector(0));
}

/// Where a row has a whole group of four values, one store writes it.
void write_rows(const LightVerticesCtx& ctx, const ValueLanes& values, int first, int used) {
    const auto row = [&](int k) {
        return ctx.out + static_cast<std::ptrdiff_t>(first + k) * ctx.stride;
    };
    const auto is_whole = [&](int group) {
        if (group + 4 > ctx.stride) return false;
        for (int k = group; k < group + 4; ++k)
            if (ctx.values[k] == VertexValue::none) return false;
        return true;
    };
    for (int group = 0; group < ctx.stride; group += 4) {
        if (used == kLanes32 && is_whole(group)) {
            Columns columns;
            for (int k = 0; k < 4; ++k) {
                const float* const from = values.lanes[ctx.values[group + k]];
                columns.column[k] = load(reinterpret_cast<const std::int16_t*>(from));
            }
            store_columns(columns, [&](int k) { return row(k) + group; });
            continue;
        }
        const int end = group + 4 < ctx.stride ? group + 4 : ctx.stride;
        for (int k = group; k < end; ++k) {
            if (ctx.values[k] == VertexValue::none) continue;
            for (int j = 0; j < used; ++j) row(j)[k] = values.lanes[ctx.values[k]][j];
        }
    }
}

/// Formulas: LightVerticesCtx.
void light_vertices(const LightVerticesCtx& ctx) noexcept {
    const WantedValues wanted(ctx);
    ValueLanes values;
    for (int i = 0; i < ctx.count; i += kLanes32) {
        const int used = ctx.count - i < kLanes32 ? ctx.count - i : kLanes32;
        const FrameLanes frame(
            ctx.frames + static_cast<std::ptrdiff_t>(i) * LightVerticesCtx::kFrameFloats, used);
        if (wanted.lighting) light_lanes(ctx, wanted, frame, values);
        if (wanted.normal) {
            const F32 half(0.5F);
            const Vector3 n = frame.vector(3);
            values.write(VertexValue::normal,
                         {n.x * half + half, n.y * half + half, n.z * half + half});
        }
        if (wanted.own) own_lanes(frame, values);
        write_rows(ctx, values, i, used);
    }
}
