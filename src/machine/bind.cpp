#include "machine/bind.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <set>

namespace burnish {

namespace {

/// A value of the program: a constant, an input, or the output of a portion.
using Value = int;
constexpr Value kNothing = -1;

using Components = std::array<Value, 4>;  // r, g, b, a

struct OperandValues {
    std::array<Value, 3> value{kNothing, kNothing, kNothing};
    Mapping mapping = Mapping::unsigned_identity;
};

/// One portion, or one fetch, on values instead of planes.
struct Operation {
    int step = 0;  ///< the portions of a stage read before any of them writes
    OperandValues a, b, c, d;
    ProductKind ab = ProductKind::none, cd = ProductKind::none;
    ThirdKind third = ThirdKind::none;
    const Portion* source = nullptr;
    int components = 1;
    Value mux = kNothing;
    std::array<Value, 3> ab_out{kNothing, kNothing, kNothing};
    std::array<Value, 3> cd_out = ab_out, third_out = ab_out;
    bool coding = false;  ///< no part of the program
    const StageFetch* fetch = nullptr;
    std::array<Value, 3> coordinates{kNothing, kNothing, kNothing};
    Components fetched{kNothing, kNothing, kNothing, kNothing};
};

bool same_everywhere(const OperandValues& o) {
    return o.value[0] == o.value[1] && o.value[1] == o.value[2];
}

ProductKind kind_of(Product p) {
    return p == Product::dot ? ProductKind::dot : ProductKind::multiply;
}

/// Turns a program into operations on values, then values into planes.
class Binder {
  public:
    Binder(const CombinerProgram& program, const Machine& machine, const UnitStates& units)
        : m_program(program),
          m_machine(machine),
          m_numbers(machine.numbers),
          m_textured(units.textured) {
        m_one = m_numbers == NumberModel::nine_bit ? 255 : 16384;
        for (auto& components : m_bound.input) components.fill(-1);
        set_initial_registers(units);
    }

    BoundProgram bind(const Wanted& wanted) {
        for (const GeneralStage& stage : m_program.stages) add_stage(stage);
        if (wanted.reg) {
            if (wanted.coded) add_coding(*wanted.reg);
            m_shown = at(wanted.coded ? Register::spare0 : *wanted.reg);
        } else {
            read_final();
        }
        m_everything = wanted.everything;
        if (!m_everything) drop_unread();
        allocate();
        return std::move(m_bound);
    }

  private:
    // --- values

    Value constant(int code) {
        const auto [at, added] = m_constants.try_emplace(code, m_value_count);
        if (added) ++m_value_count;
        return at->second;
    }
    Value constant(float x) {
        const float clamped = x > 0.0F ? std::min(x, 1.0F) : 0.0F;
        return constant(static_cast<int>(std::floor(clamped * static_cast<float>(m_one) + 0.5F)));
    }
    Components constant(const glm::vec4& v) {
        return {constant(v.r), constant(v.g), constant(v.b), constant(v.a)};
    }

    [[nodiscard]] std::optional<int> code_of(Value v) const {
        const auto known = std::ranges::find(m_constants, v, &std::pair<const int, Value>::second);
        if (known == m_constants.end()) return {};
        return known->first;
    }

    Components& at(Register r) { return m_registers[static_cast<std::size_t>(r)]; }

    Components input(Register r) {
        Components values;
        for (Value& value : values) value = m_value_count++;
        m_inputs.push_back({r, values});
        return values;
    }

    template <class Values>
    void note_beyond_one(const Values& values) {
        m_beyond_one.insert(values.begin(), values.end());
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
            if (enabled && (units.positive >> unit & 1) != 0)
                m_positive.insert(at(tex(unit)).begin(), at(tex(unit)).end());
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
            out[static_cast<std::size_t>(c)] = c < components ? m_value_count++ : out[0];
        }
        return out;
    }

