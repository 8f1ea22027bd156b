/// One texture coordinate to a texel and a weight, both ways of an axis alike.
struct AxisAddress {
    I32 texel;   ///< 0 .. size - 1
    I32 weight;  ///< of its neighbour, 0 .. 255
};

/// `whole` is the coordinate of the far side, `steps` how many 1/256 texels 1 is. Coordinates that
/// repeat are within 0 .. 1 or NaN, so that linear filtering never gets beyond the last texel; of a
/// NaN it makes -2^31 - 128 (x86) or -128 (AArch64), which both are the last texel's half, as of 0.
template <AddressMode Mode, bool Linear>
inline AxisAddress axis_address(F32 coordinate, std::int32_t size, F32 whole, F32 steps) {
    const I32 last(size - 1), zero(0), half(Linear ? 128 : 0), bits(Linear ? 255 : 0);
    const F32 one(1.0F), nought(0.0F);
    if constexpr (Mode == AddressMode::clamp_to_border) {
        const F32 f = min(max(coordinate, nought - one), whole + one);
        const I32 fixed = truncate(::xsimd::floor(f * steps)) - half;
        const I32 before(-1), behind(size), texel = fixed >> 8;
        I32 weight = fixed & bits;
        weight = ::xsimd::select(texel < before, zero, weight);
        weight = ::xsimd::select(texel > last, zero, weight);
        return {min(max(texel, before), behind), weight};
    } else if constexpr (Mode == AddressMode::repeat) {
        F32 f = coordinate - ::xsimd::floor(coordinate);
        if constexpr (!Linear) f = max(f, nought);
        const I32 fixed = truncate(f * steps) - half, texel = fixed >> 8;  // -1 or 0 .. size
        if constexpr (Linear) return {min_unsigned(texel, last), fixed & bits};
        return {::xsimd::select(texel > last, zero, texel), zero};
    } else {
        F32 f = coordinate;
        if constexpr (Mode == AddressMode::mirrored_repeat) {
            f = coordinate - F32(2.0F) * ::xsimd::floor(coordinate * F32(0.5F));
            f = ::xsimd::select(f > one, F32(2.0F) - f, f);
        }
        const I32 fixed = truncate(min(max(f, nought), whole) * steps) - half;
        if constexpr (!Linear) return {min(fixed >> 8, last), zero};
        const I32 inside = max(fixed, zero);
        return {inside >> 8, inside & bits};
    }
}

template <AddressMode ModeS, AddressMode ModeT, bool Linear>
void addresses(Packet& packet, const AddressCtx& ctx) {
    const float* u = packet.attributes + ctx.u * kAttributeStride;
    const float* v = packet.attributes + ctx.v * kAttributeStride;
    const float* q = packet.attributes + (ctx.q < 0 ? 0 : ctx.q) * kAttributeStride;
    const bool projective = ctx.q >= 0;
    const int texel_shift = ctx.texel_shift;
    const std::int32_t width = ctx.width, height = ctx.height;
    const bool texels = ctx.rectangle != 0;
    const F32 whole_x(texels ? static_cast<float>(width) : 1.0F);
    const F32 whole_y(texels ? static_cast<float>(height) : 1.0F);
    const F32 steps_x(texels ? 256.0F : static_cast<float>(256 * width));
    const F32 steps_y(texels ? 256.0F : static_cast<float>(256 * height));
    const I32 pitch(ctx.pitch);
    std::int32_t* const texel = packet.texel;
    std::int16_t *weight_x = packet.weight_x, *weight_y = packet.weight_y;
    const int n = group_count(packet);
    for (int i = 0; i < n; i += kLanes) {
        AxisAddress x[2], y[2];
        for (int half = 0; half < 2; ++half) {
            const int at = i + half * kLanes32;
            F32 s = load(u + at), t = load(v + at);
            if (projective) {
                const F32 divisor = load(q + at);
                s = divide(s, divisor);
                t = divide(t, divisor);
            }
            x[half] = axis_address<ModeS, Linear>(s, width, whole_x, steps_x);
            y[half] = axis_address<ModeT, Linear>(t, height, whole_y, steps_y);
            store(texel + at, y[half].texel * pitch + (x[half].texel << texel_shift));
        }
        store_narrowed(weight_x + i, x[0].weight, x[1].weight);
        store_narrowed(weight_y + i, y[0].weight, y[1].weight);
    }
}

