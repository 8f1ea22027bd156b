struct TexelPosition {
    std::int32_t texel;  ///< upper or left
    std::int16_t weight;
};

/// `linear`: between two texels, else the nearest. Coordinates run over 0 .. 1, of a rectangle over
/// 0 .. size.
TexelPosition texel_position(float u, std::int32_t size, AddressMode mode, bool linear,
                             bool rectangle) {
    const float whole = rectangle ? static_cast<float>(size) : 1.0F;
    const float steps = rectangle ? 256.0F : static_cast<float>(256 * size);
    const bool border = mode == AddressMode::clamp_to_border;
    float f = u;
    if (mode == AddressMode::repeat) f = u - std::floor(u);
    if (mode == AddressMode::mirrored_repeat) {
        f = u - 2.0F * std::floor(u * 0.5F);
        if (f > 1.0F) f = 2.0F - f;
    }
    f = minimum(maximum(f, border ? -1.0F : 0.0F), border ? whole + 1.0F : whole);
    const auto fixed = static_cast<std::int32_t>(std::floor(f * steps)) - (linear ? 128 : 0);
    TexelPosition p{fixed >> 8, static_cast<std::int16_t>(linear ? fixed & 255 : 0)};
    const auto stop_at = [&](std::int32_t texel) { p = {texel, 0}; };
    switch (mode) {
        case AddressMode::repeat:
            if (p.texel < 0) p.texel += size;
            if (p.texel >= size) p.texel -= size;
            break;
        case AddressMode::clamp_to_border:
            if (p.texel < -1) stop_at(-1);
            if (p.texel >= size) stop_at(size);
            break;
        case AddressMode::clamp_to_edge:
        case AddressMode::mirrored_repeat:
            if (p.texel < 0) stop_at(0);
            if (p.texel >= size) p.texel = size - 1;
            break;
    }
    return p;
}

void address(Packet& packet, const AddressCtx& ctx) noexcept {
    for (int i = 0; i < packet.count; ++i) {
        float u = attribute(packet, ctx.u)[i];
        float v = attribute(packet, ctx.v)[i];
        if (ctx.q >= 0) {
            u = u / attribute(packet, ctx.q)[i];
            v = v / attribute(packet, ctx.q)[i];
        }
        const bool linear = ctx.linear != 0, rectangle = ctx.rectangle != 0;
        const TexelPosition s = texel_position(u, ctx.width, ctx.mode_s, linear, rectangle);
        const TexelPosition t = texel_position(v, ctx.height, ctx.mode_t, linear, rectangle);
        packet.texel[i] = t.texel * ctx.pitch + s.texel * (1 << ctx.texel_shift);
        packet.weight_x[i] = s.weight;
        packet.weight_y[i] = t.weight;
    }
}

/// Something at a pixel, and how it changes to the right and downwards.
struct Changing {
    float value, dx, dy;
    Changing operator-() const { return {-value, -dx, -dy}; }
};

/// Where a direction meets a cube map, before the division by m.
struct FacePoint {
    int face;
    Changing a, b, m;
};

FacePoint face_point(const Changing& s, const Changing& t, const Changing& r) {
    const float x = std::fabs(s.value), y = std::fabs(t.value), z = std::fabs(r.value);
    if (x >= y && x >= z) {
        if (s.value < 0.0F) return {1, r, -t, -s};
        return {0, -r, -t, s};
    }
    if (y >= z) {
        if (t.value < 0.0F) return {3, s, -r, -t};
        return {2, s, r, t};
    }
    if (r.value < 0.0F) return {5, -s, -t, -r};
    return {4, s, -t, r};
}

void cube_face(Packet& packet, const CubeFaceCtx& ctx) noexcept {
    for (int i = 0; i < packet.count; ++i) {
        const auto direction = [&](int k) -> Changing { return {attribute(packet, k)[i], 0, 0}; };
        const FacePoint p = face_point(direction(ctx.s), direction(ctx.t), direction(ctx.r));
        attribute(packet, ctx.u)[i] = (p.a.value / p.m.value) * 0.5F + 0.5F;
        attribute(packet, ctx.v)[i] = (p.b.value / p.m.value) * 0.5F + 0.5F;
        plane(packet, ctx.face)[i] = static_cast<std::int16_t>(p.face);
    }
}

