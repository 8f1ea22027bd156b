#include <fmt/format.h>

#include <algorithm>
#include <burnish/texture_shader.hpp>
#include <optional>

#include "machine/unit_operations.hpp"

namespace burnish {

namespace {

using Op = TextureOperation;

std::string_view target_name(TextureTarget target) {
    switch (target) {
        case TextureTarget::one_d:
            return "1D";
        case TextureTarget::two_d:
            return "2D";
        case TextureTarget::rectangle:
            return "rectangle";
        case TextureTarget::cube:
            return "cube map";
        case TextureTarget::three_d:
            return "3D";
    }
    return "unknown";
}

std::string_view class_name(TexelClass format) {
    switch (format) {
        case TexelClass::unsigned_rgba:
            return "unsigned colours";
        case TexelClass::signed_rgba:
            return "signed colours";
        case TexelClass::mixed:
            return "colours with and without sign";
        case TexelClass::hilo:
            return "unsigned HILO";
        case TexelClass::signed_hilo:
            return "signed HILO";
        case TexelClass::dsdt:
            return "DSDT";
        case TexelClass::dsdt_mag:
            return "DSDT with magnitude";
        case TexelClass::dsdt_mag_intensity:
            return "DSDT with magnitude and intensity";
    }
    return "unknown";
}

/// What an operation can read: a bit for each class.
struct Readable {
    std::string_view name;
    unsigned classes;

    [[nodiscard]] bool has(TexelClass format) const {
        return (classes >> static_cast<unsigned>(format) & 1U) != 0;
    }
};

template <class... Classes>
constexpr unsigned any_of(Classes... classes) {
    return ((1U << static_cast<unsigned>(classes)) | ...);
}

constexpr auto kUnsigned = TexelClass::unsigned_rgba;
constexpr auto kSigned = TexelClass::signed_rgba;

/// Unit by unit: a unit that is off counts as off for those behind it.
class Checker {
  public:
    Checker(const TextureShader& shader, std::span<const TexturePtr> textures,
            const Machine& machine)
        : m_shader(shader),
          m_textures(textures),
          m_last(std::min(machine.texture_units, kTextureShaderUnits) - 1) {}

    std::vector<UnitProblem> check() {
        std::vector<UnitProblem> problems;
        for (int i = 0; i < kTextureShaderUnits; ++i) {
            if (operation(i) == Op::none) continue;
            std::optional<std::string> reason = problem(i);
            if (!reason) {
                m_consistent.at(index(i)) = true;
                continue;
            }
            problems.push_back(
                {i, fmt::format("{} {}", texture_operation_name(operation(i)), *reason)});
        }
        return problems;
    }

  private:
    using Problem = std::optional<std::string>;

    static std::size_t index(int i) { return static_cast<std::size_t>(i); }
    [[nodiscard]] const TextureUnit& unit(int i) const { return m_shader.units.at(index(i)); }
    [[nodiscard]] Op operation(int i) const { return unit(i).operation; }
    [[nodiscard]] const Texture* texture(int i) const {
        return index(i) < m_textures.size() ? m_textures[index(i)].get() : nullptr;
    }

    [[nodiscard]] Problem problem(int i) const {
        if (const Problem p = texture_problem(i)) return p;
        if (is_reflection(operation(i)) && i >= 2 && unit(i).previous >= i - 2)
            return fmt::format("reads unit {}, expected one in front of its dot products",
                               unit(i).previous);
        if (reads_previous(operation(i))) {
            if (const Problem p = previous_problem(i, unit(i).previous)) return p;
        }
        if (takes_dot_product(operation(i))) {
            if (const Problem p = mapping_problem(i)) return p;
            return dot_problem(i);
        }
        if (operation(i) == Op::texture_brdf) return brdf_problem(i);
        return std::nullopt;
    }

    [[nodiscard]] Problem texture_problem(int i) const {
        const std::optional<TextureTarget> wanted = sampled_target(operation(i));
        if (!wanted) return std::nullopt;
        const Texture* found = texture(i);
        if (found == nullptr)
            return fmt::format("without a texture, expected a {} texture", target_name(*wanted));
        if (found->target() != *wanted)
            return fmt::format("with a {} texture, expected {}", target_name(found->target()),
                               target_name(*wanted));
        return std::nullopt;
    }

    /// The class of what a unit with a texel delivers.
    [[nodiscard]] TexelClass delivered(int i) const {
        if (!sampled_target(operation(i))) return kUnsigned;  // pass-through
        return format_class(texture(i)->format());
    }

