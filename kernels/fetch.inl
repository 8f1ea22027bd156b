/// One texture coordinate to a texel and a weight, both ways of an axis alike.
struct AxisAddress {
    I32 texel;   ///< 0 .. size - 1
    I32 weight;  ///< of its neighbour, 0 .. 255
};

/// `whole` is the coordinate of the far side, `steps` how many 1/256 texels 1 is.
template <AddressMode Mode, bool Linear>
inline AxisAddress axis_address(F32 coordinate, std::int32_t size, F32 whole, F32 steps) {
    const I32 last(size - 1), zero(0);
    const F32 one(1.0F), nought(0.0F);
    F32 f = coordinate;
    if constexpr (Mode == AddressMode::repeat) f = coordinate - ::xsimd::floor(coordinate);
    if constexpr (Mode == AddressMode::mirrored_repeat) {
        f = coordinate - F32(2.0F) * ::xsimd::floor(coordinate * F32(0.5F));
        f = ::xsimd::select(f > one, F32(2.0F) - f, f);
    }
    I32 fixed;
    if constexpr (Mode == AddressMode::clamp_to_border) {
        fixed = truncate(::xsimd::floor(min(max(f, nought - one), whole + one) * steps));
    } else {
        fixed = truncate(min(max(f, nought), whole) * steps);
    }
    fixed = fixed - I32(Linear ? 128 : 0);
    AxisAddress a{fixed >> 8, Linear ? (fixed & I32(255)) : zero};
    if constexpr (Mode == AddressMode::repeat) {
        a.texel = a.texel + ((a.texel >> 31) & I32(size));
        a.texel = ::xsimd::select(a.texel > last, a.texel - I32(size), a.texel);
    } else if constexpr (Mode == AddressMode::clamp_to_border) {
        const I32 before(-1), behind(size);
        a.weight = ::xsimd::select(a.texel < before, zero, a.weight);
        a.weight = ::xsimd::select(a.texel > last, zero, a.weight);
        a.texel = min(max(a.texel, before), behind);
    } else {
        a.weight = ::xsimd::select(a.texel < zero, zero, a.weight);
        a.texel = min(max(a.texel, zero), last);
    }
    return a;
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
    for (int i = 0; i < n; i += kLanes32) {
        F32 s = load(u + i), t = load(v + i);
        if (projective) {
            const F32 divisor = load(q + i);
            s = divide(s, divisor);
            t = divide(t, divisor);
        }
        const AxisAddress x = axis_address<ModeS, Linear>(s, width, whole_x, steps_x);
        const AxisAddress y = axis_address<ModeT, Linear>(t, height, whole_y, steps_y);
        store(texel + i, y.texel * pitch + (x.texel << texel_shift));
        store_narrowed(weight_x + i, x.weight);
        store_narrowed(weight_y + i, y.weight);
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

/// The bilinear filter of the nine-bit model, for the fragments of one vector. A lerp
/// ((256 - w) x + w y + 128) >> 8 is x + ((w (y - x) + 128) >> 8), which is one rounding product.
struct FilterNineBit {
    FilterNineBit(I16 wx, I16 wy, I16 word_pair)
        : across(shuffle_bytes(wx << 7, word_pair)), down(shuffle_bytes(wy << 7, word_pair)) {}
    I16 row(I16 texels) const {
        const I16 left = texels & I16(255), right_minus_left = mul_add_bytes(texels, I16(0x01ff));
        return left + mul_round(right_minus_left, across);
    }
    I16 operator()(I16 top_texels, I16 bottom_texels) const {
        const I16 top = row(top_texels), bottom = row(bottom_texels);
        return top + mul_round(bottom - top, down);
    }
    static I16 unsigned_code(I16 v) { return v; }
    static I16 signed_code(I16 v) { return (v - I16(128)) << 1; }
    I16 across, down;
};

/// The same for the wide model, exact until the end.
struct FilterWide {
    FilterWide(I16 wx, I16 wy, I16 word_pair)
        : across(shuffle_bytes((I16(255) - wx) | (wx << 8), word_pair)) {
        const I16 bottom = shuffle_bytes(wy, word_pair);
        down = zip_lo16(I16(256) - bottom, bottom);  // and zip_hi16: words repeat
    }
    /// (256 - wx) * left + wx * right of value - 128, from -32768 to 32512. 256 does not fit a
    /// byte, so one more left is added by a second product.
    I16 row(I16 texels) const {
        const I16 biased = texels ^ I16(static_cast<std::int16_t>(0x8080));
        return mul_add_bytes(across, biased) + mul_add_bytes(I16(1), biased);
    }
    I16 operator()(I16 top_texels, I16 bottom_texels) const {
        const I16 top = row(top_texels), bottom = row(bottom_texels);
        const I32 lo = mul_add_pairs(zip_lo16(top, bottom), down) + I32(128);
        const I32 hi = mul_add_pairs(zip_hi16(top, bottom), down) + I32(128);
        return narrow(lo >> 8, hi >> 8);  // v - 32768
    }
    static I16 unsigned_code(I16 biased) {
        const I16 v = biased ^ I16(static_cast<std::int16_t>(0x8000));
        return average(shift_right_logical(v + shift_right_logical(v, 8), 1), I16(0));
    }
    static I16 signed_code(I16 biased) { return (biased + I16(1)) >> 1; }
    I16 across, down;
};

/// 64-bit loads of texel pairs, weighted where they are, transposed to planes. Vector k of four
/// holds fragments 8 p + 2 k and 8 p + 2 k + 1 in lane p; what comes out is in order. Weights and
/// offsets serve all textures, whose loads are in flight together.
template <class Filter>
void fetch(Packet& packet, const FetchCtx& ctx) {
    const FetchPatterns patterns;
    const std::ptrdiff_t pitch = ctx.pitch;
    const int textures = ctx.count;
    const std::uint8_t* texels[FetchCtx::kMaxTextures];
    std::int16_t* planes[FetchCtx::kMaxTextures];
    unsigned signed_channels[FetchCtx::kMaxTextures];
    for (int t = 0; t < textures; ++t) {
        texels[t] = ctx.texels[t];
        planes[t] = packet.planes + ctx.plane[t] * kPacketSize;
        signed_channels[t] = ctx.is_signed[t];
    }
    const std::int32_t* const texel = packet.texel;
    const std::int16_t *weight_x = packet.weight_x, *weight_y = packet.weight_y;
    const int n = group_count(packet);
    for (int i = 0; i < n; i += kLanes) {
        const I16 wx = load(weight_x + i), wy = load(weight_y + i);
        const Filter filter[4] = {
            {wx, wy, patterns.word_pair[0]},
            {wx, wy, patterns.word_pair[1]},
            {wx, wy, patterns.word_pair[2]},
            {wx, wy, patterns.word_pair[3]},
        };
        for (int t = 0; t < textures; ++t) {
            const std::uint8_t *const upper = texels[t], *const lower = texels[t] + pitch;
            const auto filtered = [&](int k) __attribute__((always_inline)) {
                const std::int32_t* at = texel + i + 2 * k;
                const I16 top = shuffle_bytes(load_pairs(upper, at), patterns.interleave);
                const I16 bottom = shuffle_bytes(load_pairs(lower, at), patterns.interleave);
                return filter[k](top, bottom);
            };
            // Four by name: as a loop they are left rolled up, and pass through memory.
            const I16 v0 = filtered(0), v1 = filtered(1), v2 = filtered(2), v3 = filtered(3);
            const I16 rg01 = zip_lo32(v0, v1), rg23 = zip_lo32(v2, v3);
            const I16 ba01 = zip_hi32(v0, v1), ba23 = zip_hi32(v2, v3);
            const I16 r = zip_lo64(rg01, rg23), g = zip_hi64(rg01, rg23);
            const I16 b = zip_lo64(ba01, ba23), a = zip_hi64(ba01, ba23);
            const auto put = [&](auto code) {
                std::int16_t* const out = planes[t] + i;
                store(out, code(r));
                store(out + kPacketSize, code(g));
                store(out + 2 * kPacketSize, code(b));
                store(out + 3 * kPacketSize, code(a));
            };
            const unsigned channels = signed_channels[t];
            if (channels == 0) {
                put([](I16 v) { return Filter::unsigned_code(v); });
            } else if (channels == FetchCtx::kAllSigned) {
                put([](I16 v) { return Filter::signed_code(v); });
            } else {
                const auto put_channel = [&](int c, I16 v) {
                    const bool is_signed = (channels >> c & 1U) != 0;
                    store(planes[t] + i + c * kPacketSize,
                          is_signed ? Filter::signed_code(v) : Filter::unsigned_code(v));
                };
                put_channel(0, r);
                put_channel(1, g);
                put_channel(2, b);
                put_channel(3, a);
            }
        }
    }
}
void fetch_nine_bit(Packet& packet, const FetchCtx& ctx) noexcept {
    fetch<FilterNineBit>(packet, ctx);
}
void fetch_wide(Packet& packet, const FetchCtx& ctx) noexcept {
    fetch<FilterWide>(packet, ctx);
}
