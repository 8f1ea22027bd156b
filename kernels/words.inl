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

/// Byte patterns for lanes of one fragment's texel pair, four words of the left and of the right.
struct WordPatterns {
    I16 interleave;  ///< channel by channel, left and right
    I16 own[4];      ///< dword k of a lane, four times

    WordPatterns() {
        alignas(16) std::int8_t bytes[16];
        for (int i = 0; i < 16; ++i)
            bytes[i] = static_cast<std::int8_t>(i / 4 * 2 + i % 2 + (i & 2) * 4);
        interleave = broadcast_lane(bytes);
        for (int k = 0; k < 4; ++k) {
            for (int i = 0; i < 16; ++i) bytes[i] = static_cast<std::int8_t>(4 * k + i % 4);
            own[k] = broadcast_lane(bytes);
        }
    }
};

/// -2^31 <= 2^16 * word, and 2^16 * 32767 + 2^15 < 2^31: parts may wrap, their sum does not. Vector
/// k of four holds fragment 4 p + k in lane p; transposed, the lanes are in order.
void fetch_words(Packet& packet, const FetchWordsCtx& ctx) noexcept {
    const WordPatterns patterns;
    std::int16_t* const out = packet.planes + ctx.plane * kPacketSize;
    const std::uint8_t *const upper = ctx.texels, *const lower = ctx.texels + ctx.pitch;
    const std::int32_t* const texel = packet.texel;
    const auto *const weight_x = reinterpret_cast<const std::uint16_t*>(packet.weight_x),
                      *const weight_y = reinterpret_cast<const std::uint16_t*>(packet.weight_y);
    const auto words = [](I32 v) { return ::xsimd::bitwise_cast<I16>(v); };
    const auto dwords = [](I16 v) { return ::xsimd::bitwise_cast<I32>(v); };
    const int n = group_count(packet);
    for (int i = 0; i < n; i += kLanes32) {
        const I32 wx = load_widened(weight_x + i);
        const I16 across = words((I32(256) - wx) | (wx << 16)),
                  down = words(load_widened(weight_y + i));
        const auto filtered = [&](int k) __attribute__((always_inline)) {
            const I16 pair = shuffle_bytes(across, patterns.own[k]);
            const auto row = [&](const std::uint8_t* base) {
                const void* at[kParts];
                for (int p = 0; p < kParts; ++p) at[p] = base + texel[i + 4 * p + k];
                return mul_add_pairs(shuffle_bytes(load_lanes(at), patterns.interleave), pair);
            };
            const I32 top = row(upper), bottom = row(lower);
            const I32 wy = dwords(shuffle_bytes(down, patterns.own[k]));
            const I32 x = ((top << 8) + (bottom - top) * wy + I32(32768)) >> 16;
            return words((x + I32(32768 + 2)) >> 2);
        };
        const I16 v0 = filtered(0), v1 = filtered(1), v2 = filtered(2), v3 = filtered(3);
        const I16 rg01 = zip_lo32(v0, v1), rg23 = zip_lo32(v2, v3);
        const I16 ba01 = zip_hi32(v0, v1), ba23 = zip_hi32(v2, v3);
        store_narrowed(out + i, dwords(zip_lo64(rg01, rg23)));
        store_narrowed(out + kPacketSize + i, dwords(zip_hi64(rg01, rg23)));
        store_narrowed(out + 2 * kPacketSize + i, dwords(zip_lo64(ba01, ba23)));
        store_narrowed(out + 3 * kPacketSize + i, dwords(zip_hi64(ba01, ba23)));
    }
}

/// f(0), f(1) .. f(n - 1), one after the other without a loop.
template <int... K, class F>
[[gnu::always_inline]] inline void in_turn(std::integer_sequence<int, K...> /*n*/, F f) {
    (f(K), ...);
}

