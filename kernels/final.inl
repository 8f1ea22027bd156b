/// round(p / 255), exactly, from p + 128 with p in 0 .. 65407. With p = 255 q + r, |r| <= 127, the
/// numerator is 65536 q + 257 (r + 128) - q, and what follows 65536 q lies within 1 .. 65535.
I16 quotient_255(I16 p128) {
    return mul_high_unsigned(p128, I16(257));
}

/// Arithmetic of the final combiner, nine-bit model: all numbers are 0 .. 255, products 0 .. 65025.
template <Rounding R, bool RoundEach>
struct FinalNineBit {
    static constexpr bool kHasSum = false;
    static constexpr std::int16_t kOne = 255;
    /// What quotient() wants added to a product beforehand.
    static constexpr std::int16_t kExtra = R == Rounding::nearest    ? 128
                                           : R == Rounding::truncate ? 1
                                                                     : 0;
    static I16 quotient(I16 p) {
        if constexpr (R == Rounding::shift8) return shift_right_logical(p, 8);
        return quotient_255(p);
    }

    /// Clamps to 0, then x or 1 - x.
    struct Map {
        Map(bool inverted, bool /*is_sum*/) : turn(inverted ? kOne : 0) {}
        I16 operator()(I16 e) const { return max(e, I16(0)) ^ turn; }
        I16 turn;
    };
    static I16 sum(I16 a, I16 b) { return a + b; }
    static I16 product(I16 a, I16 b) { return quotient(a * b + I16(kExtra)); }
    static I16 lerp(I16 a, I16 b, I16 c, I16 d) {
        const I16 rest = a ^ I16(kOne);
        if constexpr (RoundEach) return product(a, b) + product(rest, c) + d;
        return quotient(a * b + (rest * c + I16(kExtra))) + d;
    }
};

/// The same with the colour sum, up to 510, as B, C or D.
template <Rounding R, bool RoundEach>
struct FinalNineBitSum : FinalNineBit<R, RoundEach> {
    using Base = FinalNineBit<R, RoundEach>;
    static constexpr bool kHasSum = true;
    static constexpr std::int16_t kOne = Base::kOne, kExtra = Base::kExtra;
    struct Map {
        Map(bool inverted, bool /*is_sum*/)
            : turn(inverted ? -1 : 0), drop(inverted ? std::int16_t{~kOne} : std::int16_t{0}) {}
        /// Inverted, 65535 - e minus 65280, saturated at 0.
        I16 operator()(I16 e) const {
            return subtract_saturating_unsigned(max(e, I16(0)) ^ turn, drop);
        }
        I16 turn, drop;
    };
    /// Up to 1 and beyond 1 apart, so that products fit; a result above 255 may saturate.
    static I16 lerp(I16 a, I16 b, I16 c, I16 d) {
        const I16 one(kOne), extra(kExtra), rest = a ^ one;
        const I16 low_b = min(b, one), low_c = min(c, one);
        const I16 ab = a * low_b + extra, beyond_ab = a * (b - low_b);
        const I16 cd = rest * low_c, beyond_cd = rest * (c - low_c);
        if constexpr (RoundEach) {
            return Base::quotient(add_saturating_unsigned(ab, beyond_ab)) +
                   Base::quotient(add_saturating_unsigned(cd + extra, beyond_cd)) + d;
        }
        return Base::quotient(add_saturating_unsigned(ab + cd, beyond_ab + beyond_cd)) + d;
    }
};

struct FinalWide {
    static constexpr bool kHasSum = false;
    static constexpr std::int16_t kOne = 16384;

    /// Clamps to 0 .. 1; then x or 1 - x.
    struct Map {
        Map(bool inverted, bool /*is_sum*/)
            : turn(inverted ? -1 : 0), offset(inverted ? kOne + 1 : 0) {}  // ~x + 1 + one = one - x
        I16 operator()(I16 e) const { return (min(max(e, I16(0)), I16(kOne)) ^ turn) + offset; }
        I16 turn, offset;
    };
    static I16 sum(I16 a, I16 b) { return ::xsimd::sadd(a, b); }
    static I16 product(I16 a, I16 b) { return mul_14_bits_positive(a, b); }
    static I16 lerp(I16 a, I16 b, I16 c, I16 d) {
        const I16 rest = I16(kOne) - a;
        const I32 half(8192);
        const I32 lo = mul_add_pairs(zip_lo16(a, rest), zip_lo16(b, c)) + half;
        const I32 hi = mul_add_pairs(zip_hi16(a, rest), zip_hi16(b, c)) + half;
        return ::xsimd::sadd(narrow(lo >> 14, hi >> 14), d);
    }
};

