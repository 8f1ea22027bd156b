#include "machine/program_values.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace burnish {

namespace {

bool same_everywhere(const OperandValues& o) {
    return o.value[0] == o.value[1] && o.value[1] == o.value[2];
}

ProductKind kind_of(Product p) {
    return p == Product::dot ? ProductKind::dot : ProductKind::multiply;
}

/// spare0 = x/2 + 1/2, then without what lies below 0.
std::array<Portion, 2> make_coding(Register reg) {
    const Input one{Register::zero, Mapping::unsigned_invert, Component::rgb};
    std::array<Portion, 2> coding;
    coding[0].a = {reg, Mapping::signed_identity, Component::rgb};
    coding[0].b = coding[0].c = coding[0].d = one;
    coding[0].third_out = Register::spare0;
    coding[0].scale = Scale::half;
    coding[1].a = {Register::spare0, Mapping::unsigned_identity, Component::rgb};
    coding[1].b = one;
    coding[1].ab_out = Register::spare0;
    return coding;
}

/// Turns a program into operations on values.
class ValueBuilder {
  public:
    ValueBuilder(const CombinerProgram& program, const Machine& machine, const UnitStates& units)
        : m_program(program),
          m_textured(units.textured),
          m_one(machine.numbers == NumberModel::nine_bit ? 255 : 16384) {
        set_initial_registers(units);
    }

    ProgramValues build(const Wanted& wanted) {
        for (const GeneralStage& stage : m_program.stages) add_stage(stage);
        if (wanted.reg) {
            if (wanted.coded) add_coding(*wanted.reg);
            m_values.shown = at(wanted.coded ? Register::spare0 : *wanted.reg);
        } else {
            read_final();
        }
        if (!wanted.everything) drop_unread();
        return std::move(m_values);
    }

  private:
    // --- values

    Value constant(int code) {
        const auto [at, added] = m_values.constants.try_emplace(code, m_values.count);
        if (added) ++m_values.count;
        return at->second;
    }
    Value constant(float x) {
        const float clamped = x > 0.0F ? std::min(x, 1.0F) : 0.0F;
        return constant(static_cast<int>(std::floor(clamped * static_cast<float>(m_one) + 0.5F)));
    }
    Components constant(const glm::vec4& v) {
        return {constant(v.r), constant(v.g), constant(v.b), constant(v.a)};
    }

    Components& at(Register r) { return m_registers[static_cast<std::size_t>(r)]; }

    Components input(Register r) {
        Components values;
        for (Value& value : values) value = m_values.count++;
        m_values.inputs.push_back({r, values});
        return values;
    }

    template <class Values>
    void note_beyond_one(const Values& values) {
        m_values.beyond_one.insert(values.begin(), values.end());
    }

    void set_initial_registers(const UnitStates& units) {
        const Value zero = constant(0), one = constant(m_one);
        for (Components& components : m_registers) components.fill(zero);
        at(Register::const0) = constant(m_program.const0);
        at(Register::const1) = constant(m_program.const1);
        at(Register::fog) = constant(m_program.fog);
        at(Register::col0) = input(Register::col0);
        at(Register::col1) = input(Register::col1);
        if (!units.bounded_colors) {
            note_beyond_one(at(Register::col0));
            note_beyond_one(at(Register::col1));
        }
        for (int unit = 0; unit < 16; ++unit) {
            const bool enabled = (units.enabled >> unit & 1) != 0;
            const bool black = (units.black >> unit & 1) != 0;
            at(tex(unit)) =
                enabled ? input(tex(unit)) : Components{zero, zero, zero, black ? zero : one};
            if (enabled && (units.bounded >> unit & 1) == 0) note_beyond_one(at(tex(unit)));
        }
        at(Register::spare0)[3] = at(tex(0))[3];
    }

    // --- general stages

    OperandValues read(const Input& input, bool alpha_portion) {
        const Components& r = at(input.reg);
        OperandValues o;
        o.mapping = input.mapping;
        if (input.component == Component::alpha ||
            (alpha_portion && input.component == Component::rgb)) {
            o.value.fill(r[3]);
        } else if (input.component == Component::blue) {
            o.value.fill(r[2]);
        } else {
            o.value = {r[0], r[1], r[2]};
        }
        return o;
    }

