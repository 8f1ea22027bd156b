/// From a texel to the next coordinates: one short pass over the fragments each.

/// Group by group, `body(i)` on the fragments from i on.
template <class Body>
void for_each_vector(const Packet& packet, Body body) {
    const int n = group_count(packet);
    for (int i = 0; i < n; i += kLanes32) body(i);
}

float* attribute_plane(const Packet& packet, int k) {
    return packet.attributes + k * kAttributeStride;
}

/// number = (float(code) + offset) / divisor, of the code, of what of it is positive, or of its
/// byte in two's complement.
template <class Code>
void decode(const Packet& packet, const DecodeCtx& ctx, float offset_value, float divisor_value,
            Code code) {
    const std::int16_t* const from = packet.planes + ctx.plane * kPacketSize;
    float* const to = attribute_plane(packet, ctx.attribute);
    const F32 offset(offset_value), divisor(divisor_value);
    for_each_vector(packet, [&](int i) {
        store(to + i, divide(to_float(code(load_widened(from + i))) + offset, divisor));
    });
}

I32 same_code(I32 v) {
    return v;
}
I32 positive_code(I32 v) {
    return max(v, I32(0));
}
I32 two_complement(I32 v) {
    return ::xsimd::select(v >= I32(128), v - I32(256), v);
}

void decode_nine_bit(Packet& packet, const DecodeCtx& ctx) noexcept {
    switch (ctx.reading) {
        case Reading::unsigned_texel:
            return decode(packet, ctx, 0.0F, 255.0F, same_code);
        case Reading::signed_texel:
            return decode(packet, ctx, 0.0F, 256.0F, same_code);
        case Reading::expanded:
            return decode(packet, ctx, -127.5F, 127.5F, positive_code);
        case Reading::two_complement:
            return decode(packet, ctx, 0.0F, 128.0F, two_complement);
        case Reading::nv2a_d3d:
            return decode(packet, ctx, -128.0F, 127.0F, same_code);
        case Reading::nv2a_gl:
            return decode(packet, ctx, 0.5F, 127.5F, two_complement);
        case Reading::nv2a_signed:
            return decode(packet, ctx, 0.0F, 127.0F, two_complement);
    }
}

void decode_wide(Packet& packet, const DecodeCtx& ctx) noexcept {
    if (ctx.reading == Reading::expanded)
        return decode(packet, ctx, -8192.0F, 8192.0F, positive_code);
    decode(packet, ctx, 0.0F, 16384.0F, same_code);
}

void affine(Packet& packet, const AffineCtx& ctx) noexcept {
    const float* const from = attribute_plane(packet, ctx.from);
    float* const to = attribute_plane(packet, ctx.to);
    const F32 scale(ctx.scale), offset(ctx.offset), divisor(ctx.divisor);
    for_each_vector(
        packet, [&](int i) { store(to + i, divide(load(from + i) * scale + offset, divisor)); });
}

/// Three attribute planes that are read together.
struct VectorPlanes {
    VectorPlanes(const Packet& packet, const int (&plane)[3])
        : x(attribute_plane(packet, plane[0])),
          y(attribute_plane(packet, plane[1])),
          z(attribute_plane(packet, plane[2])) {}
    Vector3 at(int i) const { return {load(x + i), load(y + i), load(z + i)}; }
    const float *x, *y, *z;
};

void dot_product(Packet& packet, const DotCtx& ctx) noexcept {
    const VectorPlanes a(packet, ctx.a), b(packet, ctx.b);
    float* const to = attribute_plane(packet, ctx.to);
    for_each_vector(packet, [&](int i) { store(to + i, dot(a.at(i), b.at(i))); });
}

void hemisphere(Packet& packet, const HemisphereCtx& ctx) noexcept {
    const float* const xs = attribute_plane(packet, ctx.x);
    const float* const ys = attribute_plane(packet, ctx.y);
    float* const to = attribute_plane(packet, ctx.to);
    const F32 one(1.0F), zero(0.0F);
    for_each_vector(packet, [&](int i) {
        const F32 x = load(xs + i), y = load(ys + i);
        store(to + i, square_root(max((one - x * x) - y * y, zero)));
    });
}