/// The same with the colour sum, up to 32767, as B, C or D.
struct FinalWideSum : FinalWide {
    static constexpr bool kHasSum = true;
    struct Map {
        Map(bool inverted, bool is_sum)
            : plain(inverted, is_sum), high(is_sum && !inverted ? std::int16_t{32767} : kOne) {}
        I16 operator()(I16 e) const {
            return (min(max(e, I16(0)), high) ^ plain.turn) + plain.offset;
        }
        FinalWide::Map plain;
        I16 high;
    };
    static I16 product(I16 a, I16 b) {
        const Wide::Value v = Wide::product(a, b);
        return narrow(v.lo, v.hi);
    }
};

/// One component of the pseudo registers.
struct PseudoRegisters {
    alignas(64) std::int16_t sum[kPacketSize], product[kPacketSize], zero[kPacketSize];
};

/// One component of an input, with its mapping.
template <class Model>
struct FinalSource {
    FinalSource(const Packet& packet, const Operand& operand, int component,
                const PseudoRegisters& pseudo)
        : map(operand.mapping == 1 && operand.plane[0] != FinalCtx::kZero,
              operand.plane[0] == FinalCtx::kColorSum) {
        switch (operand.plane[0]) {
            case FinalCtx::kColorSum:
                plane = pseudo.sum;
                break;
            case FinalCtx::kFinalProduct:
                plane = pseudo.product;
                break;
            case FinalCtx::kZero:
                plane = pseudo.zero;
                break;
            default:
                plane = packet.planes + operand.plane[component] * kPacketSize;
        }
    }
    I16 operator()(int i) const { return map(load(plane + i)); }
    const std::int16_t* plane;
    typename Model::Map map;
};

/// E * F where no other operand asks for it, with its mapping as a factor.
template <class Model>
struct FinalProduct {
    FinalProduct(const Packet& packet, const FinalCtx& ctx, const Operand& factor, int component,
                 const PseudoRegisters& pseudo)
        : e(packet, ctx.e, component, pseudo),
          f(packet, ctx.f, component, pseudo),
          map(factor.mapping == 1, false) {}
    I16 operator()(int i) const { return map(Model::product(e(i), f(i))); }
    FinalSource<Model> e, f;
    typename Model::Map map;
};

inline bool is_zero(const Operand& o) {
    return o.plane[0] == FinalCtx::kZero;
}
inline bool is_final_product(const Operand& o) {
    return o.plane[0] == FinalCtx::kFinalProduct;
}

/// What is left of A * B + (1 - A) * C + D where operands are 0: a product A * B, which is
/// (1 - A) * C with A complemented where B is 0, and D. Products that are not there round to 0 in
/// every way.
struct FinalTerms {
    explicit FinalTerms(const FinalCtx& ctx)
        : a(ctx.a),
          b(is_zero(ctx.b) ? ctx.c : ctx.b),
          are_few(ctx.uses_color_sum == 0 && (is_zero(ctx.b) || is_zero(ctx.c))),
          has_product(!is_zero(b)),
          has_d(!is_zero(ctx.d)),
          has_nested(is_final_product(b) && !is_final_product(a) && !is_final_product(ctx.d)) {
        if (is_zero(ctx.b)) a.mapping ^= 1;
    }
    Operand a, b;
    bool are_few;
    bool has_product, has_d;
    bool has_nested;  ///< E * F is a factor, and nothing else
};

/// A product and D, or one of them, of one component.
template <class Model>
void final_terms(const Packet& packet, const FinalCtx& ctx, const FinalTerms& terms, int component,
                 const PseudoRegisters& pseudo, int n, std::int16_t* out) {
    using Source = FinalSource<Model>;
    const auto write = [&](const auto& value) {
        for (int i = 0; i < n; i += kLanes) store(out + i, value(i));
    };
    const Source d(packet, ctx.d, component, pseudo);
    if (!terms.has_product) return write(d);
    const Source a(packet, terms.a, component, pseudo);
    const auto write_with = [&](const auto& b) {
        if (!terms.has_d) return write([&](int i) { return Model::product(a(i), b(i)); });
        const I16 one(Model::kOne);
        write([&](int i) { return min(Model::sum(Model::product(a(i), b(i)), d(i)), one); });
    };
    if (terms.has_nested) {
        write_with(FinalProduct<Model>(packet, ctx, terms.b, component, pseudo));
    } else {
        write_with(Source(packet, terms.b, component, pseudo));
    }
}

