/// Something at a pixel, and how it changes to the right and downwards.
struct Changing {
    F32 value, dx, dy;
};
Changing negated(const Changing& c) {
    return {-c.value, -c.dx, -c.dy};
}
Changing select(MaskF where, const Changing& a, const Changing& b) {
    return {::xsimd::select(where, a.value, b.value), ::xsimd::select(where, a.dx, b.dx),
            ::xsimd::select(where, a.dy, b.dy)};
}

/// Where a direction meets a cube map, before the division by m.
struct FacePoint {
    I32 face;
    Changing a, b, m;
};

FacePoint face_point(const Changing& s, const Changing& t, const Changing& r) {
    const F32 zero(0.0F);
    const F32 x = ::xsimd::abs(s.value), y = ::xsimd::abs(t.value), z = ::xsimd::abs(r.value);
    const MaskF on_x = (x >= y) & (x >= z), on_y = y >= z;
    const Changing major = select(on_x, s, select(on_y, t, r));
    const MaskF negative = major.value < zero;
    const I32 axis =
        ::xsimd::select(as_int(on_x), I32(0), ::xsimd::select(as_int(on_y), I32(2), I32(4)));
    const Changing on_side = select(negative, r, negated(r));   // a of the x faces
    const Changing on_front = select(negative, negated(s), s);  // a of the z faces
    const Changing on_top = select(negative, negated(r), r);    // b of the y faces
    return {axis + ::xsimd::select(as_int(negative), I32(1), I32(0)),
            select(on_x, on_side, select(on_y, s, on_front)),
            select(on_x, negated(t), select(on_y, on_top, negated(t))),
            select(negative, negated(major), major)};
}

void cube_face(Packet& packet, const CubeFaceCtx& ctx) noexcept {
    const auto plane = [&](int k) { return packet.attributes + k * kAttributeStride; };
    const float *const s = plane(ctx.s), *const t = plane(ctx.t), *const r = plane(ctx.r);
    float *const u = plane(ctx.u), *const v = plane(ctx.v);
    std::int16_t* const face = packet.planes + ctx.face * kPacketSize;
    const F32 zero(0.0F), half(0.5F);
    const int n = group_count(packet);
    for (int i = 0; i < n; i += kLanes32) {
        const auto direction = [&](const float* p) { return Changing{load(p + i), zero, zero}; };
        const FacePoint at = face_point(direction(s), direction(t), direction(r));
        store(u + i, divide(at.a.value, at.m.value) * half + half);
        store(v + i, divide(at.b.value, at.m.value) * half + half);
        store_narrowed(face + i, at.face);
    }
}

/// How far the coordinate c / d moves along an axis of the screen.
F32 moved(const Changing& c, const Changing& d, F32 Changing::*along) {
    const F32 u = divide(c.value, d.value);
    return divide(c.*along - u * (d.*along), d.value);
}

/// `at` gives attribute k, or with -1 the divisor where there is no q.
template <class At>
F32 footprint(const FootprintCtx& ctx, At at) {
    Changing s = at(ctx.s), t = at(ctx.t), r = s, d = s;
    const bool slices = ctx.cube == 0 && ctx.r >= 0;
    if (ctx.cube != 0) {
        const FacePoint p = face_point(s, t, at(ctx.r));
        s = p.a;
        t = p.b;
        d = p.m;
    } else {
        if (slices) r = at(ctx.r);
        d = at(ctx.q);
    }
    const auto square = [&](F32 Changing::*along) {
        const auto texels = [&](const Changing& c, float scale) {
            return moved(c, d, along) * F32(scale);
        };
        const F32 x = texels(s, ctx.scale[0]), y = texels(t, ctx.scale[1]);
        const F32 flat = x * x + y * y;
        if (!slices) return flat;
        const F32 z = texels(r, ctx.scale[2]);
        return flat + z * z;
    };
    return max(square(&Changing::dx), square(&Changing::dy));
}

