#include "models/schedule.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

namespace burnish {

namespace {

constexpr int kRegisters = static_cast<int>(Register::discard);

/// rgb or alpha of a register.
struct Half {
    Register reg = Register::discard;
    bool alpha = false;

    friend bool operator==(const Half&, const Half&) = default;
};

void require_room(const ModelNeeds& needs, const Machine& machine) {
    const std::string missing = shortages(needs, machine);
    if (!missing.empty()) throw Shortage(missing, needs);
}

/// const0 and const1, rgb and alpha, of one stage or of the whole program.
class Constants {
  public:
    /// Where `value` is, or may be put: rgb of a constant, or alpha for numbers if `alpha` allows.
    std::optional<Half> find(ValueKind kind, const glm::dvec3& value, bool rgb, bool alpha) const {
        for (const bool known : {true, false}) {
            for (std::size_t i = 0; i < 2; ++i) {
                if (alpha && kind == ValueKind::scalar && fits(m_alpha[i], value, known))
                    return Half{reg(i), true};
                if (rgb && fits(m_rgb[i], value, known)) return Half{reg(i), false};
            }
        }
        return std::nullopt;
    }
    void put(const Half& half, const glm::dvec3& value) {
        const std::size_t i = half.reg == Register::const0 ? 0 : 1;
        (half.alpha ? m_alpha : m_rgb)[i] = value;
    }
    [[nodiscard]] glm::vec4 color(std::size_t i) const {
        return {glm::vec3(m_rgb[i].value_or(glm::dvec3(0.0))),
                static_cast<float>(m_alpha[i].value_or(glm::dvec3(0.0)).x)};
    }
    [[nodiscard]] bool used(std::size_t i) const { return m_rgb[i] || m_alpha[i]; }

  private:
    static Register reg(std::size_t i) { return i == 0 ? Register::const0 : Register::const1; }
    static bool fits(const std::optional<glm::dvec3>& slot, const glm::dvec3& value, bool known) {
        return known ? slot == value : !slot;
    }
    std::array<std::optional<glm::dvec3>, 2> m_rgb, m_alpha;
};

/// Half a portion or a whole one.
struct Placed {
    int value;
    bool in_alpha;
};

class Scheduler {
  public:
    Scheduler(const Plan& plan, const Machine& machine, const Machine& target)
        : m_plan(plan), m_machine(machine), m_target(target) {}

    Schedule make() {
        const std::size_t count = m_plan.values.size();
        m_where.resize(count);
        m_ready.assign(count, false);
        m_uses.assign(count, 0);
        m_depth.assign(count, 0);
        m_out.needs.tables = static_cast<int>(m_plan.tables.size());
        m_out.needs.units = texture_units_of(m_plan);
        count_uses();
        place_inputs();
        m_out.needs.third_vector = m_third_vector >= 0;
        require_room(m_out.needs, m_machine);
        place_quantities();
        place_tables();
        while (!finished()) add_stage();
        m_out.needs.stages = static_cast<int>(program().stages.size());
        require_room(m_out.needs, m_machine);
        finish();
        return std::move(m_out);
    }

  private:
    CombinerProgram& program() { return m_out.material.combiners; }
    const PlanValue& value(int i) const { return m_plan.values[static_cast<std::size_t>(i)]; }
    static std::size_t at(int i) { return static_cast<std::size_t>(i); }

    template <class Visit>
    void for_each_operand(const PlanValue& v, const Visit& visit) const {
        if (v.op == PlanOp::arithmetic) {
            for (int k = 0; k < 2 * v.products; ++k) {
                if (v.factors[at(k)].value >= 0) visit(v.factors[at(k)].value);
            }
        } else if (v.op == PlanOp::table) {
            for (const PlanAxis& axis : m_plan.tables[at(v.index)].axes) visit(axis.input.value);
        }
    }