template <class Model>
void final_combiner(Packet& packet, const FinalCtx& ctx) {
    using Source = FinalSource<Model>;
    PseudoRegisters pseudo;
    const I16 one(Model::kOne);
    const int n = group_count(packet);
    const FinalTerms terms(ctx);
    const bool few = !Model::kHasSum && terms.are_few;
    const bool reads_zeros = few ? !terms.has_product && !terms.has_d
                                 : is_zero(ctx.b) || is_zero(ctx.c) || is_zero(ctx.d);
    if (reads_zeros)
        for (int i = 0; i < n; i += kLanes) store(pseudo.zero + i, I16(0));
    for (int k = 0; k < 3; ++k) {
        std::int16_t* const out = packet.planes + ctx.out[k] * kPacketSize;
        if constexpr (Model::kHasSum) {
            const I16 limit(ctx.clamp_color_sum != 0 ? Model::kOne : std::int16_t{32767});
            const std::int16_t* const spare0 = packet.planes + ctx.spare0[k] * kPacketSize;
            const std::int16_t* const secondary = packet.planes + ctx.secondary[k] * kPacketSize;
            const typename Model::Map map0(ctx.complement_spare0 != 0, false),
                map1(ctx.complement_secondary != 0, false);
            for (int i = 0; i < n; i += kLanes) {
                store(pseudo.sum + i,
                      min(Model::sum(map0(load(spare0 + i)), map1(load(secondary + i))), limit));
            }
        }
        if (ctx.uses_final_product != 0 && !(few && terms.has_nested)) {
            const Source e(packet, ctx.e, k, pseudo), f(packet, ctx.f, k, pseudo);
            for (int i = 0; i < n; i += kLanes) {
                store(pseudo.product + i, Model::product(e(i), f(i)));
            }
        }
        if constexpr (!Model::kHasSum) {
            if (few) {
                final_terms<Model>(packet, ctx, terms, k, pseudo, n, out);
                continue;
            }
        }
        const Source a(packet, ctx.a, k, pseudo), b(packet, ctx.b, k, pseudo),
            c(packet, ctx.c, k, pseudo), d(packet, ctx.d, k, pseudo);
        for (int i = 0; i < n; i += kLanes) {
            store(out + i, min(Model::lerp(a(i), b(i), c(i), d(i)), one));
        }
    }
    const Source g(packet, ctx.g, 0, pseudo);
    std::int16_t* const alpha = packet.planes + ctx.out[3] * kPacketSize;
    for (int i = 0; i < n; i += kLanes) store(alpha + i, g(i));
}
template <Rounding R, bool RoundEach>
void final_nine_bit(Packet& packet, const FinalCtx& ctx) {
    if (ctx.uses_color_sum != 0) {
        final_combiner<FinalNineBitSum<R, RoundEach>>(packet, ctx);
    } else {
        final_combiner<FinalNineBit<R, RoundEach>>(packet, ctx);
    }
}
template <Rounding R>
void final_nine_bit(Packet& packet, const FinalCtx& ctx) {
    if (ctx.round_each != 0) return final_nine_bit<R, true>(packet, ctx);
    final_nine_bit<R, false>(packet, ctx);
}
void final_nine_bit(Packet& packet, const FinalCtx& ctx) noexcept {
    switch (ctx.rounding) {
        case Rounding::nearest:
            return final_nine_bit<Rounding::nearest>(packet, ctx);
        case Rounding::truncate:
            return final_nine_bit<Rounding::truncate>(packet, ctx);
        case Rounding::shift8:
            return final_nine_bit<Rounding::shift8>(packet, ctx);
    }
}
void final_wide(Packet& packet, const FinalCtx& ctx) noexcept {
    if (ctx.uses_color_sum != 0) return final_combiner<FinalWideSum>(packet, ctx);
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

/// Pixels of kLanes fragments, four bytes each: zipping keeps to the lanes, so fragments
/// 8 p .. 8 p + 3 are in the low half and the next four in the high one.
struct Pixels8 {
    alignas(64) std::int16_t half[2][kLanes];
};

/// kLanes of them one after the other.
inline void put_row(I16 low, I16 high, std::uint32_t* to) {
    auto* const words = reinterpret_cast<std::int16_t*>(to);
    store(words, zip_lanes_lo(low, high));
    store(words + kLanes, zip_lanes_hi(low, high));
}

/// The first `used` of them to the tile, wherever they lie: to look for runs costs more.
inline void put_pixels(I16 low_half, I16 high_half, const std::uint16_t* pixels, int used,
                       std::uint32_t* tile) {
    Pixels8 from;
    store(from.half[0], low_half);
    store(from.half[1], high_half);
    const auto put = [&](const std::int16_t* pixel, int k) {
        __builtin_memcpy(tile + pixels[k], pixel, 4);
    };
    int part = 0;
    for (; part + 8 <= used; part += 8) {
        const std::int16_t *low = from.half[0] + part, *high = from.half[1] + part;
        put(low, part);
        put(low + 2, part + 1);
        put(low + 4, part + 2);
        put(low + 6, part + 3);
        put(high, part + 4);
        put(high + 2, part + 5);
        put(high + 4, part + 6);
        put(high + 6, part + 7);
    }
    for (int k = part; k < used; ++k) {
        put(from.half[(k - part) / 4] + part + (k - part) % 4 * 2, k);
    }
}

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
        const I16 low = zip_lo16(rg, ba), high = zip_hi16(rg, ba);
        if (count - i >= kLanes && are_consecutive(pixels + i)) {
            put_row(low, high, tile + pixels[i]);
        } else {
            put_pixels(low, high, pixels + i, count - i < kLanes ? count - i : kLanes, tile);
        }
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
