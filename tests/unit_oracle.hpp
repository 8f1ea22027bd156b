#pragma once

#include <algorithm>
#include <array>
#include <burnish/scene.hpp>
#include <burnish/texture_shader.hpp>
#include <cmath>
#include <memory>
#include <vector>

#include "machine/interpreter.hpp"
#include "machine/unit_operations.hpp"

/// Texture shaders for one fragment, written from NV_texture_shader and docs/numbers.md, with
/// textures of single texels (nearest filter, one level, repeat and clamp_to_edge).
namespace burnish {

/// The texel that is nearest to coordinate u of an axis.
inline int nearest_texel(float u, int size, Wrap wrap, bool rectangle) {
    const float whole = rectangle ? static_cast<float>(size) : 1.0F;
    float f = wrap == Wrap::repeat ? u - std::floor(u) : u;
    f = f > 0.0F ? std::min(f, whole) : 0.0F;
    const float scale = rectangle ? 256.0F : static_cast<float>(256 * size);
    const int at = static_cast<int>(std::floor(f * scale)) >> 8;
    if (at < size) return at;
    return wrap == Wrap::repeat ? 0 : size - 1;
}

/// The texel of `texture` at (s, t, r), four numbers as the image has them.
inline std::array<int, 4> nearest_numbers(const Texture& texture, std::array<float, 3> at) {
    const TextureTarget target = texture.target();
    const Sampler& sampler = texture.sampler();
    int layer = 0;
    Wrap wrap_s = sampler.wrap_s, wrap_t = sampler.wrap_t;
    if (target == TextureTarget::cube) {
        const auto [s, t, r] = at;
        const float x = std::abs(s), y = std::abs(t), z = std::abs(r);
        float a = 0.0F, b = 0.0F, m = z;
        if (x >= y && x >= z) {
            layer = s < 0.0F ? 1 : 0;
            a = s < 0.0F ? r : -r;
            b = -t;
            m = x;
        } else if (y >= z) {
            layer = t < 0.0F ? 3 : 2;
            a = s;
            b = t < 0.0F ? -r : r;
            m = y;
        } else {
            layer = r < 0.0F ? 5 : 4;
            a = r < 0.0F ? -s : s;
            b = -t;
        }
        at = {(a / m) * 0.5F + 0.5F, (b / m) * 0.5F + 0.5F, 0.0F};
        wrap_s = wrap_t = Wrap::clamp_to_edge;
    }
    const bool rectangle = target == TextureTarget::rectangle;
    const int x = nearest_texel(at[0], texture.width(), wrap_s, rectangle);
    const int y = target == TextureTarget::one_d
                      ? 0
                      : nearest_texel(at[1], texture.height(), wrap_t, rectangle);
    if (target == TextureTarget::three_d)
        layer = nearest_texel(at[2], texture.levels().front().depth, sampler.wrap_r, false);
    std::array<int, 4> numbers{};
    const int channels = is_hilo(texture.format()) ? 2 : 4;
    for (int c = 0; c < channels; ++c)
        numbers.at(static_cast<std::size_t>(c)) = texture.texel(0, layer, x, y, c);
    return numbers;
}

/// A number of the image as the code of a register.
inline int code_of_number(int number, bool is_signed, NumberModel numbers) {
    if (numbers == NumberModel::nine_bit) return is_signed ? 2 * number : number;
    return is_signed ? 128 * number : (257 * number + 2) / 4;
}

/// What a fragment's units do.
class UnitOracle {
  public:
    UnitOracle(const TextureShader& shader, const std::vector<TexturePtr>& textures,
               const Machine& machine, const std::array<glm::vec4, 4>& coordinates)
        : m_shader(shader), m_textures(textures), m_machine(machine), m_at(coordinates) {
        for (const UnitProblem& p : check_consistency(shader, textures, machine))
            m_off.at(index(p.unit)) = true;
        for (int i = 0; i < kTextureShaderUnits; ++i) run(i);
    }

    /// What the combiners get.
    [[nodiscard]] Codes result(int unit) const { return m_results.at(index(unit)); }
    [[nodiscard]] bool kept() const { return m_kept; }
    [[nodiscard]] bool replaces_depth() const { return m_replaces_depth; }
    [[nodiscard]] float depth() const { return m_depth; }

  private:
    using Op = TextureOperation;
    using Vector = std::array<float, 3>;

    struct Texel {
        TexelClass kind = TexelClass::unsigned_rgba;
        Codes codes{};
        float hi = 0.0F, lo = 0.0F;
    };

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

