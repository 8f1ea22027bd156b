/// x / 2 with ties to the even neighbour.
Int halve_to_even(Int x) {
    const Int low = x >> 1;
    return (x & 1) != 0 && (low & 1) != 0 ? low + 1 : low;
}

Int mapped(std::uint8_t mapping, Int e, Int one, Int half) {
    const Int positive = std::max<Int>(0, e);
    switch (mapping) {
        case 0:
            return positive;
        case 1:
            return one - std::min(positive, one);
        case 2:
            return 2 * (positive - half);
        case 3:
            return -2 * (positive - half);
        case 4:
            return positive - half;
        case 5:
            return half - positive;
        case 6:
            return e;
        case 7:
            return -e;
        case Operand::kIdealHalf + 2:
            return 2 * positive - one;
        case Operand::kIdealHalf + 3:
            return one - 2 * positive;
        case Operand::kIdealHalf + 4:
            return halve_to_even(2 * positive - one);
        default:
            return halve_to_even(one - 2 * positive);
    }
}

struct NineBit {
    static constexpr Int kOne = 255;
    static constexpr Int kHalf = 128;
    static constexpr Int kLow = -256;
    static constexpr float kDimRound = 0.02F;

    static Int map(std::uint8_t mapping, Int e) { return mapped(mapping, e, kOne, kHalf); }
    static Int quotient(Int x, Rounding rounding) {
        switch (rounding) {
            case Rounding::nearest:
                return divide_to_nearest(x, kOne);
            case Rounding::truncate:
                return x / kOne;
            case Rounding::shift8:
                return x >> 8;
        }
        return 0;
    }
    static Int clamp_output(Int x, bool /*wide*/) { return clamp(x, -kOne, kOne); }
    static Int final_identity(Int e) { return std::max<Int>(0, e); }
    static Int color_sum(Int a, Int b) { return a + b; }

    static Int filter(Int top_left, Int top_right, Int bottom_left, Int bottom_right, Int wx,
                      Int wy) {
        const Int top = shift_half_up((256 - wx) * top_left + wx * top_right, 8);
        const Int bottom = shift_half_up((256 - wx) * bottom_left + wx * bottom_right, 8);
        return shift_half_up((256 - wy) * top + wy * bottom, 8);
    }
    static Int texel_code(Int v, bool is_signed) { return is_signed ? 2 * (v - 128) : v; }
    static Int to_8_bits(Int v) { return v; }
    static Int to_16_bits(Int v) { return 257 * v; }
};

struct Wide {
    static constexpr Int kOne = 16384;
    static constexpr Int kHalf = 8192;
    static constexpr Int kLow = -32768;
    static constexpr Int kHigh = 32767;
    static constexpr float kDimRound = 0.5F;

    static Int map(std::uint8_t mapping, Int e) {
        return clamp(mapped(mapping, e, kOne, kHalf), kLow, kHigh);
    }
    static Int quotient(Int x, Rounding /*nearest*/) { return shift_half_up(x, 14); }
    static Int clamp_output(Int x, bool wide) {
        return wide ? clamp(x, kLow, kHigh) : clamp(x, -kOne, kOne);
    }
    static Int final_identity(Int e) { return clamp(e, 0, kOne); }
    static Int color_sum(Int a, Int b) { return std::min(a + b, kHigh); }

    static Int filter(Int top_left, Int top_right, Int bottom_left, Int bottom_right, Int wx,
                      Int wy) {
        const Int top = (256 - wx) * top_left + wx * top_right;
        const Int bottom = (256 - wx) * bottom_left + wx * bottom_right;
        return shift_half_up((256 - wy) * top + wy * bottom, 8);
    }
    static Int texel_code(Int v, bool is_signed) {
        return is_signed ? shift_half_up(v - 32768, 1) : (v + (v >> 8) + 2) >> 2;
    }
    static Int to_8_bits(Int v) { return shift_half_up(255 * v, 14); }
    static Int to_16_bits(Int v) { return shift_half_up(65535 * v, 14); }
};

template <class Model>
void encode(Packet& packet, const EncodeCtx& ctx) noexcept {
    constexpr auto one = static_cast<float>(Model::kOne);
    for (int i = 0; i < packet.count; ++i) {
        const float x = attribute(packet, ctx.attribute)[i] * one + 0.5F;
        plane(packet, ctx.plane)[i] = static_cast<std::int16_t>(minimum(maximum(x, 0.0F), one));
    }
}

template <class Model>
void fetch(Packet& packet, const FetchCtx& ctx) noexcept {
    for (int i = 0; i < packet.count; ++i) {
        for (int k = 0; k < 4 * ctx.count; ++k) {
            const int c = k % 4;
            const auto texel = [&](std::int32_t offset) {
                const auto byte = static_cast<std::int8_t>(ctx.texels[k / 4][offset + c]);
                return Int{127} - Int{byte};
            };
            const std::int32_t upper = packet.texel[i], lower = upper + ctx.pitch;
            const Int value =
                Model::filter(texel(upper), texel(upper + 4), texel(lower), texel(lower + 4),
                              packet.weight_x[i], packet.weight_y[i]);
            plane(packet, ctx.plane[k / 4] + c)[i] = static_cast<std::int16_t>(
                Model::texel_code(value, (ctx.is_signed[k / 4] >> c & 1) != 0));
        }
    }
}

