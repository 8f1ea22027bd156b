struct Homogeneous {
    double x, y, w;
};

Homogeneous cross(const Homogeneous& a, const Homogeneous& b) {
    return {a.y * b.w - a.w * b.y, a.w * b.x - a.x * b.w, a.x * b.y - a.y * b.x};
}

/// Corner i from the centre of the reference pixel.
Homogeneous plane_corner(const AttributePlanesCtx& ctx, const PlaneTriangle& t, int i) {
    const HomogeneousVertex& h = ctx.homogeneous[t.vertex[i]];
    const double w = static_cast<double>(h.w);
    const double centre_x = t.reference_x + 0.5, centre_y = t.reference_y + 0.5;
    if (t.clipped != 0) {
        return {static_cast<double>(h.x) - centre_x * w, static_cast<double>(h.y) - centre_y * w,
                w};
    }
    return {(t.x[i] / 256.0 - centre_x) * w, (t.y[i] / 256.0 - centre_y) * w, w};
}

void attribute_planes(const AttributePlanesCtx& ctx) noexcept {
    for (int k = 0; k < ctx.count; ++k) {
        const PlaneTriangle& t = ctx.triangles[k];
        const Homogeneous v[3] = {plane_corner(ctx, t, 0), plane_corner(ctx, t, 1),
                                  plane_corner(ctx, t, 2)};
        Homogeneous b[3] = {cross(v[1], v[2]), cross(v[2], v[0]), cross(v[0], v[1])};
        const double scale = 1.0 / (v[0].x * b[0].x + v[0].y * b[0].y + v[0].w * b[0].w);
        for (Homogeneous& row : b) row = {row.x * scale, row.y * scale, row.w * scale};
        for (int e = 0; e <= ctx.attribute_count; ++e) {
            double a[3] = {1.0, 1.0, 1.0};
            for (int i = 0; i < 3 && e > 0; ++i) {
                a[i] = static_cast<double>(
                    ctx.rows[static_cast<std::ptrdiff_t>(t.vertex[i]) * ctx.row_stride + e - 1]);
            }
            const auto sum = [&](double Homogeneous::*c) {
                return static_cast<float>(a[0] * (b[0].*c) + a[1] * (b[1].*c) + a[2] * (b[2].*c));
            };
            const bool edge_on = !std::isfinite(scale);
            float* const out =
                ctx.equations + static_cast<std::ptrdiff_t>(3 * e) * kAttributeStride + k;
            out[0] = edge_on ? static_cast<float>(a[0]) : sum(&Homogeneous::w);
            out[kAttributeStride] = edge_on ? 0.0F : sum(&Homogeneous::x);
            out[2 * kAttributeStride] = edge_on ? 0.0F : sum(&Homogeneous::y);
        }
    }
}

float* attribute(const Packet& packet, int k) {
    return packet.attributes + static_cast<std::ptrdiff_t>(k) * kAttributeStride;
}

std::int16_t* plane(const Packet& packet, int k) {
    return packet.planes + static_cast<std::ptrdiff_t>(k) * kPacketSize;
}

struct Equation {
    float origin, dx, dy;
};

Equation equation(const AttributesCtx& ctx, int e, int run) {
    const float* const row =
        ctx.equations + static_cast<std::ptrdiff_t>(3 * e) * kAttributeStride + run;
    return {row[0], row[kAttributeStride], row[2 * kAttributeStride]};
}

void attributes(Packet& packet, const AttributesCtx& ctx) noexcept {
    for (int r = 0; r < ctx.run_count; ++r) {
        const Run& run = ctx.runs[r];
        for (int i = run.first; i < run.first + run.count; ++i) {
            const auto x = static_cast<float>(tile_x(packet.pixels[i]) + run.offset_x);
            const auto y = static_cast<float>(tile_y(packet.pixels[i]) + run.offset_y);
            const auto value = [&](int e) {
                const Equation p = equation(ctx, e, r);
                return (p.origin + p.dx * x) + p.dy * y;
            };
            if (ctx.attribute_count == 0) continue;
            const float w = 1.0F / value(0);
            for (int k = 0; k < ctx.attribute_count; ++k)
                attribute(packet, k)[i] = value(k + 1) * w;
        }
    }
}

struct Vector {
    float x, y, z;
};

float dot(const Vector& a, const Vector& b) {
    return (a.x * b.x + a.y * b.y) + a.z * b.z;
}