/// How far the coordinate c / d moves along an axis of the screen.
float moved(const Changing& c, const Changing& d, float Changing::*along) {
    const float u = c.value / d.value;
    return (c.*along - u * (d.*along)) / d.value;
}

/// `at` gives attribute k, or with -1 the divisor where there is no q.
template <class At>
float footprint(const FootprintCtx& ctx, At at) {
    Changing s = at(ctx.s), t = at(ctx.t), r{0.0F, 0.0F, 0.0F}, d{};
    if (ctx.cube != 0) {
        const FacePoint p = face_point(s, t, at(ctx.r));
        s = p.a;
        t = p.b;
        d = p.m;
    } else {
        if (ctx.r >= 0) r = at(ctx.r);
        d = at(ctx.q);
    }
    const auto square = [&](float Changing::*along) {
        const auto texels = [&](const Changing& c, float scale) {
            return moved(c, d, along) * scale;
        };
        const float x = texels(s, ctx.scale[0]), y = texels(t, ctx.scale[1]);
        const float flat = x * x + y * y;
        if (ctx.cube != 0 || ctx.r < 0) return flat;
        const float z = texels(r, ctx.scale[2]);
        return flat + z * z;
    };
    return maximum(square(&Changing::dx), square(&Changing::dy));
}

/// Calls f(i, at) for every fragment i; at(k) is attribute k over w there, at(-1) 1/w.
template <class F>
void for_each_fragment(const Packet& packet, const AttributesCtx& runs, F f) {
    for (int k = 0; k < runs.run_count; ++k) {
        const Run& run = runs.runs[k];
        for (int i = run.first; i < run.first + run.count; ++i) {
            const auto x = static_cast<float>(tile_x(packet.pixels[i]) + run.offset_x);
            const auto y = static_cast<float>(tile_y(packet.pixels[i]) + run.offset_y);
            f(i, [&](int attribute) -> Changing {
                const Equation p = equation(runs, attribute + 1, k);
                return {(p.origin + p.dx * x) + p.dy * y, p.dx, p.dy};
            });
        }
    }
}

void plane_footprint(Packet& packet, const PlaneFootprintCtx& ctx) noexcept {
    for_each_fragment(packet, ctx.runs, [&](int i, auto at) {
        attribute(packet, ctx.footprint.out)[i] = footprint(ctx.footprint, at);
    });
}

void quad_footprint(Packet& packet, const QuadFootprintCtx& ctx) noexcept {
    for (int i = 0; i < packet.count; ++i) {
        const int left = i & ~1, upper = i & ~2;
        const auto at = [&](int k) -> Changing {
            if (k < 0) return {1.0F, 0.0F, 0.0F};
            const float* a = attribute(packet, k);
            return {a[i], a[left + 1] - a[left], a[upper + 2] - a[upper]};
        };
        attribute(packet, ctx.footprint.out)[i] = footprint(ctx.footprint, at);
    }
}

void probe_extent(Packet& packet, const ProbeExtentCtx& ctx) noexcept {
    for_each_fragment(packet, ctx.runs, [&](int i, auto at) {
        const FootprintCtx& how = ctx.footprint;
        const Changing s = at(how.s), t = at(how.t), d = at(how.q);
        struct Step {
            float u, v, square;
        };
        const auto step = [&](float Changing::*along) -> Step {
            const float u = moved(s, d, along), v = moved(t, d, along);
            const float x = u * how.scale[0], y = v * how.scale[1];
            return {u, v, x * x + y * y};
        };
        const Step x = step(&Changing::dx), y = step(&Changing::dy);
        const float longest = maximum(x.square, y.square);
        const float shortest = maximum(minimum(x.square, y.square), 1.0F);
        const float n =
            minimum(maximum(std::ceil(std::sqrt(longest / shortest) - 0x1p-8F), 1.0F), ctx.most);
        const Step& longer = x.square > y.square ? x : y;
        attribute(packet, how.out)[i] = longest / (n * n);
        attribute(packet, ctx.probes)[i] = n;
        attribute(packet, ctx.step)[i] = n > 1.0F ? longer.u / (n + 1.0F) : 0.0F;
        attribute(packet, ctx.step + 1)[i] = n > 1.0F ? longer.v / (n + 1.0F) : 0.0F;
    });
}

