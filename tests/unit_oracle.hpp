#pragma once

#include <algorithm>
#include <array>
#include <burnish/scene.hpp>
#include <burnish/texture_shader.hpp>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "kernel_packet.hpp"
#include "machine/interpreter.hpp"

/// Texture shaders for one fragment, written from NV_texture_shader and docs/numbers.md, with
/// textures of single texels (nearest filter).
namespace burnish {

/// A texture and the image that it was made from.
struct OracleTexture {
    TexturePtr texture;
    Image8 image;
    TexelFormat format = TexelFormat::rgba8;
};

class UnitOracle {
  public:
    UnitOracle(const TextureShader& shader, const std::vector<OracleTexture>& textures,
               const Machine& machine, const std::array<glm::vec4, 4>& coordinates)
        : m_shader(shader), m_textures(textures), m_machine(machine), m_at(coordinates) {
        std::vector<TexturePtr> bound;
        for (const OracleTexture& t : textures) bound.push_back(t.texture);
        for (const UnitProblem& p : check_consistency(shader, bound, machine))
            m_off.at(static_cast<std::size_t>(p.unit)) = true;
        for (int i = 0; i < kTextureShaderUnits; ++i) run(i);
    }

    /// What the combiners get.
    [[nodiscard]] Codes result(int unit) const { return m_results.at(index(unit)); }

  private:
    using Op = TextureOperation;
    using Vector = std::array<float, 3>;

    static std::size_t index(int i) { return static_cast<std::size_t>(i); }
    [[nodiscard]] const TextureUnit& unit(int i) const { return m_shader.units.at(index(i)); }
    [[nodiscard]] Op operation(int i) const {
        return m_off.at(index(i)) ? Op::none : unit(i).operation;
    }
    [[nodiscard]] bool nine_bit() const { return m_machine.numbers == NumberModel::nine_bit; }
    [[nodiscard]] int one() const { return nine_bit() ? 255 : 16384; }
    [[nodiscard]] float s(int i) const { return m_at.at(index(i)).x; }
    [[nodiscard]] float t(int i) const { return m_at.at(index(i)).y; }
    [[nodiscard]] float r(int i) const { return m_at.at(index(i)).z; }
    [[nodiscard]] float q(int i) const { return m_at.at(index(i)).w; }

    // --- texels

    [[nodiscard]] int code(int byte, bool is_signed) const {
        const int n = is_signed && byte >= 128 ? byte - 256 : byte;
        if (nine_bit()) return is_signed ? 2 * n : n;
        return is_signed ? 128 * n : (257 * n + 2) / 4;
    }
    static int texel(float u, int size, Wrap wrap) {
        float f = wrap == Wrap::repeat ? u - std::floor(u) : u;
        f = f > 0.0F ? std::min(f, 1.0F) : 0.0F;
        const int at = static_cast<int>(f * static_cast<float>(256 * size)) / 256;
        if (at < size) return at;
        return wrap == Wrap::repeat ? 0 : size - 1;
    }
    [[nodiscard]] Codes fetch(int i, float u, float v) const {
        const OracleTexture& t = m_textures.at(index(i));
        const Sampler& sampler = t.texture->sampler();
        const int x = texel(u, t.image.width, sampler.wrap_s);
        const int y = texel(v, t.image.height, sampler.wrap_t);
        Codes codes{};
        for (std::size_t c = 0; c < 4; ++c)
            codes[c] = code(t.image.at(x, y)[c], t.format == TexelFormat::signed_rgba8);
        return codes;
    }

    // --- what texels mean

    [[nodiscard]] bool has_sign(int i) const {
        const Op op = operation(i);
        return op != Op::pass_through && op != Op::dot_product_pass_through &&
               m_textures.at(index(i)).format == TexelFormat::signed_rgba8;
    }
    [[nodiscard]] float unsigned_number(int code) const {
        return static_cast<float>(code) / static_cast<float>(one());
    }
    [[nodiscard]] float signed_number(int code) const {
        return static_cast<float>(code) / (nine_bit() ? 256.0F : 16384.0F);
    }
    [[nodiscard]] float expanded(int code) const {
        const float half = nine_bit() ? 127.5F : 8192.0F;
        return (static_cast<float>(code) - half) / half;
    }
    static int two_complement(int code) { return code >= 128 ? code - 256 : code; }