Int word_at(const std::uint8_t* texels, std::ptrdiff_t offset) {
    std::int16_t word;
    std::memcpy(&word, texels + offset, sizeof word);
    return word;
}

void fetch_hilo(Packet& packet, const FetchHiloCtx& ctx) noexcept {
    for (int i = 0; i < packet.count; ++i) {
        const Int wx = packet.weight_x[i], wy = packet.weight_y[i];
        for (int c = 0; c < 2; ++c) {
            const auto row = [&](std::ptrdiff_t left) {
                const Int l = word_at(ctx.texels, left + 2 * c);
                const Int r = word_at(ctx.texels, left + 4 + 2 * c);
                return shift_half_up((256 - wx) * l + wx * r, 8);
            };
            const Int top = row(packet.texel[i]), bottom = row(packet.texel[i] + ctx.pitch);
            plane(packet, ctx.plane + c)[i] =
                static_cast<std::int16_t>(shift_half_up((256 - wy) * top + wy * bottom, 8));
        }
    }
}

void fetch_words(Packet& packet, const FetchWordsCtx& ctx) noexcept {
    for (int i = 0; i < packet.count; ++i) {
        const Int wx = packet.weight_x[i], wy = packet.weight_y[i];
        for (int c = 0; c < 4; ++c) {
            const auto row = [&](std::ptrdiff_t left) {
                return (256 - wx) * word_at(ctx.texels, left + 2 * c) +
                       wx * word_at(ctx.texels, left + 8 + 2 * c);
            };
            const Int top = row(packet.texel[i]), bottom = row(packet.texel[i] + ctx.pitch);
            const Int x = shift_half_up((256 - wy) * top + wy * bottom, 16);
            plane(packet, ctx.plane + c)[i] = static_cast<std::int16_t>((x + 32768 + 2) >> 2);
        }
    }
}

void prefetch_quartet(Packet& /*packet*/, const PrefetchQuartetCtx& /*ctx*/) noexcept {}

void fetch_quartet(Packet& packet, const FetchQuartetCtx& ctx) noexcept {
    for (int i = 0; i < packet.count; ++i) {
        const Int wx = packet.weight_x[i], wy = packet.weight_y[i];
        for (int k = 0; k < FetchQuartetCtx::kTextures; ++k) {
            for (int c = 0; c < 4 && ctx.plane[k] >= 0; ++c) {
                if ((ctx.channels[k] >> c & 1) == 0) continue;
                const auto row = [&](std::ptrdiff_t left) {
                    const std::ptrdiff_t channel = left + FetchQuartetCtx::kNextTexture * k + 2 * c;
                    return (256 - wx) * word_at(ctx.texels, channel) +
                           wx * word_at(ctx.texels, channel + FetchQuartetCtx::kTexelBytes);
                };
                const Int top = row(packet.texel[i]), bottom = row(packet.texel[i] + ctx.pitch);
                const Int x = shift_half_up((256 - wy) * top + wy * bottom, 16);
                plane(packet, ctx.plane[k] + c)[i] =
                    static_cast<std::int16_t>((x + 32768 + 2) >> 2);
            }
        }
    }
}

void look_up_table(Packet& packet, const LookUpTableCtx& ctx) noexcept {
    constexpr int kRight = 4, kBelow = 2;  // bytes
    for (int i = 0; i < packet.count; ++i) {
        const auto position = [&](const LookUpTableCtx::Axis& axis) {
            if (axis.plane < 0) return TexelPosition{0, 0};
            const float number = static_cast<float>(plane(packet, axis.plane)[i]) / 16384.0F;
            return texel_position((number * axis.scale + axis.offset) / axis.divisor, axis.size,
                                  AddressMode::clamp_to_edge, true, false);
        };
        const TexelPosition s = position(ctx.s), t = position(ctx.t);
        const auto row = [&](std::ptrdiff_t left) {
            return (256 - Int{s.weight}) * word_at(ctx.texels, left) +
                   Int{s.weight} * word_at(ctx.texels, left + kRight);
        };
        const std::ptrdiff_t left = std::ptrdiff_t{t.texel} * ctx.pitch + kRight * s.texel;
        const Int x = shift_half_up(
            (256 - Int{t.weight}) * row(left) + Int{t.weight} * row(left + kBelow), 16);
        for (const int out : ctx.out)
            if (out >= 0) plane(packet, out)[i] = static_cast<std::int16_t>((x + 32768 + 2) >> 2);
    }
}

/// One end of what a summed table is averaged over.
struct SumEnd {
    Int place;            ///< p
    std::int32_t sum[2];  ///< of the row and the one below
    float rest[2];        ///< r
};