template <AddressMode ModeS, AddressMode ModeT>
void addresses(Packet& packet, const AddressCtx& ctx) {
    if (ctx.linear != 0) {
        addresses<ModeS, ModeT, true>(packet, ctx);
    } else {
        addresses<ModeS, ModeT, false>(packet, ctx);
    }
}

template <AddressMode ModeS>
void addresses(Packet& packet, const AddressCtx& ctx) {
    switch (ctx.mode_t) {
        case AddressMode::repeat:
            return addresses<ModeS, AddressMode::repeat>(packet, ctx);
        case AddressMode::clamp_to_edge:
            return addresses<ModeS, AddressMode::clamp_to_edge>(packet, ctx);
        case AddressMode::clamp_to_border:
            return addresses<ModeS, AddressMode::clamp_to_border>(packet, ctx);
        case AddressMode::mirrored_repeat:
            return addresses<ModeS, AddressMode::mirrored_repeat>(packet, ctx);
    }
}

void address(Packet& packet, const AddressCtx& ctx) noexcept {
    switch (ctx.mode_s) {
        case AddressMode::repeat:
            return addresses<AddressMode::repeat>(packet, ctx);
        case AddressMode::clamp_to_edge:
            return addresses<AddressMode::clamp_to_edge>(packet, ctx);
        case AddressMode::clamp_to_border:
            return addresses<AddressMode::clamp_to_border>(packet, ctx);
        case AddressMode::mirrored_repeat:
            return addresses<AddressMode::mirrored_repeat>(packet, ctx);
    }
}

/// Byte patterns for the 128-bit lanes of the fetch. A lane holds two fragments' texel pairs,
/// LLLL RRRR LLLL RRRR by channel; interleaved it is L R L R (red of both), then green, blue,
/// alpha, so that products of bytes end as words r0 r1 g0 g1 b0 b1 a0 a1.
struct FetchPatterns {
    I16 interleave;
    I16 word_pair[4];  ///< words 2 k, 2 k + 1 of a lane, four times

    FetchPatterns() {
        alignas(16) std::int8_t bytes[16];
        for (int channel = 0; channel < 4; ++channel) {
            for (int fragment = 0; fragment < 2; ++fragment) {
                for (int side = 0; side < 2; ++side) {
                    bytes[4 * channel + 2 * fragment + side] =
                        static_cast<std::int8_t>(8 * fragment + 4 * side + channel);
                }
            }
        }
        interleave = broadcast_lane(bytes);
        for (int k = 0; k < 4; ++k) {
            for (int i = 0; i < 16; ++i) bytes[i] = static_cast<std::int8_t>(4 * k + i % 4);
            word_pair[k] = broadcast_lane(bytes);
        }
    }
};

/// Weights of kLanes fragments, as the filters of each vector of texels pick them.
struct FilterWeights {
    I16 x, y;
};

