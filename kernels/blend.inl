/// Values that a blend multiplies, one row per channel: zeros, fragments, pixels, the constant.
inline constexpr int kBlendRows = 13;
inline constexpr int kSourceRow = 1, kDestinationRow = 5, kConstantRow = 9;
int blend_row(const BlendFactorCtx& factor, int channel) {
    switch (factor.operand) {
        case BlendOperand::zero:
            return 0;
        case BlendOperand::source_color:
            return kSourceRow + channel;
        case BlendOperand::source_alpha:
            return kSourceRow + 3;
        case BlendOperand::destination_color:
            return kDestinationRow + channel;
        case BlendOperand::destination_alpha:
            return kDestinationRow + 3;
        case BlendOperand::constant_color:
            return kConstantRow + channel;
    }
    return 0;
}

/// Rows of a blend's factors, channel by channel.
struct BlendRows {
    explicit BlendRows(const BlendCtx& ctx) {
        for (int c = 0; c < 4; ++c) {
            source[c] = blend_row(ctx.source, c);
            destination[c] = blend_row(ctx.destination, c);
        }
    }
    int source[4], destination[4];
};

/// The first `used` pixels of fragments `pixels`, in the order of put_pixels; the others keep what
/// was there.
inline void get_pixels(const std::uint32_t* tile, const std::uint16_t* pixels, int used,
                       Pixels8& to) {
    for (int part = 0; part < used; part += 8) {
        std::int16_t *low = to.half[0] + part, *high = to.half[1] + part;
        if (part + 8 <= used && are_consecutive(pixels + part)) {
            __builtin_memcpy(low, tile + pixels[part], 16);
            __builtin_memcpy(high, tile + pixels[part] + 4, 16);
            continue;
        }
        const int rest = used - part < 8 ? used - part : 8;
        for (int k = 0; k < rest; ++k) {
            __builtin_memcpy((k < 4 ? low : high) + k % 4 * 2, tile + pixels[part + k], 4);
        }
    }
}

/// Bytes in 16-bit lanes. Products are 0 .. 65025 and rounded as the final combiner's are; a sum of
/// two saturates where it is beyond 1 anyhow, and a difference stops at 0.
template <BlendSum Sum>
I16 blend_bytes(I16 s, I16 fs, I16 d, I16 fd) {
    const I16 half(128), one(255);
    if constexpr (Sum == BlendSum::add) {
        return min(quotient_255(add_saturating_unsigned(s * fs + half, d * fd)), one);
    } else if constexpr (Sum == BlendSum::subtract) {
        return quotient_255(subtract_saturating_unsigned(s * fs, d * fd) + half);
    } else if constexpr (Sum == BlendSum::reverse_subtract) {
        return quotient_255(subtract_saturating_unsigned(d * fd, s * fs) + half);
    } else {
        return Sum == BlendSum::min ? min(s, d) : max(s, d);
    }
}

template <class Model, BlendSum Sum>
void blend_rgba8(const Packet& packet, const BlendCtx& ctx) {
    const BlendRows rows(ctx);
    const I16 turn_source(ctx.source.inverted != 0 ? 255 : 0),
        turn_destination(ctx.destination.inverted != 0 ? 255 : 0), byte(255);
    alignas(64) std::int16_t value[kBlendRows][kLanes];
    store(value[0], I16(0));
    for (int c = 0; c < 4; ++c) {
        store(value[kConstantRow + c],
              I16(static_cast<std::int16_t>(ctx.constant[c] * 255.0F + 0.5F)));
    }
    const std::int16_t* plane[4];
    for (int c = 0; c < 4; ++c) plane[c] = packet.planes + ctx.plane[c] * kPacketSize;
    auto* const tile = static_cast<std::uint32_t*>(ctx.tile);
    Pixels8 pixels{};
    for (int i = 0; i < packet.count; i += kLanes) {
        const int used = packet.count - i < kLanes ? packet.count - i : kLanes;
        get_pixels(tile, packet.pixels + i, used, pixels);
        const I32 low = ::xsimd::bitwise_cast<I32>(load(pixels.half[0])),
                  high = ::xsimd::bitwise_cast<I32>(load(pixels.half[1]));
        const I16 old_rg = narrow((low << 16) >> 16, (high << 16) >> 16),
                  old_ba = narrow(low >> 16, high >> 16);
        const I16 d[4] = {old_rg & byte, shift_right_logical(old_rg, 8), old_ba & byte,
                          shift_right_logical(old_ba, 8)};
        I16 s[4], out[4];
        for (int c = 0; c < 4; ++c) {
            s[c] = Model::to_u8(load(plane[c] + i));
            store(value[kSourceRow + c], s[c]);
            store(value[kDestinationRow + c], d[c]);
        }
        for (int c = 0; c < 4; ++c) {
            out[c] = blend_bytes<Sum>(s[c], load(value[rows.source[c]]) ^ turn_source, d[c],
                                      load(value[rows.destination[c]]) ^ turn_destination);
        }
        const I16 rg = out[0] | (out[1] << 8), ba = out[2] | (out[3] << 8);
        store(pixels.half[0], zip_lo16(rg, ba));
        store(pixels.half[1], zip_hi16(rg, ba));
        put_pixels(pixels, packet.pixels + i, used, tile);
    }
}

