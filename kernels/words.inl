std::int32_t word_at(const std::uint8_t* texel) {
    std::int16_t word;
    __builtin_memcpy(&word, texel, sizeof word);
    return word;
}

/// Byte patterns for lanes of two fragments' texel pairs, words h l h l of the left and the right
/// texel of one, then of the other.
struct HiloPatterns {
    I16 interleave;  ///< h h l l of each fragment
    I16 weight[4];   ///< word 2 k of a lane four times, then word 2 k + 1
    I16 channels;    ///< h l h l h l h l to h h h h l l l l

    HiloPatterns() {
        alignas(16) std::int8_t bytes[16];
        const auto words = [&](auto source) {
            for (int i = 0; i < 8; ++i) {
                bytes[2 * i] = static_cast<std::int8_t>(2 * source(i));
                bytes[2 * i + 1] = static_cast<std::int8_t>(2 * source(i) + 1);
            }
            return broadcast_lane(bytes);
        };
        interleave = words([](int i) { return (i & 4) + 2 * (i & 1) + (i >> 1 & 1); });
        channels = words([](int i) { return 2 * (i & 3) + (i >> 2); });
        for (int k = 0; k < 4; ++k) weight[k] = words([k](int i) { return 2 * k + (i >> 2); });
    }
};

/// Pairs 256 - w, w of words.
I16 weight_pairs(I16 w) {
    const I16 first = ::xsimd::bitwise_cast<I16>(I32(0xffff));
    return (w ^ first) + (first & I16(257));  // ~w + 257
}

/// Sums of products stay within 24 bits, rounded lerps within 16. Vector k of four holds fragments
/// 8 p + 2 k and 8 p + 2 k + 1 in lane p, as in fetch().
void fetch_hilo(Packet& packet, const FetchHiloCtx& ctx) noexcept {
    const HiloPatterns patterns;
    std::int16_t* const out = packet.planes + ctx.plane * kPacketSize;
    const std::uint8_t *const upper = ctx.texels, *const lower = ctx.texels + ctx.pitch;
    const std::int32_t* const texel = packet.texel;
    const std::int16_t *weight_x = packet.weight_x, *weight_y = packet.weight_y;
    const auto lerp = [](I16 pairs, I16 weights) {
        return (mul_add_pairs(pairs, weights) + I32(128)) >> 8;
    };
    const int n = group_count(packet);
    for (int i = 0; i < n; i += kLanes) {
        const I16 wx = load(weight_x + i), wy = load(weight_y + i);
        const auto filtered = [&](int k) __attribute__((always_inline)) {
            const I16 across = weight_pairs(shuffle_bytes(wx, patterns.weight[k]));
            const I16 down = weight_pairs(shuffle_bytes(wy, patterns.weight[k]));
            const std::int32_t* const at = texel + i + 2 * k;
            const auto row = [&](const std::uint8_t* base) {
                return lerp(shuffle_bytes(load_pairs(base, at), patterns.interleave), across);
            };
            const I32 column = (row(upper) & I32(0xffff)) | (row(lower) << 16);
            return lerp(::xsimd::bitwise_cast<I16>(column), down);
        };
        const I16 first = shuffle_bytes(narrow(filtered(0), filtered(1)), patterns.channels);
        const I16 second = shuffle_bytes(narrow(filtered(2), filtered(3)), patterns.channels);
        store(out + i, zip_lo64(first, second));
        store(out + kPacketSize + i, zip_hi64(first, second));
    }
}

/// -2^31 <= 2^16 * word, and 2^16 * 32767 + 2^15 < 2^31.
void fetch_words(Packet& packet, const FetchWordsCtx& ctx) noexcept {
    std::int16_t* const out = packet.planes + ctx.plane * kPacketSize;
    const auto mix = [](std::int32_t a, std::int32_t b, std::int32_t w) {
        return (256 - w) * a + w * b;
    };
    for (int i = 0; i < packet.count; ++i) {
        const std::uint8_t* const upper = ctx.texels + packet.texel[i];
        const std::uint8_t* const lower = upper + ctx.pitch;
        const std::int32_t wx = packet.weight_x[i], wy = packet.weight_y[i];
        for (int c = 0; c < 4; ++c) {
            const std::int32_t top = mix(word_at(upper + 2 * c), word_at(upper + 8 + 2 * c), wx);
            const std::int32_t bottom = mix(word_at(lower + 2 * c), word_at(lower + 8 + 2 * c), wx);
            const std::int32_t x = (mix(top, bottom, wy) + 32768) >> 16;
            out[i + c * kPacketSize] = static_cast<std::int16_t>((x + 32768 + 2) >> 2);
        }
    }
}

void hilo(Packet& packet, const HiloCtx& ctx) noexcept {
    const int n = group_count(packet);
    for (int c = 0; c < 2; ++c) {
        const auto* const from =
            reinterpret_cast<const std::uint16_t*>(packet.planes + (ctx.plane + c) * kPacketSize);
        float* const to = packet.attributes + (ctx.out + c) * kAttributeStride;
        for (int i = 0; i < n; i += kLanes32) {
            const I32 biased = load_widened(from + i) ^ I32(0x8000);  // x + 32768
            store(to + i, ctx.is_signed != 0 ? divide(to_float(biased - I32(0x8000)), F32(32768.0F))
                                             : divide(to_float(biased), F32(65535.0F)));
        }
    }
}