    Operation operation(const Portion& p, bool alpha) {
        Operation op;
        op.step = m_step;
        op.source = &p;
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
        set(op.source->ab_out, op.ab_out);
        set(op.source->cd_out, op.cd_out);
        set(op.source->third_out, op.third_out);
        if (op.source->ab_blue_to_alpha) at(op.source->ab_out)[3] = op.ab_out[2];
        if (op.source->cd_blue_to_alpha) at(op.source->cd_out)[3] = op.cd_out[2];
    }

    void add_fetch(const StageFetch& fetch) {
        const int unit = static_cast<int>(fetch.destination) - static_cast<int>(Register::tex0);
        if ((m_textured >> unit & 1) == 0) {
            const Value zero = constant(0);
            at(fetch.destination) = {zero, zero, zero, constant(m_one)};
            return;
        }
        Operation op;
        op.step = m_step++;
        op.fetch = &fetch;
        for (int i = 0; i < coordinate_count(fetch.target); ++i) {
            const auto index = static_cast<std::size_t>(i);
            const FetchCoordinate& from = fetch.coordinates[index];
            op.coordinates[index] = at(from.reg)[from.component];
        }
        for (Value& value : op.fetched) value = m_value_count++;
        at(fetch.destination) = op.fetched;
        m_operations.push_back(op);
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
        if (rgb) m_operations.push_back(*rgb);
        if (alpha) m_operations.push_back(*alpha);
        ++m_step;
    }

    // --- a register instead of the final combiner

    /// spare0 = x/2 + 1/2, then without what lies below 0: two stages more.
    void add_coding(Register reg) {
        const Input one{Register::zero, Mapping::unsigned_invert, Component::rgb};
        m_coding[0].a = {reg, Mapping::signed_identity, Component::rgb};
        m_coding[0].b = m_coding[0].c = m_coding[0].d = one;
        m_coding[0].third_out = Register::spare0;
        m_coding[0].scale = Scale::half;
        m_coding[1].a = {Register::spare0, Mapping::unsigned_identity, Component::rgb};
        m_coding[1].b = one;
        m_coding[1].ab_out = Register::spare0;
        for (const Portion& portion : m_coding) {
            Operation rgb = operation(portion, false);
            Operation alpha = operation(portion, true);
            rgb.coding = alpha.coding = true;
            ++m_step;
            write(rgb, false);
            write(alpha, true);
            m_operations.push_back(rgb);
            m_operations.push_back(alpha);
        }
    }

    // --- final combiner: always the global constants

    /// 1 - x, where x is known, as another constant.
    void complement(OperandValues& o) {
        for (const Value v : o.value)
            if (!code_of(v)) return;
        for (Value& v : o.value) v = constant(m_one - *code_of(v));
        o.mapping = Mapping::unsigned_identity;
    }

    void read_final() {
        at(Register::const0) = constant(m_program.const0);
        at(Register::const1) = constant(m_program.const1);
        const FinalCombiner& f = m_program.final_combiner;
        const Input* inputs[6] = {&f.a, &f.b, &f.c, &f.d, &f.e, &f.f};
        for (std::size_t i = 0; i < 6; ++i) {
            m_final[i] = read(*inputs[i], false);
            m_uses_sum |= inputs[i]->reg == Register::color_sum;
            m_uses_product |= inputs[i]->reg == Register::final_product;
        }
        m_final[6] = read(f.g, true);
        if (f.g.mapping == Mapping::unsigned_invert) complement(m_final[6]);
        if (!m_uses_product) m_final[4] = m_final[5] = read({}, false);
        const Components &spare0 = at(Register::spare0), &secondary = at(Register::col1);
        m_sum[0].value = {spare0[0], spare0[1], spare0[2]};
        m_sum[1].value = {secondary[0], secondary[1], secondary[2]};
    }

    // --- what is never read is not computed