Vector cross(const Vector& a, const Vector& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

Vector normalised(const Vector& a) {
    const float scale = 1.0F / std::sqrt(dot(a, a));
    return {a.x * scale, a.y * scale, a.z * scale};
}

void lighting(Packet& packet, const LightingCtx& ctx) noexcept {
    for (int i = 0; i < packet.count; ++i) {
        const auto read = [&](int k) -> Vector {
            return {attribute(packet, k)[i], attribute(packet, k + 1)[i],
                    attribute(packet, k + 2)[i]};
        };
        Vector tangent = read(ctx.frame);
        Vector bitangent = read(ctx.frame + 3);
        Vector normal = read(ctx.frame + 6);
        if (ctx.orthonormal != 0) {
            normal = normalised(normal);
            const float along = dot(normal, tangent);
            tangent = normalised({tangent.x - normal.x * along, tangent.y - normal.y * along,
                                  tangent.z - normal.z * along});
            const Vector c = cross(normal, tangent);
            const bool mirrored = dot(c, bitangent) < 0.0F;
            bitangent = mirrored ? Vector{-c.x, -c.y, -c.z} : c;
        }
        const Vector position = read(ctx.frame + 9);

        const bool is_direction = ctx.light_w == 0.0F;
        const Vector l = normalised(is_direction ? Vector{ctx.light[0], ctx.light[1], ctx.light[2]}
                                                 : Vector{ctx.light[0] - position.x * ctx.light_w,
                                                          ctx.light[1] - position.y * ctx.light_w,
                                                          ctx.light[2] - position.z * ctx.light_w});
        const Vector v =
            normalised({ctx.eye[0] - position.x * ctx.eye_w, ctx.eye[1] - position.y * ctx.eye_w,
                        ctx.eye[2] - position.z * ctx.eye_w});
        const Vector sum{l.x + v.x, l.y + v.y, l.z + v.z};
        const Vector h =
            ctx.raw_half != 0 ? Vector{sum.x * 0.5F, sum.y * 0.5F, sum.z * 0.5F} : normalised(sum);

        const auto write = [&](int k, const Vector& x) {
            if (k < 0) return;
            attribute(packet, k)[i] = dot(tangent, x) * 0.5F + 0.5F;
            attribute(packet, k + 1)[i] = dot(bitangent, x) * 0.5F + 0.5F;
            attribute(packet, k + 2)[i] = dot(normal, x) * 0.5F + 0.5F;
        };
        write(ctx.half_vector, h);
        write(ctx.light_vector, l);
        write(ctx.view_vector, v);
        if (ctx.n_dot_l >= 0) attribute(packet, ctx.n_dot_l)[i] = maximum(dot(normal, l), 0.0F);
        if (ctx.h_dot_l >= 0) attribute(packet, ctx.h_dot_l)[i] = maximum(dot(h, l), 0.0F);
    }
}

/// `x` of unit length, or as it is without length.
Vector unit_or_zero(const Vector& x) {
    const float length = std::sqrt(dot(x, x));
    if (!(length > 0.0F)) return x;
    const float scale = 1.0F / length;
    return {x.x * scale, x.y * scale, x.z * scale};
}

void light_vertices(const LightVerticesCtx& ctx) noexcept {
    for (int k = 0; k < ctx.count; ++k) {
        const float* f = ctx.frames + k * LightVerticesCtx::kFrameFloats;
        const Vector position{f[0], f[1], f[2]}, normal{f[3], f[4], f[5]};
        Vector n = normal, t{f[6], f[7], f[8]}, b = cross(n, t);
        b = {b.x * f[9], b.y * f[9], b.z * f[9]};
        if (ctx.orthonormal != 0) {
            n = unit_or_zero(n);
            const float along = dot(n, t);
            t = unit_or_zero({t.x - n.x * along, t.y - n.y * along, t.z - n.z * along});
            const Vector c = cross(n, t);
            b = dot(c, b) < 0.0F ? Vector{-c.x, -c.y, -c.z} : c;
        }
        const auto towards = [&](const float(&to)[3], float w) {
            return unit_or_zero(
                {to[0] - position.x * w, to[1] - position.y * w, to[2] - position.z * w});
        };
        const Vector l = towards(ctx.light, ctx.light_w), v = towards(ctx.eye, ctx.eye_w);
        const Vector sum{l.x + v.x, l.y + v.y, l.z + v.z};
        const Vector middle{sum.x * 0.5F, sum.y * 0.5F, sum.z * 0.5F};
        const Vector h = ctx.raw_half != 0 ? middle : unit_or_zero(sum);

        float values[VertexValue::count];
        const auto write_coded = [&](int first, const Vector& x) {
            values[first] = dot(t, x) * 0.5F + 0.5F;
            values[first + 1] = dot(b, x) * 0.5F + 0.5F;
            values[first + 2] = dot(n, x) * 0.5F + 0.5F;
        };
        write_coded(VertexValue::half, h);
        write_coded(VertexValue::light, l);
        write_coded(VertexValue::view, v);
        values[VertexValue::half_sum] = dot(t, middle);
        values[VertexValue::half_sum + 1] = dot(b, middle);
        values[VertexValue::half_sum + 2] = dot(n, middle);
        const float n_dot_l = maximum(dot(n, l), 0.0F);
        values[VertexValue::n_dot_l] = n_dot_l;
        values[VertexValue::h_dot_l] = maximum(dot(h, l), 0.0F);
        for (int c = 0; c < 3; ++c)
            values[VertexValue::lit + c] = n_dot_l * ctx.tint[c] + ctx.base[c];
        values[VertexValue::normal] = normal.x * 0.5F + 0.5F;
        values[VertexValue::normal + 1] = normal.y * 0.5F + 0.5F;
        values[VertexValue::normal + 2] = normal.z * 0.5F + 0.5F;
        values[VertexValue::uv] = f[10];
        values[VertexValue::uv + 1] = 1.0F - f[11];
        const Vector tangent{f[6], f[7], f[8]}, side = cross(normal, tangent);
        const Vector frame[4] = {
            tangent, {side.x * f[9], side.y * f[9], side.z * f[9]}, normal, position};
        for (int c = 0; c < 4; ++c) {
            values[VertexValue::frame + 3 * c] = frame[c].x;
            values[VertexValue::frame + 3 * c + 1] = frame[c].y;
            values[VertexValue::frame + 3 * c + 2] = frame[c].z;
        }
        for (int i = 0; i < ctx.stride; ++i)
            if (ctx.values[i] != VertexValue::none)
                ctx.out[k * ctx.stride + i] = values[ctx.values[i]];
    }
}
