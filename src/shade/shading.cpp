#include "shade/shading.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <burnish/error.hpp>
#include <burnish/multipass.hpp>
#include <span>
#include <utility>

#include "machine/material_passes.hpp"
#include "shade/normalisation_cube.hpp"
#include "shade/packet_inputs.hpp"

namespace burnish {

namespace {

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
        case ColorInput::h_dot_l:
            return Varying::Source::h_dot_l;
        case ColorInput::normal:
            return Varying::Source::normal;
        case ColorInput::lit:
            break;
    }
    return Varying::Source::lit;
}

/// Decides where every attribute comes from and which operations bring it to the registers.
class Planner {
  public:
    /// @param units  of a pass: what they are in the whole material
    Planner(Shading& shading, const ProgramMaterial& material, const Machine& machine, bool is_mesh,
            int light, std::span<const PassUnit> units, const std::optional<FinestMap>& finest)
        : m_shading(shading),
          m_material(material),
          m_units(units),
          m_machine(machine),
          m_is_mesh(is_mesh),
          m_light(light),
          m_per_pixel(machine.half_vector == HalfVector::pixel),
          m_sampling{shading.program.numbers, kSampleScratch, shading.program.plane_count},
          m_free{kUnitAttributes, shading.program.plane_count + kSamplePlanes} {
        shading.inputs.clear();
        shading.frame_attributes =
            is_mesh ? kUvAttributes + (m_per_pixel ? kFrameAttributes : 0) : 0;
        shading.frames_from_uv = machine.tangent_frames == TangentFrames::derivative;
        m_lighting.half_vector = m_lighting.light_vector = m_lighting.view_vector = -1;
        m_lighting.n_dot_l = m_lighting.h_dot_l = -1;
        m_slots = color_slots(material, shading.program);
        if (!finest) return;
        const auto at = [&](int component) { return coordinate_of_set(finest->set, component); };
        m_sampling.corners = SampledCorners{
            finest->texture, at(0), at(1), at(3), kCornerAttributes, kCornerAttributes + 1};
        shading.corners = CornerShading{.map = *m_sampling.corners};
    }

    void plan() {
        for (const ColorSlot& slot : m_slots) {
            if (!m_is_mesh && slot.input != ColorInput::vertex) {
                throw Error(ErrorCode::bad_program,
                            "raw vertices carry no normals: their colours can only be 'vertex'");
            }
            if (varies_per_vertex(slot)) plane_of(slot);
        }
        plan_textures();  // adds the coordinates of raw vertices
        std::vector<InputOp> encodings;
        for (const ColorSlot& slot : m_slots) {
            const int attribute = attribute_of(slot);
            if (attribute < 0) {
                encodings.emplace_back(ClearCtx{slot.plane});
            } else {
                encodings.emplace_back(EncodeCtx{attribute, slot.plane});
            }
        }
        plan_lighting(m_shading.lights[static_cast<std::size_t>(m_light)].space);
        std::vector<InputOp>& inputs = m_shading.inputs;
        inputs.insert(inputs.end(), m_cube_ops.begin(), m_cube_ops.end());
        inputs.insert(inputs.end(), m_vector_ops.begin(), m_vector_ops.end());
        m_shading.fixed_inputs = inputs.size();
        inputs.insert(inputs.end(), encodings.begin(), encodings.end());
        for (PlannedUnit& unit : m_shading.units) unit.first_op += inputs.size();
        inputs.insert(inputs.end(), m_texture_ops.begin(), m_texture_ops.end());
    }

