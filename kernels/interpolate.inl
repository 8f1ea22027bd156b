/// Perspective-correct attributes.
void attributes(Packet& packet, const AttributesCtx& ctx) noexcept {
    const int attribute_count = ctx.attribute_count;
    if (attribute_count == 0) return;
    const FragmentRuns runs(packet, ctx);
    const auto vector = [&](int first, const PixelPositions& pixel, const auto& row) {
        const auto at_pixel = [&](int equation) {
            const int k = 3 * equation;
            return (row(k) + row(k + 1) * pixel.x) + row(k + 2) * pixel.y;
        };
        const float level_w = row.level_w();
        const F32 w = level_w != 0.0F ? F32(level_w) : divide(F32(1.0F), at_pixel(0));
        float* const out = packet.attributes + first;
        for (int k = 0; k < attribute_count; ++k) {
            store(out + k * kAttributeStride, at_pixel(k + 1) * w);
        }
    };
    // Rows are loaded once for all of them, and what x adds is the same in a column.
    const auto vectors = [&](int first, const auto& pixel, const auto& row) {
        constexpr int kCount = std::extent_v<std::remove_cvref_t<decltype(pixel)>>;
        constexpr bool kIsColumn = kHasColumns && kCount == kColumnVectors;
        const auto evaluate = [&](int equation, F32(&value)[kCount]) {
            const int k = 3 * equation;
            const F32 origin = row(k), right = row(k + 1), down = row(k + 2);
            const F32 beginning = origin + right * pixel[0].x;
            for (int v = 0; v < kCount; ++v) {
                const F32 at_x = kIsColumn ? beginning : origin + right * pixel[v].x;
                value[v] = at_x + down * pixel[v].y;
            }
        };
        F32 w[kCount], value[kCount];
        const float level_w = row.level_w();
        if (level_w != 0.0F) {
            for (F32& each : w) each = F32(level_w);
        } else {
            evaluate(0, w);
            for (F32& each : w) each = divide(F32(1.0F), each);
        }
        float* const out = packet.attributes + first;
        for (int k = 0; k < attribute_count; ++k) {
            evaluate(k + 1, value);
            for (int v = 0; v < kCount; ++v)
                store(out + k * kAttributeStride + v * kLanes32, value[v] * w[v]);
        }
    };
    runs.for_each_vector(vector, vectors);
}

struct Vector3 {
    F32 x, y, z;
};
F32 dot(const Vector3& a, const Vector3& b) {
    return (a.x * b.x + a.y * b.y) + a.z * b.z;
}
Vector3 normalised(const Vector3& a) {
    const F32 scale = divide(F32(1.0F), square_root(dot(a, a)));
    return {a.x * scale, a.y * scale, a.z * scale};
}

/// Gram and Schmidt, the normal first; the bitangent keeps its side.
void make_orthonormal(Vector3& t, Vector3& b, Vector3& n) {
    n = normalised(n);
    const F32 d = dot(n, t);
    t = normalised({t.x - n.x * d, t.y - n.y * d, t.z - n.z * d});
    const Vector3 c{n.y * t.z - n.z * t.y, n.z * t.x - n.x * t.z, n.x * t.y - n.y * t.x};
    const F32 side = ::xsimd::select(dot(c, b) < F32(0.0F), F32(-1.0F), F32(1.0F));
    b = {c.x * side, c.y * side, c.z * side};
}

/// A direction of light is normalised once.
template <bool IsDirection>
void lighting(Packet& packet, const LightingCtx& ctx) {
    const Vector3 light{F32(ctx.light[0]), F32(ctx.light[1]), F32(ctx.light[2])};
    const Vector3 eye{F32(ctx.eye[0]), F32(ctx.eye[1]), F32(ctx.eye[2])};
    const Vector3 direction = normalised(light);
    const F32 light_w(ctx.light_w), eye_w(ctx.eye_w), half(0.5F), zero(0.0F);
    float* const planes = packet.attributes;
    const int first = ctx.frame, n = group_count(packet);
    for (int i = 0; i < n; i += kLanes32) {
        const auto vector = [&](int k) {
            const float* p = planes + (first + 3 * k) * kAttributeStride + i;
            return Vector3{load(p), load(p + kAttributeStride), load(p + 2 * kAttributeStride)};
        };
        Vector3 t = vector(0), b = vector(1), normal = vector(2);
        const Vector3 position = vector(3);
        if (ctx.orthonormal != 0) make_orthonormal(t, b, normal);
        Vector3 l = direction;
        if constexpr (!IsDirection) {
            l = normalised({light.x - position.x * light_w, light.y - position.y * light_w,
                            light.z - position.z * light_w});
        }
        const Vector3 v = normalised(
            {eye.x - position.x * eye_w, eye.y - position.y * eye_w, eye.z - position.z * eye_w});
        const auto write = [&](int plane, const Vector3& x) {
            if (plane < 0) return;
            float* p = planes + plane * kAttributeStride + i;
            store(p, dot(t, x) * half + half);
            store(p + kAttributeStride, dot(b, x) * half + half);
            store(p + 2 * kAttributeStride, dot(normal, x) * half + half);
        };
        if (ctx.half_vector >= 0 || ctx.h_dot_l >= 0) {
            const Vector3 sum{l.x + v.x, l.y + v.y, l.z + v.z};
            const Vector3 h = ctx.raw_half != 0 ? Vector3{sum.x * half, sum.y * half, sum.z * half}
                                                : normalised(sum);
            write(ctx.half_vector, h);
            if (ctx.h_dot_l >= 0) {
                store(planes + ctx.h_dot_l * kAttributeStride + i, max(dot(h, l), zero));
            }
        }
        write(ctx.light_vector, l);
        write(ctx.view_vector, v);
        if (ctx.n_dot_l >= 0) {
            store(planes + ctx.n_dot_l * kAttributeStride + i, max(dot(normal, l), zero));
        }
    }
}

void lighting(Packet& packet, const LightingCtx& ctx) noexcept {
    ctx.light_w == 0.0F ? lighting<true>(packet, ctx) : lighting<false>(packet, ctx);
}

void encode(Packet& packet, const EncodeCtx& ctx, float one_value) {
    const F32 one(one_value), half(0.5F), zero(0.0F);
    const float* from = packet.attributes + ctx.attribute * kAttributeStride;
    std::int16_t* to = packet.planes + ctx.plane * kPacketSize;
    const int n = group_count(packet);
    const auto code = [&](int i) {
        return truncate(min(max(load(from + i) * one + half, zero), one));
    };
    for (int i = 0; i < n; i += kLanes) store_narrowed(to + i, code(i), code(i + kLanes32));
}
void encode_nine_bit(Packet& packet, const EncodeCtx& ctx) noexcept {
    encode(packet, ctx, 255.0F);
}
void encode_wide(Packet& packet, const EncodeCtx& ctx) noexcept {
    encode(packet, ctx, 16384.0F);
}