    template <class F>
    static void for_each_read(const Operation& op, F&& f) {
        if (op.fetch != nullptr) {
            for (const Value v : op.coordinates) {
                if (v != kNothing) f(v);
            }
            return;
        }
        const auto operand = [&](const OperandValues& o, ProductKind product) {
            const int used = product == ProductKind::dot ? 3 : op.components;
            for (int c = 0; c < used; ++c) f(o.value[static_cast<std::size_t>(c)]);
        };
        operand(op.a, op.ab);
        operand(op.b, op.ab);
        if (op.cd != ProductKind::none) {
            operand(op.c, op.cd);
            operand(op.d, op.cd);
        }
        if (op.third == ThirdKind::mux) f(op.mux);
    }

    template <class F>
    void for_each_final_read(F&& f) const {
        if (m_shown) {
            for (const Value v : *m_shown) f(v);
            return;
        }
        for (const OperandValues& o : m_final) {
            for (const Value v : o.value) f(v);
        }
        if (!m_uses_sum) return;
        for (const OperandValues& o : m_sum) {
            for (const Value v : o.value) f(v);
        }
    }

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
        std::vector<bool> live(static_cast<std::size_t>(m_value_count), false);
        const auto mark = [&](Value v) { live[static_cast<std::size_t>(v)] = true; };
        const auto clean = [&](std::array<Value, 3>& out) {
            bool any = false;
            for (Value& v : out) {
                if (v != kNothing && !live[static_cast<std::size_t>(v)]) v = kNothing;
                any |= v != kNothing;
            }
            return any;
        };
        for_each_final_read(mark);
        std::vector<Operation> kept;
        for (auto op = m_operations.rbegin(); op != m_operations.rend(); ++op) {
            if (op->fetch != nullptr) {
                const bool read = std::any_of(op->fetched.begin(), op->fetched.end(), [&](Value v) {
                    return live[static_cast<std::size_t>(v)];
                });
                if (!read) continue;
                for_each_read(*op, mark);
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
            for_each_read(*op, mark);
            kept.push_back(*op);
        }
        m_operations.assign(kept.rbegin(), kept.rend());
    }

    // --- planes

    void allocate() {
        m_plane.assign(static_cast<std::size_t>(m_value_count), -1);
        m_last_use.assign(static_cast<std::size_t>(m_value_count), -1);
        for (const Operation& op : m_operations) {
            for_each_read(op, [&](Value v) { m_last_use[static_cast<std::size_t>(v)] = op.step; });
        }
        for_each_final_read([&](Value v) { m_last_use[static_cast<std::size_t>(v)] = m_step; });
        place_constants();
        m_trash = m_bound.plane_count++;
        place_inputs();
        for (std::size_t i = 0; i < m_operations.size();) {
            const int step = m_operations[i].step;
            const std::size_t first = i;
            for (; i < m_operations.size() && m_operations[i].step == step; ++i) {
                m_operations[i].fetch != nullptr ? emit_fetch(m_operations[i])
                                                 : emit(m_operations[i]);
            }
            for (std::size_t k = first; k < i; ++k) {
                for_each_read(m_operations[k], [&](Value v) { release(v, step); });
                for (const Value v : m_operations[k].fetched) release_unread(v);
            }
        }
        m_shown ? emit_registers(*m_shown) : emit_final();
        m_bound.numbers = m_numbers;
    }

    void place_constants() {
        for (const auto& [code, value] : m_constants) {
            if (m_last_use[static_cast<std::size_t>(value)] < 0) continue;
            m_plane[static_cast<std::size_t>(value)] = m_bound.plane_count++;
            m_bound.constants.push_back(static_cast<std::int16_t>(code));
            m_last_use[static_cast<std::size_t>(value)] = m_step + 1;
        }
    }

    void place_inputs() {
        for (const auto& [reg, values] : m_inputs) {
            const auto read = [&](Value v) { return m_last_use[static_cast<std::size_t>(v)] >= 0; };
            if (std::none_of(values.begin(), values.end(), read)) continue;
            const bool texture = reg >= Register::tex0 && reg <= Register::tex15;
            for (std::size_t c = 0; c < 4; ++c) {
                if (!texture && !read(values[c])) continue;
                const int plane = m_bound.plane_count++;
                m_plane[static_cast<std::size_t>(values[c])] = plane;
                m_bound.input[static_cast<std::size_t>(reg)][c] = plane;
                if (!read(values[c])) m_unread.push_back(plane);
            }
        }
        m_free = m_unread;
    }