    /// One value per component; a single one where all are equal.
    std::array<Value, 3> output(Register r, int components) {
        std::array<Value, 3> out{kNothing, kNothing, kNothing};
        if (r == Register::discard) return out;
        for (int c = 0; c < 3; ++c) {
            out[static_cast<std::size_t>(c)] = c < components ? m_values.count++ : out[0];
        }
        return out;
    }

    Operation operation(const Portion& p, bool alpha) {
        Operation op;
        op.step = m_values.steps;
        op.source = p;
        op.a = read(p.a, alpha);
        op.b = read(p.b, alpha);
        op.c = read(p.c, alpha);
        op.d = read(p.d, alpha);
        op.ab = kind_of(p.ab_product);
        op.cd = kind_of(p.cd_product);
        const bool uses_third = p.third_out != Register::discard;
        if (uses_third) op.third = p.third == Third::mux ? ThirdKind::mux : ThirdKind::sum;
        op.mux = at(Register::spare0)[3];
        const bool ab_same =
            op.ab == ProductKind::dot || (same_everywhere(op.a) && same_everywhere(op.b));
        const bool cd_same =
            op.cd == ProductKind::dot || (same_everywhere(op.c) && same_everywhere(op.d));
        const bool ab_read = uses_third || p.ab_out != Register::discard;
        const bool cd_read = uses_third || p.cd_out != Register::discard;
        op.components = (ab_same || !ab_read) && (cd_same || !cd_read) ? 1 : 3;
        op.ab_out = output(p.ab_out, op.components);
        op.cd_out = output(p.cd_out, op.components);
        op.third_out = output(p.third_out, op.components);
        if (p.wide) {
            note_beyond_one(op.ab_out);
            note_beyond_one(op.cd_out);
            note_beyond_one(op.third_out);
        }
        return op;
    }

    void write(const Operation& op, bool alpha) {
        const auto set = [&](Register r, const std::array<Value, 3>& out) {
            if (r == Register::discard) return;
            if (alpha) {
                at(r)[3] = out[0];
            } else {
                std::copy(out.begin(), out.end(), at(r).begin());
            }
        };
        set(op.source.ab_out, op.ab_out);
        set(op.source.cd_out, op.cd_out);
        set(op.source.third_out, op.third_out);
        if (op.source.ab_blue_to_alpha) at(op.source.ab_out)[3] = op.ab_out[2];
        if (op.source.cd_blue_to_alpha) at(op.source.cd_out)[3] = op.cd_out[2];
    }

    void add_fetch(const StageFetch& fetch) {
        const int unit = static_cast<int>(fetch.destination) - static_cast<int>(Register::tex0);
        if ((m_textured >> unit & 1) == 0) {
            const Value zero = constant(0);
            at(fetch.destination) = {zero, zero, zero, constant(m_one)};
            return;
        }
        Operation op;
        op.step = m_values.steps++;
        op.fetch = &fetch;
        for (int i = 0; i < coordinate_count(fetch.target); ++i) {
            const auto index = static_cast<std::size_t>(i);
            const FetchCoordinate& from = fetch.coordinates[index];
            op.coordinates[index] = at(from.reg)[from.component];
        }
        for (Value& value : op.fetched) value = m_values.count++;
        at(fetch.destination) = op.fetched;
        m_values.operations.push_back(op);
    }

    void add_stage(const GeneralStage& stage) {
        at(Register::const0) = constant(stage.const0.value_or(m_program.const0));
        at(Register::const1) = constant(stage.const1.value_or(m_program.const1));
        for (const StageFetch& fetch : stage.fetches) add_fetch(fetch);
        std::optional<Operation> rgb, alpha;
        if (stage.rgb.writes()) rgb = operation(stage.rgb, false);
        if (stage.alpha.writes()) alpha = operation(stage.alpha, true);
        if (rgb) write(*rgb, false);
        if (alpha) write(*alpha, true);
        if (rgb) m_values.operations.push_back(*rgb);
        if (alpha) m_values.operations.push_back(*alpha);
        ++m_values.steps;
    }

    // --- a register instead of the final combiner

    void add_coding(Register reg) {
        for (const Portion& portion : make_coding(reg)) {
            Operation rgb = operation(portion, false);
            Operation alpha = operation(portion, true);
            rgb.coding = alpha.coding = true;
            ++m_values.steps;
            write(rgb, false);
            write(alpha, true);
            m_values.operations.push_back(rgb);
            m_values.operations.push_back(alpha);
        }
    }

    // --- final combiner: always the global constants

