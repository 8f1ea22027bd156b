/// The low byte of a code in two's complement.
int two_complement(int code) {
    return code >= 128 ? code - 256 : code;
}

float number_nine_bit(Reading reading, int code) {
    const int n = two_complement(code);
    switch (reading) {
        case Reading::unsigned_texel:
            return static_cast<float>(code) / 255.0F;
        case Reading::signed_texel:
            return static_cast<float>(code) / 256.0F;
        case Reading::expanded:
            return (static_cast<float>(std::max(code, 0)) - 127.5F) / 127.5F;
        case Reading::two_complement:
            return static_cast<float>(n) / 128.0F;
        case Reading::nv2a_d3d:
            return (static_cast<float>(code) - 128.0F) / 127.0F;
        case Reading::nv2a_gl:
            return (static_cast<float>(n) + 0.5F) / 127.5F;
        case Reading::nv2a_signed:
            return static_cast<float>(n) / 127.0F;
    }
    return 0.0F;
}

float number_wide(Reading reading, int code) {
    if (reading == Reading::expanded)
        return (static_cast<float>(std::max(code, 0)) - 8192.0F) / 8192.0F;
    return static_cast<float>(code) / 16384.0F;
}

template <float (*Number)(Reading, int)>
void decode(Packet& packet, const DecodeCtx& ctx) noexcept {
    for (int i = 0; i < packet.count; ++i)
        attribute(packet, ctx.attribute)[i] = Number(ctx.reading, plane(packet, ctx.plane)[i]);
}

void affine(Packet& packet, const AffineCtx& ctx) noexcept {
    for (int i = 0; i < packet.count; ++i) {
        const float x = attribute(packet, ctx.from)[i];
        attribute(packet, ctx.to)[i] = (x * ctx.scale + ctx.offset) / ctx.divisor;
    }
}

Vector vector_of(const Packet& packet, const int (&planes)[3], int i) {
    return {attribute(packet, planes[0])[i], attribute(packet, planes[1])[i],
            attribute(packet, planes[2])[i]};
}

void dot_product(Packet& packet, const DotCtx& ctx) noexcept {
    for (int i = 0; i < packet.count; ++i)
        attribute(packet, ctx.to)[i] =
            dot(vector_of(packet, ctx.a, i), vector_of(packet, ctx.b, i));
}

void hemisphere(Packet& packet, const HemisphereCtx& ctx) noexcept {
    for (int i = 0; i < packet.count; ++i) {
        const float x = attribute(packet, ctx.x)[i], y = attribute(packet, ctx.y)[i];
        attribute(packet, ctx.to)[i] = std::sqrt(maximum((1.0F - x * x) - y * y, 0.0F));
    }
}

void offset(Packet& packet, const OffsetCtx& ctx) noexcept {
    for (int i = 0; i < packet.count; ++i) {
        float s = attribute(packet, ctx.s)[i], t = attribute(packet, ctx.t)[i];
        if (ctx.q >= 0) {
            s = s / attribute(packet, ctx.q)[i];
            t = t / attribute(packet, ctx.q)[i];
        }
        const float ds = attribute(packet, ctx.ds)[i], dt = attribute(packet, ctx.dt)[i];
        attribute(packet, ctx.to)[i] = (s + ctx.m[0] * ds) + ctx.m[2] * dt;
        attribute(packet, ctx.to + 1)[i] = (t + ctx.m[1] * ds) + ctx.m[3] * dt;
    }
}

void reflect(Packet& packet, const ReflectCtx& ctx) noexcept {
    for (int i = 0; i < packet.count; ++i) {
        const Vector n = vector_of(packet, ctx.n, i), e = vector_of(packet, ctx.e, i);
        const float k = (2.0F * dot(n, e)) / dot(n, n);
        attribute(packet, ctx.to)[i] = k * n.x - e.x;
        attribute(packet, ctx.to + 1)[i] = k * n.y - e.y;
        attribute(packet, ctx.to + 2)[i] = k * n.z - e.z;
    }
}

void quotient(Packet& packet, const QuotientCtx& ctx) noexcept {
    for (int i = 0; i < packet.count; ++i)
        attribute(packet, ctx.to)[i] = attribute(packet, ctx.a)[i] / attribute(packet, ctx.b)[i];
}

void angle(Packet& packet, const AngleCtx& ctx) noexcept {
    for (int i = 0; i < packet.count; ++i) {
        const float d = attribute(packet, ctx.a)[i] - attribute(packet, ctx.b)[i];
        attribute(packet, ctx.to)[i] = d - std::floor(d);
    }
}

void cull(Packet& packet, const CullCtx& ctx) noexcept {
    for (int i = 0; i < packet.count; ++i) {
        bool kept = ctx.also < 0 || attribute(packet, ctx.also)[i] > 0.0F;
        for (int k = 0; k < 4; ++k) {
            const float x = attribute(packet, ctx.coordinate[k])[i];
            kept = kept && (ctx.less[k] != 0 ? x < 0.0F : x >= 0.0F);
        }
        attribute(packet, ctx.keep)[i] = kept ? 1.0F : 0.0F;
    }
}

template <class Model>
void dim(Packet& packet, const MagnitudeCtx& ctx) noexcept {
    constexpr auto one = static_cast<float>(Model::kOne);
    for (int i = 0; i < packet.count; ++i) {
        float f =
            ctx.bias + ctx.scale * (static_cast<float>(plane(packet, ctx.magnitude)[i]) / one);
        if (ctx.clamp_factor != 0) f = minimum(maximum(f, 0.0F), 1.0F);
        for (int c = 0; c < 3; ++c) {
            const auto code = static_cast<float>(plane(packet, ctx.from + c)[i]);
            const float x =
                minimum(maximum(code * f + Model::kDimRound, static_cast<float>(Model::kLow)), one);
            plane(packet, ctx.to + c)[i] = static_cast<std::int16_t>(std::floor(x));
        }
        plane(packet, ctx.to + 3)[i] = plane(packet, ctx.from + 3)[i];
    }
}