/// A row of both texels is at most four vectors, and one lane of them is one texture; so eight
/// fragments are transposed lane by lane. T and B are rows of 24 bits, their weighted sum may wrap
/// by what the sign of 2^31 takes back.
template <int RowVectors>
void fetch_quartet(Packet& packet, const FetchQuartetCtx& ctx) {
    using Vectors = std::make_integer_sequence<int, kTexelRowVectors>;
    constexpr int kAtOnce = 8;  // fragments
    const int n = group_count(packet);
    alignas(64) std::int32_t across[kPacketSize], upper[kPacketSize], lower[kPacketSize];
    for (int i = 0; i < n; i += kLanes32) {
        const auto widened = [i](const std::int16_t* weights) {
            return load_widened(reinterpret_cast<const std::uint16_t*>(weights) + i);
        };
        const I32 wx = widened(packet.weight_x), wy = widened(packet.weight_y);
        store(across + i, (I32(256) - wx) | (wx << 16));
        store(upper + i, I32(256) - wy);
        store(lower + i, wy);
    }
    const std::uint8_t *const top = ctx.texels, *const bottom = ctx.texels + ctx.pitch;
    const std::int32_t* const texel = packet.texel;
    std::int16_t* out[FetchQuartetCtx::kTextures];
    unsigned wanted = 0;  // bit 4 k + c
    for (int k = 0; k < FetchQuartetCtx::kTextures; ++k) {
        out[k] = packet.planes + ctx.plane[k] * kPacketSize;
        if (ctx.plane[k] >= 0) wanted |= unsigned{ctx.channels[k]} << (4 * k);
    }
    // Of fragment f and the one behind it words 0, 0, 1, 1, 2, 2, 3, 3 of every lane.
    struct Codes {
        I16 v[kTexelRowVectors];
    };
    const auto filtered = [&](int f, I32(&x)[kTexelRowVectors]) __attribute__((always_inline)) {
        I16 t[kTexelRowVectors], b[kTexelRowVectors];
        load_texel_row(top + texel[f], t);
        load_texel_row(bottom + texel[f], b);
        const I16 sides = ::xsimd::bitwise_cast<I16>(I32(across[f]));
        const I32 above(upper[f]), below(lower[f]);
        const I32 half_and_sign(static_cast<std::int32_t>(0x80008000));
        in_turn(
            Vectors(), [&](int j) __attribute__((always_inline)) {
                x[j] = mul_add_pairs(t[j], sides) * above + mul_add_pairs(b[j], sides) * below +
                       half_and_sign;
            });
    };
    const auto pair = [&](int f) __attribute__((always_inline)) {
        I32 first[kTexelRowVectors], second[kTexelRowVectors];
        filtered(f, first);
        filtered(f + 1, second);
        Codes codes;
        in_turn(
            Vectors(), [&](int j) __attribute__((always_inline)) {
                const I16 v = upper_words(first[j], second[j]);  // x + 32768
                codes.v[j] = average(shift_right_logical(v, 1), I16(0));
            });
        return codes;
    };
    // put(j, c, v): channel c of fragments f .. f + 7, lane p of texture kTexelRowVectors p + j.
    const auto eight = [&](int f, auto put) __attribute__((always_inline)) {
        const Codes ab = pair(f), cd = pair(f + 2), ef = pair(f + 4), gh = pair(f + 6);
        in_turn(
            Vectors(), [&](int j) __attribute__((always_inline)) {
                const I16 ad01 = zip_lo32(ab.v[j], cd.v[j]), ad23 = zip_hi32(ab.v[j], cd.v[j]);
                const I16 eh01 = zip_lo32(ef.v[j], gh.v[j]), eh23 = zip_hi32(ef.v[j], gh.v[j]);
                put(j, 0, zip_lo64(ad01, eh01));
                put(j, 1, zip_hi64(ad01, eh01));
                put(j, 2, zip_lo64(ad23, eh23));
                put(j, 3, zip_hi64(ad23, eh23));
            });
    };
    if constexpr (RowVectors == 1) {  // with registers for whole vectors of every plane
        using Four = std::make_integer_sequence<int, 4>;
        for (int i = 0; i < n; i += kLanes) {
            I16 rows[4][4];
            in_turn(
                Four(), [&](int g) __attribute__((always_inline)) {
                    eight(
                        i + kAtOnce * g, [&](int /*j*/, int c, I16 v)
                                             __attribute__((always_inline)) { rows[c][g] = v; });
                });
            in_turn(
                Four(), [&](int c) __attribute__((always_inline)) {
                    if ((wanted >> c & 0x1111U) == 0) return;
                    const LaneRows lanes(rows[c]);
                    const auto put = [&](auto k) __attribute__((always_inline)) {
                        if ((wanted >> (4 * k + c) & 1U) != 0)
                            lanes.template store<decltype(k)::value>(out[k] + c * kPacketSize + i);
                    };
                    put(std::integral_constant<int, 0>());
                    put(std::integral_constant<int, 1>());
                    put(std::integral_constant<int, 2>());
                    put(std::integral_constant<int, 3>());
                });
        }
    } else {
        for (int i = 0; i < n; i += kAtOnce) {
            eight(
                i, [&](int j, int c, I16 v) __attribute__((always_inline)) {
                    const auto put = [&](auto p) __attribute__((always_inline)) {
                        if constexpr (decltype(p)::value < kParts) {
                            const int k = kTexelRowVectors * p + j;
                            if ((wanted >> (4 * k + c) & 1U) != 0)
                                store_lane<decltype(p)::value>(out[k] + c * kPacketSize + i, v);
                        }
                    };
                    put(std::integral_constant<int, 0>());
                    put(std::integral_constant<int, 1>());
                });
        }
    }
}

