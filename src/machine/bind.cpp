#include "machine/bind.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "machine/program_values.hpp"

namespace burnish {

namespace {

/// Gives values their planes, from the operation that writes them to the last one that reads them.
class PlaneAllocator {
  public:
    PlaneAllocator(const CombinerProgram& program, const Machine& machine, ProgramValues values)
        : m_program(program), m_machine(machine), m_values(std::move(values)) {
        for (auto& components : m_bound.input) components.fill(-1);
    }

    BoundProgram bind(bool everything) {
        m_everything = everything;
        m_plane.assign(static_cast<std::size_t>(m_values.count), -1);
        m_last_use.assign(static_cast<std::size_t>(m_values.count), -1);
        for (const Operation& op : m_values.operations) {
            ProgramValues::for_each_read(
                op, [&](Value v) { m_last_use[static_cast<std::size_t>(v)] = op.step; });
        }
        m_values.for_each_final_read(
            [&](Value v) { m_last_use[static_cast<std::size_t>(v)] = m_values.steps; });
        place_constants();
        m_trash = m_bound.plane_count++;
        place_inputs();
        for (std::size_t i = 0; i < m_values.operations.size();) {
            const int step = m_values.operations[i].step;
            const std::size_t first = i;
            for (; i < m_values.operations.size() && m_values.operations[i].step == step; ++i) {
                m_values.operations[i].fetch != nullptr ? emit_fetch(m_values.operations[i])
                                                        : emit(m_values.operations[i]);
            }
            for (std::size_t k = first; k < i; ++k) {
                ProgramValues::for_each_read(m_values.operations[k],
                                             [&](Value v) { release(v, step); });
                for (const Value v : m_values.operations[k].fetched) release_unread(v);
            }
        }
        m_values.shown ? emit_shown() : emit_final();
        m_bound.numbers = m_machine.numbers;
        return std::move(m_bound);
    }

  private:
    void place_constants() {
        for (const auto& [code, value] : m_values.constants) {
            if (m_last_use[static_cast<std::size_t>(value)] < 0) continue;
            m_plane[static_cast<std::size_t>(value)] = m_bound.plane_count++;
            m_bound.constants.push_back(static_cast<std::int16_t>(code));
            m_last_use[static_cast<std::size_t>(value)] = m_values.steps + 1;
        }
    }

    void place_inputs() {
        for (const auto& [reg, values] : m_values.inputs) {
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
        ctx.scale = static_cast<OutputScale>(op.source.scale);
        // The code of a shown register is no work of the machine: it is the same on all of them.
        ctx.rounding = op.coding ? Rounding::nearest : rounding();
        ctx.halve_down = !op.coding && m_machine.halving == Halving::down ? 1 : 0;
        ctx.mux_lsb = m_program.mux_bit == MuxBit::lsb ? 1 : 0;
        ctx.bias_minus_half = op.source.bias_minus_half ? 1 : 0;
        ctx.wide = op.source.wide ? 1 : 0;
        ctx.components = static_cast<std::uint8_t>(op.components);
        ctx.bounded = 1;
        ProgramValues::for_each_read(op, [&](Value v) {
            if (m_values.beyond_one.contains(v)) ctx.bounded = 0;
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

    void emit_final() {
        FinalCtx& ctx = m_bound.final_combiner;
        const FinalCombiner& f = m_program.final_combiner;
        const Input* inputs[6] = {&f.a, &f.b, &f.c, &f.d, &f.e, &f.f};
        Operand* operands[6] = {&ctx.a, &ctx.b, &ctx.c, &ctx.d, &ctx.e, &ctx.f};
        for (std::size_t i = 0; i < 6; ++i) {
            *operands[i] = operand(m_values.final_inputs[i]);
            const bool may_be_zero = i >= 1 && i <= 3;  // B, C, D
            if (may_be_zero && m_values.is_zero(m_values.final_inputs[i]))
                operands[i]->plane[0] = FinalCtx::kZero;
            if (inputs[i]->reg == Register::color_sum) operands[i]->plane[0] = FinalCtx::kColorSum;
            if (inputs[i]->reg == Register::final_product) {
                operands[i]->plane[0] = FinalCtx::kFinalProduct;
            }
        }
        ctx.g = operand(m_values.final_inputs[6]);
        const Operand spare0 = operand(m_values.color_sum[0]),
                      secondary = operand(m_values.color_sum[1]);
        std::copy(std::begin(spare0.plane), std::end(spare0.plane), ctx.spare0);
        std::copy(std::begin(secondary.plane), std::end(secondary.plane), ctx.secondary);
        ctx.rounding = rounding();
        ctx.round_each = m_machine.lerp_rounding == LerpRounding::each ? 1 : 0;
        ctx.complement_spare0 = f.complement_spare0 ? 1 : 0;
        ctx.complement_secondary = f.complement_secondary ? 1 : 0;
        ctx.clamp_color_sum = f.clamp_color_sum ? 1 : 0;
        ctx.uses_color_sum = m_values.uses_color_sum ? 1 : 0;
        ctx.uses_final_product = m_values.uses_final_product ? 1 : 0;
        for (std::int16_t& plane : ctx.out) plane = static_cast<std::int16_t>(take_plane());
        std::copy(std::begin(ctx.out), std::end(ctx.out), m_bound.result.begin());
    }

    void emit_shown() {
        m_bound.has_final = false;
        for (std::size_t c = 0; c < 4; ++c) {
            const int plane = m_plane[static_cast<std::size_t>((*m_values.shown)[c])];
            m_bound.result[c] = static_cast<std::int16_t>(plane);
        }
    }

    const CombinerProgram& m_program;
    const Machine& m_machine;
    ProgramValues m_values;
    bool m_everything = false;             ///< what nothing reads has a plane, too
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
    return PlaneAllocator(program, machine, values_of(program, machine, units, wanted))
        .bind(wanted.everything);
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