    [[nodiscard]] std::array<const PlanInput*, 5> final_inputs() const {
        const PlanFinal& f = m_plan.final;
        return {&f.a, &f.b, &f.d, &f.e, &f.f};
    }

    void count_uses() {
        const int last = static_cast<int>(m_plan.values.size()) - 1;
        for (const PlanInput* i : final_inputs()) {
            if (i->value >= 0) ++m_uses[at(i->value)];
        }
        // Operands come before what they make, so whoever is needed is known to be by now.
        for (int i = last; i >= 0; --i) {
            if (m_uses[at(i)] == 0) continue;
            const int below = m_depth[at(i)] + (value(i).op == PlanOp::table ? 1 : 2);
            for_each_operand(value(i), [&](int k) {
                ++m_uses[at(k)];
                m_depth[at(k)] = std::max(m_depth[at(k)], below);
            });
        }
    }

    void occupy(int v, const Half& half) {
        m_where[at(v)] = half;
        m_ready[at(v)] = true;
        m_holds[index(half)] = v;
    }
    static std::size_t index(const Half& half) {
        return 2 * static_cast<std::size_t>(half.reg) + (half.alpha ? 1 : 0);
    }

    void place_inputs() {
        ProgramMaterial& m = m_out.material;
        m.half_scale = glm::vec3(m_plan.half_scale);
        m.lit_tint = glm::vec3(m_plan.lit_tint);
        m.lit_base = glm::vec3(m_plan.lit_base);
        int vectors = 0, numbers = 0;
        for (std::size_t i = 0; i < m_plan.values.size(); ++i) {
            const PlanValue& v = m_plan.values[i];
            if (v.op != PlanOp::input) continue;
            const int id = static_cast<int>(i);
            if (v.name == "lit") {
                m.col1_rgb = ColorInput::lit;
                occupy(id, {Register::col1, false});
            } else if (v.kind == ValueKind::vector) {
                const ColorInput input = v.name == "h"   ? ColorInput::half_tangent
                                         : v.name == "l" ? ColorInput::light_tangent
                                                         : ColorInput::view_tangent;
                if (vectors == 0) m.col0_rgb = input;
                if (vectors == 1) m.col1_rgb = input;
                if (vectors < 2)
                    occupy(id, {vectors == 0 ? Register::col0 : Register::col1, false});
                if (vectors == 2) m_third_vector = id;
                ++vectors;
            } else {
                const ColorInput input =
                    v.name == "n_dot_l" ? ColorInput::n_dot_l : ColorInput::h_dot_l;
                (numbers == 0 ? m.col0_a : m.col1_a) = input;
                occupy(id, {numbers == 0 ? Register::col0 : Register::col1, true});
                ++numbers;
            }
        }
    }

    /// Vectors and colours get a unit each, numbers its alpha, or units of their own by twos.
    void place_quantities() {
        const std::size_t count = m_plan.quantities.size();
        m_out.quantities.resize(count);
        int units = 0;
        std::vector<int> free_alpha;
        for (std::size_t i = 0; i < count; ++i) {
            if (m_plan.quantities[i].kind == ValueKind::scalar) continue;
            m_out.quantities[i] = {units, false};
            free_alpha.push_back(units++);
        }
        std::reverse(free_alpha.begin(), free_alpha.end());
        for (std::size_t i = 0; i < count; ++i) {
            if (m_plan.quantities[i].kind != ValueKind::scalar) continue;
            if (!free_alpha.empty()) {
                m_out.quantities[i] = {free_alpha.back(), true};
                free_alpha.pop_back();
            } else {
                m_out.quantities[i] = {units, false};
                free_alpha.push_back(units++);
            }
        }
        if (m_third_vector >= 0) {
            // Only the first units can pass coordinates on; what was there moves.
            m_out.pass_unit = std::min(units, kTextureShaderUnits - 1);
            for (QuantityPlace& place : m_out.quantities) {
                if (place.unit == m_out.pass_unit) place.unit = units;
            }
            ++units;
            occupy(m_third_vector, {tex(m_out.pass_unit), false});
        }
        for (std::size_t i = 0; i < m_plan.values.size(); ++i) {
            const PlanValue& v = m_plan.values[i];
            if (v.op != PlanOp::quantity) continue;
            const QuantityPlace& place = m_out.quantities[at(v.index)];
            occupy(static_cast<int>(i), {tex(place.unit), place.alpha});
        }
        m_units = units;
    }