    [[nodiscard]] Vector vector(int i) const {
        const int from = unit(i).previous;
        const Codes& texel = m_texels.at(index(from));
        Vector v{};
        for (std::size_t c = 0; c < 3; ++c) {
            const float code = static_cast<float>(texel[c]);
            const auto n = static_cast<float>(two_complement(texel[c]));
            if (has_sign(from)) {
                v[c] = signed_number(texel[c]);
                continue;
            }
            switch (unit(i).dot_mapping) {
                case DotMapping::expand:
                    v[c] = expanded(texel[c]);
                    break;
                case DotMapping::force_blue_to_one:
                    v[c] = c == 2 ? 1.0F : unsigned_number(texel[c]);
                    break;
                case DotMapping::nv2a_d3d:
                    v[c] = (code - 128.0F) / 127.0F;
                    break;
                case DotMapping::nv2a_gl:
                    v[c] = (n + 0.5F) / 127.5F;
                    break;
                case DotMapping::nv2a_signed:
                    v[c] = n / 127.0F;
                    break;
                default:
                    v[c] = unsigned_number(texel[c]);
                    break;
            }
        }
        return v;
    }

    // --- units

    void run(int i) {
        const Op op = operation(i);
        if (op == Op::none) return;
        if (op >= Op::dot_product && op <= Op::dot_product_affine_depth_replace) {
            const Vector v = vector(i);
            m_dots.at(index(i)) = (s(i) * v[0] + t(i) * v[1]) + r(i) * v[2];
        }
        const Codes previous = m_texels.at(index(unit(i).previous));
        switch (op) {
            case Op::texture_2d:
                return deliver(i, fetch(i, s(i) / q(i), t(i) / q(i)));
            case Op::pass_through:
                return deliver(i, {clamped(s(i)), clamped(t(i)), clamped(r(i)), clamped(q(i))});
            case Op::offset_2d:
            case Op::offset_2d_scale:
            case Op::offset_projective_2d:
            case Op::offset_projective_2d_scale:
                return offset(i, previous);
            case Op::dependent_ar:
                return deliver(
                    i, fetch(i, unsigned_number(previous[3]), unsigned_number(previous[0])));
            case Op::dependent_gb:
                return deliver(
                    i, fetch(i, unsigned_number(previous[1]), unsigned_number(previous[2])));
            case Op::dot_product_2d:
                return deliver(i, fetch(i, m_dots.at(index(i - 1)), m_dots.at(index(i))));
            case Op::dot_product_pass_through: {
                const int p = clamped(m_dots.at(index(i)));
                return deliver(i, {p, p, p, p});
            }
            default:
                return;
        }
    }

    void deliver(int i, const Codes& texel) {
        m_texels.at(index(i)) = m_results.at(index(i)) = texel;
    }

    [[nodiscard]] int clamped(float x) const { return color_code(x, m_machine.numbers); }

