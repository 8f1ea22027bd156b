#include "shade/shading.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <burnish/error.hpp>

#include "shade/sample.hpp"

namespace burnish {

namespace {

constexpr int kUnitsWithCoordinates = 4;  // of raw vertices; further units take the first's

/// A colour component that the program reads, and what it is to carry.
struct ColorSlot {
    Register reg;
    int component;
    ColorInput input;
    int plane;
};

std::vector<ColorSlot> color_slots(const ProgramMaterial& m, const BoundProgram& program) {
    std::vector<ColorSlot> slots;
    const auto add = [&](Register reg, ColorInput rgb, ColorInput a) {
        for (int c = 0; c < 4; ++c) {
            const int plane =
                program.input[static_cast<std::size_t>(reg)][static_cast<std::size_t>(c)];
            if (plane >= 0) slots.push_back({reg, c, c < 3 ? rgb : a, plane});
        }
    };
    add(Register::col0, m.col0_rgb, m.col0_a);
    add(Register::col1, m.col1_rgb, m.col1_a);
    return slots;
}

Varying::Source source_of(const ColorSlot& slot) {
    switch (slot.input) {
        case ColorInput::vertex:
            return slot.reg == Register::col0 ? Varying::Source::color0 : Varying::Source::color1;
        case ColorInput::half_tangent:
            return Varying::Source::half_tangent;
        case ColorInput::light_tangent:
            return Varying::Source::light_tangent;
        case ColorInput::view_tangent:
            return Varying::Source::view_tangent;
        case ColorInput::n_dot_l:
            return Varying::Source::n_dot_l;
        case ColorInput::lit:
            break;
    }
    return Varying::Source::lit;
}

/// Decides where every attribute comes from and which operations bring it to the registers.
class Planner {
  public:
    Planner(Shading& shading, const ProgramMaterial& material, bool is_mesh, bool per_pixel)
        : m_shading(shading), m_is_mesh(is_mesh), m_per_pixel(per_pixel) {
        shading.varying_list.clear();
        shading.inputs.clear();
        shading.frame_attributes = is_mesh ? kUvAttributes + (per_pixel ? kFrameAttributes : 0) : 0;
        m_slots = color_slots(material, shading.program);
    }

    void plan(const LightSpace& space) {
        for (const ColorSlot& slot : m_slots) {
            if (!m_is_mesh && slot.input != ColorInput::vertex) {
                throw Error(ErrorCode::bad_program,
                            "raw vertices carry no normals: their colours can only be 'vertex'");
            }
            if (varies_per_vertex(slot)) varying({source_of(slot), index_of(slot)});
        }
        plan_textures();  // adds the coordinates of raw vertices
        if (m_is_mesh && m_per_pixel) plan_lighting(space);
        for (const ColorSlot& slot : m_slots) {
            const int attribute = attribute_of(slot);
            if (attribute < 0) {
                m_shading.inputs.emplace_back(ClearCtx{slot.plane});
            } else {
                m_shading.inputs.emplace_back(EncodeCtx{attribute, slot.plane});
            }
        }
        m_shading.inputs.insert(m_shading.inputs.end(), m_texture_ops.begin(), m_texture_ops.end());
    }

  private:
    [[nodiscard]] static bool is_vector(ColorInput input) {
        return input == ColorInput::half_tangent || input == ColorInput::light_tangent ||
               input == ColorInput::view_tangent;
    }
    [[nodiscard]] static int index_of(const ColorSlot& slot) {
        return slot.input == ColorInput::n_dot_l ? 0 : slot.component;
    }
    /// Vectors and `lit` have three components, and a mesh has no vertex colour.
    [[nodiscard]] bool carries_something(const ColorSlot& slot) const {
        if (slot.input == ColorInput::vertex) return !m_is_mesh;
        return slot.input == ColorInput::n_dot_l || slot.component < 3;
    }
    [[nodiscard]] bool varies_per_vertex(const ColorSlot& slot) const {
        if (!carries_something(slot)) return false;
        const bool lighting = is_vector(slot.input) || slot.input == ColorInput::n_dot_l;
        return !(lighting && m_per_pixel);
    }