    void place_tables() {
        for (std::size_t i = 0; i < m_plan.tables.size(); ++i) m_out.tables.push_back(m_units++);
        m_reserved.assign(kRegisters, false);
        for (const int unit : m_out.tables) m_reserved[static_cast<std::size_t>(tex(unit))] = true;
    }

    [[nodiscard]] bool finished() const {
        const auto inputs = final_inputs();
        return std::all_of(inputs.begin(), inputs.end(), [&](const PlanInput* i) {
            return i->value < 0 || m_ready[at(i->value)] || value(i->value).op == PlanOp::constant;
        });
    }

    [[nodiscard]] bool operands_ready(const PlanValue& v) const {
        bool ready = true;
        for_each_operand(v, [&](int i) {
            ready = ready && (m_ready[at(i)] || value(i).op == PlanOp::constant);
        });
        return ready;
    }

    void add_stage() {
        m_stage = idle_stage();
        m_constants = m_machine.stage_constants ? Constants() : m_constants;
        m_written.clear();
        add_fetches();
        std::vector<int> order;
        for (std::size_t i = 0; i < m_plan.values.size(); ++i) {
            if (m_plan.values[i].op == PlanOp::arithmetic && !m_ready[i] && m_uses[i] > 0 &&
                operands_ready(m_plan.values[i]))
                order.push_back(static_cast<int>(i));
        }
        std::stable_sort(order.begin(), order.end(),
                         [&](int a, int b) { return m_depth[at(a)] > m_depth[at(b)]; });
        bool any = !m_stage.fetches.empty();
        Filling rgb, alpha;
        // Numbers go to the alpha portion while it has room: rgb is for vectors and colours.
        for (const bool vectors : {true, false}) {
            for (const int i : order) {
                const PlanValue& v = value(i);
                const bool needs_rgb = v.is_dot || v.kind != ValueKind::scalar;
                if (needs_rgb != vectors) continue;
                const bool done = (!needs_rgb && place(i, alpha, true)) || place(i, rgb, false);
                any |= done;
            }
        }
        if (!any) throw Shortage("no registers or constants are left", m_out.needs);
        for (const auto& [v, half] : m_written) occupy(v, half);
        if (m_machine.stage_constants) {
            if (m_constants.used(0)) m_stage.const0 = m_constants.color(0);
            if (m_constants.used(1)) m_stage.const1 = m_constants.color(1);
        }
        program().stages.push_back(m_stage);
    }

    void add_fetches() {
        for (bool again = true; again;) {
            again = false;
            std::vector<int> brought;
            for (std::size_t i = 0; i < m_plan.values.size(); ++i) {
                const PlanValue& v = m_plan.values[i];
                if (v.op != PlanOp::table || m_ready[i] || m_uses[i] == 0 || !operands_ready(v))
                    continue;
                m_stage.fetches.push_back(fetch_of(v));
                for_each_operand(v, [&](int k) { --m_uses[at(k)]; });
                brought.push_back(static_cast<int>(i));
            }
            for (const int i : brought) {
                occupy(i, {tex(m_out.tables[at(value(i).index)]), false});
                again = m_target.stage_fetches;
            }
        }
    }

