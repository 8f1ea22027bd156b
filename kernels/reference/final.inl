template <class Model>
Int final_mapping(std::uint8_t mapping, Int identity) {
    return mapping == 1 ? Model::kOne - std::min(identity, Model::kOne) : identity;
}

template <class Model>
Int final_register(const Packet& packet, const Operand& operand, int c, int i) {
    return final_mapping<Model>(operand.mapping,
                                Model::final_identity(plane(packet, operand.plane[c])[i]));
}

template <class Model>
Int final_input(const Packet& packet, const FinalCtx& ctx, const Operand& operand, int c, int i) {
    if (operand.plane[0] == FinalCtx::kZero) return 0;
    if (operand.plane[0] == FinalCtx::kColorSum) {
        const auto term = [&](const std::int16_t* planes, std::uint8_t complement) {
            const Int x = Model::final_identity(plane(packet, planes[c])[i]);
            return complement != 0 ? Model::kOne - x : x;
        };
        const Int sum = Model::color_sum(term(ctx.spare0, ctx.complement_spare0),
                                         term(ctx.secondary, ctx.complement_secondary));
        return final_mapping<Model>(operand.mapping,
                                    ctx.clamp_color_sum != 0 ? std::min(sum, Model::kOne) : sum);
    }
    if (operand.plane[0] == FinalCtx::kFinalProduct) {
        const Int e = final_register<Model>(packet, ctx.e, c, i);
        const Int f = final_register<Model>(packet, ctx.f, c, i);
        return final_mapping<Model>(operand.mapping, Model::quotient(e * f, ctx.rounding));
    }
    return final_register<Model>(packet, operand, c, i);
}

template <class Model>
void final_combiner(Packet& packet, const FinalCtx& ctx) noexcept {
    for (int i = 0; i < packet.count; ++i) {
        for (int c = 0; c < 3; ++c) {
            const auto read = [&](const Operand& o) {
                return final_input<Model>(packet, ctx, o, c, i);
            };
            const Int ab = read(ctx.a) * read(ctx.b);
            const Int rest = (Model::kOne - read(ctx.a)) * read(ctx.c);
            const Int blend = ctx.round_each != 0 ? Model::quotient(ab, ctx.rounding) +
                                                        Model::quotient(rest, ctx.rounding)
                                                  : Model::quotient(ab + rest, ctx.rounding);
            const Int sum = blend + read(ctx.d);
            plane(packet, ctx.out[c])[i] = static_cast<std::int16_t>(std::min(sum, Model::kOne));
        }
        const Int alpha = final_register<Model>(packet, ctx.g, 0, i);
        plane(packet, ctx.out[3])[i] = static_cast<std::int16_t>(alpha);
    }
}

template <class Channel>
void write_channel(const StoreCtx& ctx, int pixel, int channel, Channel value) {
    auto* bytes = static_cast<std::byte*>(ctx.tile);
    std::memcpy(bytes + (pixel * 4 + channel) * static_cast<int>(sizeof(Channel)), &value,
                sizeof(Channel));
}

template <class Model>
void store(Packet& packet, const StoreCtx& ctx) noexcept {
    for (int i = 0; i < packet.count; ++i) {
        const int pixel = packet.pixels[i];
        for (int c = 0; c < 4; ++c) {
            const std::int16_t v = plane(packet, ctx.plane[c])[i];
            switch (ctx.format) {
                case StoreFormat::rgba8:
                    write_channel(ctx, pixel, c, static_cast<std::uint8_t>(Model::to_8_bits(v)));
                    break;
                case StoreFormat::rgba16:
                    write_channel(ctx, pixel, c, static_cast<std::uint16_t>(Model::to_16_bits(v)));
                    break;
                case StoreFormat::rgba32f:
                    write_channel(ctx, pixel, c,
                                  static_cast<float>(v) / static_cast<float>(Model::kOne));
                    break;
            }
        }
    }
}

/// `filtered(upper left, upper right, lower left, lower right, wx, wy)` of every channel.
template <class Filter>
void filter_corners(Packet& packet, const FilterCtx& ctx, Filter filtered) {
    for (int i = 0; i < packet.count; ++i) {
        const Int wx = plane(packet, ctx.weight)[i], wy = plane(packet, ctx.weight + 1)[i];
        for (int c = 0; c < 4; ++c) {
            const auto corner = [&](int k) {
                return Int{plane(packet, ctx.corners + 4 * k + c)[i]};
            };
            const Int x = filtered(corner(0), corner(1), corner(2), corner(3), wx, wy);
            plane(packet, ctx.out + c)[i] = static_cast<std::int16_t>(x);
        }
    }
}

void filter_nine_bit(Packet& packet, const FilterCtx& ctx) noexcept {
    filter_corners(packet, ctx, [](Int a, Int b, Int c, Int d, Int wx, Int wy) {
        const auto lerp = [](Int from, Int to, Int w) {
            return shift_half_up((256 - w) * from + w * to, 8);
        };
        return lerp(lerp(a, b, wx), lerp(c, d, wx), wy);
    });
}

void filter_wide(Packet& packet, const FilterCtx& ctx) noexcept {
    filter_corners(packet, ctx, [](Int a, Int b, Int c, Int d, Int wx, Int wy) {
        const Int top = (256 - wx) * a + wx * b, bottom = (256 - wx) * c + wx * d;
        return shift_half_up((256 - wy) * top + wy * bottom, 16);
    });
}