    int take_plane() {
        if (m_free.empty()) return m_bound.plane_count++;
        const int plane = m_free.back();
        m_free.pop_back();
        return plane;
    }

    /// Four planes in a row.
    int take_row() {
        std::sort(m_free.begin(), m_free.end());
        for (std::size_t i = 0; i + 3 < m_free.size(); ++i) {
            const int first = m_free[i];
            if (m_free[i + 3] != first + 3) continue;
            const auto at = m_free.begin() + static_cast<std::ptrdiff_t>(i);
            m_free.erase(at, at + 4);
            return first;
        }
        m_bound.plane_count += 4;
        return m_bound.plane_count - 4;
    }

    /// What a fetch brings and nobody reads.
    void release_unread(Value v) {
        if (v == kNothing || m_last_use[static_cast<std::size_t>(v)] >= 0) return;
        m_free.push_back(m_plane[static_cast<std::size_t>(v)]);
    }

    void release(Value v, int step) {
        int& last = m_last_use[static_cast<std::size_t>(v)];
        if (last != step) return;
        m_free.push_back(m_plane[static_cast<std::size_t>(v)]);
        last = -1;  // once, however often it was read
    }

    [[nodiscard]] Rounding rounding() const {
        switch (m_machine.product_rounding) {
            case ProductRounding::nearest:
                break;
            case ProductRounding::truncate:
                return Rounding::truncate;
            case ProductRounding::shift8:
                return Rounding::shift8;
        }
        return Rounding::nearest;
    }

    Operand operand(const OperandValues& o) const {
        Operand result{};
        for (std::size_t c = 0; c < 3; ++c) {
            const int plane = m_plane[static_cast<std::size_t>(o.value[c])];
            result.plane[c] = static_cast<std::int16_t>(std::max(plane, 0));
        }
        result.mapping = static_cast<std::uint8_t>(o.mapping);
        const bool has_half =
            o.mapping >= Mapping::expand && o.mapping <= Mapping::half_bias_negate;
        if (has_half && m_machine.expand == ExpandRule::ideal) {
            result.mapping = static_cast<std::uint8_t>(result.mapping + Operand::kIdealHalf);
        }
        return result;
    }

    [[nodiscard]] bool is_positive(Value v) const {
        return m_positive.contains(v) || code_of(v).has_value();
    }

    // --- of the final combiner

    bool is_zero(const OperandValues& o) {
        const Value zero = constant(0);
        return o.mapping == Mapping::unsigned_identity &&
               std::all_of(o.value.begin(), o.value.end(), [&](Value v) { return v == zero; });
    }

    void place_outputs(const std::array<Value, 3>& out, std::int16_t (&planes)[3]) {
        for (std::size_t c = 0; c < 3; ++c) {
            int plane = m_trash;
            if (out[c] != kNothing) {
                int& assigned = m_plane[static_cast<std::size_t>(out[c])];
                if (assigned < 0) assigned = take_plane();
                plane = assigned;
            }
            planes[c] = static_cast<std::int16_t>(plane);
        }
    }