    /// Numbers are the same in r, g and b; a frame brings blue or alpha to s, red or alpha to t.
    StageFetch fetch_of(const PlanValue& v) const {
        const std::vector<PlanAxis>& axes = m_plan.tables[at(v.index)].axes;
        StageFetch fetch;
        fetch.destination = tex(m_out.tables[at(v.index)]);
        fetch.target = axes.size() == 1 ? FetchTarget::table_1d : FetchTarget::table_2d;
        for (std::size_t k = 0; k < axes.size(); ++k) {
            const Half half = m_where[at(axes[k].input.value)];
            const int component = half.alpha ? 3 : k == 0 ? 2 : 0;
            fetch.coordinates[k] = {half.reg, static_cast<std::uint8_t>(component), false};
        }
        return fetch;
    }

    /// What a portion of the stage holds already.
    struct Filling {
        int products = 0;
        int doublings = 0;
    };

    bool place(int i, Filling& filling, bool in_alpha) {
        const PlanValue& v = value(i);
        if (filling.products > 0 &&
            (filling.products + v.products > 2 || filling.doublings != v.doublings))
            return false;
        std::array<Input, 4> inputs;
        Constants constants = m_constants;
        for (int k = 0; k < 2 * v.products; ++k) {
            const std::optional<Input> input = operand(v.factors[at(k)], in_alpha, constants);
            if (!input) return false;
            inputs[at(k)] = *input;
        }
        const std::optional<Half> to = target(i, in_alpha);
        if (!to) return false;
        m_constants = constants;
        Portion& p = in_alpha ? m_stage.alpha : m_stage.rgb;
        if (v.products == 2) {
            p.a = inputs[0];
            p.b = inputs[1];
            p.c = inputs[2];
            p.d = inputs[3];
            p.third_out = to->reg;
        } else if (filling.products == 0) {
            p.a = inputs[0];
            p.b = inputs[1];
            p.ab_product = v.is_dot ? Product::dot : Product::multiply;
            p.ab_out = to->reg;
        } else {
            p.c = inputs[0];
            p.d = inputs[1];
            p.cd_product = v.is_dot ? Product::dot : Product::multiply;
            p.cd_out = to->reg;
        }
        constexpr Scale kScales[] = {Scale::half, Scale::one, Scale::two, Scale::four};
        p.scale = kScales[v.doublings + 1];
        filling.products += v.products;
        filling.doublings = v.doublings;
        m_written.emplace_back(i, *to);
        for_each_operand(v, [&](int k) { --m_uses[at(k)]; });
        return true;
    }

    std::optional<Input> operand(const PlanInput& from, bool in_alpha, Constants& constants) const {
        if (from.value < 0)
            return Input{Register::zero, from.mapping,
                         in_alpha ? Component::alpha : Component::rgb};
        const PlanValue& v = value(from.value);
        Half half = m_where[at(from.value)];
        if (v.op == PlanOp::constant) {
            const std::optional<Half> found = constants.find(v.kind, v.constant, !in_alpha, true);
            if (!found) return std::nullopt;
            half = *found;
            constants.put(half, v.constant);
        }
        const Component component = half.alpha ? Component::alpha
                                    : in_alpha ? Component::blue
                                               : Component::rgb;
        return Input{half.reg, from.mapping, component};
    }

    /// Half a register that nobody reads any more after this stage.
    std::optional<Half> target(int i, bool in_alpha) const {
        constexpr Register kFirst[] = {Register::spare0, Register::spare1, Register::col0,
                                       Register::col1};
        const auto is_free = [&](const Half& half) {
            if (m_reserved[static_cast<std::size_t>(half.reg)]) {
                // A table's own register, before the fetch and while its value is read.
                const int holds = m_holds[index({half.reg, false})];
                if (holds < 0 || m_uses[at(holds)] > uses_by(i, holds)) return false;
            }
            for (const auto& [v, taken] : m_written) {
                if (taken == half) return false;
            }
            const int holds = m_holds[index(half)];
            return holds < 0 || m_uses[at(holds)] <= uses_by(i, holds);
        };
        for (const Register reg : kFirst) {
            if (is_free({reg, in_alpha})) return Half{reg, in_alpha};
        }
        for (int unit = 0; unit < m_target.texture_units; ++unit) {
            if (is_free({tex(unit), in_alpha})) return Half{tex(unit), in_alpha};
        }
        return std::nullopt;
    }
    /// How often value i itself reads another.
    int uses_by(int i, int other) const {
        int uses = 0;
        for_each_operand(value(i), [&](int k) { uses += k == other ? 1 : 0; });
        return uses;
    }

