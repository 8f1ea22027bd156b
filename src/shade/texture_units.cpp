#include "shade/texture_units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <burnish/error.hpp>
#include <optional>
#include <utility>

#include "core/dmath.hpp"
#include "machine/unit_operations.hpp"
#include "shade/shading.hpp"
#include "shade/table_look_up.hpp"

namespace burnish {

namespace {

using Op = TextureOperation;

constexpr int kMostUnits = 16;

/// What each unit does: as the shader says, or the plain fetch of its texture. Units that are off
/// do nothing.
std::array<TextureUnit, kMostUnits> active_units(const ProgramMaterial& material,
                                                 const Machine& machine) {
    std::array<TextureUnit, kMostUnits> units{};
    std::size_t first_plain = 0;
    if (material.texture_shader) {
        const TextureShader& shader = *material.texture_shader;
        std::copy(shader.units.begin(), shader.units.end(), units.begin());
        for (const UnitProblem& p : check_consistency(shader, material.units, machine)) {
            units.at(static_cast<std::size_t>(p.unit)).operation = Op::none;
        }
        first_plain = shader.units.size();
    }
    for (std::size_t i = first_plain; i < material.units.size(); ++i) {
        if (material.units[i]) {
            units.at(i).operation = plain_operation(material.units[i]->target());
        }
    }
    return units;
}

bool is_hilo(TexelClass kind) {
    return kind == TexelClass::hilo || kind == TexelClass::signed_hilo;
}

/// Whether a texel of the format is a colour for the combiners; others read (0, 0, 0, 0).
bool has_color(TexelClass format) {
    return !is_hilo(format) && format != TexelClass::dsdt && format != TexelClass::dsdt_mag;
}

TextureOperation operation_of(FetchTarget target) {
    switch (target) {
        case FetchTarget::table_1d:
            return Op::texture_1d;
        case FetchTarget::table_2d:
            return Op::texture_2d;
        case FetchTarget::table_3d:
            return Op::texture_3d;
        case FetchTarget::table_cube_map:
            return Op::texture_cube_map;
        case FetchTarget::table_rectangle:
            return Op::texture_rectangle;
    }
    return Op::none;
}

/// Plans the units one after the other.
class UnitPlanner {
  public:
    UnitPlanner(const ProgramMaterial& material, const Machine& machine,
                const BoundProgram& program, const CoordinatePlane& coordinates,
                SamplePlan& sampling, FreePlanes& free)
        : m_material(material),
          m_machine(machine),
          m_program(program),
          m_coordinates(coordinates),
          m_sampling(sampling),
          m_free(free),
          m_units(active_units(material, machine)) {
        m_dots.fill(-1);
        if (material.texture_shader) m_bump_source = material.texture_shader->bump_source;
    }

    UnitPlan plan() {
        mark_needed();
        for (int i = 0; i < kMostUnits; ++i) {
            if (!m_needed.at(index(i))) continue;
            const std::size_t first_op = m_plan.ops.size();
            plan_unit(i);
            const Texel& texel = m_texels.at(index(i));
            m_plan.units.push_back({i, first_op, texel.registers, texel.values});
        }
        return std::move(m_plan);
    }

  private:
    /// What a unit leaves for later ones, before any dimming.
    struct Texel {
        TexelClass format = TexelClass::unsigned_rgba;
        int registers = -1;  ///< first of four register planes
        int values = -1;     ///< HILO: first of two attribute planes
    };
    using Vector = std::array<int, 3>;  // attribute planes

    static std::size_t index(int i) { return static_cast<std::size_t>(i); }
    [[nodiscard]] const TextureUnit& unit(int i) const { return m_units.at(index(i)); }
    [[nodiscard]] Op operation(int i) const { return unit(i).operation; }
    [[nodiscard]] const Texture& texture(int i) const { return *m_material.units.at(index(i)); }
    [[nodiscard]] const Texel& previous(int i) const {
        return m_texels.at(index(unit(i).previous));
    }

    /// Where the program reads unit i, or -1.
    [[nodiscard]] int program_planes(int i) const {
        return m_program.input[static_cast<std::size_t>(tex(i))][0];
    }

    // --- who reads whom