void offset(Packet& packet, const OffsetCtx& ctx) noexcept {
    const float* const ss = attribute_plane(packet, ctx.s);
    const float* const ts = attribute_plane(packet, ctx.t);
    const float* const qs = attribute_plane(packet, ctx.q < 0 ? ctx.s : ctx.q);
    const float* const dss = attribute_plane(packet, ctx.ds);
    const float* const dts = attribute_plane(packet, ctx.dt);
    float* const to = attribute_plane(packet, ctx.to);
    const F32 m0(ctx.m[0]), m1(ctx.m[1]), m2(ctx.m[2]), m3(ctx.m[3]);
    const bool projective = ctx.q >= 0;
    for_each_vector(packet, [&](int i) {
        F32 s = load(ss + i), t = load(ts + i);
        if (projective) {
            const F32 q = load(qs + i);
            s = divide(s, q);
            t = divide(t, q);
        }
        const F32 ds = load(dss + i), dt = load(dts + i);
        store(to + i, (s + m0 * ds) + m2 * dt);
        store(to + kAttributeStride + i, (t + m1 * ds) + m3 * dt);
    });
}

void reflect(Packet& packet, const ReflectCtx& ctx) noexcept {
    const VectorPlanes normals(packet, ctx.n), eyes(packet, ctx.e);
    float* const to = attribute_plane(packet, ctx.to);
    for_each_vector(packet, [&](int i) {
        const Vector3 n = normals.at(i), e = eyes.at(i);
        const F32 k = divide(F32(2.0F) * dot(n, e), dot(n, n));
        store(to + i, k * n.x - e.x);
        store(to + kAttributeStride + i, k * n.y - e.y);
        store(to + 2 * kAttributeStride + i, k * n.z - e.z);
    });
}

void quotient(Packet& packet, const QuotientCtx& ctx) noexcept {
    const float* const a = attribute_plane(packet, ctx.a);
    const float* const b = attribute_plane(packet, ctx.b);
    float* const to = attribute_plane(packet, ctx.to);
    for_each_vector(packet, [&](int i) { store(to + i, divide(load(a + i), load(b + i))); });
}

void angle(Packet& packet, const AngleCtx& ctx) noexcept {
    const float* const a = attribute_plane(packet, ctx.a);
    const float* const b = attribute_plane(packet, ctx.b);
    float* const to = attribute_plane(packet, ctx.to);
    for_each_vector(packet, [&](int i) {
        const F32 d = load(a + i) - load(b + i);
        store(to + i, d - round_down(d));
    });
}

void cull(Packet& packet, const CullCtx& ctx) noexcept {
    const float* coordinates[4];
    bool less[4];
    for (int k = 0; k < 4; ++k) {
        coordinates[k] = attribute_plane(packet, ctx.coordinate[k]);
        less[k] = ctx.less[k] != 0;
    }
    const bool joins = ctx.also >= 0;
    const float* const also = attribute_plane(packet, joins ? ctx.also : ctx.keep);
    float* const keep = attribute_plane(packet, ctx.keep);
    const F32 zero(0.0F), one(1.0F);
    for_each_vector(packet, [&](int i) {
        F32 kept = one;
        if (joins) kept = ::xsimd::select(load(also + i) > zero, one, zero);
        for (int k = 0; k < 4; ++k) {
            const F32 x = load(coordinates[k] + i);
            kept = ::xsimd::select(less[k] ? x < zero : x >= zero, kept, zero);
        }
        store(keep + i, kept);
    });
}

void dim(const Packet& packet, const MagnitudeCtx& ctx, float one_value, float low_value,
         float round_value) {
    const std::int16_t* const magnitudes = packet.planes + ctx.magnitude * kPacketSize;
    const std::int16_t* const from = packet.planes + ctx.from * kPacketSize;
    std::int16_t* const to = packet.planes + ctx.to * kPacketSize;
    const F32 scale(ctx.scale), bias(ctx.bias), one(one_value), low(low_value), round(round_value);
    const bool clamps = ctx.clamp_factor != 0;
    for_each_vector(packet, [&](int i) {
        F32 f = bias + scale * divide(to_float(load_widened(magnitudes + i)), one);
        if (clamps) f = min(max(f, F32(0.0F)), F32(1.0F));
        for (int c = 0; c < 3; ++c) {
            const F32 x = to_float(load_widened(from + c * kPacketSize + i)) * f + round;
            store_narrowed(to + c * kPacketSize + i,
                           truncate(::xsimd::floor(min(max(x, low), one))));
        }
    });
    if (ctx.to == ctx.from) return;
    const int n = group_count(packet);
    for (int i = 0; i < n; i += kLanes) {
        store(to + 3 * kPacketSize + i, load(from + 3 * kPacketSize + i));
    }
}
void dim_nine_bit(Packet& packet, const MagnitudeCtx& ctx) noexcept {
    dim(packet, ctx, 255.0F, -256.0F, 0.02F);
}
void dim_wide(Packet& packet, const MagnitudeCtx& ctx) noexcept {
    dim(packet, ctx, 16384.0F, -32768.0F, 0.5F);
}