    /// Attribute plane of a varying, added where it is new.
    int varying(const Varying& v) {
        std::vector<Varying>& list = m_shading.varying_list;
        const auto at = std::find(list.begin(), list.end(), v);
        const auto position = static_cast<int>(at - list.begin());
        if (at == list.end()) list.push_back(v);
        return m_shading.frame_attributes + position;
    }

    int attribute_of(const ColorSlot& slot) {
        if (!carries_something(slot)) return -1;
        if (varies_per_vertex(slot)) return varying({source_of(slot), index_of(slot)});
        switch (slot.input) {
            case ColorInput::half_tangent:
                return m_lighting.half_vector + slot.component;
            case ColorInput::light_tangent:
                return m_lighting.light_vector + slot.component;
            case ColorInput::view_tangent:
                return m_lighting.view_vector + slot.component;
            default:
                return m_lighting.n_dot_l;
        }
    }

    void plan_lighting(const LightSpace& space) {
        int next = m_shading.interpolated();
        const auto planes = [&](ColorInput input, int count) {
            const bool used = std::any_of(m_slots.begin(), m_slots.end(), [&](const ColorSlot& s) {
                return s.input == input && carries_something(s);
            });
            if (!used) return -1;
            next += count;
            return next - count;
        };
        m_lighting.frame = kUvAttributes;
        m_lighting.half_vector = planes(ColorInput::half_tangent, 3);
        m_lighting.light_vector = planes(ColorInput::light_tangent, 3);
        m_lighting.view_vector = planes(ColorInput::view_tangent, 3);
        m_lighting.n_dot_l = planes(ColorInput::n_dot_l, 1);
        for (int i = 0; i < 3; ++i) {
            m_lighting.light[i] = space.light[i];
            m_lighting.eye[i] = space.eye[i];
        }
        m_lighting.light_w = space.light_w;
        if (next > m_shading.interpolated()) m_shading.inputs.emplace_back(m_lighting);
    }

    SampleCoordinates coordinates(int unit, TextureTarget target) {
        if (m_is_mesh) return {0, 1, -1, -1, true};
        const int set = unit < kUnitsWithCoordinates ? unit : 0;
        const auto coordinate = [&](int component) {
            return varying({Varying::Source::uv, 4 * set + component});
        };
        SampleCoordinates at{coordinate(0), -1, -1, -1, true};
        if (target != TextureTarget::one_d) at.t = coordinate(1);
        if (target == TextureTarget::cube || target == TextureTarget::three_d) at.r = coordinate(2);
        if (target != TextureTarget::cube) at.q = coordinate(3);
        return at;
    }

    /// What registers get of a texture without a texture shader: nothing of hilo and DSDT but the
    /// intensity.
    void plan_texture(const Texture& texture, int unit, int plane, SamplePlan& plan) {
        const TexelClass kind = format_class(texture.format());
        const bool offsets = kind == TexelClass::dsdt || kind == TexelClass::dsdt_mag;
        const bool hidden = offsets || is_hilo(texture.format());
        if (!hidden) {
            plan_sample(texture, coordinates(unit, texture.target()), {plane, -1}, plan,
                        m_texture_ops);
        }
        const int cleared = hidden ? 4 : kind == TexelClass::dsdt_mag_intensity ? 3 : 0;
        for (int c = 0; c < cleared; ++c) m_texture_ops.emplace_back(ClearCtx{plane + c});
    }

    void plan_textures() {
        BoundProgram& program = m_shading.program;
        SamplePlan plan{program.numbers, kSampleScratch, program.plane_count};
        for (std::size_t unit = 0; unit < m_shading.textures.size(); ++unit) {
            const TexturePtr& texture = m_shading.textures[unit];
            const auto reg = static_cast<std::size_t>(tex(static_cast<int>(unit)));
            const int plane = program.input[reg][0];
            if (!texture || plane < 0) continue;
            plan_texture(*texture, static_cast<int>(unit), plane, plan);
        }
        if (plan.uses_planes) program.plane_count += kSamplePlanes;
    }