  private:
    [[nodiscard]] static bool is_vector(ColorInput input) {
        return input == ColorInput::half_tangent || input == ColorInput::light_tangent ||
               input == ColorInput::view_tangent;
    }
    /// One number for every component.
    [[nodiscard]] static bool is_cosine(ColorInput input) {
        return input == ColorInput::n_dot_l || input == ColorInput::h_dot_l;
    }
    [[nodiscard]] static bool depends_on_light(ColorInput input) {
        return is_cosine(input) || input == ColorInput::half_tangent ||
               input == ColorInput::light_tangent || input == ColorInput::lit;
    }
    [[nodiscard]] static int index_of(const ColorSlot& slot) {
        return is_cosine(slot.input) ? 0 : slot.component;
    }
    /// Vectors and `lit` have three components, and a mesh has no vertex colour.
    [[nodiscard]] bool carries_something(const ColorSlot& slot) const {
        if (slot.input == ColorInput::vertex) return !m_is_mesh;
        return is_cosine(slot.input) || slot.component < 3;
    }
    [[nodiscard]] bool varies_per_vertex(const ColorSlot& slot) const {
        if (!carries_something(slot)) return false;
        const bool lighting = is_vector(slot.input) || is_cosine(slot.input);
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
        if (is_vector(slot.input)) return coded_component(slot.input, slot.component);
        return plane_of(slot);
    }
    /// Attribute plane of what a vertex or the lighting stage delivers.
    int plane_of(const ColorSlot& slot) {
        if (depends_on_light(slot.input)) m_shading.reads_light = true;
        if (slot.input == ColorInput::half_tangent && m_machine.half_vector == HalfVector::cube) {
            return cube_plane() + slot.component;
        }
        if (varies_per_vertex(slot)) {
            const int light = depends_on_light(slot.input) ? m_light : 0;
            return varying({source_of(slot), index_of(slot), light});
        }
        return lighting_plane(slot.input) + index_of(slot);
    }

    /// First attribute plane of the half vector that the cube map normalises, coded.
    int cube_plane() {
        if (m_cube_plane >= 0) return m_cube_plane;
        const auto sum = [&](int c) { return varying({Varying::Source::half_sum, c, m_light}); };
        const SampleCoordinates at{sum(0), sum(1), sum(2), -1, true};
        if (!m_shading.half_cube) {
            m_shading.half_cube =
                normalisation_cube(m_machine.half_vector_size, m_machine.half_vector_bits);
        }
        m_shading.textures.push_back(m_shading.half_cube);
        const int texel = m_free.reg;
        m_free.reg += 4;
        m_cube_plane = m_free.attribute;
        m_free.attribute += 3;
        SamplePlan sampling{m_sampling.numbers, m_sampling.attributes, m_sampling.planes};
        plan_sample(*m_shading.half_cube, at, {texel, -1}, sampling, m_cube_ops);
        for (int c = 0; c < 3; ++c)
            m_cube_ops.emplace_back(
                DecodeCtx{texel + c, m_cube_plane + c, Reading::unsigned_texel});
        return m_cube_plane;
    }

    /// First attribute plane of what the lighting stage delivers, which is asked for by this.
    int lighting_plane(ColorInput input) {
        switch (input) {
            case ColorInput::half_tangent:
                return m_lighting.half_vector = kLightingAttributes;
            case ColorInput::light_tangent:
                return m_lighting.light_vector = kLightingAttributes + 3;
            case ColorInput::view_tangent:
                return m_lighting.view_vector = kLightingAttributes + 6;
            case ColorInput::h_dot_l:
                return m_lighting.h_dot_l = kLightingAttributes + 10;
            default:
                return m_lighting.n_dot_l = kLightingAttributes + 9;
        }
    }

    void plan_lighting(const LightSpace& space) {
        m_lighting.frame = kUvAttributes;
        for (int i = 0; i < 3; ++i) {
            m_lighting.light[i] = space.light[i];
            m_lighting.eye[i] = space.eye[i];
        }
        m_lighting.light_w = space.light_w;
        m_lighting.eye_w = space.eye_w;
        m_lighting.raw_half = m_machine.normalise_half_vector ? 0 : 1;
        m_lighting.orthonormal = m_machine.tangent_frames == TangentFrames::mikktspace ? 0 : 1;
        const bool used = m_lighting.half_vector >= 0 || m_lighting.light_vector >= 0 ||
                          m_lighting.view_vector >= 0 || m_lighting.n_dot_l >= 0 ||
                          m_lighting.h_dot_l >= 0;
        if (!used) return;
        m_shading.reads_frame = true;
        m_shading.inputs.emplace_back(m_lighting);
    }