    void sample(int i, const Vector& at) {
        const Texture& texture = *m_textures.at(index(i));
        const std::array<int, 4> numbers = nearest_numbers(texture, at);
        Texel& texel = m_texels.at(index(i));
        texel.kind = format_class(texture.format());
        for (std::size_t c = 0; c < 4; ++c)
            texel.codes[c] = code_of_number(numbers[c], texture.is_signed(static_cast<int>(c)),
                                            m_machine.numbers);
        const float divisor = texel.kind == TexelClass::hilo ? 65535.0F : 32768.0F;
        texel.hi = static_cast<float>(numbers[0]) / divisor;
        texel.lo = static_cast<float>(numbers[1]) / divisor;
        Codes& result = m_results.at(index(i));
        switch (texel.kind) {
            case TexelClass::unsigned_rgba:
            case TexelClass::signed_rgba:
            case TexelClass::mixed:
                result = texel.codes;
                break;
            case TexelClass::dsdt_mag_intensity:
                result = {0, 0, 0, texel.codes[3]};
                break;
            default:
                result = {};
                break;
        }
    }

    // --- what texels mean

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
        const Texel& texel = m_texels.at(index(unit(i).previous));
        const DotMapping mapping = unit(i).dot_mapping;
        if (texel.kind == TexelClass::hilo && mapping != DotMapping::nv2a_hemisphere_d3d)
            return {texel.hi, texel.lo, 1.0F};
        if (texel.kind == TexelClass::hilo || texel.kind == TexelClass::signed_hilo) {
            const auto mapped = [&](float x) {
                switch (mapping) {
                    case DotMapping::nv2a_hemisphere_d3d:
                        return (x * 65535.0F - 32768.0F) / 32767.0F;
                    case DotMapping::nv2a_hemisphere_gl:
                        return (x * 32768.0F + 0.5F) / 32767.5F;
                    case DotMapping::nv2a_hemisphere_signed:
                        return x * 32768.0F / 32767.0F;
                    default:
                        return x;
                }
            };
            const float x = mapped(texel.hi), y = mapped(texel.lo);
            return {x, y, std::sqrt(std::max((1.0F - x * x) - y * y, 0.0F))};
        }
        Vector v{};
        for (std::size_t c = 0; c < 3; ++c) {
            const int code = texel.codes[c];
            if (texel.kind == TexelClass::signed_rgba) {
                v[c] = signed_number(code);
                continue;
            }
            const auto n = static_cast<float>(two_complement(code));
            switch (mapping) {
                case DotMapping::expand:
                    v[c] = expanded(code);
                    break;
                case DotMapping::force_blue_to_one:
                    v[c] = c == 2 ? 1.0F : unsigned_number(code);
                    break;
                case DotMapping::nv2a_d3d:
                    v[c] = (static_cast<float>(code) - 128.0F) / 127.0F;
                    break;
                case DotMapping::nv2a_gl:
                    v[c] = (n + 0.5F) / 127.5F;
                    break;
                case DotMapping::nv2a_signed:
                    v[c] = n / 127.0F;
                    break;
                default:
                    v[c] = unsigned_number(code);
                    break;
            }
        }
        return v;
    }

    [[nodiscard]] float dot(int i) const {
        const Vector v = vector(i);
        return (s(i) * v[0] + t(i) * v[1]) + r(i) * v[2];
    }

    // --- units