    void emit(const Operation& op) {
        PortionCtx ctx{};
        ctx.a = operand(op.a);
        ctx.b = operand(op.b);
        ctx.c = op.cd == ProductKind::none ? ctx.a : operand(op.c);
        ctx.d = op.cd == ProductKind::none ? ctx.b : operand(op.d);
        ctx.ab = op.ab;
        ctx.cd = op.cd;
        ctx.third = op.third;
        ctx.scale = static_cast<OutputScale>(op.source->scale);
        // The code of a shown register is no work of the machine: it is the same on all of them.
        ctx.rounding = op.coding ? Rounding::nearest : rounding();
        ctx.halve_down = !op.coding && m_machine.halving == Halving::down ? 1 : 0;
        ctx.mux_lsb = m_program.mux_bit == MuxBit::lsb ? 1 : 0;
        ctx.bias_minus_half = op.source->bias_minus_half ? 1 : 0;
        ctx.wide = op.source->wide ? 1 : 0;
        ctx.components = static_cast<std::uint8_t>(op.components);
        ctx.bounded = 1;
        for_each_read(op, [&](Value v) {
            if (m_beyond_one.contains(v)) ctx.bounded = 0;
        });
        const bool muxes = op.third == ThirdKind::mux;
        ctx.mux_plane =
            static_cast<std::int16_t>(muxes ? m_plane[static_cast<std::size_t>(op.mux)] : 0);
        place_outputs(op.ab_out, ctx.ab_out);
        place_outputs(op.cd_out, ctx.cd_out);
        place_outputs(op.third_out, ctx.third_out);
        m_bound.portions.push_back(ctx);
    }

    void emit_fetch(const Operation& op) {
        BoundFetch fetch;
        fetch.before = m_bound.portions.size();
        fetch.unit = static_cast<int>(op.fetch->destination) - static_cast<int>(Register::tex0);
        fetch.target = op.fetch->target;
        for (std::size_t i = 0; i < 3; ++i) {
            if (op.coordinates[i] == kNothing) continue;
            fetch.plane[i] = m_plane[static_cast<std::size_t>(op.coordinates[i])];
            fetch.expand[i] = op.fetch->coordinates[i].expand;
        }
        fetch.out = take_row();
        for (std::size_t c = 0; c < 4; ++c) {
            const auto value = static_cast<std::size_t>(op.fetched[c]);
            m_plane[value] = fetch.out + static_cast<int>(c);
            if (m_everything || m_last_use[value] >= 0)
                fetch.live |= static_cast<std::uint8_t>(1U << c);
        }
        m_bound.fetches.push_back(fetch);
    }

    /// D and G as they lie in registers, all that the final combiner would do with them being to
    /// clamp what is below 0 or beyond 1.
    [[nodiscard]] std::optional<Components> copied_by_final() {
        const OperandValues &d = m_final[3], &g = m_final[6];
        const bool is_sum = m_uses_sum || m_uses_product;
        if (m_everything || is_sum || !is_zero(m_final[1]) || !is_zero(m_final[2])) return {};
        const Components values{d.value[0], d.value[1], d.value[2], g.value[0]};
        const bool as_they_are =
            d.mapping == Mapping::unsigned_identity && g.mapping == Mapping::unsigned_identity &&
            std::all_of(values.begin(), values.end(), [this](Value v) { return is_positive(v); });
        if (!as_they_are) return {};
        return values;
    }

    void emit_final() {
        if (const auto copied = copied_by_final()) return emit_registers(*copied);
        FinalCtx& ctx = m_bound.final_combiner;
        const FinalCombiner& f = m_program.final_combiner;
        const Input* inputs[6] = {&f.a, &f.b, &f.c, &f.d, &f.e, &f.f};
        Operand* operands[6] = {&ctx.a, &ctx.b, &ctx.c, &ctx.d, &ctx.e, &ctx.f};
        for (std::size_t i = 0; i < 6; ++i) {
            *operands[i] = operand(m_final[i]);
            const bool may_be_zero = i >= 1 && i <= 3;  // B, C, D
            if (may_be_zero && is_zero(m_final[i])) operands[i]->plane[0] = FinalCtx::kZero;
            if (inputs[i]->reg == Register::color_sum) operands[i]->plane[0] = FinalCtx::kColorSum;
            if (inputs[i]->reg == Register::final_product) {
                operands[i]->plane[0] = FinalCtx::kFinalProduct;
            }
        }
        ctx.g = operand(m_final[6]);
        const Operand spare0 = operand(m_sum[0]), secondary = operand(m_sum[1]);
        std::copy(std::begin(spare0.plane), std::end(spare0.plane), ctx.spare0);
        std::copy(std::begin(secondary.plane), std::end(secondary.plane), ctx.secondary);
        ctx.rounding = rounding();
        ctx.round_each = m_machine.lerp_rounding == LerpRounding::each ? 1 : 0;
        ctx.complement_spare0 = f.complement_spare0 ? 1 : 0;
        ctx.complement_secondary = f.complement_secondary ? 1 : 0;
        ctx.clamp_color_sum = f.clamp_color_sum ? 1 : 0;
        ctx.uses_color_sum = m_uses_sum ? 1 : 0;
        ctx.uses_final_product = m_uses_product ? 1 : 0;
        for (std::int16_t& plane : ctx.out) plane = static_cast<std::int16_t>(take_plane());
        std::copy(std::begin(ctx.out), std::end(ctx.out), m_bound.result.begin());
    }