/// An attribute over w, or 1/w as number -1, from its equation.
template <class Row>
auto equations_at(const PixelPositions& pixel, const Row& row) {
    return [&pixel, &row](int attribute) {
        const int k = 3 * (attribute + 1);
        const F32 dx = row(k + 1), dy = row(k + 2);
        return Changing{(row(k) + dx * pixel.x) + dy * pixel.y, dx, dy};
    };
}

void plane_footprint(Packet& packet, const PlaneFootprintCtx& ctx) noexcept {
    const FootprintCtx how = ctx.footprint;
    float* const out = packet.attributes + how.out * kAttributeStride;
    const FragmentRuns runs(packet, ctx.runs);
    runs.for_each_vector([&](int first, const PixelPositions& pixel, const auto& row) {
        store(out + first, footprint(how, equations_at(pixel, row)));
    });
}

void quad_footprint(Packet& packet, const QuadFootprintCtx& ctx) noexcept {
    const FootprintCtx how = ctx.footprint;
    float* const out = packet.attributes + how.out * kAttributeStride;
    const int n = group_count(packet);
    for (int i = 0; i < n; i += kLanes32) {
        const auto at = [&](int attribute) {
            if (attribute < 0) return Changing{F32(1.0F), F32(0.0F), F32(0.0F)};
            const float* const a = packet.attributes + attribute * kAttributeStride + i;
            float dx[kLanes32], dy[kLanes32];
            for (int k = 0; k < kLanes32; ++k) {
                dx[k] = a[k | 1] - a[k & ~1];
                dy[k] = a[k | 2] - a[k & ~2];
            }
            return Changing{load(a), load(dx), load(dy)};
        };
        store(out + i, footprint(how, at));
    }
}

/// The steps of the level of detail by the upper 8 bits of the mantissa: how many lie before the
/// interval, << 16, and where in it another one is, 0 .. 2^15; 2^15: none.
struct Log2Intervals {
    std::int32_t entry[256];

    constexpr Log2Intervals() : entry{} {
        for (int k = 0; k < 256; ++k) {
            std::int32_t before = 0, at = 1 << 15;
            for (const std::int32_t step : kLog2Step) {
                if (step >> 15 == k) at = step & 0x7fff;
                before += step >> 15 < k ? 1 : 0;
            }
            entry[k] = before << 16 | at;
        }
    }
};
constexpr Log2Intervals kLog2Intervals;

void level_of_detail(Packet& packet, const LevelOfDetailCtx& ctx) noexcept {
    const float* const from = packet.attributes + ctx.footprint * kAttributeStride;
    std::int16_t* const to = packet.planes + ctx.plane * kPacketSize;
    const F32 low(0x1p-64F), high(0x1p64F);
    const I32 bias(ctx.bias), last(ctx.max), zero(0), one(1), code_of_one(0x3f800000);
    const bool below_one_is_0 = ctx.bias <= 0;
    const int n = group_count(packet);
    for (int i = 0; i < n; i += kLanes32) {
        const I32 bits = ::xsimd::bitwise_cast<I32>(min(max(load(from + i), low), high));
        if (below_one_is_0 && !::xsimd::any(bits >= code_of_one)) {
            store_narrowed(to + i, zero);
            continue;
        }
        const I32 entry = look_up(kLog2Intervals.entry, (bits >> 15) & I32(255));
        const I32 beyond = ::xsimd::select((bits & I32(0x7fff)) < (entry & I32(0xffff)), zero, one);
        const I32 octaves = ((bits >> 23) - I32(127)) << 7;
        store_narrowed(to + i, min(max(octaves + (entry >> 16) + beyond + bias, zero), last));
    }
}

/// As axis_address(), with a size and a way to filter per fragment.
struct LevelAxis {
    AddressMode mode;
    bool rectangle;