void probe_point(Packet& packet, const ProbePointCtx& ctx) noexcept {
    for (int i = 0; i < packet.count; ++i) {
        const int n = static_cast<int>(attribute(packet, ctx.probes)[i]);
        const float steps =
            static_cast<float>(std::min(ctx.probe, n - 1)) - static_cast<float>(n - 1) * 0.5F;
        for (int c = 0; c < 2; ++c) {
            float at = attribute(packet, c == 0 ? ctx.u : ctx.v)[i];
            if (ctx.q >= 0) at = at / attribute(packet, ctx.q)[i];
            attribute(packet, ctx.to + c)[i] = at + attribute(packet, ctx.step + c)[i] * steps;
        }
    }
}

void probe_sum(Packet& packet, const ProbeSumCtx& ctx) noexcept {
    for (int i = 0; i < packet.count; ++i) {
        const int n = static_cast<int>(attribute(packet, ctx.probes)[i]);
        for (int c = 0; c < ctx.channels; ++c) {
            float& sum = attribute(packet, ctx.sum + c)[i];
            const Int before = ctx.probe == 0 ? 0 : static_cast<Int>(sum);
            const Int code = ctx.probe < n ? plane(packet, ctx.plane[c])[i] : 0;
            sum = static_cast<float>(before + code);
        }
    }
}

void probe_mean(Packet& packet, const ProbeSumCtx& ctx) noexcept {
    for (int i = 0; i < packet.count; ++i) {
        const Int n = static_cast<Int>(attribute(packet, ctx.probes)[i]);
        for (int c = 0; c < ctx.channels; ++c) {
            const Int unit = (ctx.doubled >> c & 1) != 0 ? 2 : 1;
            const Int sum = static_cast<Int>(attribute(packet, ctx.sum + c)[i]) / unit;
            // floor((2 sum + n) / (2 n)), the numerator made positive by a multiple of 2 n.
            const Int mean = (2 * sum + n + (Int{2} * n << 24)) / (2 * n) - (Int{1} << 24);
            plane(packet, ctx.plane[c])[i] = static_cast<std::int16_t>(mean * unit);
        }
    }
}

void level_of_detail(Packet& packet, const LevelOfDetailCtx& ctx) noexcept {
    for (int i = 0; i < packet.count; ++i) {
        const float f = minimum(maximum(attribute(packet, ctx.footprint)[i], 0x1p-64F), 0x1p64F);
        std::int32_t bits;
        std::memcpy(&bits, &f, sizeof bits);
        Int lambda = Int{128} * ((bits >> 23) - 127) + ctx.bias;
        for (const std::int32_t step : kLog2Step) lambda += step <= (bits & 0x7fffff) ? 1 : 0;
        plane(packet, ctx.plane)[i] = static_cast<std::int16_t>(clamp(lambda, 0, ctx.max));
    }
}

int chosen_level(LevelChoice choice, int lambda, int last) {
    switch (choice) {
        case LevelChoice::base:
            return 0;
        case LevelChoice::nearest:
            return std::min((lambda + 127) >> 8, last);
        case LevelChoice::floor:
            return lambda >> 8;
        case LevelChoice::ceiling:
            return std::min((lambda >> 8) + 1, last);
    }
    return 0;
}

std::int32_t slice_behind(std::int32_t slice, std::int32_t depth, AddressMode mode) {
    const std::int32_t next = slice + 1;
    if (mode == AddressMode::clamp_to_border) return std::min(next, depth);
    if (next < depth) return next;
    return mode == AddressMode::repeat ? 0 : depth - 1;
}

