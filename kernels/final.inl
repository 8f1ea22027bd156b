/// Arithmetic of the final combiner, nine-bit model.
struct FinalNineBit {
    static constexpr std::int16_t kOne = 255;
    static I16 identity(I16 e) { return max(e, I16(0)); }
    static I16 color_sum(I16 a, I16 b) { return identity(a) + identity(b); }
    static I16 product(I16 a, I16 b) { return product_255(a << 6, b << 1); }

    /// round((a b + (255 - a) c) / 255) + d = c + round(a (b - c) / 255) + d, since c is an
    /// integer.
    static I16 lerp(I16 a, I16 b, I16 c, I16 d) {
        return c + product_255(a << 6, (b - c) << 1) + d;
    }

    /// The same where the colour sum makes |b - c| as large as 510: in 32 bits, with a division
    /// that is exact to 2^-24, and no quotient comes nearer than 1/255 to an integer unless it is
    /// one.
    static I16 lerp_with_sum(I16 a, I16 b, I16 c, I16 d) {
        constexpr int kLift = 512;  // keeps what is truncated positive
        const I16 difference = b - c;
        const I16 low = a * difference, high = mul_high(a, difference);
        const auto quotient = [](I16 pair) {
            const I32 p = ::xsimd::bitwise_cast<I32>(pair) + I32(127 + 255 * kLift);
            return truncate(divide(to_float(p), F32(255.0F))) - I32(kLift);
        };
        return c + narrow(quotient(zip_lo16(low, high)), quotient(zip_hi16(low, high))) + d;
    }
};

struct FinalWide {
    static constexpr std::int16_t kOne = 16384;
    static I16 identity(I16 e) { return min(max(e, I16(0)), I16(kOne)); }
    static I16 color_sum(I16 a, I16 b) { return ::xsimd::sadd(identity(a), identity(b)); }
    static I16 product(I16 a, I16 b) {
        const Wide::Value v = Wide::product(a, b);
        return narrow(v.lo, v.hi);
    }
    static I16 lerp(I16 a, I16 b, I16 c, I16 d) {
        const I16 rest = I16(kOne) - a;
        const I32 half(8192);
        const I32 lo = mul_add_pairs(zip_lo16(a, rest), zip_lo16(b, c)) + half;
        const I32 hi = mul_add_pairs(zip_hi16(a, rest), zip_hi16(b, c)) + half;
        return ::xsimd::sadd(narrow(lo >> 14, hi >> 14), d);
    }
    static I16 lerp_with_sum(I16 a, I16 b, I16 c, I16 d) { return lerp(a, b, c, d); }
};

/// The pseudo registers of one packet; a plane each for r, g, b.
struct PseudoRegisters {
    alignas(64) std::int16_t sum[3][kPacketSize], product[3][kPacketSize];
};

/// An input with its mapping: clamp to 0 and, for an inverted input, to 1; then x or 1 - x.
template <class Model>
struct FinalSource {
    FinalSource(const Packet& packet, const Operand& operand, const PseudoRegisters& pseudo)
        : is_sum(operand.plane[0] == FinalCtx::kColorSum), turn(0), offset(0), high(Model::kOne) {
        const bool is_product = operand.plane[0] == FinalCtx::kFinalProduct;
        for (int c = 0; c < 3; ++c) {
            plane[c] = is_sum       ? pseudo.sum[c]
                       : is_product ? pseudo.product[c]
                                    : packet.planes + operand.plane[c] * kPacketSize;
        }
        if (operand.mapping == 1) {
            turn = I16(-1);
            offset = I16(Model::kOne + 1);  // ~x + 1 + one = one - x
        } else if (is_sum) {
            high = I16(32767);  // may exceed 1
        }
    }
    I16 operator()(int component, int i) const {
        return (min(max(load(plane[component] + i), I16(0)), high) ^ turn) + offset;
    }
    const std::int16_t* plane[3];
    bool is_sum;
    I16 turn, offset, high;
};

template <class Model, bool UsesSum>
void blend(Packet& packet, const FinalCtx& ctx, const PseudoRegisters& pseudo) {
    using Source = FinalSource<Model>;
    const Source a(packet, ctx.a, pseudo), b(packet, ctx.b, pseudo), c(packet, ctx.c, pseudo),
        d(packet, ctx.d, pseudo);
    const I16 one(Model::kOne);
    const int n = group_count(packet);
    for (int k = 0; k < 3; ++k) {
        std::int16_t* const out = packet.planes + ctx.out[k] * kPacketSize;
        for (int i = 0; i < n; i += kLanes) {
            const I16 va = a(k, i), vb = b(k, i), vc = c(k, i), vd = d(k, i);
            if constexpr (UsesSum) {
                store(out + i, min(Model::lerp_with_sum(va, vb, vc, vd), one));
            } else {
                store(out + i, min(Model::lerp(va, vb, vc, vd), one));
            }
        }
    }
}

