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

/// Vectors of fragments that are lit together, step by step: a root and a division that wait for
/// another root and division are longer than what a CPU looks ahead, those of several vectors are
/// not. With 32 registers four of them stay there; 16 do not hold them anyway.
inline constexpr int kLitVectors = kLanes32 == 16 ? 4 : 8;
static_assert(kPacketSize % (kLitVectors * kLanes32) == 0);

/// f(0) .. f(kLitVectors - 1) without a loop, so that arrays of vectors may be registers.
template <class F, int... K>
[[gnu::always_inline]] inline void for_lit_vectors(F f, std::integer_sequence<int, K...> /*n*/) {
    (f(K), ...);
}
template <class F>
[[gnu::always_inline]] inline void for_lit_vectors(F f) {
    for_lit_vectors(f, std::make_integer_sequence<int, kLitVectors>());
}

/// Three planes of attributes as vectors.
struct LitPlanes {
    LitPlanes(float* planes, int number)
        : x(planes + number * kAttributeStride), y(x + kAttributeStride), z(y + kAttributeStride) {}
    [[nodiscard]] Vector3 at(int i) const { return {load(x + i), load(y + i), load(z + i)}; }
    void set(int i, F32 to_x, F32 to_y, F32 to_z) const {
        store(x + i, to_x);
        store(y + i, to_y);
        store(z + i, to_z);
    }
    float *x, *y, *z;
};

/// A direction of light is normalised once.
template <bool IsDirection, bool Orthonormal>
void lighting(Packet& packet, const LightingCtx& ctx) {
    const Vector3 light{F32(ctx.light[0]), F32(ctx.light[1]), F32(ctx.light[2])};
    const Vector3 eye{F32(ctx.eye[0]), F32(ctx.eye[1]), F32(ctx.eye[2])};
    const Vector3 direction = normalised(light);
    const F32 light_w(ctx.light_w), eye_w(ctx.eye_w), half(0.5F), zero(0.0F);
    float* const planes = packet.attributes;
    const LitPlanes tangents(planes, ctx.frame), bitangents(planes, ctx.frame + 3),
        normals(planes, ctx.frame + 6), positions(planes, ctx.frame + 9);
    const bool writes_h = ctx.half_vector >= 0, writes_l = ctx.light_vector >= 0,
               writes_v = ctx.view_vector >= 0, writes_h_dot_l = ctx.h_dot_l >= 0,
               writes_n_dot_l = ctx.n_dot_l >= 0, raw_half = ctx.raw_half != 0;
    const auto wanted = [](int number) { return number < 0 ? 0 : number; };
    const LitPlanes to_h(planes, wanted(ctx.half_vector)), to_l(planes, wanted(ctx.light_vector)),
        to_v(planes, wanted(ctx.view_vector));
    float* const to_h_dot_l = planes + wanted(ctx.h_dot_l) * kAttributeStride;
    float* const to_n_dot_l = planes + wanted(ctx.n_dot_l) * kAttributeStride;
    const auto towards =
        [](const Vector3& to, F32 w, const Vector3& from) __attribute__((always_inline)) {
        return normalised({to.x - from.x * w, to.y - from.y * w, to.z - from.z * w});
    };
    const int n = group_count(packet);
    for (int first = 0; first < n; first += kLitVectors * kLanes32) {
        Vector3 l[IsDirection ? 1 : kLitVectors], v[kLitVectors], h[kLitVectors];
        const auto light_vector = [&](int k) __attribute__((always_inline)) {
            return IsDirection ? direction : l[k];
        };
        for_lit_vectors([&](int k) __attribute__((always_inline)) {
            // h may stay as it is here, which nobody reads: compilers do not see that.
            const Vector3 position = positions.at(first + k * kLanes32);
            if constexpr (!IsDirection) l[k] = towards(light, light_w, position);
            h[k] = v[k] = towards(eye, eye_w, position);
        });
        if (writes_h || writes_h_dot_l) {
            for_lit_vectors([&](int k) __attribute__((always_inline)) {
                const Vector3 to_light = light_vector(k);
                const Vector3 sum{to_light.x + v[k].x, to_light.y + v[k].y, to_light.z + v[k].z};
                h[k] =
                    raw_half ? Vector3{sum.x * half, sum.y * half, sum.z * half} : normalised(sum);
            });
        }
        for_lit_vectors([&](int k) __attribute__((always_inline)) {
            const int i = first + k * kLanes32;
            if (i >= n) return;
            Vector3 t = tangents.at(i), b = bitangents.at(i), normal = normals.at(i);
            if constexpr (Orthonormal) make_orthonormal(t, b, normal);
            const auto write = [&](const LitPlanes& to, const Vector3& x)
                __attribute__((always_inline)) {
                to.set(i, dot(t, x) * half + half, dot(b, x) * half + half,
                       dot(normal, x) * half + half);
            };
            if (writes_h) write(to_h, h[k]);
            if (writes_l) write(to_l, light_vector(k));
            if (writes_v) write(to_v, v[k]);
            if (writes_h_dot_l) store(to_h_dot_l + i, max(dot(h[k], light_vector(k)), zero));
            if (writes_n_dot_l) store(to_n_dot_l + i, max(dot(normal, light_vector(k)), zero));
        });
    }
}

void lighting(Packet& packet, const LightingCtx& ctx) noexcept {
    const bool is_direction = ctx.light_w == 0.0F;
    if (ctx.orthonormal != 0) {
        is_direction ? lighting<true, true>(packet, ctx) : lighting<false, true>(packet, ctx);
    } else {
        is_direction ? lighting<true, false>(packet, ctx) : lighting<false, false>(packet, ctx);
    }
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
