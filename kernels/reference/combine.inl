template <class Model>
Int input(const Packet& packet, const Operand& operand, int component, int i) {
    return Model::map(operand.mapping, plane(packet, operand.plane[component])[i]);
}

template <class Model>
Int product(const Packet& packet, ProductKind kind, const Operand& x, const Operand& y,
            Rounding rounding, int component, int i) {
    const auto term = [&](int c) {
        return Model::quotient(input<Model>(packet, x, c, i) * input<Model>(packet, y, c, i),
                               rounding);
    };
    switch (kind) {
        case ProductKind::multiply:
            return term(component);
        case ProductKind::dot:
            return term(0) + term(1) + term(2);
        case ProductKind::none:
            return 0;
    }
    return 0;
}

template <class Model>
std::int16_t output(const PortionCtx& ctx, Int x) {
    if (ctx.bias_minus_half != 0) x -= Model::kHalf;
    switch (ctx.scale) {
        case OutputScale::one:
            break;
        case OutputScale::two:
            x *= 2;
            break;
        case OutputScale::four:
            x *= 4;
            break;
        case OutputScale::half:
            x = ctx.halve_down != 0 ? x >> 1 : shift_half_up(x, 1);
            break;
    }
    return static_cast<std::int16_t>(Model::clamp_output(x, ctx.wide != 0));
}

template <class Model>
void portion(Packet& packet, const PortionCtx& ctx) noexcept {
    for (int i = 0; i < packet.count; ++i) {
        const std::int16_t selector = plane(packet, ctx.mux_plane)[i];
        const bool takes_cd = ctx.mux_lsb != 0 ? (selector & 1) != 0 : selector >= Model::kHalf;
        Int ab[3], cd[3];
        for (int c = 0; c < ctx.components; ++c) {
            ab[c] = product<Model>(packet, ctx.ab, ctx.a, ctx.b, ctx.rounding, c, i);
            cd[c] = product<Model>(packet, ctx.cd, ctx.c, ctx.d, ctx.rounding, c, i);
        }
        for (int c = 0; c < ctx.components; ++c) {
            plane(packet, ctx.ab_out[c])[i] = output<Model>(ctx, ab[c]);
            if (ctx.cd != ProductKind::none)
                plane(packet, ctx.cd_out[c])[i] = output<Model>(ctx, cd[c]);
            if (ctx.third == ThirdKind::none) continue;
            const Int third = ctx.third == ThirdKind::sum ? ab[c] + cd[c]
                              : takes_cd                  ? cd[c]
                                                          : ab[c];
            plane(packet, ctx.third_out[c])[i] = output<Model>(ctx, third);
        }
    }
}