    void emit_registers(const Components& values) {
        m_bound.has_final = false;
        for (std::size_t c = 0; c < 4; ++c) {
            const int plane = m_plane[static_cast<std::size_t>(values[c])];
            m_bound.result[c] = static_cast<std::int16_t>(plane);
        }
    }

    const CombinerProgram& m_program;
    const Machine& m_machine;
    NumberModel m_numbers;
    std::uint32_t m_textured;
    int m_step = 0;  ///< fetches and stages so far
    int m_one = 0;
    std::array<Components, kRegisterCount> m_registers;
    int m_value_count = 0;
    std::map<int, Value> m_constants;  // by code
    std::set<Value> m_beyond_one;      // what may lie outside of [-1, 1],
    std::set<Value> m_positive;        // and inputs that lie within [0, 1]
    std::vector<std::pair<Register, Components>> m_inputs;
    std::vector<Operation> m_operations;
    std::array<OperandValues, 7> m_final;  // A .. G
    std::array<OperandValues, 2> m_sum;    // spare0, col1
    bool m_uses_sum = false, m_uses_product = false, m_everything = false;
    std::array<Portion, 2> m_coding;
    std::optional<Components> m_shown;     ///< values of a register that is the result
    std::vector<int> m_plane, m_last_use;  // by value
    std::vector<int> m_free, m_unread;
    int m_trash = 0;
    BoundProgram m_bound;
};

}  // namespace

bool BoundProgram::reads(Register r) const {
    const auto& planes = input[static_cast<std::size_t>(r)];
    return std::any_of(planes.begin(), planes.end(), [](int plane) { return plane >= 0; });
}

BoundProgram bind(const CombinerProgram& program, const Machine& machine, const UnitStates& units,
                  const Wanted& wanted) {
    program.validate(machine);
    return Binder(program, machine, units).bind(wanted);
}

void load_constants(const BoundProgram& program, Packet& packet) {
    std::int16_t* plane = packet.planes;
    for (const std::int16_t code : program.constants) {
        std::fill_n(plane, kPacketSize, code);
        plane += kPacketSize;
    }
}

void run_portions(const BoundProgram& program, const KernelTable& kernels, Packet& packet,
                  std::size_t first, std::size_t last) {
    const bool nine_bit = program.numbers == NumberModel::nine_bit;
    const auto portion = nine_bit ? kernels.portion_nine_bit : kernels.portion_wide;
    for (std::size_t i = first; i < last; ++i) portion(packet, program.portions[i]);
}

void run_final(const BoundProgram& program, const KernelTable& kernels, Packet& packet) {
    if (!program.has_final) return;
    const bool nine_bit = program.numbers == NumberModel::nine_bit;
    (nine_bit ? kernels.final_nine_bit : kernels.final_wide)(packet, program.final_combiner);
}

void run(const BoundProgram& program, const KernelTable& kernels, Packet& packet) {
    run_portions(program, kernels, packet, 0, program.portions.size());
    run_final(program, kernels, packet);
}

}  // namespace burnish