    void mark_needed() {
        for (int i = kMostUnits - 1; i >= 0; --i) {
            const Op op = operation(i);
            if (op == Op::none) continue;
            const bool acts = op == Op::cull_fragment || replaces_depth(op);
            if (acts || program_planes(i) >= 0) m_needed.at(index(i)) = true;
            if (!m_needed.at(index(i))) continue;
            if (reads_previous(op)) read(unit(i).previous);
            for (int k = 1; k < dot_products_used(op); ++k) m_needed.at(index(i - k)) = true;
            if (op == Op::dot_product_diffuse_cube_map) read(unit(i + 1).previous);
            if (op == Op::texture_brdf) {
                read(i - 1);
                read(i - 2);
            }
        }
    }
    void read(int i) {
        m_needed.at(index(i)) = true;
        m_read_later.at(index(i)) = true;
    }

    // --- planes

    template <class Ctx>
    void add(const Ctx& ctx) {
        m_plan.ops.emplace_back(ctx);
    }
    int take_attributes(int count) {
        return std::exchange(m_free.attribute, m_free.attribute + count);
    }
    int take_registers() { return std::exchange(m_free.reg, m_free.reg + 4); }

    int constant(float value) {
        const auto at = std::find_if(m_constants.begin(), m_constants.end(),
                                     [&](const FillCtx& c) { return c.value == value; });
        if (at != m_constants.end()) return at->attribute;
        m_constants.push_back({take_attributes(1), value});
        add(m_constants.back());
        return m_constants.back().attribute;
    }

    int coordinate(int i, int component) {
        const int plane = m_coordinates(i, component);
        return plane >= 0 ? plane : constant(component == 3 ? 1.0F : 0.0F);
    }
    /// The same of a sample: at a corner, if its coordinates are those of the finest map.
    int sampled_coordinate(int i, int component) {
        const int plane = m_coordinates(i, component);
        const std::optional<SampledCorners>& corners = m_sampling.corners;
        const bool moves = corners && plane >= 0 && m_coordinates(i, 0) == corners->s;
        if (moves && component == 0) return corners->corner_s;
        if (moves && component == 1) return corners->corner_t;
        if (moves && component == 3) return -1;
        return plane;
    }
    int sampled(int i, int component) {
        const int plane = sampled_coordinate(i, component);
        return plane >= 0 ? plane : constant(component == 3 ? 1.0F : 0.0F);
    }
    Vector str(int i) { return {coordinate(i, 0), coordinate(i, 1), coordinate(i, 2)}; }

    /// A component of a texel as a number, decoded once.
    int number(int plane, Reading reading) {
        const auto at = std::find_if(m_numbers.begin(), m_numbers.end(), [&](const DecodeCtx& c) {
            return c.plane == plane && c.reading == reading;
        });
        if (at != m_numbers.end()) return at->attribute;
        m_numbers.push_back({plane, take_attributes(1), reading});
        add(m_numbers.back());
        return m_numbers.back().attribute;
    }

    // --- texels

    /// Where unit i's texel goes before it is dimmed or stripped.
    Texel place_texel(int i, TexelClass format) {
        Texel texel{.format = format};
        if (is_hilo(format)) {
            texel.values = take_attributes(2);
            return texel;
        }
        const bool kept = is_dimmed(operation(i)) && m_read_later.at(index(i));
        const bool as_it_is = program_planes(i) >= 0 && !kept &&
                              (format == TexelClass::unsigned_rgba ||
                               format == TexelClass::signed_rgba || format == TexelClass::mixed);
        texel.registers = as_it_is ? program_planes(i) : take_registers();
        return texel;
    }

    void sample(int i, SampleCoordinates at) {
        // Constant coordinates and those of light are made by operations, too.
        at.interpolated = at.interpolated && interpolated(at.s) && interpolated(at.t) &&
                          interpolated(at.r) && interpolated(at.q);
        m_plan.quads |= !at.interpolated && needs_level_of_detail(texture(i));
        const Texel texel = place_texel(i, format_class(texture(i).format()));
        plan_sample(texture(i), at, {texel.registers, texel.values}, m_sampling, m_plan.ops);
        m_texels.at(index(i)) = texel;
        const int out = program_planes(i);
        if (out < 0 || !has_color(texel.format)) return;
        int color = texel.registers;
        if (texel.format == TexelClass::dsdt_mag_intensity) {
            for (int c = 0; c < 3; ++c) add(ClearCtx{out + c});
            add(CopyCtx{color + 3, out + 3});
            color = out;
        }
        if (is_dimmed(operation(i))) dim(i, color, out);
    }

