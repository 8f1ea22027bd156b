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

/// Pixels of kLanes fragments, four bytes each: the first four of each eight, and the others.
struct PixelLanes {
    I16 low, high;
};

/// Of the first `used` fragments; the others are zeros.
inline PixelLanes get_pixels(const std::uint32_t* tile, const std::uint16_t* pixels, int used) {
    Pixels8 scattered{};
    for (int k = 0; k < used; ++k) {
        std::int16_t* const half = scattered.half[k / 4 % 2] + k / 8 * 8;
        __builtin_memcpy(half + k % 4 * 2, tile + pixels[k], 4);
    }
    return {load(scattered.half[0]), load(scattered.half[1])};
}
/// kLanes of them one after the other.
inline PixelLanes get_row(const std::uint32_t* from) {
    const auto* const words = reinterpret_cast<const std::int16_t*>(from);
    const I16 first = load(words), second = load(words + kLanes);
    return {even_lanes(first, second), odd_lanes(first, second)};
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

/// The bytes of pixels, channel by channel in 16-bit lanes.
struct ChannelBytes {
    alignas(64) std::uint8_t rg[2 * kLanes], ba[2 * kLanes];
};
constexpr ChannelBytes make_channel_bytes() {
    ChannelBytes bytes{};
    for (int i = 0; i < 2 * kLanes; ++i) {
        const int at = i % 16, byte = at % 8 / 2 * 4 + at / 8;
        bytes.rg[i] = static_cast<std::uint8_t>(at % 2 == 0 ? byte : 0x80);
        bytes.ba[i] = static_cast<std::uint8_t>(at % 2 == 0 ? byte + 2 : 0x80);
    }
    return bytes;
}
constexpr ChannelBytes kChannelBytes = make_channel_bytes();
inline void split_channels(const PixelLanes& pixels, I16 (&channel)[4]) {
    const I16 rg = load(reinterpret_cast<const std::int16_t*>(kChannelBytes.rg)),
              ba = load(reinterpret_cast<const std::int16_t*>(kChannelBytes.ba));
    const I16 low_rg = shuffle_bytes(pixels.low, rg), high_rg = shuffle_bytes(pixels.high, rg),
              low_ba = shuffle_bytes(pixels.low, ba), high_ba = shuffle_bytes(pixels.high, ba);
    channel[0] = zip_lo64(low_rg, high_rg);
    channel[1] = zip_hi64(low_rg, high_rg);
    channel[2] = zip_lo64(low_ba, high_ba);
    channel[3] = zip_hi64(low_ba, high_ba);
}

/// Any factors, from rows of what they may be.
template <BlendSum Sum>
class AnyFactors {
  public:
    explicit AnyFactors(const BlendCtx& ctx)
        : m_rows(ctx),
          m_turn_source(ctx.source.inverted != 0 ? 255 : 0),
          m_turn_destination(ctx.destination.inverted != 0 ? 255 : 0) {
        store(m_value[0], I16(0));
        for (int c = 0; c < 4; ++c) {
            store(m_value[kConstantRow + c],
                  I16(static_cast<std::int16_t>(ctx.constant[c] * 255.0F + 0.5F)));
        }
    }
    void operator()(const I16 (&s)[4], const I16 (&d)[4], I16 (&out)[4]) {
        for (int c = 0; c < 4; ++c) {
            store(m_value[kSourceRow + c], s[c]);
            store(m_value[kDestinationRow + c], d[c]);
        }
        for (int c = 0; c < 4; ++c) {
            out[c] = blend_bytes<Sum>(s[c], load(m_value[m_rows.source[c]]) ^ m_turn_source, d[c],
                                      load(m_value[m_rows.destination[c]]) ^ m_turn_destination);
        }
    }

  private:
    BlendRows m_rows;
    I16 m_turn_source, m_turn_destination;
    alignas(64) std::int16_t m_value[kBlendRows][kLanes];
};

/// s a + d (1 - a): the two products are at most 255^2 together.
struct SourceAlpha {
    void operator()(const I16 (&s)[4], const I16 (&d)[4], I16 (&out)[4]) const {
        const I16 a = s[3], rest = I16(255) - a;
        for (int c = 0; c < 4; ++c) out[c] = quotient_255(s[c] * a + I16(128) + d[c] * rest);
    }
    static bool are_factors_of(const BlendCtx& ctx) {
        return ctx.source.operand == BlendOperand::source_alpha && ctx.source.inverted == 0 &&
               ctx.destination.operand == BlendOperand::source_alpha &&
               ctx.destination.inverted != 0;
    }
};

template <class Model, class Factors>
void blend_rgba8_by(const Packet& packet, const BlendCtx& ctx, Factors blend) {
    const std::int16_t* plane[4];
    for (int c = 0; c < 4; ++c) plane[c] = packet.planes + ctx.plane[c] * kPacketSize;
    auto* const tile = static_cast<std::uint32_t*>(ctx.tile);
    for (int i = 0; i < packet.count; i += kLanes) {
        const std::uint16_t* const pixels = packet.pixels + i;
        const int used = packet.count - i < kLanes ? packet.count - i : kLanes;
        const bool in_a_row = used == kLanes && are_consecutive(pixels);
        I16 s[4], d[4], out[4];
        split_channels(in_a_row ? get_row(tile + pixels[0]) : get_pixels(tile, pixels, used), d);
        for (int c = 0; c < 4; ++c) s[c] = Model::to_u8(load(plane[c] + i));
        blend(s, d, out);
        const I16 rg = out[0] | (out[1] << 8), ba = out[2] | (out[3] << 8);
        const I16 low = zip_lo16(rg, ba), high = zip_hi16(rg, ba);
        if (in_a_row) {
            put_row(low, high, tile + pixels[0]);
        } else {
            put_pixels(low, high, pixels, used, tile);
        }
    }
}

template <class Model, BlendSum Sum>
void blend_rgba8(const Packet& packet, const BlendCtx& ctx) {
    if (Sum == BlendSum::add && SourceAlpha::are_factors_of(ctx)) {
        return blend_rgba8_by<Model>(packet, ctx, SourceAlpha());
    }
    blend_rgba8_by<Model>(packet, ctx, AnyFactors<Sum>(ctx));
}

/// Channels of the wider frames, one at a time.
struct BlendWords {
    using Channel = std::uint16_t;
    using Value = std::uint32_t;
    static constexpr Value kOne = 65535;
    template <class Model>
    static Value source(std::int16_t v) {
        return Model::to_u16(v);
    }
    static Value constant(float x) { return static_cast<Value>(x * 65535.0F + 0.5F); }
    static Value add(Value a, Value b) {
        const Value rest = kOne * kOne - a;
        return rounded(a + (b < rest ? b : rest));
    }
    static Value subtract(Value a, Value b) { return rounded(a > b ? a - b : 0); }
    /// p / 65535 to nearest, p up to 65535^2. With p = 65535 q + r, |r| <= 32767, the upper half of
    /// t = p + 32768 = 65536 q - q + r + 32768 is q or q - 1, so that t plus it is 65536 q and
    /// something within 0 .. 65535.
    static Value rounded(Value p) {
        const Value t = p + 32768;
        return (t + (t >> 16)) >> 16;
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
    static Value add(Value a, Value b) { return clamped(a + b); }
    static Value subtract(Value a, Value b) { return clamped(a - b); }
    static Value clamped(Value p) {
        const Value q = p > 0.0F ? p : 0.0F;
        return q < 1.0F ? q : 1.0F;
    }
};

template <class Frame, BlendSum Sum>
typename Frame::Value blend_channel(typename Frame::Value s, typename Frame::Value fs,
                                    typename Frame::Value d, typename Frame::Value fd) {
    if constexpr (Sum == BlendSum::add) {
        return Frame::add(s * fs, d * fd);
    } else if constexpr (Sum == BlendSum::subtract) {
        return Frame::subtract(s * fs, d * fd);
    } else if constexpr (Sum == BlendSum::reverse_subtract) {
        return Frame::subtract(d * fd, s * fs);
    } else if constexpr (Sum == BlendSum::min) {
        return s < d ? s : d;
    } else {
        return s > d ? s : d;
    }
}

/// A group of fragments at a time, so that the arithmetic runs over rows.
template <class Model, class Frame, BlendSum Sum>
void blend_channels(const Packet& packet, const BlendCtx& ctx) {
    using Value = typename Frame::Value;
    using Channel = typename Frame::Channel;
    constexpr int kGroup = kFragmentGroup;
    const BlendRows rows(ctx);
    alignas(64) Value value[kBlendRows][kGroup] = {};
    alignas(64) Value factor[2][kGroup], out[4][kGroup];
    for (int c = 0; c < 4; ++c) {
        for (Value& x : value[kConstantRow + c]) x = Frame::constant(ctx.constant[c]);
    }
    const auto set_factor = [&](Value* to, int row, bool inverted) {
        const Value* const from = value[row];
        for (int i = 0; i < kGroup; ++i) to[i] = inverted ? Frame::kOne - from[i] : from[i];
    };
    auto* const tile = static_cast<Channel*>(ctx.tile);
    for (int first = 0; first < packet.count; first += kGroup) {
        const int used = packet.count - first < kGroup ? packet.count - first : kGroup;
        const std::uint16_t* const pixels = packet.pixels + first;
        for (int c = 0; c < 4; ++c) {
            const std::int16_t* const plane = packet.planes + ctx.plane[c] * kPacketSize + first;
            Value* const source = value[kSourceRow + c];
            for (int i = 0; i < kGroup; ++i) source[i] = Frame::template source<Model>(plane[i]);
            Value* const destination = value[kDestinationRow + c];
            for (int i = 0; i < used; ++i) {
                destination[i] = static_cast<Value>(tile[4 * pixels[i] + c]);
            }
        }
        for (int c = 0; c < 4; ++c) {
            set_factor(factor[0], rows.source[c], ctx.source.inverted != 0);
            set_factor(factor[1], rows.destination[c], ctx.destination.inverted != 0);
            const Value *const s = value[kSourceRow + c], *const d = value[kDestinationRow + c];
            for (int i = 0; i < kGroup; ++i) {
                out[c][i] = blend_channel<Frame, Sum>(s[i], factor[0][i], d[i], factor[1][i]);
            }
        }
        for (int i = 0; i < used; ++i) {
            Channel* const pixel = tile + 4 * pixels[i];
            for (int c = 0; c < 4; ++c) pixel[c] = static_cast<Channel>(out[c][i]);
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
