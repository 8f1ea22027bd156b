/// round(a b / 255), exactly, for |a|, |b| <= 256, from 64 a and 2 b; a test tries all 513^2.
/// With p = a b, h = (p + 128) >> 8 and d = p - 256 h, a signed byte, the quotient is
/// h + round((h + d) / 255); 129 / 2^15 rounds like 1 / 255 does as far as h + d goes.
I16 product_255(I16 a64, I16 b2) {
    const I16 h = mul_round(a64, b2);
    const I16 d = a64 * (b2 + b2) >> 8;
    return h + mul_round(h + d, I16(129));
}

/// The same for a square or for two even numbers, from 72 a and 114 b: 513 * 72 * 114 / 2^30 is
/// 1/255 but for 3e-6, and the first rounding never leads the second one astray. No proof but that
/// a test tries all; of all scales only a handful pass.
I16 short_product_255(I16 a72, I16 b114) {
    return mul_round(mul_round(a72, b114), I16(513));
}

/// Any mapping of a register value e, times `scale`: max(e, low) * factor + offset, which may wrap
/// on the way.
template <std::int16_t One, std::int16_t Half>
struct FactorMap {
    FactorMap(std::uint8_t mapping, std::int16_t scale) {
        static constexpr std::int16_t kNumbers[8][3] = {
            {0, 1, 0},          // unsigned_identity
            {0, -1, One},       // unsigned_invert
            {0, 2, -2 * Half},  // expand
            {0, -2, 2 * Half},  // expand_negate
            {0, 1, -Half},      // half_bias
            {0, -1, Half},      // half_bias_negate
            {-32768, 1, 0},     // signed_identity
            {-32768, -1, 0},    // signed_negate
        };
        low = I16(kNumbers[mapping][0]);
        factor = I16(static_cast<std::int16_t>(scale * kNumbers[mapping][1]));
        offset = I16(static_cast<std::int16_t>(scale * kNumbers[mapping][2]));
    }
    I16 operator()(I16 e) const { return max(e, low) * factor + offset; }
    I16 low, factor, offset;
};

/// The nine-bit model: one 16-bit lane holds every intermediate value (|x| <= 4 * 1542).
struct NineBit {
    using Value = I16;
    static constexpr std::int16_t kOne = 255, kHalf = 128, kHighest = 255, kLowest = -255;

    using Map = FactorMap<kOne, kHalf>;
    static constexpr std::int16_t kScaleA = 64, kScaleB = 2;  // of the operands of product()
    static Value product(I16 a, I16 b) { return product_255(a, b); }
    static Value add(Value a, Value b) { return a + b; }
    static Value sum(Value p, Value q, Value r) { return p + q + r; }
    /// cd where the selector is above the limit.
    static Value mux(I16 selector, I16 limit, Value ab, Value cd) {
        return ::xsimd::select(selector > limit, cd, ab);
    }
    struct Output {
        explicit Output(const PortionCtx& ctx)
            : bias((ctx.bias_minus_half != 0 ? -kHalf : 0) +
                   (ctx.scale == OutputScale::half && ctx.halve_down == 0 ? 1 : 0)),
              left(ctx.scale == OutputScale::two    ? 1
                   : ctx.scale == OutputScale::four ? 2
                                                    : 0),
              right(ctx.scale == OutputScale::half ? 1 : 0) {}
        I16 operator()(Value x) const {
            if (!plain) x = ((x + I16(static_cast<std::int16_t>(bias))) << left) >> right;
            return min(max(x, I16(kLowest)), I16(kHighest));
        }
        int bias, left, right;
        bool plain = bias == 0 && left == 0 && right == 0;
    };
};

/// The same numbers, where the short product is exact.
struct NineBitShort : NineBit {
    static constexpr std::int16_t kScaleA = 72, kScaleB = 114;
    static Value product(I16 a, I16 b) { return short_product_255(a, b); }
};

/// The nine-bit model with the choices that are not the NV2A's. Rarely used, so not tuned.
template <Rounding R>
struct NineBitChoice : NineBit {
    static constexpr std::int16_t kScaleA = R == Rounding::shift8 ? 16 : 1, kScaleB = kScaleA;

