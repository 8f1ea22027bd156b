/// One texture coordinate to a texel and a weight, both ways of an axis alike.
struct AxisAddress {
    I32 texel;   ///< 0 .. size - 1
    I32 weight;  ///< of its neighbour, 0 .. 255
};

template <AddressMode Mode, bool Linear>
inline AxisAddress axis_address(F32 coordinate, std::int32_t size) {
    const I32 last(size - 1), zero(0);
    F32 f = coordinate;
    if constexpr (Mode == AddressMode::repeat) f = coordinate - ::xsimd::floor(coordinate);
    f = min(max(f, F32(0.0F)), F32(1.0F));
    const I32 fixed = truncate(f * F32(static_cast<float>(256 * size))) - I32(Linear ? 128 : 0);
    AxisAddress a{fixed >> 8, Linear ? (fixed & I32(255)) : zero};
    if constexpr (Mode == AddressMode::repeat) {
        a.texel = a.texel + ((a.texel >> 31) & I32(size));
        a.texel = ::xsimd::select(a.texel > last, a.texel - I32(size), a.texel);
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
    const std::int32_t width = ctx.width, height = ctx.height;
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
        const AxisAddress x = axis_address<ModeS, Linear>(s, width);
        const AxisAddress y = axis_address<ModeT, Linear>(t, height);
        store(texel + i, y.texel * pitch + (x.texel << 2));
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

void address(Packet& packet, const AddressCtx& ctx) noexcept {
    constexpr AddressMode kRepeat = AddressMode::repeat, kClamp = AddressMode::clamp_to_edge;
    if (ctx.mode_s == kRepeat) {
        if (ctx.mode_t == kRepeat) return addresses<kRepeat, kRepeat>(packet, ctx);
        return addresses<kRepeat, kClamp>(packet, ctx);
    }
    if (ctx.mode_t == kRepeat) return addresses<kClamp, kRepeat>(packet, ctx);
    return addresses<kClamp, kClamp>(packet, ctx);
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

/// (256 - wx) * left + wx * right of two rows of texels that are stored as value - 128: exact, from
/// -32768 to 32512. 256 does not fit a byte, so one more left is added by a second product.
I16 lerp_row(I16 texels, I16 weight_bytes) {
    return mul_add_bytes(weight_bytes, texels) + mul_add_bytes(I16(1), texels);
}

/// Vertical lerp and number format of the nine-bit model.
struct FetchNineBit {
    static I16 combine(I16 top, I16 bottom, I16 weight_top, I16 weight_bottom) {
        // 0x8080: back from value - 128 in 1/256, plus one half.
        const I16 bias(static_cast<std::int16_t>(0x8080));
        const I16 t = shift_right_logical(top + bias, 8), b = shift_right_logical(bottom + bias, 8);
        return shift_right_logical(t * weight_top + b * weight_bottom + I16(128), 8);
    }
};

struct FetchWide {
    static I16 combine(I16 top, I16 bottom, I16 weight_top, I16 weight_bottom) {
        const I32 lo = mul_add_pairs(zip_lo16(top, bottom), zip_lo16(weight_top, weight_bottom));
        const I32 hi = mul_add_pairs(zip_hi16(top, bottom), zip_hi16(weight_top, weight_bottom));
        const I16 v = narrow((lo + I32(128)) >> 8, (hi + I32(128)) >> 8) ^
                      I16(static_cast<std::int16_t>(0x8000));
        const I16 x = v + shift_right_logical(v, 8);
        return shift_right_logical(shift_right_logical(x, 1) + I16(1), 1);
    }
};

/// 64-bit loads of texel pairs, weighted where they are, transposed to planes. Vector k of four
/// holds fragments 8 p + 2 k and 8 p + 2 k + 1 in lane p; what comes out is in order. Weights and
/// offsets serve all textures, whose loads are in flight together.
template <class Model>
void fetch(Packet& packet, const FetchCtx& ctx) {
    const FetchPatterns patterns;
    const std::ptrdiff_t pitch = ctx.pitch;
    const int textures = ctx.count;
    const std::int8_t* texels[FetchCtx::kMaxTextures];
    std::int16_t* planes[FetchCtx::kMaxTextures];
    for (int t = 0; t < textures; ++t) {
        texels[t] = ctx.texels[t];
        planes[t] = packet.planes + ctx.plane[t] * kPacketSize;
    }
    const std::int32_t* const texel = packet.texel;
    const std::int16_t *weight_x = packet.weight_x, *weight_y = packet.weight_y;
    const int n = group_count(packet);
    for (int i = 0; i < n; i += kLanes) {
        const I16 wx = load(weight_x + i), wy = load(weight_y + i);
        const I16 weight_bytes = (I16(255) - wx) | (wx << 8);
        I16 bytes[4], up[4], down[4];
        for (int k = 0; k < 4; ++k) {
            bytes[k] = shuffle_bytes(weight_bytes, patterns.word_pair[k]);
            down[k] = shuffle_bytes(wy, patterns.word_pair[k]);
            up[k] = I16(256) - down[k];
        }
        for (int t = 0; t < textures; ++t) {
            const std::int8_t *const upper = texels[t], *const lower = texels[t] + pitch;
            const auto filtered = [&](int k) __attribute__((always_inline)) {
                const std::int32_t* at = texel + i + 2 * k;
                const I16 top = shuffle_bytes(load_pairs(upper, at), patterns.interleave);
                const I16 bottom = shuffle_bytes(load_pairs(lower, at), patterns.interleave);
                return Model::combine(lerp_row(top, bytes[k]), lerp_row(bottom, bytes[k]), up[k],
                                      down[k]);
            };
            // Four by name: as a loop they are left rolled up, and pass through memory.
            const I16 v0 = filtered(0), v1 = filtered(1), v2 = filtered(2), v3 = filtered(3);
            const I16 rg01 = zip_lo32(v0, v1), rg23 = zip_lo32(v2, v3);
            const I16 ba01 = zip_hi32(v0, v1), ba23 = zip_hi32(v2, v3);
            std::int16_t* const out = planes[t] + i;
            store(out, zip_lo64(rg01, rg23));
            store(out + kPacketSize, zip_hi64(rg01, rg23));
            store(out + 2 * kPacketSize, zip_lo64(ba01, ba23));
            store(out + 3 * kPacketSize, zip_hi64(ba01, ba23));
        }
    }
}
void fetch_nine_bit(Packet& packet, const FetchCtx& ctx) noexcept {
    fetch<FetchNineBit>(packet, ctx);
}
void fetch_wide(Packet& packet, const FetchCtx& ctx) noexcept {
    fetch<FetchWide>(packet, ctx);
}
