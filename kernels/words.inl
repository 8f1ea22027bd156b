std::int32_t word_at(const std::uint8_t* texel) {
    std::int16_t word;
    __builtin_memcpy(&word, texel, sizeof word);
    return word;
}

/// Each lerp stays within 16 bits, its sum within 24.
void fetch_hilo(Packet& packet, const FetchHiloCtx& ctx) noexcept {
    std::int16_t* const out = packet.planes + ctx.plane * kPacketSize;
    const auto lerp = [](std::int32_t a, std::int32_t b, std::int32_t w) {
        return ((256 - w) * a + w * b + 128) >> 8;
    };
    for (int i = 0; i < packet.count; ++i) {
        const std::uint8_t* const upper = ctx.texels + packet.texel[i];
        const std::uint8_t* const lower = upper + ctx.pitch;
        const std::int32_t wx = packet.weight_x[i], wy = packet.weight_y[i];
        for (int c = 0; c < 2; ++c) {
            const std::int32_t top = lerp(word_at(upper + 2 * c), word_at(upper + 4 + 2 * c), wx);
            const std::int32_t bottom =
                lerp(word_at(lower + 2 * c), word_at(lower + 4 + 2 * c), wx);
            out[i + c * kPacketSize] = static_cast<std::int16_t>(lerp(top, bottom, wy));
        }
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
