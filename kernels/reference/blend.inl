/// A channel of a frame of whole numbers, `One` of which are 1.
template <class Channel, Int One>
struct WholeFrame {
    using Value = Int;
    static constexpr Int kOne = One;
    template <class Model>
    static Int of_code(Int v) {
        return sizeof(Channel) == 1 ? Model::to_8_bits(v) : Model::to_16_bits(v);
    }
    static Int of_constant(float x) { return static_cast<Int>(x * static_cast<float>(One) + 0.5F); }
    static Int sum(Int a, Int fa, Int b, Int fb) { return rounded(a * fa + b * fb); }
    static Int difference(Int a, Int fa, Int b, Int fb) { return rounded(a * fa - b * fb); }
    /// floor(p / One + 1/2) = floor((2 p + One) / (2 One)); negative ones are clamped anyhow.
    static Int rounded(Int p) { return p <= 0 ? 0 : std::min((2 * p + One) / (2 * One), One); }
};
struct FloatFrame {
    using Value = float;
    static constexpr float kOne = 1.0F;
    template <class Model>
    static float of_code(Int v) {
        return static_cast<float>(v) / static_cast<float>(Model::kOne);
    }
    static float of_constant(float x) { return x; }
    static float sum(float a, float fa, float b, float fb) {
        return minimum(maximum(a * fa + b * fb, 0.0F), 1.0F);
    }
    static float difference(float a, float fa, float b, float fb) {
        return minimum(maximum(a * fa - b * fb, 0.0F), 1.0F);
    }
};

template <class Frame>
typename Frame::Value blend_factor(const BlendFactorCtx& factor, int c,
                                   const typename Frame::Value* source,
                                   const typename Frame::Value* destination,
                                   const float* constant) {
    typename Frame::Value f = 0;
    switch (factor.operand) {
        case BlendOperand::zero:
            break;
        case BlendOperand::source_color:
            f = source[c];
            break;
        case BlendOperand::source_alpha:
            f = source[3];
            break;
        case BlendOperand::destination_color:
            f = destination[c];
            break;
        case BlendOperand::destination_alpha:
            f = destination[3];
            break;
        case BlendOperand::constant_color:
            f = Frame::of_constant(constant[c]);
            break;
    }
    return factor.inverted != 0 ? Frame::kOne - f : f;
}

template <class Model, class Channel, class Frame>
void blend_frame(const Packet& packet, const BlendCtx& ctx) {
    using Value = typename Frame::Value;
    for (int i = 0; i < packet.count; ++i) {
        std::byte* const at = static_cast<std::byte*>(ctx.tile) +
                              static_cast<std::size_t>(packet.pixels[i]) * 4 * sizeof(Channel);
        Channel pixel[4];
        std::memcpy(pixel, at, sizeof pixel);
        Value s[4], d[4];
        for (int c = 0; c < 4; ++c) {
            s[c] = Frame::template of_code<Model>(plane(packet, ctx.plane[c])[i]);
            d[c] = static_cast<Value>(pixel[c]);
        }
        for (int c = 0; c < 4; ++c) {
            const Value fs = blend_factor<Frame>(ctx.source, c, s, d, ctx.constant);
            const Value fd = blend_factor<Frame>(ctx.destination, c, s, d, ctx.constant);
            Value result = 0;
            switch (ctx.sum) {
                case BlendSum::add:
                    result = Frame::sum(s[c], fs, d[c], fd);
                    break;
                case BlendSum::subtract:
                    result = Frame::difference(s[c], fs, d[c], fd);
                    break;
                case BlendSum::reverse_subtract:
                    result = Frame::difference(d[c], fd, s[c], fs);
                    break;
                case BlendSum::min:
                    result = s[c] < d[c] ? s[c] : d[c];
                    break;
                case BlendSum::max:
                    result = s[c] > d[c] ? s[c] : d[c];
                    break;
            }
            pixel[c] = static_cast<Channel>(result);
        }
        std::memcpy(at, pixel, sizeof pixel);
    }
}

template <class Model>
void blend(Packet& packet, const BlendCtx& ctx) noexcept {
    switch (ctx.format) {
        case StoreFormat::rgba8:
            return blend_frame<Model, std::uint8_t, WholeFrame<std::uint8_t, 255>>(packet, ctx);
        case StoreFormat::rgba16:
            return blend_frame<Model, std::uint16_t, WholeFrame<std::uint16_t, 65535>>(packet, ctx);
        case StoreFormat::rgba32f:
            return blend_frame<Model, float, FloatFrame>(packet, ctx);
    }
}