    /// The result may be cut to even numbers: (x - 127.5) with ties to even is (x - 127) so cut.
    struct Map {
        Map(std::uint8_t mapping, std::int16_t scale) : plain(mapping & 7, scale), even(-1) {
            if (mapping < Operand::kIdealHalf) return;
            const bool negates = (mapping & 1) != 0, expands = (mapping & 7) < 4;
            const int offset = expands ? kOne : kHalf - (negates ? 0 : 1);
            plain.offset = I16(static_cast<std::int16_t>(scale * (negates ? offset : -offset)));
            if (!expands) even = I16(static_cast<std::int16_t>(-2 * scale));
        }
        I16 operator()(I16 e) const { return plain(e) & even; }
        NineBit::Map plain;
        I16 even;
    };
    static Value product(I16 a, I16 b) {
        if constexpr (R == Rounding::shift8) return mul_high(a, b);  // 16 a * 16 b / 2^16
        const I16 nearest = product_255(a << 6, b << 1);
        if constexpr (R == Rounding::nearest) return nearest;
        // Back by one where the remainder points away from zero.
        const I16 sign = (a ^ b) >> 15, remainder = a * b - nearest * I16(255);
        const I16 away = ((remainder ^ sign) - sign) >> 15;
        return nearest + ((away ^ sign) - sign);
    }
};

/// The wide model: 16-bit operands, 32-bit products and sums, so that nothing saturates early.
struct Wide {
    struct Value {
        I32 lo, hi;
    };
    static constexpr std::int16_t kOne = 16384, kHalf = 8192;

    /// Any mapping of a register value e: clamp(e, low, high) + offset, then doubled and negated
    /// where the masks say so. Saturating, since 2 (e - 1/2) and -e can leave the 16 bits.
    struct Map {
        Map(std::uint8_t mapping, std::int16_t /*scale*/) {
            constexpr std::int16_t kMax = 32767, kMin = -32768;
            static constexpr std::int16_t kNumbers[8][5] = {
                {0, kMax, 0, 0, 0},         // unsigned_identity
                {0, kOne, -kOne, 0, -1},    // unsigned_invert
                {0, kMax, -kHalf, -1, 0},   // expand
                {0, kMax, -kHalf, -1, -1},  // expand_negate
                {0, kMax, -kHalf, 0, 0},    // half_bias
                {0, kMax, -kHalf, 0, -1},   // half_bias_negate
                {kMin, kMax, 0, 0, 0},      // signed_identity
                {kMin, kMax, 0, 0, -1},     // signed_negate
            };
            low = I16(kNumbers[mapping][0]);
            high = I16(kNumbers[mapping][1]);
            offset = I16(kNumbers[mapping][2]);
            twice = I16(kNumbers[mapping][3]);
            negate = I16(kNumbers[mapping][4]);
        }
        I16 operator()(I16 e) const {
            const I16 shifted = min(max(e, low), high) + offset;
            const I16 turned = ::xsimd::ssub(shifted ^ negate, negate);
            return ::xsimd::sadd(turned, turned & twice);
        }
        I16 low, high, offset, twice, negate;
    };
    static constexpr std::int16_t kScaleA = 1, kScaleB = 1;
    static Value product(I16 a, I16 b) {
        using ::xsimd::bitwise_cast;
        const I16 low = a * b, high = mul_high(a, b);
        const I32 half(8192);
        return {(bitwise_cast<I32>(zip_lo16(low, high)) + half) >> 14,
                (bitwise_cast<I32>(zip_hi16(low, high)) + half) >> 14};
    }
    static Value add(Value a, Value b) { return {a.lo + b.lo, a.hi + b.hi}; }
    static Value sum(Value p, Value q, Value r) { return add(add(p, q), r); }
    static Value mux(I16 selector, I16 limit, Value ab, Value cd) {
        return {::xsimd::select(widen_lo(selector) > widen_lo(limit), cd.lo, ab.lo),
                ::xsimd::select(widen_hi(selector) > widen_hi(limit), cd.hi, ab.hi)};
    }
    struct Output {
        explicit Output(const PortionCtx& ctx)
            : bias((ctx.bias_minus_half != 0 ? -kHalf : 0) +
                   (ctx.scale == OutputScale::half ? 1 : 0)),
              left(ctx.scale == OutputScale::two    ? 1
                   : ctx.scale == OutputScale::four ? 2
                                                    : 0),
              right(ctx.scale == OutputScale::half ? 1 : 0),
              limit(ctx.wide != 0 ? 32767 : kOne) {}
        I16 operator()(Value x) const {
            if (!plain) {
                const I32 b(bias);
                x = {((x.lo + b) << left) >> right, ((x.hi + b) << left) >> right};
            }
            const I16 v = narrow(x.lo, x.hi);
            const I16 lowest(static_cast<std::int16_t>(limit == 32767 ? -32768 : -limit));
            return min(max(v, lowest), I16(limit));
        }
        int bias, left, right;
        bool plain = bias == 0 && left == 0 && right == 0;
        std::int16_t limit;
    };
};