    [[nodiscard]] static bool interpolated(int attribute) {
        return attribute < kMaxInterpolated || attribute == kCornerAttributes ||
               attribute == kCornerAttributes + 1;
    }

    void dim(int i, int from, int to) {
        const bool bytes = m_bump_source == BumpSource::rgba8;
        const int magnitude = previous(i).registers + (bytes ? 0 : 2);
        const bool clamps = m_machine.magnitude_factor == MagnitudeFactor::clamped;
        add(MagnitudeCtx{magnitude, from, to, unit(i).offset_scale, unit(i).offset_bias,
                         clamps ? std::uint8_t{1} : std::uint8_t{0}});
    }

    void sample_at(int i, const Vector& at) {
        const bool three = sampled_target(operation(i)) == TextureTarget::three_d ||
                           sampled_target(operation(i)) == TextureTarget::cube;
        const bool one = sampled_target(operation(i)) == TextureTarget::one_d;
        sample(i, {at[0], one ? -1 : at[1], three ? at[2] : -1, -1, false});
    }

    // --- operations

    void plan_unit(int i) {
        switch (operation(i)) {
            case Op::none:
                return;
            case Op::texture_1d:
                return sample(i, {sampled(i, 0), -1, -1, sampled_coordinate(i, 3), true});
            case Op::texture_2d:
            case Op::texture_rectangle:
                return sample(i,
                              {sampled(i, 0), sampled(i, 1), -1, sampled_coordinate(i, 3), true});
            case Op::texture_3d:  // without an r, plan_sample refuses
                return sample(i, {coordinate(i, 0), coordinate(i, 1), m_coordinates(i, 2),
                                  m_coordinates(i, 3), true});
            case Op::texture_cube_map:
                return sample(i,
                              {coordinate(i, 0), coordinate(i, 1), m_coordinates(i, 2), -1, true});
            case Op::pass_through:
                return pass_through(i);
            case Op::cull_fragment:
                return cull(i);
            case Op::texture_brdf:
                return brdf(i);
            default:
                break;
        }
        if (takes_dot_product(operation(i))) {
            dot(i);
        } else if (operation(i) >= Op::dependent_ar) {
            sample_at(i, dependent_coordinates(i));
        } else {
            offset(i);
        }
    }

    void pass_through(int i) {
        const Vector s = str(i);
        encode(i, {s[0], s[1], s[2], coordinate(i, 3)});
    }
    void encode(int i, const std::array<int, 4>& attributes) {
        const int out = program_planes(i) >= 0 ? program_planes(i) : take_registers();
        for (int c = 0; c < 4; ++c) add(EncodeCtx{attributes.at(index(c)), out + c});
        m_texels.at(index(i)) = {.registers = out};
    }

    void cull(int i) {
        CullCtx ctx{};
        for (int c = 0; c < 4; ++c) {
            ctx.coordinate[c] = coordinate(i, c);
            ctx.less[c] = unit(i).cull.at(index(c)) == CullTest::less_than_zero ? 1 : 0;
        }
        ctx.also = m_plan.keep_attribute;
        if (m_plan.keep_attribute < 0) m_plan.keep_attribute = take_attributes(1);
        ctx.keep = m_plan.keep_attribute;
        add(ctx);
    }

    void offset(int i) {
        const TextureUnit& u = unit(i);
        const Texel& from = previous(i);
        OffsetCtx ctx{};
        ctx.s = sampled(i, 0);
        ctx.t = sampled(i, 1);
        ctx.q = is_projective_offset(u.operation) ? sampled_coordinate(i, 3) : -1;
        if (is_hilo_offset(u.operation)) {
            ctx.ds = from.values;
            ctx.dt = from.values + 1;
        } else if (m_bump_source == BumpSource::rgba8) {
            const Reading reading = from.format == TexelClass::signed_rgba
                                        ? Reading::signed_texel
                                        : Reading::two_complement;
            ctx.ds = number(from.registers + 2, reading);
            ctx.dt = number(from.registers + 1, reading);
        } else {
            ctx.ds = number(from.registers, Reading::signed_texel);
            ctx.dt = number(from.registers + 1, Reading::signed_texel);
        }
        for (int k = 0; k < 4; ++k) ctx.m[k] = u.offset_matrix[k / 2][k % 2];
        ctx.to = take_attributes(2);
        add(ctx);
        sample(i, {ctx.to, ctx.to + 1, -1, -1, false});
    }