    void offset(int i, const Codes& previous) {
        const Op op = operation(i);
        const bool projective =
            op == Op::offset_projective_2d || op == Op::offset_projective_2d_scale;
        const bool scaled = op == Op::offset_2d_scale || op == Op::offset_projective_2d_scale;
        const auto from = [&](int c) {
            const int code = previous.at(index(c));
            if (has_sign(unit(i).previous)) return signed_number(code);
            return static_cast<float>(two_complement(code)) / 128.0F;
        };
        const float ds = from(2), dt = from(1);
        const glm::mat2& m = unit(i).offset_matrix;
        const float u = projective ? s(i) / q(i) : s(i), v = projective ? t(i) / q(i) : t(i);
        const Codes texel =
            fetch(i, (u + m[0][0] * ds) + m[1][0] * dt, (v + m[0][1] * ds) + m[1][1] * dt);
        deliver(i, texel);
        if (!scaled) return;
        const float magnitude = unsigned_number(previous[0]);
        float f = unit(i).offset_bias + unit(i).offset_scale * magnitude;
        if (m_machine.magnitude_factor == MagnitudeFactor::clamped)
            f = f > 0.0F ? std::min(f, 1.0F) : 0.0F;
        for (std::size_t c = 0; c < 3; ++c) {
            const float x = static_cast<float>(texel[c]) * f + (nine_bit() ? 0.02F : 0.5F);
            const float low = nine_bit() ? -256.0F : -32768.0F;
            m_results.at(index(i))[c] =
                static_cast<int>(std::floor(std::clamp(x, low, static_cast<float>(one()))));
        }
    }

    const TextureShader& m_shader;
    const std::vector<OracleTexture>& m_textures;
    const Machine& m_machine;
    std::array<glm::vec4, 4> m_at;
    std::array<bool, 4> m_off{};
    std::array<Codes, 4> m_texels{}, m_results{};
    std::array<float, 4> m_dots{};
};

// --- random shaders

inline TextureUnit random_unit(Random& random, const Machine& machine, int i) {
    using Op = TextureOperation;
    TextureUnit u;
    constexpr std::array kFirst{Op::texture_2d, Op::texture_2d, Op::texture_2d, Op::pass_through,
                                Op::none};
    constexpr std::array kLater{Op::offset_2d,
                                Op::offset_2d_scale,
                                Op::offset_projective_2d,
                                Op::offset_projective_2d_scale,
                                Op::dependent_ar,
                                Op::dependent_gb,
                                Op::dot_product_pass_through,
                                Op::texture_2d,
                                Op::pass_through,
                                Op::dot_product};
    u.operation = i == 0 ? random.pick(kFirst) : random.pick(kLater);
    u.previous = i == 0 ? 0 : random.below(i);
    const int mappings = machine.numbers == NumberModel::nine_bit ? 6 : 3;
    u.dot_mapping = static_cast<DotMapping>(random.below(mappings));
    for (int k = 0; k < 4; ++k) u.offset_matrix[k / 2][k % 2] = random.real(-1.0F, 1.0F);
    u.offset_scale = random.real(-2.0F, 2.0F);
    u.offset_bias = random.real(-0.5F, 1.0F);
    for (int c = 0; c < 3; ++c) u.const_eye[c] = random.real(-1.0F, 1.0F);
    return u;
}

inline TextureOperation random_group_end(Random& /*random*/, bool /*three*/) {
    return TextureOperation::dot_product_2d;
}

inline OracleTexture random_oracle_texture(Random& random, const TextureUnit& /*unit*/,
                                           const Machine& /*machine*/) {
    OracleTexture result;
    result.image = Image8(random.between(1, 9), random.between(1, 9));
    for (std::uint8_t& byte : result.image.rgba)
        byte = static_cast<std::uint8_t>(random.below(256));
    result.format = random.chance(4) ? TexelFormat::signed_rgba8 : TexelFormat::rgba8;
    const auto wrap = [&] { return random.chance(2) ? Wrap::repeat : Wrap::clamp_to_edge; };
    if (!random.chance(9))
        result.texture = std::make_shared<const Texture>(
            result.image, Sampler{Filter::nearest, wrap(), wrap()}, result.format);
    return result;
}

inline std::array<glm::vec4, 4> random_coordinates(Random& random) {
    std::array<glm::vec4, 4> sets{};
    for (glm::vec4& uv : sets)
        uv = {random.real(-1.5F, 1.5F), random.real(-1.5F, 1.5F), random.real(-1.5F, 1.5F),
              random.chance(3) ? random.real(0.5F, 2.0F) : 1.0F};
    return sets;
}

}  // namespace burnish