/// The wide model where no operand is beyond 1: products and, saturating, sums fit 16 bits.
/// Whatever saturates on the way lies beyond the ends of the register in the end, too, but for two
/// products of 1 and half of 32768, which are mended where they come about.
struct WideBounded {
    using Value = I16;
    static constexpr std::int16_t kOne = 16384, kHalf = 8192;

    using Map = FactorMap<kOne, kHalf>;
    static constexpr std::int16_t kScaleA = 1, kScaleB = 1;
    static Value product(I16 a, I16 b) { return mul_14_bits(a, b); }
    static Value add(Value a, Value b) { return ::xsimd::sadd(a, b); }
    /// Two products of 1 make 32767 of what r may bring back below: one is added afterwards.
    static Value sum(Value p, Value q, Value r) {
        const I16 both = equal_words(min(p, q), I16(kOne));
        return ::xsimd::ssub(::xsimd::sadd(::xsimd::sadd(p, q), r), both);
    }
    struct Output {
        explicit Output(const PortionCtx& ctx)
            : doublings(ctx.scale == OutputScale::two    ? 1
                        : ctx.scale == OutputScale::four ? 2
                                                         : 0),
              halves(ctx.scale == OutputScale::half),
              to_one(ctx.wide == 0) {}
        I16 operator()(Value x) const {
            if (halves) x = (x >> 1) + (x & I16(1));  // of 32768, too, which is 32767 here
            if (doublings > 0) x = ::xsimd::sadd(x, x);
            if (doublings > 1) x = ::xsimd::sadd(x, x);
            return to_one ? min(max(x, I16(-kOne)), I16(kOne)) : x;
        }
        int doublings;
        bool halves, to_one;
    };
};

/// The same where every operand is expanded, or taken as it is: most dot products and most other
/// products of compiled models.
struct WideExpanded : WideBounded {
    struct Map {
        Map(std::uint8_t /*mapping*/, std::int16_t /*scale*/) {}
        I16 operator()(I16 e) const {
            const I16 x = max(e, I16(0));
            return (x + x) - I16(kOne);
        }
    };
};
struct WidePlain : WideBounded {
    struct Map {
        Map(std::uint8_t /*mapping*/, std::int16_t /*scale*/) {}
        I16 operator()(I16 e) const { return e; }
    };
};

std::int16_t* plane_of(const Packet& packet, std::ptrdiff_t plane) {
    return packet.planes + plane * kPacketSize;
}

/// An operand's planes, copied out of the argument: vector stores might alias it otherwise.
template <class Model>
struct Source {
    Source(const Packet& packet, const Operand& operand, std::int16_t scale)
        : plane{plane_of(packet, operand.plane[0]), plane_of(packet, operand.plane[1]),
                plane_of(packet, operand.plane[2])},
          map(operand.mapping, scale) {}
    I16 operator()(int component, int i) const { return map(load(plane[component] + i)); }
    const std::int16_t* plane[3];
    typename Model::Map map;
};

/// Three components of an operand.
struct Vector {
    I16 x, y, z;
};

// Always inline: its six mappings then stay in registers around the loop.
template <class Model>
[[gnu::always_inline]] inline Vector vector_at(const Source<Model>& source, int i) {
    return {source(0, i), source(1, i), source(2, i)};
}
template <class Model>
[[gnu::always_inline]] inline typename Model::Value dot_product(const Vector& a, const Vector& b) {
    return Model::sum(Model::product(a.x, b.x), Model::product(a.y, b.y), Model::product(a.z, b.z));
}

bool are_same(const Operand& a, const Operand& b) {
    return a.mapping == b.mapping && a.plane[0] == b.plane[0] && a.plane[1] == b.plane[1] &&
           a.plane[2] == b.plane[2];
}

/// The outputs of one component.
template <class Model, ProductKind Cd, ThirdKind Third>
struct Sink {
    Sink(const Packet& packet, const PortionCtx& ctx, int component)
        : selector(plane_of(packet, ctx.mux_plane)),
          selector_bits(ctx.mux_lsb != 0 ? 1 : -1),
          limit(ctx.mux_lsb != 0 ? 0 : Model::kHalf - 1),
          ab_out(plane_of(packet, ctx.ab_out[component])),
          cd_out(plane_of(packet, ctx.cd_out[component])),
          third_out(plane_of(packet, ctx.third_out[component])) {}
    void operator()(const typename Model::Output& output, int i, const typename Model::Value& ab,
                    const typename Model::Value& cd) const {
        // Both in one plane: that is the trash.
        if (Third == ThirdKind::none || ab_out != cd_out) {
            store(ab_out + i, output(ab));
            if constexpr (Cd != ProductKind::none) store(cd_out + i, output(cd));
        }
        if constexpr (Third == ThirdKind::sum) store(third_out + i, output(Model::add(ab, cd)));
        if constexpr (Third == ThirdKind::mux)
            store(third_out + i,
                  output(Model::mux(load(selector + i) & selector_bits, limit, ab, cd)));
    }
    const std::int16_t* selector;
    I16 selector_bits, limit;
    std::int16_t *ab_out, *cd_out, *third_out;
};