    void read_final() {
        at(Register::const0) = constant(m_program.const0);
        at(Register::const1) = constant(m_program.const1);
        const FinalCombiner& f = m_program.final_combiner;
        const Input* inputs[6] = {&f.a, &f.b, &f.c, &f.d, &f.e, &f.f};
        for (std::size_t i = 0; i < 6; ++i) {
            m_values.final_inputs[i] = read(*inputs[i], false);
            m_values.uses_color_sum |= inputs[i]->reg == Register::color_sum;
            m_values.uses_final_product |= inputs[i]->reg == Register::final_product;
        }
        m_values.final_inputs[6] = read(f.g, true);
        if (!m_values.uses_final_product)
            m_values.final_inputs[4] = m_values.final_inputs[5] = read({}, false);
        const Components &spare0 = at(Register::spare0), &secondary = at(Register::col1);
        m_values.color_sum[0].value = {spare0[0], spare0[1], spare0[2]};
        m_values.color_sum[1].value = {secondary[0], secondary[1], secondary[2]};
    }

    // --- what is never read is not computed

    /// Where a single component of r, g, b is read, it is the only one to compute.
    static void keep_component(Operation& op) {
        if (op.components == 1) return;
        int kept = -1;
        for (int c = 0; c < 3; ++c) {
            const auto at = static_cast<std::size_t>(c);
            const bool is_read = op.ab_out[at] != kNothing || op.cd_out[at] != kNothing ||
                                 op.third_out[at] != kNothing;
            if (is_read && kept >= 0) return;
            if (is_read) kept = c;
        }
        const auto at = static_cast<std::size_t>(kept);
        op.components = 1;
        for (std::array<Value, 3>* out : {&op.ab_out, &op.cd_out, &op.third_out})
            out->fill((*out)[at]);
        const auto take = [&](OperandValues& o, ProductKind product) {
            if (product == ProductKind::multiply) o.value.fill(o.value[at]);
        };
        take(op.a, op.ab);
        take(op.b, op.ab);
        take(op.c, op.cd);
        take(op.d, op.cd);
    }

    void drop_unread() {
        std::vector<bool> live(static_cast<std::size_t>(m_values.count), false);
        const auto mark = [&](Value v) { live[static_cast<std::size_t>(v)] = true; };
        const auto clean = [&](std::array<Value, 3>& out) {
            bool any = false;
            for (Value& v : out) {
                if (v != kNothing && !live[static_cast<std::size_t>(v)]) v = kNothing;
                any |= v != kNothing;
            }
            return any;
        };
        m_values.for_each_final_read(mark);
        std::vector<Operation> kept;
        for (auto op = m_values.operations.rbegin(); op != m_values.operations.rend(); ++op) {
            if (op->fetch != nullptr) {
                const bool read = std::any_of(op->fetched.begin(), op->fetched.end(), [&](Value v) {
                    return live[static_cast<std::size_t>(v)];
                });
                if (!read) continue;
                ProgramValues::for_each_read(*op, mark);
                kept.push_back(*op);
                continue;
            }
            const bool ab = clean(op->ab_out), cd = clean(op->cd_out), third = clean(op->third_out);
            if (!ab && !cd && !third) continue;
            keep_component(*op);
            if (!third) {
                op->third = ThirdKind::none;
                if (!cd) op->cd = ProductKind::none;
                if (!ab) {  // a lone product is always AB
                    op->a = op->c;
                    op->b = op->d;
                    op->ab = op->cd;
                    op->ab_out = op->cd_out;
                    op->cd = ProductKind::none;
                    op->cd_out.fill(kNothing);
                }
            }
            ProgramValues::for_each_read(*op, mark);
            kept.push_back(*op);
        }
        m_values.operations.assign(kept.rbegin(), kept.rend());
    }

    const CombinerProgram& m_program;
    std::uint32_t m_textured;
    int m_one;
    std::array<Components, kRegisterCount> m_registers;
    ProgramValues m_values;
};

}  // namespace

bool ProgramValues::is_zero(const OperandValues& o) const {
    const auto zero = constants.find(0);
    return zero != constants.end() && o.mapping == Mapping::unsigned_identity &&
           std::all_of(o.value.begin(), o.value.end(), [&](Value v) { return v == zero->second; });
}

ProgramValues values_of(const CombinerProgram& program, const Machine& machine,
                        const UnitStates& units, const Wanted& wanted) {
    return ValueBuilder(program, machine, units).build(wanted);
}

}  // namespace burnish