    void finish() {
        CombinerProgram& p = program();
        FinalCombiner& f = p.final_combiner;
        const PlanFinal& planned = m_plan.final;
        if (m_machine.stage_constants) m_constants = Constants();
        f.a = final_input(planned.a);
        f.d = final_input(planned.d);
        if (planned.has_product) {
            f.b = combine::raw(Register::final_product);
            f.e = final_input(planned.e);
            f.f = final_input(planned.f);
        } else {
            f.b = final_input(planned.b);
        }
        f.g = combine::alpha(combine::one());
        p.const0 = m_constants.color(0);
        p.const1 = m_constants.color(1);
        ProgramMaterial& m = m_out.material;
        m.units.resize(static_cast<std::size_t>(m_units));
        if (m_out.pass_unit >= 0) {
            TextureShader shader;
            for (int unit = 0; unit < std::min(m_units, kTextureShaderUnits); ++unit)
                shader.units[at(unit)].operation = TextureOperation::texture_2d;
            for (const int unit : m_out.tables) {
                if (unit < kTextureShaderUnits)
                    shader.units[at(unit)].operation = TextureOperation::none;
            }
            shader.units[at(m_out.pass_unit)].operation = TextureOperation::pass_through;
            const std::string& name = value(m_third_vector).name;
            m.uv[at(m_out.pass_unit)] = name == "h"   ? CoordinateInput::half_coded
                                        : name == "l" ? CoordinateInput::light_coded
                                                      : CoordinateInput::view_coded;
            m.texture_shader = shader;
        }
    }

    Input final_input(const PlanInput& from) {
        if (from.value < 0) {
            const bool is_one = from.mapping == Mapping::unsigned_invert;
            return is_one ? combine::one() : combine::raw(Register::zero);
        }
        const std::optional<Input> input = operand(from, false, m_constants);
        if (!input) throw Shortage("no constants are left", m_out.needs);
        Input raw = *input;
        if (raw.mapping == Mapping::signed_identity) raw.mapping = Mapping::unsigned_identity;
        return raw;
    }

    const Plan& m_plan;
    const Machine& m_machine;
    const Machine& m_target;
    Schedule m_out;
    std::vector<Half> m_where;
    std::vector<bool> m_ready, m_reserved;
    std::vector<int> m_uses, m_depth;
    std::array<int, 2 * kRegisters> m_holds = filled_with_nobody();
    int m_third_vector = -1, m_units = 0;
    GeneralStage m_stage;
    Constants m_constants;
    std::vector<std::pair<int, Half>> m_written;

    static std::array<int, 2 * kRegisters> filled_with_nobody() {
        std::array<int, 2 * kRegisters> nobody{};
        nobody.fill(-1);
        return nobody;
    }
};

}  // namespace

int texture_units_of(const Plan& plan) {
    int vectors = 0, colors = 0, numbers = 0;
    for (const PlanValue& v : plan.values)
        vectors += v.op == PlanOp::input && v.kind == ValueKind::vector ? 1 : 0;
    for (const PlanQuantity& q : plan.quantities)
        (q.kind == ValueKind::scalar ? numbers : colors) += 1;
    const int layer = colors + (std::max(numbers - colors, 0) + 1) / 2;
    return layer + (vectors == 3 ? 1 : 0) + static_cast<int>(plan.tables.size());
}

Schedule schedule(const Plan& plan, const Machine& machine, const Machine& target) {
    return Scheduler(plan, machine, target).make();
}

}  // namespace burnish