void fetch_quartet(Packet& packet, const FetchQuartetCtx& ctx) noexcept {
    fetch_quartet<kTexelRowVectors>(packet, ctx);
}

/// Both rows of one fragment in two: texels about as large as pixels are half a line.
void prefetch_quartet(Packet& packet, const PrefetchQuartetCtx& ctx) noexcept {
    constexpr int kStep = 2;
    const std::uint8_t *const upper = ctx.texels, *const lower = upper + ctx.pitch;
    const std::int32_t* const texel = packet.texel;
    const int count = packet.count;
    for (int i = 0; i < count; i += kStep) {
        __builtin_prefetch(upper + texel[i]);
        __builtin_prefetch(lower + texel[i]);
    }
}

/// From a wide register to texel and weight along an axis of a table. Dividing by a power of two is
/// multiplying by its inverse, bit for bit; and where numbers are not immense, such factors may
/// come first: then scale and offset lead to 1/256 texel at once.
struct TableAxis {
    TableAxis(const Packet& packet, const LookUpTableCtx::Axis& axis)
        : codes(packet.planes + axis.plane * kPacketSize),
          size(axis.size),
          scale(axis.scale),
          offset(axis.offset),
          divisor(axis.divisor),
          inverse(1.0F / axis.divisor),
          steps(static_cast<float>(256 * axis.size)),
          code_scale(axis.scale * 0x1p-6F),  // 256 / 2^14
          step_offset(axis.offset * 256.0F),
          has_inverse((axis.size & (axis.size - 1)) == 0 &&
                      axis.divisor == static_cast<float>(axis.size)),
          in_steps(has_inverse && is_usual(axis.scale) && is_usual(axis.offset)) {}
    /// 0, or neither near overflow nor near denormal numbers.
    static bool is_usual(float x) {
        const float size = x < 0.0F ? -x : x;
        return x == 0.0F || (size > 0x1p-40F && size < 0x1p40F);
    }
    [[nodiscard]] F32 code(int i) const { return to_float(load_widened(codes + i)); }
    [[nodiscard]] F32 number(int i) const { return code(i) * F32(0x1p-14F); }
    [[nodiscard]] F32 coordinate(F32 number) const {
        const F32 position = number * scale + offset;
        return has_inverse ? position * inverse : divide(position, divisor);
    }
    AxisAddress operator()(int i) const {
        constexpr AddressMode kClamp = AddressMode::clamp_to_edge;
        if (!in_steps)
            return axis_address<kClamp, true>(coordinate(number(i)), size, F32(1.0F), steps);
        return axis_address<kClamp, true>(code(i) * code_scale + step_offset, size, steps,
                                          F32(1.0F));
    }
    const std::int16_t* codes;
    std::int32_t size;
    F32 scale, offset, divisor, inverse, steps, code_scale, step_offset;
    bool has_inverse, in_steps;
};