    Shading& m_shading;
    bool m_is_mesh, m_per_pixel;
    std::vector<ColorSlot> m_slots;
    std::vector<InputOp> m_texture_ops;
    LightingCtx m_lighting{};
};

}  // namespace

void plan_shading(Shading& shading, const ProgramMaterial& material, const Machine& machine,
                  bool is_mesh, const Wanted& wanted) {
    if (material.units.size() > static_cast<std::size_t>(machine.texture_units)) {
        throw Error(ErrorCode::bad_program,
                    fmt::format("{} texture units, machine '{}' has {}", material.units.size(),
                                machine.name, machine.texture_units));
    }
    std::uint32_t enabled = 0;
    for (std::size_t i = 0; i < material.units.size(); ++i) {
        if (material.units[i]) enabled |= 1U << i;
    }
    shading.program = bind(material.combiners, machine, enabled, wanted);
    shading.textures = material.units;
    Planner(shading, material, is_mesh, machine.half_vector == HalfVector::pixel)
        .plan(shading.space);
}

void vertex_attributes(const Shading& shading, std::uint32_t vertex, float* out) {
    if (shading.frame_attributes > 0) {
        const VertexFrame& f = shading.frames[vertex];
        *out++ = f.uv.x;
        *out++ = 1.0F - f.uv.y;  // rows of a texture go down, v goes up
    }
    if (shading.frame_attributes > kUvAttributes) {
        const VertexFrame& f = shading.frames[vertex];
        const glm::vec3 vectors[4] = {glm::vec3(f.tangent), bitangent(f), f.normal, f.position};
        for (const glm::vec3& v : vectors) {
            *out++ = v.x;
            *out++ = v.y;
            *out++ = v.z;
        }
    }
    const std::size_t count = shading.varying_list.size();
    std::copy_n(shading.varyings.data() + vertex * count, count, out);
}

void feed_input(const InputOp& op, NumberModel numbers, const KernelTable& kernels,
                const AttributesCtx& runs, Packet& packet) {
    struct FeedInput {
        const KernelTable& k;
        const AttributesCtx& runs;
        Packet& p;
        bool nine_bit;
        void operator()(const ClearCtx& c) const {
            std::fill_n(p.planes + c.plane * kPacketSize, kPacketSize, std::int16_t{0});
        }
        void operator()(const LightingCtx& c) const { k.lighting(p, c); }
        void operator()(const AddressCtx& c) const { k.address(p, c); }
        void operator()(const EncodeCtx& c) const {
            (nine_bit ? k.encode_nine_bit : k.encode_wide)(p, c);
        }
        void operator()(const FetchCtx& c) const {
            (nine_bit ? k.fetch_nine_bit : k.fetch_wide)(p, c);
        }
        void operator()(const CubeFaceCtx& c) const { k.cube_face(p, c); }
        void operator()(const PlaneFootprintCtx& c) const {
            k.plane_footprint(p, {c.footprint, runs});
        }
        void operator()(const QuadFootprintCtx& c) const { k.quad_footprint(p, c); }
        void operator()(const LevelOfDetailCtx& c) const { k.level_of_detail(p, c); }
        void operator()(const LevelAddressCtx& c) const { k.level_address(p, c); }
        void operator()(const FetchHiloCtx& c) const { k.fetch_hilo(p, c); }
        void operator()(const FetchWordsCtx& c) const { k.fetch_words(p, c); }
        void operator()(const BlendLevelsCtx& c) const { k.blend_levels(p, c); }
        void operator()(const HiloCtx& c) const { k.hilo(p, c); }
    };
    std::visit(FeedInput{kernels, runs, packet, numbers == NumberModel::nine_bit}, op);
}

void shade_packet(const Shading& shading, const KernelTable& kernels, const AttributesCtx& runs,
                  Packet& packet) {
    kernels.attributes(packet, runs);
    for (const InputOp& op : shading.inputs) {
        feed_input(op, shading.program.numbers, kernels, runs, packet);
    }
    run(shading.program, kernels, packet);
}

}  // namespace burnish