    AxisAddress operator()(F32 coordinate, I32 size, I32 half, I32 weight_bits) const {
        const I32 zero(0), last = size - I32(1);
        const F32 one(1.0F), nought(0.0F);
        const F32 whole = rectangle ? to_float(size) : one;
        const F32 steps = rectangle ? F32(256.0F) : to_float(size << 8);
        F32 f = coordinate;
        switch (mode) {
            case AddressMode::repeat: {
                f = max(coordinate - ::xsimd::floor(coordinate), nought);  // at most 1
                const I32 fixed = truncate(f * steps) - half, texel = fixed >> 8;
                const I32 below_size = ::xsimd::select(texel < size, texel, zero);
                return {min_unsigned(below_size, last), fixed & weight_bits};
            }
            case AddressMode::clamp_to_border: {
                f = min(max(f, nought - one), whole + one);
                const I32 fixed = truncate(::xsimd::floor(f * steps)) - half, texel = fixed >> 8;
                const I32 before(-1);
                I32 weight = fixed & weight_bits;
                weight = ::xsimd::select(texel < before, zero, weight);
                weight = ::xsimd::select(texel < size, weight, zero);
                return {min(max(texel, before), size), weight};
            }
            case AddressMode::mirrored_repeat:
                f = coordinate - F32(2.0F) * ::xsimd::floor(coordinate * F32(0.5F));
                f = ::xsimd::select(f > one, F32(2.0F) - f, f);
                break;
            case AddressMode::clamp_to_edge:
                break;
        }
        const I32 fixed = truncate(min(max(f, nought), whole) * steps) - half;
        const I32 inside = max(fixed, zero);
        return {min(inside >> 8, last), inside & weight_bits};
    }
};

I32 chosen_level(LevelChoice choice, I32 lambda, I32 last) {
    switch (choice) {
        case LevelChoice::base:
            break;
        case LevelChoice::nearest:
            return min((lambda + I32(127)) >> 8, last);
        case LevelChoice::floor:
            return lambda >> 8;
        case LevelChoice::ceiling:
            return min((lambda >> 8) + I32(1), last);
    }
    return I32(0);
}

I32 slice_behind(I32 slice, I32 depth, AddressMode mode) {
    const I32 next = slice + I32(1);
    if (mode == AddressMode::clamp_to_border) return min(next, depth);
    if (mode != AddressMode::repeat) return min(next, depth - I32(1));
    return ::xsimd::select(next < depth, next, I32(0));
}

/// One number of every level.
ShortTable table_of(const LevelAddressCtx& ctx, std::int32_t LevelAddressCtx::Level::*number,
                    std::int32_t (&entries)[16]) {
    static_assert(LevelAddressCtx::kMaxLevels <= 16);
    for (int k = 0; k < 16; ++k) entries[k] = k < ctx.level_count ? ctx.levels[k].*number : 0;
    return ShortTable(entries);
}