SumEnd sum_end(const AverageTableCtx& ctx, float coordinate, std::ptrdiff_t row) {
    const float at = (coordinate * ctx.s.scale + ctx.s.offset) / ctx.s.divisor;
    const auto place =
        static_cast<Int>(std::floor(at * static_cast<float>(256 * ctx.s.size))) - 128;
    const Int inside = clamp(place, 0, 256 * (Int{ctx.s.size} - 1));
    const Int weight = inside & 255;
    SumEnd end{place, {}, {}};
    for (int k = 0; k < (ctx.t.plane < 0 ? 1 : 2); ++k) {
        const std::ptrdiff_t texel = row + k * std::ptrdiff_t{ctx.pitch} + 8 * (inside >> 8);
        const Int own = word_at(ctx.texels, texel), next = word_at(ctx.texels, texel + 2);
        std::memcpy(&end.sum[k], ctx.texels + texel + 4, sizeof end.sum[k]);
        const float within =
            static_cast<float>(weight) * static_cast<float>(512 * own + weight * (next - own));
        end.rest[k] = within * 0x1p-16F +
                      static_cast<float>(place - inside) * static_cast<float>(own) * 0x1p-7F;
    }
    return end;
}

/// What LookUpTableCtx makes of a summed table.
Int summed_word(const AverageTableCtx& ctx, TexelPosition s, TexelPosition t) {
    const auto row = [&](int k) {
        const std::ptrdiff_t texel = (t.texel + k) * std::ptrdiff_t{ctx.pitch} + 8 * s.texel;
        return (256 - Int{s.weight}) * word_at(ctx.texels, texel) +
               Int{s.weight} * word_at(ctx.texels, texel + 2);
    };
    const Int below = ctx.t.plane < 0 ? 0 : row(1);
    return shift_half_up((256 - Int{t.weight}) * row(0) + Int{t.weight} * below, 16);
}

void average_table(Packet& packet, const AverageTableCtx& ctx) noexcept {
    const std::int16_t* const codes = plane(packet, ctx.s.plane);
    const auto number = [&](int k, int i) {
        return static_cast<float>(plane(packet, k)[i]) / 16384.0F;
    };
    std::int16_t result[kPacketSize];
    for (int i = 0; i < packet.count; ++i) {
        const int left = i & ~1, upper = i & ~2;
        const int step = std::max(std::abs(codes[left + 1] - codes[left]),
                                  std::abs(codes[upper + 2] - codes[upper]));
        const float at = number(ctx.s.plane, i), half = static_cast<float>(step) * ctx.reach;
        TexelPosition row{0, 0};
        if (ctx.t.plane >= 0) {
            const float below = number(ctx.t.plane, i) * ctx.t.scale + ctx.t.offset;
            row = texel_position(below / ctx.t.divisor, ctx.t.size, AddressMode::clamp_to_edge,
                                 true, false);
        }
        const std::ptrdiff_t first = std::ptrdiff_t{row.texel} * ctx.pitch;
        const SumEnd low = sum_end(ctx, maximum(at - half, ctx.least), first),
                     high = sum_end(ctx, minimum(at + half, ctx.most), first);
        Int x = 0;
        if (high.place > low.place) {
            const auto area = [&](int k) {
                return static_cast<float>(high.sum[k] - low.sum[k]) + (high.rest[k] - low.rest[k]);
            };
            float n = area(0);
            if (ctx.t.plane >= 0)
                n = n + (area(1) - n) * (static_cast<float>(row.weight) * 0x1p-8F);
            const float mean = n * 128.0F / static_cast<float>(high.place - low.place);
            x = clamp(static_cast<Int>(std::floor(mean + 0.5F)), -32768, 32767);
        } else {
            const float place = (at * ctx.s.scale + ctx.s.offset) / ctx.s.divisor;
            x = summed_word(
                ctx, texel_position(place, ctx.s.size, AddressMode::clamp_to_edge, true, false),
                row);
        }
        result[i] = static_cast<std::int16_t>((x + 32768 + 2) >> 2);
    }
    for (const int out : ctx.out)
        if (out >= 0) std::copy_n(result, packet.count, plane(packet, out));
}

void blend_levels(Packet& packet, const BlendLevelsCtx& ctx) noexcept {
    for (int i = 0; i < packet.count; ++i) {
        const Int w = plane(packet, ctx.weight)[i] & 255;
        for (int c = 0; c < ctx.channels; ++c) {
            const Int a = plane(packet, ctx.a + c)[i], b = plane(packet, ctx.b + c)[i];
            const Int unit = (ctx.doubled >> c & 1) != 0 ? 2 : 1;
            const Int n = shift_half_up((256 - w) * (a / unit) + w * (b / unit), 8);
            plane(packet, ctx.out + c)[i] = static_cast<std::int16_t>(n * unit);
        }
    }
}

void hilo(Packet& packet, const HiloCtx& ctx) noexcept {
    for (int i = 0; i < packet.count; ++i) {
        for (int c = 0; c < 2; ++c) {
            const int x = plane(packet, ctx.plane + c)[i];
            attribute(packet, ctx.out + c)[i] = ctx.is_signed != 0
                                                    ? static_cast<float>(x) / 32768.0F
                                                    : static_cast<float>(x + 32768) / 65535.0F;
        }
    }
}