    /// Attribute plane of a component of a unit's coordinates, -1 where it is that of (0, 0, 0, 1).
    int coordinate(int unit, int component) {
        if (!m_units.empty()) unit = m_units[static_cast<std::size_t>(unit)].material_unit;
        return coordinate_of_set(unit < kCoordinateSets ? unit : 0, component);
    }
    int coordinate_of_set(int set, int component) {
        const CoordinateInput input = m_material.uv[static_cast<std::size_t>(set)];
        const bool own = input == CoordinateInput::uv || input == CoordinateInput::vertex;
        if (!m_is_mesh) {
            if (own) return varying({Varying::Source::uv, 4 * set + component});
            throw Error(ErrorCode::bad_program,
                        "raw vertices carry no normals: their coordinates can only be 'uv' or "
                        "'vertex'");
        }
        if (own) {
            if (input != CoordinateInput::uv || component >= kUvAttributes) return -1;
            m_shading.reads_frame = true;
            return component;
        }
        if (component == 3) return -1;
        const ColorInput vector = vector_of(input);
        return is_coded(input) ? coded_component(vector, component)
                               : affine_component(vector, component, 2.0F, -1.0F);
    }

    /// x/2 + 1/2 of a vector's component; the half vector scaled.
    int coded_component(ColorInput vector, int component) {
        const float scale =
            vector == ColorInput::half_tangent ? m_material.half_scale[component] : 1.0F;
        if (scale == 1.0F) return plane_of({Register::col0, component, vector, -1});
        return affine_component(vector, component, scale, 0.5F - 0.5F * scale);
    }

    /// scale * c + offset of a vector's component, which comes coded as c.
    int affine_component(ColorInput vector, int component, float scale, float offset) {
        const int from = plane_of({Register::col0, component, vector, -1});
        const auto at =
            std::find_if(m_vectors.begin(), m_vectors.end(), [&](const VectorComponent& v) {
                return v.from == from && v.scale == scale && v.offset == offset;
            });
        if (at != m_vectors.end()) return at->plane;
        const int to = m_free.attribute++;
        m_vector_ops.emplace_back(AffineCtx{from, to, scale, offset, 1.0F});
        m_vectors.push_back({from, scale, offset, to});
        return to;
    }
    static bool is_coded(CoordinateInput input) {
        return input == CoordinateInput::half_coded || input == CoordinateInput::light_coded ||
               input == CoordinateInput::view_coded;
    }
    static ColorInput vector_of(CoordinateInput input) {
        switch (input) {
            case CoordinateInput::light_tangent:
            case CoordinateInput::light_coded:
                return ColorInput::light_tangent;
            case CoordinateInput::view_tangent:
            case CoordinateInput::view_coded:
                return ColorInput::view_tangent;
            default:
                return ColorInput::half_tangent;
        }
    }

    void plan_textures() {
        UnitPlan units = plan_texture_units(
            m_material, m_machine, m_shading.program,
            [this](int unit, int component) { return coordinate(unit, component); }, m_sampling,
            m_free);
        m_texture_ops = std::move(units.ops);
        m_shading.units = std::move(units.units);
        m_shading.keep_attribute = units.keep_attribute;
        m_shading.depth_attribute = units.depth_attribute;
        m_shading.quads = units.quads;
        plan_stage_fetches();
    }

