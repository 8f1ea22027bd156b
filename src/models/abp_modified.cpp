#include "models/abp_modified.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <burnish/error.hpp>
#include <cmath>

#include "core/tile_watch.hpp"

namespace burnish {

namespace {

using namespace combine;

/// The dots are of vectors times m; two scales undo it: 1/m = dot scale * sqrt(square scale).
struct LobeScale {
    float reach;  ///< 1/m
    Scale dot, square;
};
constexpr LobeScale kLobeScales[] = {
    {1.0F, Scale::one, Scale::one},
    {2.0F, Scale::two, Scale::one},
    {4.0F, Scale::four, Scale::one},
    {8.0F, Scale::four, Scale::four},
};

const LobeScale& lobe_scale(const Material& material) {
    if (material.tangent_map && material.bitangent_map) {
        for (const LobeScale& s : kLobeScales) {
            if (material.map_scale * s.reach == 1.0F) return s;
        }
        throw Error(ErrorCode::bad_program,
                    fmt::format("material '{}': map_scale {}, expected 1, 0.5, 0.25 or 0.125",
                                material.name, material.map_scale));
    }
    const float narrowest = std::min(material.alpha_x, material.alpha_y);
    for (const LobeScale& s : kLobeScales) {
        if (narrowest * s.reach >= 1.0F) return s;
    }
    throw Error(ErrorCode::bad_program,
                fmt::format("material '{}': alpha {} is too narrow, two scales by 4 reach 0.125",
                            material.name, narrowest));
}

std::uint8_t code(float x) {
    const float c = std::floor(127.5F * x + 128.0F);
    return static_cast<std::uint8_t>(c > 0.0F ? std::min(c, 255.0F) : 0.0F);
}

glm::vec3 normal_at(const Texture& map, int x, int y) {
    const auto component = [&](int c) {
        return static_cast<float>(map.texel(0, 0, x, y, c) - (map.is_signed(c) ? 0 : 128));
    };
    const glm::vec3 n(component(0), component(1), component(2));
    const float length = std::sqrt((n.x * n.x + n.y * n.y) + n.z * n.z);
    return length > 0.0F ? n / length : glm::vec3(0.0F, 0.0F, 1.0F);
}

/// Tangent: the u axis made perpendicular to the normal; bitangent: normal x tangent.
glm::vec3 frame_axis(const glm::vec3& n, int axis) {
    glm::vec3 t = glm::vec3(1.0F, 0.0F, 0.0F) - n * n.x;
    const float length = std::sqrt((t.x * t.x + t.y * t.y) + t.z * t.z);
    t = length > 1e-6F ? t / length : glm::vec3(0.0F, 0.0F, -1.0F);
    return axis == 0 ? t : glm::cross(n, t);
}

void write_axis(const glm::vec3& axis, float factor, std::uint8_t* texel) {
    for (int c = 0; c < 3; ++c) texel[c] = code(axis[c] * factor);
    texel[3] = 255;
}

bool is_grey(const glm::vec3& c) {
    return c.r == c.g && c.g == c.b;
}

[[noreturn]] void short_of(const Material& material, const Machine& machine, const char* why) {
    throw Error(ErrorCode::bad_program,
                fmt::format("material '{}' on machine '{}': {}", material.name, machine.name, why));
}

/// Stages 0 and 1: spare0 = (h.t / alpha_x)^2 + (h.b / alpha_y)^2, clamped to 1.
void add_lobe(ProgramBuilder& p, const LobeScale& scale) {
    p.stage()
        .rgb()
        .ab(dot(expand(tex(0)), expand(Register::col0)), Register::spare0)
        .cd(dot(expand(tex(1)), expand(Register::col0)), Register::spare1)
        .scale(scale.dot);
    p.stage()
        .rgb()
        .ab(mul(in(Register::spare0), in(Register::spare0)))
        .cd(mul(in(Register::spare1), in(Register::spare1)))
        .sum(Register::spare0)
        .scale(scale.square);
}

const Input kNone = raw(Register::zero);
const Input kLobe = raw(Register::spare0);

/// Four stages or more: every factor has a place.
void compile_long(const Material& material, const glm::vec3& light, const glm::vec3& ambient,
                  const LobeScale& scale, ProgramMaterial& out) {
    ProgramBuilder p;
    add_lobe(p, scale);
    const Register specular = Register::spare1, diffuse = tex(1);
    const Input n_dot_l = alpha(in(Register::col0));
    p.stage()
        .rgb()
        .ab(mul(n_dot_l, in(Register::const0)), specular)
        .cd(mul(n_dot_l, in(Register::const1)), diffuse);
    p.stage();
    if (material.specular_map) p.rgb().ab(mul(in(specular), in(tex(2))), specular);
    const bool lit = material.kd != glm::vec3(0.0F);
    if (lit) {
        p.stage()
            .rgb()
            .ab(mul(in(diffuse), one()))
            .cd(mul(in(Register::const1), one()))
            .sum(diffuse);
    }
    p.lerp(kLobe, kNone, raw(specular), lit ? raw(diffuse) : raw(Register::const1));
    p.out_alpha(alpha(one()));
    p.constants(glm::vec4(0.0F), glm::vec4(ambient, 1.0F));
    out.combiners = p.build();
    out.combiners.stages[2].const0 = glm::vec4(material.ks * light, 1.0F);
    out.combiners.stages[2].const1 = glm::vec4(material.kd * light, 1.0F);
    out.units.push_back(material.specular_map);
}

/// Ambient and diffuse light, where no stage is left for them: a constant, or with the vertices.
Input unlobed_light(const Material& material, const glm::vec3& light, const glm::vec3& ambient,
                    CombinerProgram& program, ProgramMaterial& out) {
    if (material.kd == glm::vec3(0.0F)) {
        program.const1 = glm::vec4(ambient, 1.0F);
        return raw(Register::const1);
    }
    out.col1_rgb = ColorInput::lit;
    out.lit_tint = material.kd * light;
    out.lit_base = ambient;
    return raw(Register::col1);
}

/// Two stages, two units: ks is a constant times the tangent map's alpha; diffuse and ambient light
/// come with the vertices.
void compile_two_units(const Material& material, const glm::vec3& light, const glm::vec3& ambient,
                       const LobeScale& scale, ProgramMaterial& out) {
    ProgramBuilder p;
    add_lobe(p, scale);
    CombinerProgram program = p.build();
    PortionBuilder(program.stages[0].alpha)
        .ab(mul(alpha(in(tex(0))), alpha(in(Register::col0))), Register::spare0);
    ProgramBuilder last;
    last.product(alpha(raw(Register::spare0)), raw(Register::const0));
    last.lerp(kLobe, kNone, raw(Register::final_product),
              unlobed_light(material, light, ambient, program, out));
    last.out_alpha(alpha(one()));
    program.final_combiner = last.build().final_combiner;
    program.const0 = glm::vec4(material.ks * light, 1.0F);
    out.combiners = program;
}

/// Two stages, three units: ks is a map. E*F holds the map and one more factor, so the constants
/// either are grey and enter in stage 0, or come with the vertices in place of the diffuse term.
void compile_three_units(const Material& material, const Machine& machine, const glm::vec3& light,
                         const glm::vec3& ambient, const LobeScale& scale, ProgramMaterial& out) {
    ProgramBuilder p;
    add_lobe(p, scale);
    CombinerProgram program = p.build();
    const glm::vec3 factor = material.ks * light;
    ProgramBuilder last;
    if (is_grey(factor)) {
        PortionBuilder(program.stages[0].alpha)
            .ab(mul(alpha(in(Register::col0)), alpha(in(Register::const0))), Register::spare0);
        program.const0 = glm::vec4(0.0F, 0.0F, 0.0F, factor.r);
        last.product(raw(tex(2)), alpha(raw(Register::spare0)));
        last.lerp(kLobe, kNone, raw(Register::final_product),
                  unlobed_light(material, light, ambient, program, out));
    } else if (material.kd == glm::vec3(0.0F)) {
        last.product(raw(tex(2)), raw(Register::col1));
        last.lerp(kLobe, kNone, raw(Register::final_product), raw(Register::const1));
        program.const1 = glm::vec4(ambient, 1.0F);
        out.col1_rgb = ColorInput::lit;
        out.lit_tint = factor;
    } else {
        short_of(material, machine,
                 "a ks map with coloured ks or light and a diffuse term needs 5 general stages");
    }
    last.out_alpha(alpha(one()));
    program.final_combiner = last.build().final_combiner;
    out.combiners = program;
    out.units.push_back(material.specular_map);
}

}  // namespace

TexturePtr DerivedMaps::axis_map(const TexturePtr& normal_map, int axis, float factor) {
    for (Entry& e : m_entries) {
        if (e.normal_map == normal_map && e.axis == axis && e.factor == factor) {
            e.idle = 0;
            return e.map;
        }
    }
    Image8 image(normal_map ? normal_map->width() : 1, normal_map ? normal_map->height() : 1);
    for (int y = 0; y < image.height; ++y) {
        require_wanted(models.stop);
        for (int x = 0; x < image.width; ++x) {
            const glm::vec3 n =
                normal_map ? normal_at(*normal_map, x, y) : glm::vec3(0.0F, 0.0F, 1.0F);
            write_axis(frame_axis(n, axis), factor, image.at(x, y));
        }
    }
    TextureDescription description;
    if (normal_map) {
        description.sampler = normal_map->sampler();
        description.box_mipmaps = normal_map->levels().size() > 1;
    }
    m_entries.push_back({normal_map, axis, factor,
                         std::make_shared<Texture>(std::span(&image, 1), description), 0});
    return m_entries.back().map;
}

void DerivedMaps::drop_unused(int frames) {
    std::erase_if(m_entries, [frames](const Entry& e) { return e.idle >= frames; });
    for (Entry& e : m_entries) ++e.idle;
    models.drop_unused(frames);
}

bool has_own_maps(const Material& material) {
    return material.model == Model::abp_modified && material.tangent_map && !material.mipmaps;
}

ProgramMaterial compile_abp_modified(const Material& material, const Machine& machine,
                                     const glm::vec3& light, const glm::vec3& ambient,
                                     DerivedMaps& maps) {
    if (!(material.alpha_x > 0.0F && material.alpha_x <= 1.0F && material.alpha_y > 0.0F &&
          material.alpha_y <= 1.0F)) {
        throw Error(
            ErrorCode::bad_program,
            fmt::format("material '{}': alpha_x {}, alpha_y {}, expected more than 0, at most 1",
                        material.name, material.alpha_x, material.alpha_y));
    }
    if (!material.tangent_map != !material.bitangent_map) {
        short_of(material, machine,
                 "a tangent map or a bitangent map alone, expected both or neither");
    }
    for (const TexturePtr& map : {material.normal_map, material.tangent_map, material.bitangent_map,
                                  material.specular_map}) {
        if (map && (map->target() != TextureTarget::two_d || has_words(map->format()) ||
                    format_class(map->format()) != TexelClass::unsigned_rgba)) {
            short_of(material, machine, "a map that is not two-dimensional of unsigned bytes");
        }
    }
    if (machine.texture_units < 2) short_of(material, machine, "needs 2 texture units");
    if (machine.general_stages < 2) short_of(material, machine, "needs 2 general stages");
    const LobeScale& scale = lobe_scale(material);
    ProgramMaterial out;
    out.units = {material.tangent_map, material.bitangent_map};
    if (!material.tangent_map) {
        out.units[0] =
            maps.axis_map(material.normal_map, 0, 1.0F / (scale.reach * material.alpha_x));
        out.units[1] =
            maps.axis_map(material.normal_map, 1, 1.0F / (scale.reach * material.alpha_y));
    }
    out.col0_rgb = ColorInput::half_tangent;
    out.col0_a = ColorInput::n_dot_l;
    if (machine.general_stages >= 5 && machine.texture_units >= 3 && machine.stage_constants) {
        compile_long(material, light, ambient, scale, out);
    } else if (machine.texture_units >= 3 && material.specular_map) {
        compile_three_units(material, machine, light, ambient, scale, out);
    } else {
        compile_two_units(material, light, ambient, scale, out);
    }
    return out;
}

}  // namespace burnish
