/// Filtering after combining: where the four corners are, and what becomes of their colours.

/// One coordinate's way to a texel centre.
struct CornerAxis {
    AddressMode mode;
    bool rectangle;
    F32 centre;  ///< of the texel, in 1/256 texel from the left one's lower end, and 1/2

    struct Position {
        F32 coordinate;
        I32 weight;
    };

    Position operator()(F32 u, I32 size, F32 half, I32 weight_bits) const {
        const F32 nought(0.0F), one(1.0F), two(2.0F), unit(256.0F);
        const F32 steps = rectangle ? unit : to_float(size << 8);
        F32 whole = nought;
        if (mode == AddressMode::repeat) whole = round_down(u);
        if (mode == AddressMode::mirrored_repeat) whole = two * round_down(u * F32(0.5F));
        const F32 f = u - whole;
        const MaskF mirrored = f > (mode == AddressMode::mirrored_repeat ? one : F32(kInfinity));
        const F32 x = round_down(::xsimd::select(mirrored, two - f, f) * steps) - half;
        const F32 x0 = round_down(x * F32(0x1p-8F));
        const F32 weight = min(max(x - x0 * unit, nought), F32(255.0F));
        const F32 c = divide(x0 * unit + centre, steps);
        return {whole + ::xsimd::select(mirrored, two - c, c), truncate(weight) & weight_bits};
    }

    static constexpr float kInfinity = __builtin_inff();
};

void texel_corner(Packet& packet, const TexelCornerCtx& ctx) noexcept {
    const auto attribute = [&](int k) {
        return packet.attributes + (k < 0 ? 0 : k) * kAttributeStride;
    };
    const auto codes = [&](int k) { return packet.planes + (k < 0 ? 0 : k) * kPacketSize; };
    const float *const u = attribute(ctx.u), *const v = attribute(ctx.v),
                       *const q = attribute(ctx.q);
    float *const to_s = attribute(ctx.to), *const to_t = attribute(ctx.to + 1);
    const auto* const lambdas = reinterpret_cast<const std::uint16_t*>(codes(ctx.lambda));
    std::int16_t *const weight_x = codes(ctx.weight), *const weight_y = codes(ctx.weight + 1),
                        *const levels = codes(ctx.level);
    std::int32_t entries[2][16];
    for (int k = 0; k < 16; ++k) {
        entries[0][k] = k < ctx.level_count ? ctx.levels[k].width : 0;
        entries[1][k] = k < ctx.level_count ? ctx.levels[k].height : 0;
    }
    const ShortTable widths(entries[0]), heights(entries[1]);
    const bool rectangle = ctx.rectangle != 0;
    const CornerAxis axis_s{ctx.mode_s, rectangle, F32(ctx.right != 0 ? 384.5F : 128.5F)},
        axis_t{ctx.mode_t, rectangle, F32(ctx.below != 0 ? 384.5F : 128.5F)};
    const I32 zero(0), last(ctx.level_count - 1);
    const I32 min_bits(ctx.min_linear != 0 ? 255 : 0), mag_bits(ctx.mag_linear != 0 ? 255 : 0);
    const int n = group_count(packet);
    for (int i = 0; i < n; i += kLanes32) {
        const I32 lambda = ctx.lambda < 0 ? zero : load_widened(lambdas + i);
        const I32 bits = ::xsimd::select(lambda > zero, min_bits, mag_bits);
        const F32 half = to_float(bits & I32(128));
        const I32 level = chosen_level(ctx.choice, lambda, last);
        F32 s = load(u + i), t = load(v + i);
        if (ctx.q >= 0) {
            const F32 divisor = load(q + i);
            s = divide(s, divisor);
            t = divide(t, divisor);
        }
        const auto x = axis_s(s, widths(level), half, bits);
        const auto y = axis_t(t, heights(level), half, bits);
        store(to_s + i, x.coordinate);
        store(to_t + i, y.coordinate);
        store_narrowed(weight_x + i, x.weight);
        store_narrowed(weight_y + i, y.weight);
        if (ctx.level >= 0) store_narrowed(levels + i, level << 8);
    }
}

/// `lerp(upper left, upper right, lower left, lower right, wx, wy)` of every channel.
template <class Lerp>
void filter_corners(Packet& packet, const FilterCtx& ctx, Lerp lerp) {
    const auto plane = [&](int k) { return packet.planes + k * kPacketSize; };
    const std::int16_t *const weight_x = plane(ctx.weight), *const weight_y = plane(ctx.weight + 1);
    const int n = group_count(packet);
    for (int c = 0; c < 4; ++c) {
        const std::int16_t* const from = plane(ctx.corners + c);
        std::int16_t* const out = plane(ctx.out + c);
        for (int i = 0; i < n; i += kLanes) {
            const auto corner = [&](int k) { return load(from + 4 * k * kPacketSize + i); };
            store(out + i, lerp(corner(0), corner(1), corner(2), corner(3), load(weight_x + i),
                                load(weight_y + i)));
        }
    }
}

/// a + ((b - a) w 128 + 2^14 >> 15): a rounding product.
void filter_nine_bit(Packet& packet, const FilterCtx& ctx) noexcept {
    filter_corners(packet, ctx, [](I16 a, I16 b, I16 c, I16 d, I16 wx, I16 wy) {
        const I16 x = wx << 7, y = wy << 7;
        const I16 top = a + mul_round(b - a, x), bottom = c + mul_round(d - c, x);
        return top + mul_round(bottom - top, y);
    });
}

/// Parts may wrap, their sum does not: as in fetch_words().
void filter_wide(Packet& packet, const FilterCtx& ctx) noexcept {
    filter_corners(packet, ctx, [](I16 a, I16 b, I16 c, I16 d, I16 wx, I16 wy) {
        const I16 left = I16(256) - wx, zero(0);
        const auto rows = [](I32 top, I32 bottom, I32 y) {
            return ((top << 8) + (bottom - top) * y + I32(32768)) >> 16;
        };
        const I16 weights_lo = zip_lo16(left, wx), weights_hi = zip_hi16(left, wx);
        return narrow(rows(mul_add_pairs(zip_lo16(a, b), weights_lo),
                           mul_add_pairs(zip_lo16(c, d), weights_lo),
                           ::xsimd::bitwise_cast<I32>(zip_lo16(wy, zero))),
                      rows(mul_add_pairs(zip_hi16(a, b), weights_hi),
                           mul_add_pairs(zip_hi16(c, d), weights_hi),
                           ::xsimd::bitwise_cast<I32>(zip_hi16(wy, zero))));
    });
}