void level_address(Packet& packet, const LevelAddressCtx& ctx) noexcept {
    const auto attribute = [&](int k) {
        return packet.attributes + (k < 0 ? 0 : k) * kAttributeStride;
    };
    const auto codes = [&](int k) {  // none is negative
        return reinterpret_cast<const std::uint16_t*>(packet.planes +
                                                      (k < 0 ? 0 : k) * kPacketSize);
    };
    const float *const u = attribute(ctx.u), *const v = attribute(ctx.v),
                       *const r = attribute(ctx.r), *const q = attribute(ctx.q);
    const std::uint16_t *const lambdas = codes(ctx.lambda), *const faces = codes(ctx.face);
    std::int16_t* const slice_weight =
        packet.planes + (ctx.slice_weight < 0 ? 0 : ctx.slice_weight) * kPacketSize;
    using Level = LevelAddressCtx::Level;
    std::int32_t entries[4][16];
    const ShortTable widths = table_of(ctx, &Level::width, entries[0]),
                     heights = table_of(ctx, &Level::height, entries[1]),
                     depths = table_of(ctx, &Level::depth, entries[2]),
                     offsets = table_of(ctx, &Level::offset, entries[3]);
    const LevelAxis axis_s{ctx.mode_s, ctx.rectangle != 0}, axis_t{ctx.mode_t, ctx.rectangle != 0},
        axis_r{ctx.mode_r, false};
    const I32 zero(0), last(ctx.level_count - 1);
    const I32 min_half(ctx.min_linear != 0 ? 128 : 0), mag_half(ctx.mag_linear != 0 ? 128 : 0);
    const I32 min_bits(ctx.min_linear != 0 ? 255 : 0), mag_bits(ctx.mag_linear != 0 ? 255 : 0);
    const bool layers = ctx.face >= 0 || ctx.r >= 0;
    const int n = group_count(packet);
    for (int i = 0; i < n; i += kLanes32) {
        const I32 lambda = ctx.lambda < 0 ? zero : load_widened(lambdas + i);
        const I32 half = ::xsimd::select(lambda > zero, min_half, mag_half);
        const I32 bits = ::xsimd::select(lambda > zero, min_bits, mag_bits);
        const I32 level = chosen_level(ctx.choice, lambda, last);
        F32 s = load(u + i), t = load(v + i);
        if (ctx.q >= 0) {
            s = divide(s, load(q + i));
            t = divide(t, load(q + i));
        }
        const AxisAddress x = axis_s(s, widths(level), half, bits);
        const AxisAddress y = axis_t(t, heights(level), half, bits);
        I32 layer = ctx.face < 0 ? zero : load_widened(faces + i);
        if (ctx.r >= 0) {
            const F32 p = ctx.q >= 0 ? divide(load(r + i), load(q + i)) : load(r + i);
            const I32 depth = depths(level);
            const AxisAddress z = axis_r(p, depth, half, bits);
            layer = ctx.behind != 0 ? slice_behind(z.texel, depth, ctx.mode_r) : z.texel;
            if (ctx.slice_weight >= 0) store_narrowed(slice_weight + i, z.weight);
        }
        I32 at = offsets(level) + y.texel * I32(ctx.pitch) + x.texel * I32(ctx.texel_bytes);
        if (layers) at = at + layer * I32(ctx.layer_bytes);
        store(packet.texel + i, at);
        store_narrowed(packet.weight_x + i, x.weight);
        store_narrowed(packet.weight_y + i, y.weight);
    }
}

/// a + (b - a) w / 256 is a + ((b - a) w 128 + 2^14 >> 15), a rounding product, unless b - a
/// needs 17 bits.
template <bool Words>
I16 blended(I16 a, I16 b, I16 w) {
    if constexpr (!Words) return a + mul_round(b - a, w << 7);
    const auto lerp = [](I32 from, I32 to, I32 by) {
        return ((from << 8) + (to - from) * by + I32(128)) >> 8;
    };
    return narrow(lerp(widen_lo(a), widen_lo(b), widen_lo(w)),
                  lerp(widen_hi(a), widen_hi(b), widen_hi(w)));
}

template <bool Words>
void blend_levels(Packet& packet, const BlendLevelsCtx& ctx) {
    const std::int16_t* const weight = packet.planes + ctx.weight * kPacketSize;
    const int n = group_count(packet);
    for (int c = 0; c < ctx.channels; ++c) {
        const std::int16_t* const a = packet.planes + (ctx.a + c) * kPacketSize;
        const std::int16_t* const b = packet.planes + (ctx.b + c) * kPacketSize;
        std::int16_t* const out = packet.planes + (ctx.out + c) * kPacketSize;
        const int shift = ctx.doubled >> c & 1;
        for (int i = 0; i < n; i += kLanes) {
            const I16 w = load(weight + i) & I16(255);
            const I16 x = load(a + i) >> shift, y = load(b + i) >> shift;
            store(out + i, blended<Words>(x, y, w) << shift);
        }
    }
}
void blend_levels(Packet& packet, const BlendLevelsCtx& ctx) noexcept {
    ctx.words != 0 ? blend_levels<true>(packet, ctx) : blend_levels<false>(packet, ctx);
}