    [[nodiscard]] Readable readable(int i) const {
        const bool bytes = m_shader.bump_source == BumpSource::rgba8;
        switch (operation(i)) {
            case Op::offset_2d:
            case Op::offset_rectangle:
            case Op::offset_projective_2d:
            case Op::offset_projective_rectangle:
                if (bytes) return {"colours", any_of(kUnsigned, kSigned)};
                return {"DSDT", any_of(TexelClass::dsdt, TexelClass::dsdt_mag,
                                       TexelClass::dsdt_mag_intensity)};
            case Op::offset_2d_scale:
            case Op::offset_rectangle_scale:
            case Op::offset_projective_2d_scale:
            case Op::offset_projective_rectangle_scale:
                if (bytes) return {"unsigned colours", any_of(kUnsigned)};
                return {"DSDT with magnitude",
                        any_of(TexelClass::dsdt_mag, TexelClass::dsdt_mag_intensity)};
            case Op::offset_hilo_2d:
            case Op::offset_hilo_rectangle:
            case Op::offset_hilo_projective_2d:
            case Op::offset_hilo_projective_rectangle:
                return {"signed HILO", any_of(TexelClass::signed_hilo)};
            case Op::dependent_hilo:
                return {"unsigned HILO", any_of(TexelClass::hilo)};
            case Op::dependent_ar:
            case Op::dependent_gb:
            case Op::dependent_rgb_3d:
            case Op::dependent_rgb_cube_map:
                return {"unsigned colours", any_of(kUnsigned)};
            default:
                return {"colours of one sign or HILO",
                        any_of(kUnsigned, kSigned, TexelClass::hilo, TexelClass::signed_hilo)};
        }
    }

    [[nodiscard]] Problem previous_problem(int i, int from) const {
        if (!has_texel(operation(from)))
            return fmt::format("reads unit {}, whose operation {} has no texel", from,
                               texture_operation_name(operation(from)));
        if (!m_consistent.at(index(from))) return fmt::format("reads unit {}, which is off", from);
        const Readable wanted = readable(i);
        const TexelClass found = delivered(from);
        if (wanted.has(found)) return std::nullopt;
        return fmt::format("reads unit {}, whose texels are {}, expected {}", from,
                           class_name(found), wanted.name);
    }

    /// The codes of the NV2A say what the previous texel is.
    [[nodiscard]] Problem mapping_problem(int i) const {
        const TexelClass found = delivered(unit(i).previous);
        const auto expect = [&](TexelClass wanted) -> Problem {
            if (found == wanted) return std::nullopt;
            return fmt::format(
                "reads unit {} by a dot mapping of the NV2A, whose texels are {}, "
                "expected {}",
                unit(i).previous, class_name(found), class_name(wanted));
        };
        switch (unit(i).dot_mapping) {
            case DotMapping::nv2a_d3d:
            case DotMapping::nv2a_gl:
            case DotMapping::nv2a_signed:
                return expect(kUnsigned);
            case DotMapping::nv2a_hilo:
            case DotMapping::nv2a_hemisphere_d3d:
                return expect(TexelClass::hilo);
            case DotMapping::nv2a_hemisphere_gl:
            case DotMapping::nv2a_hemisphere_signed:
                return expect(TexelClass::signed_hilo);
            default:
                return std::nullopt;
        }
    }

    /// Units i - 1, i - 2, ... that must take dot products, too.
    [[nodiscard]] Problem dot_problem(int i) const {
        const Op op = operation(i);
        if (op == Op::dot_product) {
            if (i < m_last) return std::nullopt;
            return std::string("in the last unit, expected a unit behind it");
        }
        for (int k = 1; k < dot_products_used(op); ++k) {
            const bool diffuse = k == 1 && is_reflection(op) && i > 0 &&
                                 operation(i - 1) == Op::dot_product_diffuse_cube_map;
            if (i < k || (operation(i - k) != Op::dot_product && !diffuse))
                return fmt::format("in unit {}, expected dot_product in unit {}", i, i - k);
            if (!m_consistent.at(index(i - k)))
                return fmt::format("needs the dot product of unit {}, which is off", i - k);
        }
        if (op == Op::dot_product_diffuse_cube_map) return diffuse_problem(i);
        return std::nullopt;
    }

    /// Its third dot product is the next unit's.
    [[nodiscard]] Problem diffuse_problem(int i) const {
        if (i >= m_last || !is_reflection(operation(i + 1)))
            return fmt::format("in unit {}, expected a reflection in unit {}", i, i + 1);
        const int from = unit(i + 1).previous;
        if (from >= i - 1 || previous_problem(i + 1, from) || mapping_problem(i + 1))
            return fmt::format("needs the dot product of unit {}, which is off", i + 1);
        return std::nullopt;
    }

    [[nodiscard]] Problem brdf_problem(int i) const {
        for (int k = 2; k >= 1; --k) {
            if (i < k || !has_texel(operation(i - k)) || !m_consistent.at(index(i - k)))
                return fmt::format("in unit {}, expected HILO texels in units {} and {}", i, i - 2,
                                   i - 1);
            const TexelClass found = delivered(i - k);
            if (found != TexelClass::hilo && found != TexelClass::signed_hilo)
                return fmt::format("reads unit {}, whose texels are {}, expected HILO", i - k,
                                   class_name(found));
        }
        return std::nullopt;
    }

    const TextureShader& m_shader;
    std::span<const TexturePtr> m_textures;
    int m_last;
    std::array<bool, kTextureShaderUnits> m_consistent{};
};

}  // namespace

std::vector<UnitProblem> check_consistency(const TextureShader& shader,
                                           std::span<const TexturePtr> textures,
                                           const Machine& machine) {
    return Checker(shader, textures, machine).check();
}

}  // namespace burnish