/// The bilinear filter of the nine-bit model, for the fragments of one vector, from texels x =
/// 127 - t. A weighted sum s of two, divided by 256 with halves downwards, is 127 minus the lerp
/// with halves upwards; a rounding product with -128 / 2^15 is just minus that quotient. The weight
/// 256 does not fit a byte, but (255, 0) do as well: (255 x + 127) >> 8 = x for all x of a byte.
struct FilterNineBit {
    static FilterWeights weights(I16 wx, I16 wy) {
        return {min(I16(256) - wx, I16(255)) | (wx << 8), wy << 7};
    }
    FilterNineBit(const FilterWeights& w, I16 word_pair)
        : across(shuffle_bytes(w.x, word_pair)), down(shuffle_bytes(w.y, word_pair)) {}
    I16 row(I16 texels) const { return mul_round(mul_add_bytes(across, texels), I16(-128)); }
    /// v - 127. A lerp ((256 - w) x + w y + 128) >> 8 is x + ((w (y - x) + 128) >> 8).
    I16 operator()(I16 top_texels, I16 bottom_texels) const {
        const I16 top = row(top_texels), bottom = row(bottom_texels);
        return top + mul_round(bottom - top, down);
    }
    static I16 unsigned_code(I16 v) { return v + I16(127); }
    static I16 signed_code(I16 v) { return (v - I16(1)) << 1; }
    I16 across, down;
};

/// The same for the wide model, exact until the end.
struct FilterWide {
    static FilterWeights weights(I16 wx, I16 wy) { return {(I16(255) - wx) | (wx << 8), wy}; }
    FilterWide(const FilterWeights& w, I16 word_pair) : across(shuffle_bytes(w.x, word_pair)) {
        const I16 bottom = shuffle_bytes(w.y, word_pair);
        down = zip_lo16(bottom - I16(256), I16(0) - bottom);  // and zip_hi16: words repeat
    }
    /// (256 - wx) * left + wx * right of 127 - t, from -32768 to 32512. 256 does not fit a byte, so
    /// one more left is added by a second product.
    I16 row(I16 texels) const {
        return mul_add_bytes(across, texels) + mul_add_bytes(I16(1), texels);
    }
    I16 operator()(I16 top_texels, I16 bottom_texels) const {
        const I16 top = row(top_texels), bottom = row(bottom_texels);
        const I32 half(128 - 65536);  // minus the sum of 127 - t is that of t - 128 plus 1 each
        const I32 lo = mul_add_pairs(zip_lo16(top, bottom), down) + half;
        const I32 hi = mul_add_pairs(zip_hi16(top, bottom), down) + half;
        return narrow(lo >> 8, hi >> 8);  // v - 32768
    }
    static I16 unsigned_code(I16 biased) {
        const I16 v = biased ^ I16(static_cast<std::int16_t>(0x8000));
        return average(shift_right_logical(v + shift_right_logical(v, 8), 1), I16(0));
    }
    static I16 signed_code(I16 biased) { return (biased + I16(1)) >> 1; }
    I16 across, down;
};

/// Whether textures are beyond what caches near by keep, so that prefetching pays; they are taken
/// for squares.
bool are_large(const FetchCtx& ctx) {
    constexpr std::int64_t kFewBytes = 4 << 20;
    return ctx.count * (std::int64_t{ctx.pitch} * ctx.pitch / 4) > kFewBytes;
}

/// Brings what a packet is about to read closer, many lines at once: one fragment in eight, both
/// rows, touches nearly all lines of texels about as large as pixels. Always inline: GCC 12 drops
/// calls of a function that does nothing else.
[[gnu::always_inline]] inline void prefetch_texels(const Packet& packet, const FetchCtx& ctx) {
    constexpr int kStep = 8;
    const std::ptrdiff_t pitch = ctx.pitch;
    const std::int32_t* const texel = packet.texel;
    const int count = packet.count;
    for (int t = 0; t < ctx.count; ++t) {
        const std::uint8_t *const upper = ctx.texels[t], *const lower = upper + pitch;
        for (int i = 0; i < count; i += kStep) {
            __builtin_prefetch(upper + texel[i]);
            __builtin_prefetch(lower + texel[i]);
        }
    }
}

/// Four vectors of texels as their channels.
struct Channels {
    explicit Channels(const I16 (&v)[4]) {
        const I16 rg01 = zip_lo32(v[0], v[1]), rg23 = zip_lo32(v[2], v[3]);
        const I16 ba01 = zip_hi32(v[0], v[1]), ba23 = zip_hi32(v[2], v[3]);
        r = zip_lo64(rg01, rg23);
        g = zip_hi64(rg01, rg23);
        b = zip_lo64(ba01, ba23);
        a = zip_hi64(ba01, ba23);
    }
    I16 r, g, b, a;
};