/// Products go component by component; where there is a dot, which serves all of them, fragments
/// come first.
template <class Model, ProductKind Ab, ProductKind Cd, ThirdKind Third>
void portion(Packet& packet, const PortionCtx& ctx) {
    using Map = typename Model::Map;
    using Outputs = Sink<Model, Cd, Third>;
    const typename Model::Output output(ctx);
    const int components = ctx.components, n = group_count(packet);
    typename Model::Value ab, cd;
    if constexpr (Ab != ProductKind::dot && Cd != ProductKind::dot) {
        const Map map_a(ctx.a.mapping, Model::kScaleA), map_b(ctx.b.mapping, Model::kScaleB),
            map_c(ctx.c.mapping, Model::kScaleA), map_d(ctx.d.mapping, Model::kScaleB);
        for (int k = 0; k < components; ++k) {
            const std::int16_t *const a = plane_of(packet, ctx.a.plane[k]),
                                      *const b = plane_of(packet, ctx.b.plane[k]),
                                      *const c = plane_of(packet, ctx.c.plane[k]),
                                      *const d = plane_of(packet, ctx.d.plane[k]);
            const Outputs outputs(packet, ctx, k);
            for (int i = 0; i < n; i += kLanes) {
                ab = Model::product(map_a(load(a + i)), map_b(load(b + i)));
                if constexpr (Cd != ProductKind::none)
                    cd = Model::product(map_c(load(c + i)), map_d(load(d + i)));
                outputs(output, i, ab, cd);
            }
        }
    } else {
        const Source<Model> a(packet, ctx.a, Model::kScaleA), b(packet, ctx.b, Model::kScaleB),
            c(packet, ctx.c, Model::kScaleA), d(packet, ctx.d, Model::kScaleB);
        if constexpr (Ab == ProductKind::dot && Cd == ProductKind::dot) {
            if (are_same(ctx.b, ctx.d)) {  // two vectors by one, as two axes of a frame
                for (int i = 0; i < n; i += kLanes) {
                    const Vector shared = vector_at(b, i);
                    ab = dot_product<Model>(vector_at(a, i), shared);
                    cd = dot_product<Model>(vector_at(c, i), shared);
                    for (int k = 0; k < components; ++k) Outputs(packet, ctx, k)(output, i, ab, cd);
                }
                return;
            }
        }
        for (int i = 0; i < n; i += kLanes) {
            if constexpr (Ab == ProductKind::dot)
                ab = dot_product<Model>(vector_at(a, i), vector_at(b, i));
            if constexpr (Cd == ProductKind::dot)
                cd = dot_product<Model>(vector_at(c, i), vector_at(d, i));
            for (int k = 0; k < components; ++k) {
                if constexpr (Ab == ProductKind::multiply) ab = Model::product(a(k, i), b(k, i));
                if constexpr (Cd == ProductKind::multiply) cd = Model::product(c(k, i), d(k, i));
                Outputs(packet, ctx, k)(output, i, ab, cd);
            }
        }
    }
}

template <class Model, ProductKind Ab, ProductKind Cd>
void portion(Packet& packet, const PortionCtx& ctx) {
    if constexpr (Cd != ProductKind::none) {
        if (ctx.third == ThirdKind::sum) return portion<Model, Ab, Cd, ThirdKind::sum>(packet, ctx);
        if (ctx.third == ThirdKind::mux) return portion<Model, Ab, Cd, ThirdKind::mux>(packet, ctx);
    }
    portion<Model, Ab, Cd, ThirdKind::none>(packet, ctx);
}

template <class Model, ProductKind Ab>
void portion(Packet& packet, const PortionCtx& ctx) {
    switch (ctx.cd) {
        case ProductKind::none:
            return portion<Model, Ab, ProductKind::none>(packet, ctx);
        case ProductKind::multiply:
            return portion<Model, Ab, ProductKind::multiply>(packet, ctx);
        case ProductKind::dot:
            return portion<Model, Ab, ProductKind::dot>(packet, ctx);
    }
}