    void run(int i) {
        const Codes& previous = m_texels.at(index(unit(i).previous)).codes;
        const Texel& from = m_texels.at(index(unit(i).previous));
        switch (operation(i)) {
            case Op::none:
            case Op::dot_product:
                return;
            case Op::texture_1d:
            case Op::texture_2d:
            case Op::texture_rectangle:
            case Op::texture_3d:
                return sample(i, {s(i) / q(i), t(i) / q(i), r(i) / q(i)});
            case Op::texture_cube_map:
                return sample(i, {s(i), t(i), r(i)});
            case Op::pass_through:
                return color(i, {s(i), t(i), r(i), q(i)});
            case Op::cull_fragment:
                for (int c = 0; c < 4; ++c) {
                    const float x = m_at.at(index(i))[c];
                    const bool less = unit(i).cull.at(index(c)) == CullTest::less_than_zero;
                    m_kept = m_kept && (less ? x < 0.0F : x >= 0.0F);
                }
                return;
            case Op::dependent_ar:
                return sample(i, {unsigned_number(previous[3]), unsigned_number(previous[0]), 0});
            case Op::dependent_gb:
                return sample(i, {unsigned_number(previous[1]), unsigned_number(previous[2]), 0});
            case Op::dependent_hilo:
                return sample(i, {from.hi, from.lo, 0.0F});
            case Op::dependent_rgb_3d:
                return sample(i, {unsigned_number(previous[0]), unsigned_number(previous[1]),
                                  unsigned_number(previous[2])});
            case Op::dependent_rgb_cube_map:
                return sample(
                    i, {expanded(previous[0]), expanded(previous[1]), expanded(previous[2])});
            case Op::dot_product_1d:
                return sample(i, {dot(i), 0.0F, 0.0F});
            case Op::dot_product_2d:
            case Op::dot_product_rectangle:
                return sample(i, {dot(i - 1), dot(i), 0.0F});
            case Op::dot_product_3d:
            case Op::dot_product_cube_map:
                return sample(i, {dot(i - 2), dot(i - 1), dot(i)});
            case Op::dot_product_diffuse_cube_map:
                return sample(i, {dot(i - 1), dot(i), dot(i + 1)});
            case Op::dot_product_reflect_cube_map:
                return reflect(i, {q(i - 2), q(i - 1), q(i)});
            case Op::dot_product_const_eye_reflect_cube_map:
                return reflect(i, {unit(i).const_eye.x, unit(i).const_eye.y, unit(i).const_eye.z});
            case Op::dot_product_pass_through:
                return color(i, {dot(i), dot(i), dot(i), dot(i)});
            case Op::dot_product_depth_replace:
                m_replaces_depth = true;
                m_depth = dot(i - 1) / dot(i);
                return;
            case Op::dot_product_affine_depth_replace:
                m_replaces_depth = true;
                m_depth = dot(i);
                return;
            case Op::texture_brdf: {
                const Texel &eye = m_texels.at(index(i - 2)), &light = m_texels.at(index(i - 1));
                const float phi = eye.hi - light.hi;
                return sample(i, {eye.lo, light.lo, phi - std::floor(phi)});
            }
            default:
                return offset(i, from);
        }
    }

    void color(int i, const std::array<float, 4>& x) {
        for (std::size_t c = 0; c < 4; ++c)
            m_results.at(index(i))[c] = color_code(x[c], m_machine.numbers);
        m_texels.at(index(i)) = {.codes = m_results.at(index(i))};
    }

    void reflect(int i, const Vector& e) {
        const Vector n{dot(i - 2), dot(i - 1), dot(i)};
        const auto product = [](const Vector& a, const Vector& b) {
            return (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2];
        };
        const float k = (2.0F * product(n, e)) / product(n, n);
        sample(i, {k * n[0] - e[0], k * n[1] - e[1], k * n[2] - e[2]});
    }

    void offset(int i, const Texel& from) {
        const bool bytes = m_shader.bump_source == BumpSource::rgba8;
        float ds = signed_number(from.codes[0]), dt = signed_number(from.codes[1]);
        int magnitude = from.codes[2];
        if (is_hilo_offset(operation(i))) {
            ds = from.hi;
            dt = from.lo;
        } else if (bytes) {
            const auto byte = [&](int code) {
                return from.kind == TexelClass::signed_rgba
                           ? signed_number(code)
                           : static_cast<float>(two_complement(code)) / 128.0F;
            };
            ds = byte(from.codes[2]);
            dt = byte(from.codes[1]);
            magnitude = from.codes[0];
        }
        const glm::mat2& m = unit(i).offset_matrix;
        const bool projective = is_projective_offset(operation(i));
        const float u = projective ? s(i) / q(i) : s(i), v = projective ? t(i) / q(i) : t(i);
        sample(i, {(u + m[0][0] * ds) + m[1][0] * dt, (v + m[0][1] * ds) + m[1][1] * dt, 0.0F});
        if (!is_dimmed(operation(i))) return;
        float f = unit(i).offset_bias + unit(i).offset_scale * unsigned_number(magnitude);
        if (m_machine.magnitude_factor == MagnitudeFactor::clamped)
            f = f > 0.0F ? std::min(f, 1.0F) : 0.0F;
        const TexelClass kind = m_texels.at(index(i)).kind;
        if (kind != TexelClass::unsigned_rgba && kind != TexelClass::signed_rgba &&
            kind != TexelClass::mixed)
            return;
        for (std::size_t c = 0; c < 3; ++c) {
            int& code = m_results.at(index(i))[c];
            const float x = static_cast<float>(code) * f + (nine_bit() ? 0.02F : 0.5F);
            const float low = nine_bit() ? -256.0F : -32768.0F;
            code = static_cast<int>(std::floor(std::clamp(x, low, static_cast<float>(one()))));
        }
    }

    const TextureShader& m_shader;
    const std::vector<TexturePtr>& m_textures;
    const Machine& m_machine;
    std::array<glm::vec4, 4> m_at;
    std::array<bool, 4> m_off{};
    std::array<Texel, 4> m_texels{};
    std::array<Codes, 4> m_results{};
    bool m_kept = true, m_replaces_depth = false;
    float m_depth = 0.0F;
};

}  // namespace burnish