    /// What they take for themselves is free again after each of them.
    void plan_stage_fetches() {
        BoundProgram& program = m_shading.program;
        int planes = m_free.reg;
        m_shading.stage_fetches.clear();
        for (const BoundFetch& fetch : program.fetches) {
            SamplePlan sampling{m_sampling.numbers, m_sampling.attributes, m_sampling.planes};
            FreePlanes free = m_free;
            const Texture& texture = *m_material.units[static_cast<std::size_t>(fetch.unit)];
            m_shading.stage_fetches.push_back(
                {fetch.before, plan_stage_fetch(fetch, texture, sampling, free)});
            m_shading.quads |= needs_quads(texture);
            planes = std::max(planes, free.reg);
            m_sampling.uses_planes |= sampling.uses_planes;
        }
        const bool unused =
            !m_sampling.uses_planes && planes == program.plane_count + kSamplePlanes;
        if (!unused) program.plane_count = planes;
    }

    struct VectorComponent {
        int from;  ///< attribute
        float scale, offset;
        int plane;  ///< attribute
    };

    Shading& m_shading;
    const ProgramMaterial& m_material;
    std::span<const PassUnit> m_units;
    const Machine& m_machine;
    bool m_is_mesh;
    int m_light;  ///< of the shading's
    bool m_per_pixel;
    SamplePlan m_sampling;
    FreePlanes m_free;
    std::vector<ColorSlot> m_slots;
    std::vector<VectorComponent> m_vectors;
    std::vector<InputOp> m_cube_ops, m_vector_ops, m_texture_ops;
    int m_cube_plane = -1;
    LightingCtx m_lighting{};
};

/// Binds and plans one pass. Attributes that earlier passes asked for keep their places.
void plan_pass(Shading& shading, const ProgramMaterial& material, const Machine& machine,
               bool is_mesh, int light, const Wanted& wanted,
               const std::optional<FinestMap>& finest, std::span<const PassUnit> units = {}) {
    shading.unit_states = unit_states(material, machine);
    for (std::size_t i = 0; i < units.size(); ++i) {
        const std::uint32_t bit = 1U << i;
        if (units[i].frame < 0 && units[i].address < 0) continue;
        shading.unit_states.enabled |= bit;
        shading.unit_states.black &= ~bit;
    }
    shading.program = bind(material.combiners, machine, shading.unit_states, wanted);
    Planner(shading, material, machine, is_mesh, light, units, finest).plan();
}

/// The material as a pass has it: its own program, and the textures that it reads.
ProgramMaterial material_of_pass(const ProgramMaterial& material, const ProgramPass& pass) {
    ProgramMaterial own = material;
    own.combiners = pass.program;
    own.units.assign(pass.units.size(), nullptr);
    for (std::size_t i = 0; i < pass.units.size(); ++i) {
        const int unit = pass.units[i].material_unit;
        const bool is_table = pass.units[i].address >= 0;
        if (unit >= 0 && unit < static_cast<int>(material.units.size()) && !is_table) {
            own.units[i] = material.units[static_cast<std::size_t>(unit)];
        }
    }
    if (!material.texture_shader || refers_to_units(*material.texture_shader)) return own;
    // Units that know nothing of each other went where the pass has room.
    own.texture_shader.emplace();
    for (std::size_t i = 0; i < std::min<std::size_t>(own.units.size(), kTextureShaderUnits); ++i) {
        const auto unit = static_cast<std::size_t>(std::max(pass.units[i].material_unit, 0));
        if (pass.units[i].material_unit < 0 || pass.units[i].address >= 0) continue;
        TextureUnit& to = own.texture_shader->units[i];
        if (unit < kTextureShaderUnits) {
            to = material.texture_shader->units[unit];
        } else {
            to.operation = TextureOperation::texture_2d;
        }
    }
    return own;
}

/// Where frames of earlier passes lie, and what is free behind them.
struct FramePlanes {
    int first;    ///< of the first frame's four planes
    int scratch;  ///< first of kSamplePlanes register planes
};