void level_address(Packet& packet, const LevelAddressCtx& ctx) noexcept {
    for (int i = 0; i < packet.count; ++i) {
        const int lambda = ctx.lambda < 0 ? 0 : plane(packet, ctx.lambda)[i];
        const bool linear = (lambda > 0 ? ctx.min_linear : ctx.mag_linear) != 0;
        const LevelAddressCtx::Level& level =
            ctx.levels[chosen_level(ctx.choice, lambda, ctx.level_count - 1)];
        const auto coordinate = [&](int k) {
            const float c = attribute(packet, k)[i];
            return ctx.q < 0 ? c : c / attribute(packet, ctx.q)[i];
        };
        const bool rectangle = ctx.rectangle != 0;
        const TexelPosition s =
            texel_position(coordinate(ctx.u), level.width, ctx.mode_s, linear, rectangle);
        const TexelPosition t =
            texel_position(coordinate(ctx.v), level.height, ctx.mode_t, linear, rectangle);
        std::int32_t layer = ctx.face < 0 ? 0 : plane(packet, ctx.face)[i];
        if (ctx.r >= 0) {
            const TexelPosition r =
                texel_position(coordinate(ctx.r), level.depth, ctx.mode_r, linear, false);
            layer = ctx.behind != 0 ? slice_behind(r.texel, level.depth, ctx.mode_r) : r.texel;
            if (ctx.slice_weight >= 0) plane(packet, ctx.slice_weight)[i] = r.weight;
        }
        packet.texel[i] = level.offset + t.texel * ctx.pitch + s.texel * ctx.texel_bytes +
                          layer * ctx.layer_bytes;
        packet.weight_x[i] = s.weight;
        packet.weight_y[i] = t.weight;
    }
}

struct CornerPosition {
    float coordinate;
    std::int16_t weight;
};

CornerPosition corner_position(float u, std::int32_t size, AddressMode mode, bool linear,
                               bool rectangle, bool second) {
    const float steps = rectangle ? 256.0F : static_cast<float>(256 * size);
    float whole = 0.0F;
    if (mode == AddressMode::repeat) whole = std::floor(u);
    if (mode == AddressMode::mirrored_repeat) whole = 2.0F * std::floor(u * 0.5F);
    const float f = u - whole;
    const bool mirrored = mode == AddressMode::mirrored_repeat && f > 1.0F;
    const float x = std::floor((mirrored ? 2.0F - f : f) * steps) - (linear ? 128.0F : 0.0F);
    const float x0 = std::floor(x * 0x1p-8F);
    const float weight = minimum(maximum(x - x0 * 256.0F, 0.0F), 255.0F);
    const float c = (x0 * 256.0F + (second ? 384.5F : 128.5F)) / steps;
    return {whole + (mirrored ? 2.0F - c : c),
            linear ? static_cast<std::int16_t>(weight) : std::int16_t{0}};
}

void texel_corner(Packet& packet, const TexelCornerCtx& ctx) noexcept {
    for (int i = 0; i < packet.count; ++i) {
        const int lambda = ctx.lambda < 0 ? 0 : plane(packet, ctx.lambda)[i];
        const bool linear = (lambda > 0 ? ctx.min_linear : ctx.mag_linear) != 0;
        const int number = chosen_level(ctx.choice, lambda, ctx.level_count - 1);
        const LevelAddressCtx::Level& level = ctx.levels[number];
        const auto coordinate = [&](int k) {
            const float c = attribute(packet, k)[i];
            return ctx.q < 0 ? c : c / attribute(packet, ctx.q)[i];
        };
        const bool rectangle = ctx.rectangle != 0;
        const CornerPosition s = corner_position(coordinate(ctx.u), level.width, ctx.mode_s, linear,
                                                 rectangle, ctx.right != 0);
        const CornerPosition t = corner_position(coordinate(ctx.v), level.height, ctx.mode_t,
                                                 linear, rectangle, ctx.below != 0);
        attribute(packet, ctx.to)[i] = s.coordinate;
        attribute(packet, ctx.to + 1)[i] = t.coordinate;
        plane(packet, ctx.weight)[i] = s.weight;
        plane(packet, ctx.weight + 1)[i] = t.weight;
        if (ctx.level >= 0) plane(packet, ctx.level)[i] = static_cast<std::int16_t>(256 * number);
    }
}