/// Channels of the wider frames, one at a time.
struct BlendWords {
    using Channel = std::uint16_t;
    using Value = std::int64_t;
    static constexpr Value kOne = 65535;
    template <class Model>
    static Value source(std::int16_t v) {
        return Model::to_u16(v);
    }
    static Value constant(float x) { return static_cast<Value>(x * 65535.0F + 0.5F); }
    /// To nearest; 65535 is odd, so that there are no ties.
    static Value result(Value p) {
        const Value q = p > 0 ? (p + kOne / 2) / kOne : 0;
        return q < kOne ? q : kOne;
    }
};
struct BlendFloats {
    using Channel = float;
    using Value = float;
    static constexpr Value kOne = 1.0F;
    template <class Model>
    static Value source(std::int16_t v) {
        return Model::to_float(v);
    }
    static Value constant(float x) { return x; }
    static Value result(Value p) {
        const Value q = p > 0.0F ? p : 0.0F;
        return q < 1.0F ? q : 1.0F;
    }
};

template <class Frame, BlendSum Sum>
typename Frame::Value blend_channel(typename Frame::Value s, typename Frame::Value fs,
                                    typename Frame::Value d, typename Frame::Value fd) {
    if constexpr (Sum == BlendSum::add) {
        return Frame::result(s * fs + d * fd);
    } else if constexpr (Sum == BlendSum::subtract) {
        return Frame::result(s * fs - d * fd);
    } else if constexpr (Sum == BlendSum::reverse_subtract) {
        return Frame::result(d * fd - s * fs);
    } else if constexpr (Sum == BlendSum::min) {
        return s < d ? s : d;
    } else {
        return s > d ? s : d;
    }
}

template <class Model, class Frame, BlendSum Sum>
void blend_channels(const Packet& packet, const BlendCtx& ctx) {
    using Value = typename Frame::Value;
    using Channel = typename Frame::Channel;
    const BlendRows rows(ctx);
    const bool invert_source = ctx.source.inverted != 0,
               invert_destination = ctx.destination.inverted != 0;
    Value value[kBlendRows] = {};
    for (int c = 0; c < 4; ++c) value[kConstantRow + c] = Frame::constant(ctx.constant[c]);
    const std::int16_t* plane[4];
    for (int c = 0; c < 4; ++c) plane[c] = packet.planes + ctx.plane[c] * kPacketSize;
    for (int i = 0; i < packet.count; ++i) {
        Channel* const pixel = static_cast<Channel*>(ctx.tile) + packet.pixels[i] * std::size_t{4};
        for (int c = 0; c < 4; ++c) {
            value[kSourceRow + c] = Frame::template source<Model>(plane[c][i]);
            value[kDestinationRow + c] = static_cast<Value>(pixel[c]);
        }
        for (int c = 0; c < 4; ++c) {
            const Value fs = value[rows.source[c]], fd = value[rows.destination[c]];
            pixel[c] = static_cast<Channel>(blend_channel<Frame, Sum>(
                value[kSourceRow + c], invert_source ? Frame::kOne - fs : fs,
                value[kDestinationRow + c], invert_destination ? Frame::kOne - fd : fd));
        }
    }
}

template <class Model, BlendSum Sum>
void blend(const Packet& packet, const BlendCtx& ctx) {
    switch (ctx.format) {
        case StoreFormat::rgba8:
            return blend_rgba8<Model, Sum>(packet, ctx);
        case StoreFormat::rgba16:
            return blend_channels<Model, BlendWords, Sum>(packet, ctx);
        case StoreFormat::rgba32f:
            return blend_channels<Model, BlendFloats, Sum>(packet, ctx);
    }
}
template <class Model>
void blend(const Packet& packet, const BlendCtx& ctx) {
    switch (ctx.sum) {
        case BlendSum::add:
            return blend<Model, BlendSum::add>(packet, ctx);
        case BlendSum::subtract:
            return blend<Model, BlendSum::subtract>(packet, ctx);
        case BlendSum::reverse_subtract:
            return blend<Model, BlendSum::reverse_subtract>(packet, ctx);
        case BlendSum::min:
            return blend<Model, BlendSum::min>(packet, ctx);
        case BlendSum::max:
            return blend<Model, BlendSum::max>(packet, ctx);
    }
}
void blend_nine_bit(Packet& packet, const BlendCtx& ctx) noexcept {
    blend<StoreNineBit>(packet, ctx);
}
void blend_wide(Packet& packet, const BlendCtx& ctx) noexcept {
    blend<StoreWide>(packet, ctx);
}