/// Columns first: sums of products are the same either way.
template <bool TwoAxes>
void look_up_table(Packet& packet, const LookUpTableCtx& ctx) {
    const TableAxis axis_s(packet, ctx.s), axis_t(packet, TwoAxes ? ctx.t : ctx.s);
    const std::uint8_t* const texels = ctx.texels;
    const I32 pitch(ctx.pitch);
    std::int16_t* out[4];
    int outs = 0;
    for (const int plane : ctx.out)
        if (plane >= 0) out[outs++] = packet.planes + plane * kPacketSize;
    const int n = group_count(packet);
    alignas(64) std::int32_t offset[kPacketSize], across[kPacketSize], down[kPacketSize];
    for (int i = 0; i < n; i += kLanes32) {
        const AxisAddress s = axis_s(i);
        I32 offsets = s.texel << 2;
        if constexpr (TwoAxes) {
            const AxisAddress t = axis_t(i);
            offsets = offsets + t.texel * pitch;
            store(down + i, (I32(256) - t.weight) | (t.weight << 16));
        }
        store(offset + i, offsets);
        store(across + i, s.weight);
    }
    const auto code = [&](int i) {
        const I16 rows = ::xsimd::bitwise_cast<I16>(TwoAxes ? load(down + i) : I32(256));
        const I32 first = mul_add_pairs(load_pairs<4>(texels, offset + i), zip_lo32(rows, rows));
        const I32 second =
            mul_add_pairs(load_pairs<4>(texels, offset + i + 2), zip_hi32(rows, rows));
        const I32 left = even_dwords(first, second), right = odd_dwords(first, second);
        const I32 x = ((left << 8) + (right - left) * load(across + i) + I32(32768)) >> 16;
        return (x + I32(32768 + 2)) >> 2;
    };
    for (int i = 0; i < n; i += kLanes) {
        const I32 first = code(i), second = code(i + kLanes32);
        for (int k = 0; k < outs; ++k) store_narrowed(out[k] + i, first, second);
    }
}

/// Vectors have nothing that is quicker than loads; four codes are stored at once.
void look_up_codes(Packet& packet, const LookUpTableCtx& ctx) {
    const auto* const from =
        reinterpret_cast<const std::uint16_t*>(packet.planes + ctx.s.plane * kPacketSize);
    const auto* const codes = reinterpret_cast<const std::uint16_t*>(ctx.codes);
    const int n = group_count(packet);
    for (const int plane : ctx.out) {
        if (plane < 0) continue;
        std::int16_t* const out = packet.planes + plane * kPacketSize;
#pragma GCC unroll 2
        for (int i = 0; i < n; i += 4) {
            const auto code = [&](int k) { return std::uint64_t{codes[from[i + k]]} << (16 * k); };
            const std::uint64_t four = (code(0) | code(1)) | (code(2) | code(3));
            __builtin_memcpy(out + i, &four, sizeof four);
        }
    }
}

void look_up_table(Packet& packet, const LookUpTableCtx& ctx) noexcept {
    if (ctx.codes != nullptr) return look_up_codes(packet, ctx);
    ctx.t.plane < 0 ? look_up_table<false>(packet, ctx) : look_up_table<true>(packet, ctx);
}

/// `reach` times the longer step from each fragment's code to those beside it in its quad.
void half_steps(const std::int16_t* codes, int count, float reach, float* to) {
    const auto change = [](int a, int b) { return a < b ? b - a : a - b; };
    const auto larger = [](int a, int b) { return a < b ? b : a; };
    for (int i = 0; i < count; i += 4) {
        const int top = change(codes[i], codes[i + 1]), bottom = change(codes[i + 2], codes[i + 3]),
                  left = change(codes[i], codes[i + 2]), right = change(codes[i + 1], codes[i + 3]);
        to[i] = static_cast<float>(larger(top, left)) * reach;
        to[i + 1] = static_cast<float>(larger(top, right)) * reach;
        to[i + 2] = static_cast<float>(larger(bottom, left)) * reach;
        to[i + 3] = static_cast<float>(larger(bottom, right)) * reach;
    }
}

constexpr int kSummedTexel = 8;  // bytes