template <class Filter>
inline void put_codes(std::int16_t* out, const Channels& v, unsigned is_signed) {
    const auto put = [&](auto code) {
        store(out, code(v.r));
        store(out + kPacketSize, code(v.g));
        store(out + 2 * kPacketSize, code(v.b));
        store(out + 3 * kPacketSize, code(v.a));
    };
    if (is_signed == 0) return put([](I16 x) { return Filter::unsigned_code(x); });
    if (is_signed == FetchCtx::kAllSigned) return put([](I16 x) { return Filter::signed_code(x); });
    const auto put_channel = [&](unsigned c, I16 x) {
        store(out + c * kPacketSize,
              (is_signed >> c & 1U) != 0 ? Filter::signed_code(x) : Filter::unsigned_code(x));
    };
    put_channel(0, v.r);
    put_channel(1, v.g);
    put_channel(2, v.b);
    put_channel(3, v.a);
}

/// 64-bit loads of texel pairs, weighted where they are, transposed to planes. Vector k of four
/// holds fragments 8 p + 2 k and 8 p + 2 k + 1 in lane p; what comes out is in order. Weights and
/// addresses serve all textures, whose loads are in flight together.
template <class Filter, int Textures>
void fetch(Packet& packet, const FetchCtx& ctx) {
    const FetchPatterns patterns;
    std::uintptr_t row[2 * Textures];
    std::int16_t* planes[Textures];
    unsigned is_signed[Textures];
    for (int t = 0; t < Textures; ++t) {
        row[2 * t] = reinterpret_cast<std::uintptr_t>(ctx.texels[t]);
        row[2 * t + 1] = row[2 * t] + static_cast<std::uintptr_t>(ctx.pitch);
        planes[t] = packet.planes + ctx.plane[t] * kPacketSize;
        is_signed[t] = ctx.is_signed[t];
    }
    const std::int32_t* const texel = packet.texel;
    const std::int16_t *weight_x = packet.weight_x, *weight_y = packet.weight_y;
    const int n = group_count(packet);
    for (int i = 0; i < n; i += kLanes) {
        const FilterWeights weights = Filter::weights(load(weight_x + i), load(weight_y + i));
        I16 filtered[Textures][4];
#pragma GCC unroll 4
        for (int k = 0; k < 4; ++k) {
            const Filter filter(weights, patterns.word_pair[k]);
            I16 pairs[2 * Textures];
            load_pairs(row, texel + i + 2 * k, pairs);
#pragma GCC unroll 4
            for (int t = 0; t < Textures; ++t) {
                filtered[t][k] = filter(shuffle_bytes(pairs[2 * t], patterns.interleave),
                                        shuffle_bytes(pairs[2 * t + 1], patterns.interleave));
            }
        }
#pragma GCC unroll 4
        for (int t = 0; t < Textures; ++t)
            put_codes<Filter>(planes[t] + i, Channels(filtered[t]), is_signed[t]);
    }
}

template <class Filter>
void fetch(Packet& packet, const FetchCtx& ctx) {
    if (are_large(ctx)) prefetch_texels(packet, ctx);
    switch (ctx.count) {
        case 1:
            return fetch<Filter, 1>(packet, ctx);
        case 2:
            return fetch<Filter, 2>(packet, ctx);
        case 3:
            return fetch<Filter, 3>(packet, ctx);
        default:
            return fetch<Filter, 4>(packet, ctx);
    }
}
void fetch_nine_bit(Packet& packet, const FetchCtx& ctx) noexcept {
    fetch<FilterNineBit>(packet, ctx);
}
void fetch_wide(Packet& packet, const FetchCtx& ctx) noexcept {
    fetch<FilterWide>(packet, ctx);
}