template <class Model>
void portion(Packet& packet, const PortionCtx& ctx) {
    if (ctx.ab == ProductKind::dot) return portion<Model, ProductKind::dot>(packet, ctx);
    portion<Model, ProductKind::multiply>(packet, ctx);
}

/// Squares, and pairs of `expand` and `expand_negate`, whose results are even.
bool has_short_product(const Operand& a, const Operand& b) {
    const auto is_even = [](std::uint8_t mapping) { return mapping == 2 || mapping == 3; };
    if (is_even(a.mapping) && is_even(b.mapping)) return true;
    return are_same(a, b);
}

/// None of the choices of NineBitChoice.
bool is_usual(const PortionCtx& ctx) {
    const auto usual = [](const Operand& o) { return o.mapping < Operand::kIdealHalf; };
    return ctx.rounding == Rounding::nearest && usual(ctx.a) && usual(ctx.b) && usual(ctx.c) &&
           usual(ctx.d);
}

void portion_nine_bit(Packet& packet, const PortionCtx& ctx) noexcept {
    if (!is_usual(ctx)) {
        switch (ctx.rounding) {
            case Rounding::nearest:
                return portion<NineBitChoice<Rounding::nearest>>(packet, ctx);
            case Rounding::truncate:
                return portion<NineBitChoice<Rounding::truncate>>(packet, ctx);
            case Rounding::shift8:
                return portion<NineBitChoice<Rounding::shift8>>(packet, ctx);
        }
    }
    if (has_short_product(ctx.a, ctx.b) &&
        (ctx.cd == ProductKind::none || has_short_product(ctx.c, ctx.d))) {
        portion<NineBitShort>(packet, ctx);
    } else {
        portion<NineBit>(packet, ctx);
    }
}

/// Whether all operands that count have this mapping.
bool all_mapped(const PortionCtx& ctx, std::uint8_t mapping) {
    return ctx.a.mapping == mapping && ctx.b.mapping == mapping &&
           (ctx.cd == ProductKind::none || (ctx.c.mapping == mapping && ctx.d.mapping == mapping));
}

/// Bounded products whose sums WideBounded knows; half of a dot may be above 1.
template <class Model, ProductKind Ab, ProductKind Cd>
bool bounded_portion(Packet& packet, const PortionCtx& ctx) {
    constexpr bool kHasDot = Ab == ProductKind::dot || Cd == ProductKind::dot;
    if (kHasDot && ctx.scale == OutputScale::half && ctx.wide != 0) return false;
    if (ctx.third == ThirdKind::none) {
        portion<Model, Ab, Cd, ThirdKind::none>(packet, ctx);
        return true;
    }
    if constexpr (!kHasDot && Cd != ProductKind::none) {
        if (ctx.third == ThirdKind::sum) {
            portion<Model, Ab, Cd, ThirdKind::sum>(packet, ctx);
            return true;
        }
    }
    return false;
}

bool bounded_portion(Packet& packet, const PortionCtx& ctx) {
    constexpr std::uint8_t kExpand = 2, kSignedIdentity = 6;
    constexpr ProductKind kDot = ProductKind::dot, kMultiply = ProductKind::multiply,
                          kNone = ProductKind::none;
    if (ctx.ab == kDot) {
        const bool expands = all_mapped(ctx, kExpand);
        if (ctx.cd == kNone)
            return expands ? bounded_portion<WideExpanded, kDot, kNone>(packet, ctx)
                           : bounded_portion<WideBounded, kDot, kNone>(packet, ctx);
        if (ctx.cd == kDot)
            return expands ? bounded_portion<WideExpanded, kDot, kDot>(packet, ctx)
                           : bounded_portion<WideBounded, kDot, kDot>(packet, ctx);
        return bounded_portion<WideBounded, kDot, kMultiply>(packet, ctx);
    }
    const bool plain = all_mapped(ctx, kSignedIdentity);
    if (ctx.cd == kNone)
        return plain ? bounded_portion<WidePlain, kMultiply, kNone>(packet, ctx)
                     : bounded_portion<WideBounded, kMultiply, kNone>(packet, ctx);
    if (ctx.cd == kMultiply)
        return plain ? bounded_portion<WidePlain, kMultiply, kMultiply>(packet, ctx)
                     : bounded_portion<WideBounded, kMultiply, kMultiply>(packet, ctx);
    return bounded_portion<WideBounded, kMultiply, kDot>(packet, ctx);
}

void portion_wide(Packet& packet, const PortionCtx& ctx) noexcept {
    if (ctx.bounded != 0 && ctx.bias_minus_half == 0 && bounded_portion(packet, ctx)) return;
    portion<Wide>(packet, ctx);
}