    Vector dependent_coordinates(int i) {
        const Texel& from = previous(i);
        const auto color = [&](int c) {
            return number(from.registers + c, operation(i) == Op::dependent_rgb_cube_map
                                                  ? Reading::expanded
                                                  : Reading::unsigned_texel);
        };
        switch (operation(i)) {
            case Op::dependent_ar:
                return {color(3), color(0), -1};
            case Op::dependent_gb:
                return {color(1), color(2), -1};
            case Op::dependent_hilo:
                return {from.values, from.values + 1, -1};
            default:
                return {color(0), color(1), color(2)};
        }
    }

    // --- dot products

    int dot_of(int i) {
        int& plane = m_dots.at(index(i));
        if (plane >= 0) return plane;
        const Vector a = str(i), b = vector_of(previous(i), unit(i).dot_mapping);
        plane = take_attributes(1);
        add(DotCtx{{a[0], a[1], a[2]}, {b[0], b[1], b[2]}, plane});
        return plane;
    }

    /// The previous texel as a vector.
    Vector vector_of(const Texel& texel, DotMapping mapping) {
        if (is_hilo(texel.format)) return hilo_vector(texel, mapping);
        const Reading reading = reading_of(texel.format, mapping);
        const int x = number(texel.registers, reading), y = number(texel.registers + 1, reading);
        if (mapping == DotMapping::force_blue_to_one && reading == Reading::unsigned_texel)
            return {x, y, constant(1.0F)};
        return {x, y, number(texel.registers + 2, reading)};
    }

    static Reading reading_of(TexelClass format, DotMapping mapping) {
        if (format == TexelClass::signed_rgba) return Reading::signed_texel;
        switch (mapping) {
            case DotMapping::expand:
                return Reading::expanded;
            case DotMapping::nv2a_d3d:
                return Reading::nv2a_d3d;
            case DotMapping::nv2a_gl:
                return Reading::nv2a_gl;
            case DotMapping::nv2a_signed:
                return Reading::nv2a_signed;
            default:
                return Reading::unsigned_texel;
        }
    }

    Vector hilo_vector(const Texel& texel, DotMapping mapping) {
        int hi = texel.values, lo = texel.values + 1;
        const auto map = [&](float scale, float offset, float divisor) {
            const int to = take_attributes(2);
            add(AffineCtx{hi, to, scale, offset, divisor});
            add(AffineCtx{lo, to + 1, scale, offset, divisor});
            hi = to;
            lo = to + 1;
        };
        switch (mapping) {
            case DotMapping::nv2a_hemisphere_d3d:
                map(65535.0F, -32768.0F, 32767.0F);
                break;
            case DotMapping::nv2a_hemisphere_gl:
                map(32768.0F, 0.5F, 32767.5F);
                break;
            case DotMapping::nv2a_hemisphere_signed:
                map(32768.0F, 0.0F, 32767.0F);
                break;
            default:
                if (texel.format == TexelClass::hilo) return {hi, lo, constant(1.0F)};
        }
        const int z = take_attributes(1);
        add(HemisphereCtx{hi, lo, z});
        return {hi, lo, z};
    }

    void dot(int i) {
        const Op op = operation(i);
        const int p = dot_of(i);
        switch (op) {
            case Op::dot_product:
                return;
            case Op::dot_product_1d:
                return sample_at(i, {p, -1, -1});
            case Op::dot_product_2d:
            case Op::dot_product_rectangle:
                return sample_at(i, {dot_of(i - 1), p, -1});
            case Op::dot_product_diffuse_cube_map:
                return sample_at(i, {dot_of(i - 1), p, dot_of(i + 1)});
            case Op::dot_product_3d:
            case Op::dot_product_cube_map:
                return sample_at(i, {dot_of(i - 2), dot_of(i - 1), p});
            case Op::dot_product_reflect_cube_map:
            case Op::dot_product_const_eye_reflect_cube_map:
                return sample_at(i, reflection(i));
            case Op::dot_product_pass_through:
                return encode(i, {p, p, p, p});
            case Op::dot_product_affine_depth_replace:
                m_plan.depth_attribute = p;
                return;
            case Op::dot_product_depth_replace:
                m_plan.depth_attribute = take_attributes(1);
                add(QuotientCtx{dot_of(i - 1), p, m_plan.depth_attribute});
                return;
            default:
                return;
        }
    }