/// What units of a pass read from frames and from tables that frames address, after its other
/// inputs. `quads` is set for tables with levels.
void add_frames(const ProgramPass& pass, const ProgramMaterial& material, const FramePlanes& planes,
                const BoundProgram& program, std::vector<InputOp>& inputs, bool& quads) {
    SamplePlan sampling{program.numbers, kSampleScratch, planes.scratch};
    for (std::size_t i = 0; i < pass.units.size(); ++i) {
        const PassUnit& unit = pass.units[i];
        const int to = program.input[static_cast<std::size_t>(tex(static_cast<int>(i)))][0];
        if (to < 0) continue;
        if (unit.frame >= 0) {
            for (int c = 0; c < 4; ++c)
                inputs.emplace_back(CopyCtx{planes.first + 4 * unit.frame + c, to + c});
        } else if (unit.address >= 0) {
            const int frame = pass.units[static_cast<std::size_t>(unit.address)].frame;
            const Texture& table = *material.units[static_cast<std::size_t>(unit.material_unit)];
            quads |= needs_quads(table);
            const bool is_1d = table.target() == TextureTarget::one_d;
            BoundFetch fetch;
            fetch.unit = unit.material_unit;
            fetch.target = is_1d ? FetchTarget::table_1d : FetchTarget::table_2d;
            fetch.plane = {planes.first + 4 * frame + 3, planes.first + 4 * frame, 0};
            fetch.out = to;
            fetch.live = 15;
            FreePlanes free{kUnitAttributes, planes.scratch + kSamplePlanes};
            const std::vector<InputOp> ops = plan_stage_fetch(fetch, table, sampling, free);
            inputs.insert(inputs.end(), ops.begin(), ops.end());
        }
    }
}

void plan_passes(Shading& shading, const ProgramMaterial& material, const Machine& machine,
                 bool is_mesh, int light, const std::optional<FinestMap>& finest) {
    const std::vector<ProgramPass> passes = passes_of(material, machine);
    FramePlanes planes{0, 0};  // behind the planes of all passes
    bool quads = false;
    for (const ProgramPass& pass : passes) {
        plan_pass(shading, material_of_pass(material, pass), machine, is_mesh, light, {}, finest,
                  pass.units);
        planes.first = std::max(planes.first, shading.program.plane_count);
        quads |= shading.quads;
        if (&pass == &passes.back()) break;
        shading.earlier_passes.push_back({std::move(shading.inputs), shading.program, 0});
    }
    planes.scratch = planes.first + 4 * static_cast<int>(shading.earlier_passes.size());
    for (std::size_t i = 0; i < shading.earlier_passes.size(); ++i) {
        EarlierPass& pass = shading.earlier_passes[i];
        pass.frame = planes.first + 4 * static_cast<int>(i);
        add_frames(passes[i], material, planes, pass.program, pass.inputs, quads);
    }
    add_frames(passes.back(), material, planes, shading.program, shading.inputs, quads);
    shading.quads = quads;
    shading.program.plane_count = planes.scratch + kSamplePlanes + 4;
}

/// Passes and inputs of one light. Attributes that other lights asked for keep their places.
void plan_light(Shading& shading, const ProgramMaterial& material, const Machine& machine,
                bool is_mesh, int light, const Wanted& wanted,
                const std::optional<FinestMap>& finest) {
    shading.textures.insert(shading.textures.end(), material.units.begin(), material.units.end());
    shading.earlier_passes.clear();
    if (machine.multipass && !has_room_for(machine, material)) {
        // Registers between the passes are those of the whole program.
        const bool inside = wanted.everything || wanted.reg;
        if (!inside) return plan_passes(shading, material, machine, is_mesh, light, finest);
        return plan_pass(shading, material, with_room(machine), is_mesh, light, wanted, finest);
    }
    if (material.units.size() > static_cast<std::size_t>(machine.texture_units)) {
        const bool cube = machine.half_vector == HalfVector::cube;
        throw Error(ErrorCode::bad_program,
                    fmt::format("{} texture units, machine '{}' has {}{}", material.units.size(),
                                machine.name, machine.texture_units,
                                cube ? " besides the one that normalises half vectors" : ""));
    }
    plan_pass(shading, material, machine, is_mesh, light, wanted, finest);
}