/// A texel of a summed table for every lane.
struct SummedTexels {
    SummedTexels(const std::uint8_t* texels, I32 offset) {
        alignas(64) std::int32_t at[kLanes32];
        store(at, offset);
        const I32 first = ::xsimd::bitwise_cast<I32>(load_pairs<4>(texels, at)),
                  second = ::xsimd::bitwise_cast<I32>(load_pairs<4>(texels, at + 2));
        const I32 words = even_dwords(first, second);
        own = (words << 16) >> 16;
        step = (words >> 16) - own;
        sum = odd_dwords(first, second);
    }
    I32 own, step, sum;
};

/// Where the integral of a summed table begins or ends.
struct SumEnd {
    SumEnd(const TableAxis& axis, F32 number)
        : place(truncate(::xsimd::floor(axis.coordinate(number) * axis.steps)) - I32(128)) {
        const I32 inside = min(max(place, I32(0)), I32(256 * (axis.size - 1)));
        weight = inside & I32(255);
        offset = (inside >> 8) * I32(kSummedTexel);
        beyond = to_float(place - inside);
    }
    [[nodiscard]] F32 rest(const SummedTexels& at) const {
        const I32 line = (at.own << 9) + at.step * weight;
        return to_float(weight) * to_float(line) * F32(0x1p-16F) +
               beyond * to_float(at.own) * F32(0x1p-7F);
    }
    I32 place, weight, offset;
    F32 beyond;
};

/// Twice the integral from `low` to `high`, in texels.
F32 integral(const std::uint8_t* row, I32 offset, const SumEnd& low, const SumEnd& high) {
    const SummedTexels first(row, offset + low.offset), last(row, offset + high.offset);
    return to_float(last.sum - first.sum) + (high.rest(last) - low.rest(first));
}

template <bool TwoAxes>
void average_table(Packet& packet, const AverageTableCtx& ctx) {
    const TableAxis axis_s(packet, ctx.s), axis_t(packet, TwoAxes ? ctx.t : ctx.s);
    const std::uint8_t *const upper = ctx.texels, *const lower = upper + ctx.pitch;
    const I32 pitch(ctx.pitch), zero(0), one(1);
    std::int16_t* out[4];
    int outs = 0;
    for (const int plane : ctx.out)
        if (plane >= 0) out[outs++] = packet.planes + plane * kPacketSize;
    const int n = group_count(packet);
    alignas(64) float half[kPacketSize];
    half_steps(packet.planes + ctx.s.plane * kPacketSize, n, ctx.reach, half);
    for (int i = 0; i < n; i += kLanes32) {
        const F32 number = axis_s.number(i), reach = load(half + i);
        const SumEnd low(axis_s, max(number - reach, F32(ctx.least)));
        const SumEnd high(axis_s, min(number + reach, F32(ctx.most)));
        AxisAddress row{zero, zero};
        if constexpr (TwoAxes) row = axis_t(i);
        const I32 offset = row.texel * pitch;
        F32 area = integral(upper, offset, low, high);
        if constexpr (TwoAxes) {
            const F32 below = integral(lower, offset, low, high);
            area = area + (below - area) * (to_float(row.weight) * F32(0x1p-8F));
        }
        const I32 width = high.place - low.place;
        const F32 mean = divide(area * F32(128.0F), to_float(max(width, one)));
        I32 x = truncate(::xsimd::floor(mean + F32(0.5F)));
        x = min(max(x, I32(-32768)), I32(32767));
        if (::xsimd::any(width < one)) {
            const AxisAddress at = axis_s(i);
            const I32 texel = offset + at.texel * I32(kSummedTexel);
            const auto between = [&](const std::uint8_t* texels) {
                const SummedTexels here(texels, texel);
                return (here.own << 8) + here.step * at.weight;
            };
            const I32 top = between(upper);
            I32 point = top << 8;
            if constexpr (TwoAxes) point = point + (between(lower) - top) * row.weight;
            x = ::xsimd::select(width < one, (point + I32(32768)) >> 16, x);
        }
        const I32 code = (x + I32(32768 + 2)) >> 2;
        for (int k = 0; k < outs; ++k) store_narrowed(out[k] + i, code);
    }
}

void average_table(Packet& packet, const AverageTableCtx& ctx) noexcept {
    ctx.t.plane < 0 ? average_table<false>(packet, ctx) : average_table<true>(packet, ctx);
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