template <class Model>
void final_combiner(Packet& packet, const FinalCtx& ctx) {
    PseudoRegisters pseudo{};
    const int n = group_count(packet);
    if (ctx.uses_color_sum != 0) {
        const I16 limit(ctx.clamp_color_sum != 0 ? Model::kOne : std::int16_t{32767});
        for (int k = 0; k < 3; ++k) {
            const std::int16_t* const spare0 = packet.planes + ctx.spare0[k] * kPacketSize;
            const std::int16_t* const secondary = packet.planes + ctx.secondary[k] * kPacketSize;
            for (int i = 0; i < n; i += kLanes) {
                store(pseudo.sum[k] + i,
                      min(Model::color_sum(load(spare0 + i), load(secondary + i)), limit));
            }
        }
    }
    if (ctx.uses_final_product != 0) {
        const FinalSource<Model> e(packet, ctx.e, pseudo), f(packet, ctx.f, pseudo);
        for (int k = 0; k < 3; ++k) {
            for (int i = 0; i < n; i += kLanes) {
                store(pseudo.product[k] + i, Model::product(e(k, i), f(k, i)));
            }
        }
    }
    if (ctx.uses_color_sum != 0) {
        blend<Model, true>(packet, ctx, pseudo);
    } else {
        blend<Model, false>(packet, ctx, pseudo);
    }
    const FinalSource<Model> g(packet, ctx.g, pseudo);
    std::int16_t* const alpha = packet.planes + ctx.out[3] * kPacketSize;
    for (int i = 0; i < n; i += kLanes) store(alpha + i, g(0, i));
}
void final_nine_bit(Packet& packet, const FinalCtx& ctx) noexcept {
    final_combiner<FinalNineBit>(packet, ctx);
}
void final_wide(Packet& packet, const FinalCtx& ctx) noexcept {
    final_combiner<FinalWide>(packet, ctx);
}

/// Codes to the channels of a frame.
struct StoreNineBit {
    static I16 to_u8(I16 v) { return v; }
    static std::uint16_t to_u16(std::int16_t v) { return static_cast<std::uint16_t>(v * 257); }
    static float to_float(std::int16_t v) { return static_cast<float>(v) / 255.0F; }
};
struct StoreWide {
    static I16 to_u8(I16 v) { return mul_round(v, I16(510)); }  // (255 v + 2^13) >> 14
    static std::uint16_t to_u16(std::int16_t v) {
        return static_cast<std::uint16_t>((v * 65535 + 8192) >> 14);
    }
    static float to_float(std::int16_t v) { return static_cast<float>(v) / 16384.0F; }
};

template <class Model>
void store_rgba8(const Packet& packet, const StoreCtx& ctx) {
    const std::int16_t* plane[4];
    for (int k = 0; k < 4; ++k) plane[k] = packet.planes + ctx.plane[k] * kPacketSize;
    auto* const tile = static_cast<std::uint32_t*>(ctx.tile);
    const std::uint16_t* const pixels = packet.pixels;
    const int count = packet.count;
    for (int i = 0; i < count; i += kLanes) {
        const I16 rg = Model::to_u8(load(plane[0] + i)) | (Model::to_u8(load(plane[1] + i)) << 8);
        const I16 ba = Model::to_u8(load(plane[2] + i)) | (Model::to_u8(load(plane[3] + i)) << 8);
        // Zipping keeps to the lanes: fragments 8 p .. 8 p + 3 are in the low half, the next four
        // in the high one.
        alignas(64) std::int16_t half[2][kLanes];
        store(half[0], zip_lo16(rg, ba));
        store(half[1], zip_hi16(rg, ba));
        const auto put = [&](const std::int16_t* from, int k) {
            __builtin_memcpy(tile + pixels[i + k], from, 4);
        };
        const int used = count - i < kLanes ? count - i : kLanes;
        int part = 0;
        for (; part + 8 <= used; part += 8) {
            const std::int16_t *low = half[0] + part, *high = half[1] + part;
            put(low, part);
            put(low + 2, part + 1);
            put(low + 4, part + 2);
            put(low + 6, part + 3);
            put(high, part + 4);
            put(high + 2, part + 5);
            put(high + 4, part + 6);
            put(high + 6, part + 7);
        }
        for (int k = part; k < used; ++k) put(half[(k - part) / 4] + part + (k - part) % 4 * 2, k);
    }
}

template <class Model>
void store_pixels(Packet& packet, const StoreCtx& ctx) {
    if (ctx.format == StoreFormat::rgba8) return store_rgba8<Model>(packet, ctx);
    for (int k = 0; k < 4; ++k) {
        const std::int16_t* const plane = packet.planes + ctx.plane[k] * kPacketSize;
        for (int i = 0; i < packet.count; ++i) {
            const std::size_t at =
                4 * static_cast<std::size_t>(packet.pixels[i]) + static_cast<std::size_t>(k);
            if (ctx.format == StoreFormat::rgba16) {
                static_cast<std::uint16_t*>(ctx.tile)[at] = Model::to_u16(plane[i]);
            } else {
                static_cast<float*>(ctx.tile)[at] = Model::to_float(plane[i]);
            }
        }
    }
}
void store_nine_bit(Packet& packet, const StoreCtx& ctx) noexcept {
    store_pixels<StoreNineBit>(packet, ctx);
}
void store_wide(Packet& packet, const StoreCtx& ctx) noexcept {
    store_pixels<StoreWide>(packet, ctx);
}