    Vector reflection(int i) {
        ReflectCtx ctx{};
        const glm::vec3& eye = unit(i).const_eye;
        const bool constant_eye = operation(i) == Op::dot_product_const_eye_reflect_cube_map;
        for (int k = 0; k < 3; ++k) {
            ctx.n[k] = dot_of(i - 2 + k);
            ctx.e[k] = constant_eye ? constant(eye[k]) : coordinate(i - 2 + k, 3);
        }
        ctx.to = take_attributes(3);
        add(ctx);
        return {ctx.to, ctx.to + 1, ctx.to + 2};
    }

    /// Texels are (phi, sigma): phi counts turns.
    void brdf(int i) {
        const int eye = m_texels.at(index(i - 2)).values, light = m_texels.at(index(i - 1)).values;
        const int phi = take_attributes(1);
        add(AngleCtx{eye, light, phi});
        sample(i, {eye + 1, light + 1, phi, -1, false});
    }

    const ProgramMaterial& m_material;
    const Machine& m_machine;
    const BoundProgram& m_program;
    const CoordinatePlane& m_coordinates;
    SamplePlan& m_sampling;
    FreePlanes& m_free;
    std::array<TextureUnit, kMostUnits> m_units;
    BumpSource m_bump_source = BumpSource::dsdt;
    std::array<bool, kMostUnits> m_needed{}, m_read_later{};
    std::array<Texel, kMostUnits> m_texels{};
    std::array<int, kMostUnits> m_dots{};
    std::vector<FillCtx> m_constants;
    std::vector<DecodeCtx> m_numbers;
    UnitPlan m_plan;
};

}  // namespace

std::optional<FinestMap> finest_map(const ProgramMaterial& material, const Machine& machine,
                                    bool is_mesh) {
    std::uint32_t tables = 0;
    for (const GeneralStage& stage : material.combiners.stages)
        for (const StageFetch& fetch : stage.fetches)
            tables |=
                1U << (static_cast<int>(fetch.destination) - static_cast<int>(Register::tex0));
    const auto units = active_units(material, machine);
    std::optional<FinestMap> finest;
    const auto texels = [](const Texture& t) { return std::int64_t{t.width()} * t.height(); };
    for (std::size_t i = 0; i < material.units.size(); ++i) {
        const Op op = units.at(i).operation;
        if ((op != Op::texture_2d && op != Op::texture_rectangle) || (tables >> i & 1) != 0)
            continue;
        const int set = i < kCoordinateSets ? static_cast<int>(i) : 0;
        const CoordinateInput input = material.uv[static_cast<std::size_t>(set)];
        const bool of_vertices =
            input == CoordinateInput::uv || (input == CoordinateInput::vertex && !is_mesh);
        const Texture& texture = *material.units[i];
        const bool linear =
            is_linear_within(texture.sampler().filter) || texture.sampler().mag_is_linear();
        if (!of_vertices || !linear) continue;
        if (!finest || texels(texture) > texels(*finest->texture)) finest = {&texture, set};
    }
    return finest;
}

UnitStates unit_states(const ProgramMaterial& material, const Machine& machine) {
    UnitStates states{.bounded = ~0U, .bounded_colors = true};
    for (std::size_t i = 0; i < material.units.size(); ++i) {
        if (material.units[i]) states.textured |= 1U << i;
    }
    if (material.texture_shader) material.texture_shader->validate(machine);
    const auto units = active_units(material, machine);
    for (std::size_t i = 0; i < units.size(); ++i) {
        const Op op = units[i].operation;
        const std::uint32_t bit = 1U << i;
        const bool texel = has_texel(op) && (!sampled_target(op) ||
                                             has_color(format_class(material.units[i]->format())));
        if (is_dimmed(op)) states.bounded &= ~bit;
        if (texel) {
            states.enabled |= bit;
            const bool is_unsigned =
                sampled_target(op) && !is_dimmed(op) &&
                format_class(material.units[i]->format()) == TexelClass::unsigned_rgba;
            if (is_unsigned) states.positive |= bit;
        } else if (op != Op::none ||
                   (material.texture_shader && i < material.texture_shader->units.size())) {
            states.black |= bit;
        }
    }
    return states;
}

namespace {

/// Brings a table's coordinate from its domain to 0 .. 1, where the centres of `size` texels lie.
void add_span(TexelSpan span, int size, int attribute, std::vector<InputOp>& ops) {
    if (span == TexelSpan::edges) return;
    const SpanToEdges edges = to_edges(span, size);
    ops.emplace_back(AffineCtx{attribute, attribute, edges.scale, edges.offset, edges.divisor});
}

LookUpTableCtx look_up(const BoundFetch& fetch, const Texture& table) {
    LookUpTableCtx ctx = table_look_up(table, fetch.plane[0], fetch.plane[1]);
    for (int c = 0; c < 4; ++c)
        if ((fetch.live >> c & 1) != 0) ctx.out[c] = fetch.out + c;
    return ctx;
}

AverageTableCtx average(const LookUpTableCtx& at, const Texture& table) {
    const auto reach =
        static_cast<float>(dmath::exp2(static_cast<double>(table.sampler().lod_bias) - 15.0));
    AverageTableCtx ctx{at.texels, at.s, at.t, reach, table.summed()->least, table.summed()->most,
                        at.pitch,  {}};
    std::copy(std::begin(at.out), std::end(at.out), ctx.out);
    return ctx;
}

}  // namespace

std::vector<InputOp> plan_stage_fetch(const BoundFetch& fetch, const Texture& texture,
                                      SamplePlan& sampling, FreePlanes& free) {
    const Op equivalent = plain_operation(texture.target());
    if (operation_of(fetch.target) != equivalent)
        throw Error(ErrorCode::bad_program,
                    fmt::format("a fetch to tex{} does {}, its texture is for {}", fetch.unit,
                                texture_operation_name(operation_of(fetch.target)),
                                texture_operation_name(equivalent)));
    std::vector<InputOp> ops;
    if (texture.is_table()) {
        if (fetch.expand[0] || fetch.expand[1] || sampling.numbers == NumberModel::nine_bit)
            throw Error(ErrorCode::bad_program,
                        fmt::format("the table of tex{} with coordinates that expand or of nine "
                                    "bits, expected wide registers as they are",
                                    fetch.unit));
        const LookUpTableCtx plain = look_up(fetch, texture);
        if (texture.summed()) {
            ops.emplace_back(average(plain, texture));
        } else {
            ops.emplace_back(plain);
        }
        return ops;
    }
    const TexelClass format = format_class(texture.format());
    if (!has_color(format)) {
        for (int c = 0; c < 4; ++c) ops.emplace_back(ClearCtx{fetch.out + c});
        return ops;
    }
    std::array<int, 3> at{-1, -1, -1};
    for (int i = 0; i < coordinate_count(fetch.target); ++i) {
        const auto k = static_cast<std::size_t>(i);
        at[k] = free.attribute++;
        ops.emplace_back(DecodeCtx{fetch.plane[k], at[k],
                                   fetch.expand[k] ? Reading::expanded : Reading::unsigned_texel});
        add_span(k == 0 ? texture.sampler().span_s : texture.sampler().span_t,
                 k == 0 ? texture.width() : texture.height(), at[k], ops);
    }
    const bool intensity = format == TexelClass::dsdt_mag_intensity;
    const int out = intensity ? std::exchange(free.reg, free.reg + 4) : fetch.out;
    plan_sample(texture, {at[0], at[1], at[2], -1, false}, {out, -1}, sampling, ops);
    if (intensity) {
        for (int c = 0; c < 3; ++c) ops.emplace_back(ClearCtx{fetch.out + c});
        ops.emplace_back(CopyCtx{out + 3, fetch.out + 3});
    }
    return ops;
}

UnitPlan plan_texture_units(const ProgramMaterial& material, const Machine& machine,
                            const BoundProgram& program, const CoordinatePlane& coordinates,
                            SamplePlan& sampling, FreePlanes& free) {
    return UnitPlanner(material, machine, program, coordinates, sampling, free).plan();
}

}  // namespace burnish
