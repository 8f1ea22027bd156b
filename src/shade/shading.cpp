#include "shade/shading.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <burnish/error.hpp>

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

    AddressCtx address_of(const Texture& texture, int unit) {
        const auto mode = [](Wrap wrap) {
            return wrap == Wrap::repeat ? AddressMode::repeat : AddressMode::clamp_to_edge;
        };
        const int set = unit < kUnitsWithCoordinates ? unit : 0;
        const auto coordinate = [&](int component) {
            return varying({Varying::Source::uv, 4 * set + component});
        };
        AddressCtx ctx{};
        ctx.u = m_is_mesh ? 0 : coordinate(0);
        ctx.v = m_is_mesh ? 1 : coordinate(1);
        ctx.q = m_is_mesh ? -1 : coordinate(3);
        ctx.width = texture.width();
        ctx.height = texture.height();
        ctx.pitch = texture.pitch();
        ctx.mode_s = mode(texture.sampler().wrap_s);
        ctx.mode_t = mode(texture.sampler().wrap_t);
        ctx.linear = texture.sampler().filter == Filter::linear ? 1 : 0;
        return ctx;
    }

    static bool same(const AddressCtx& a, const AddressCtx& b) {
        return a.u == b.u && a.v == b.v && a.q == b.q && a.width == b.width &&
               a.height == b.height && a.pitch == b.pitch && a.mode_s == b.mode_s &&
               a.mode_t == b.mode_t && a.linear == b.linear;
    }

    /// Addresses are made once for units in a row that share coordinates, size and sampler, and
    /// their texels fetched together.
    void add_fetch(const AddressCtx& address, const Texture& texture, int plane,
                   const AddressCtx& last) {
        const bool shares = !m_texture_ops.empty() && same(last, address);
        if (!shares) m_texture_ops.emplace_back(address);
        auto* fetch = shares ? &std::get<FetchCtx>(m_texture_ops.back()) : nullptr;
        if (fetch == nullptr || fetch->count == FetchCtx::kMaxTextures) {
            m_texture_ops.emplace_back(FetchCtx{{}, {}, {}, 0, texture.pitch()});
            fetch = &std::get<FetchCtx>(m_texture_ops.back());
        }
        fetch->texels[fetch->count] = texture.texels();
        fetch->is_signed[fetch->count] = texture.format() == TexelFormat::signed_rgba8 ? 1 : 0;
        fetch->plane[fetch->count++] = plane;
    }

    void plan_textures() {
        AddressCtx last{};
        for (std::size_t unit = 0; unit < m_shading.textures.size(); ++unit) {
            const TexturePtr& texture = m_shading.textures[unit];
            const auto reg = static_cast<std::size_t>(tex(static_cast<int>(unit)));
            const int plane = m_shading.program.input[reg][0];
            if (!texture || plane < 0) continue;
            const AddressCtx address = address_of(*texture, static_cast<int>(unit));
            add_fetch(address, *texture, plane, last);
            last = address;
        }
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
                Packet& packet) {
    struct FeedInput {
        const KernelTable& k;
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
    };
    std::visit(FeedInput{kernels, packet, numbers == NumberModel::nine_bit}, op);
}

void shade_packet(const Shading& shading, const KernelTable& kernels, const AttributesCtx& runs,
                  Packet& packet) {
    kernels.attributes(packet, runs);
    for (const InputOp& op : shading.inputs) {
        feed_input(op, shading.program.numbers, kernels, packet);
    }
    run(shading.program, kernels, packet);
}

}  // namespace burnish