/// sum = a + b, at most 1: products with 1 are exact in both number models.
PortionCtx sum_of(const std::array<std::int16_t, 4>& a, const std::array<std::int16_t, 3>& b,
                  const std::array<std::int16_t, 3>& sum, std::int16_t zero, std::int16_t trash) {
    const auto mapping = [](Mapping m) { return static_cast<std::uint8_t>(m); };
    PortionCtx add{};
    for (std::size_t c = 0; c < 3; ++c) {
        add.a.plane[c] = a[c];
        add.c.plane[c] = b[c];
        add.b.plane[c] = add.d.plane[c] = zero;
        add.ab_out[c] = add.cd_out[c] = trash;
        add.third_out[c] = sum[c];
    }
    add.a.mapping = add.c.mapping = mapping(Mapping::signed_identity);
    add.b.mapping = add.d.mapping = mapping(Mapping::unsigned_invert);  // of 0: 1
    add.ab = add.cd = ProductKind::multiply;
    add.third = ThirdKind::sum;
    add.scale = OutputScale::one;
    add.rounding = Rounding::nearest;
    add.components = 3;
    return add;
}

/// Sums of lights in planes behind those of all programs; no portion reads what it writes.
void plan_sums(Shading& shading) {
    int planes = shading.program.plane_count;
    for (const FurtherLight& light : shading.further_lights)
        planes = std::max(planes, light.program.plane_count);
    const auto next = [&] { return static_cast<std::int16_t>(planes++); };
    const std::int16_t zero = next(), trash = next();
    std::array<std::int16_t, 3> sum{zero, zero, zero}, free{next(), next(), next()},
        other{next(), next(), next()};
    const auto add = [&](const LightShading& light) {
        const PortionCtx ctx = sum_of(light.program.result, sum, free, zero, trash);
        sum = free;
        std::swap(free, other);
        return ctx;
    };
    for (FurtherLight& light : shading.further_lights) light.add = add(light);
    shading.add_first = add(shading);
    shading.zero_plane = zero;
    std::copy(sum.begin(), sum.end(), shading.result.begin());
    shading.program.plane_count = planes;
}

/// Of FilterOrder::after: the programs of all lights are shaded at the same places.
std::optional<FinestMap> map_of_corners(std::span<const ProgramMaterial> programs,
                                        const Machine& machine, bool is_mesh) {
    if (machine.filter_order == FilterOrder::before) return std::nullopt;
    for (const ProgramMaterial& program : programs)
        if (const auto finest = finest_map(program, machine, is_mesh)) return finest;
    return std::nullopt;
}

}  // namespace

void plan_shading(Shading& shading, std::span<const ProgramMaterial> programs,
                  const Machine& whole_machine, bool is_mesh, const Wanted& wanted) {
    const Machine machine = whole_machine.for_programs();
    shading.textures.clear();
    shading.varying_list.clear();
    shading.further_lights.clear();
    shading.reads_light = shading.reads_frame = false;
    shading.corners.reset();
    const std::optional<FinestMap> finest = map_of_corners(programs, whole_machine, is_mesh);
    bool quads = false;
    for (std::size_t i = 1; i < programs.size(); ++i) {
        plan_light(shading, programs[i], machine, is_mesh, static_cast<int>(i), wanted, finest);
        quads |= shading.quads;
        shading.further_lights.push_back({std::move(static_cast<LightShading&>(shading)), {}});
    }
    plan_light(shading, programs.front(), machine, is_mesh, 0, wanted, finest);
    shading.quads |= quads;
    shading.quads_of_pixels = shading.quads && machine.quads == Quads::of_pixels;
    shading.result = shading.program.result;
    if (programs.size() > 1) plan_sums(shading);
    if (shading.corners) plan_corners(shading);
    const bool flat = !shading.reads_frame && shading.varying_list.empty();
    if (flat && !wanted.everything) shading.frame_attributes = 0;
    shading.packet_inputs = plan_packet_inputs(shading);
}

}  // namespace burnish
