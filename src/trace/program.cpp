#include "trace/program.hpp"

#include <algorithm>
#include <burnish/program_text.hpp>
#include <string>

namespace burnish {

namespace {

/// Registers that a program names; constants, colours and spares are always of interest.
Registers<bool> named_registers(const CombinerProgram& program) {
    Registers<bool> named;
    const auto name = [&](Register r) { named[r].fill(true); };
    for (const Register r : {Register::const0, Register::const1, Register::col0, Register::col1,
                             Register::spare0, Register::spare1}) {
        name(r);
    }
    for (const GeneralStage& stage : program.stages) {
        for (const StageFetch& fetch : stage.fetches) {
            name(fetch.destination);
            for (int i = 0; i < coordinate_count(fetch.target); ++i)
                name(fetch.coordinates[static_cast<std::size_t>(i)].reg);
        }
        for (const Portion* p : {&stage.rgb, &stage.alpha}) {
            if (!p->writes()) continue;
            for (const Input* in : {&p->a, &p->b, &p->c, &p->d}) name(in->reg);
            for (const Register out : {p->ab_out, p->cd_out, p->third_out}) name(out);
        }
    }
    const FinalCombiner& f = program.final_combiner;
    for (const Input* in : {&f.a, &f.b, &f.c, &f.d, &f.e, &f.f, &f.g}) name(in->reg);
    named[Register::zero] = named[Register::discard] = {};
    named[Register::color_sum] = named[Register::final_product] = {};
    return named;
}

/// What a stage does, with the switches that only the hardware had as comments.
std::string stage_text(const CombinerProgram& program, const GeneralStage& stage) {
    std::string text;
    if (!stage.fetches.empty()) {
        text = "fetch {\n";
        for (const StageFetch& fetch : stage.fetches) text += "    " + print_fetch(fetch) + ";\n";
        text += "}\n";
    }
    text += print_stage(stage);
    if (stage.rgb.ab_blue_to_alpha) text += "// the blue of AB goes to alpha\n";
    if (stage.rgb.cd_blue_to_alpha) text += "// the blue of CD goes to alpha\n";
    const auto muxes = [](const Portion& p) {
        return p.third == Third::mux && p.third_out != Register::discard;
    };
    if (program.mux_bit == MuxBit::lsb && (muxes(stage.rgb) || muxes(stage.alpha))) {
        text += "// the mux tests the least significant bit\n";
    }
    return text;
}

std::string final_text(const FinalCombiner& final) {
    std::string text = print_final(final);
    if (final.complement_spare0) text += "// color_sum takes 1 - spare0\n";
    if (final.complement_secondary) text += "// color_sum takes 1 - col1\n";
    return text;
}

/// Turns what the interpreters noted into rows.
class StageWriter {
  public:
    StageWriter(const CombinerProgram& program, double one, const Registers<bool>& filled)
        : m_one(one), m_named(named_registers(program)), m_filled(filled) {}

    TracedStage stage(std::string name, std::string text, const RegisterFile& codes,
                      const RealRegisters& exact) {
        TracedStage result{std::move(name), std::move(text), {}};
        for (int r = 0; r < static_cast<int>(Register::discard); ++r) {
            const auto reg = static_cast<Register>(r);
            if (m_named[reg][0]) result.registers.push_back(row(reg, codes, exact));
        }
        m_before = codes;
        m_started = true;
        m_written = {};
        return result;
    }

    /// What the next stage writes.
    void write(const GeneralStage& stage) {
        for (const StageFetch& fetch : stage.fetches) {
            m_written[fetch.destination].fill(true);
            m_filled[fetch.destination].fill(true);
        }
        const auto mark = [&](const Portion& portion, std::size_t first, std::size_t last) {
            for (const Register r : {portion.ab_out, portion.cd_out, portion.third_out}) {
                for (std::size_t c = first; c <= last; ++c) {
                    m_written[r][c] = m_filled[r][c] = true;
                }
            }
        };
        mark(stage.rgb, 0, 2);
        mark(stage.alpha, 3, 3);
        const auto mark_alpha = [&](Register r) { m_written[r][3] = m_filled[r][3] = true; };
        if (stage.rgb.ab_blue_to_alpha) mark_alpha(stage.rgb.ab_out);
        if (stage.rgb.cd_blue_to_alpha) mark_alpha(stage.rgb.cd_out);
    }

    /// The final combiner makes the sum and the product; what it reads is marked nowhere.
    void write_final() {
        for (const Register r : {Register::color_sum, Register::final_product}) {
            m_named[r].fill(true);
            m_written[r] = {true, true, true, false};
        }
    }

  private:
    TracedRegister row(Register reg, const RegisterFile& codes, const RealRegisters& exact) const {
        TracedRegister result{reg, codes[reg], {}, m_filled[reg], m_written[reg]};
        const bool constant = reg == Register::const0 || reg == Register::const1;
        for (std::size_t c = 0; c < 4; ++c) {
            result.color[c] = {codes[reg][c] / m_one, exact[reg][c]};
            if (constant && m_started) result.changed[c] = codes[reg][c] != m_before[reg][c];
        }
        return result;
    }

    double m_one;
    Registers<bool> m_named, m_filled, m_written;
    RegisterFile m_before;
    bool m_started = false;
};

}  // namespace

void trace_program(const ProgramMaterial& program, const Machine& machine,
                   const FragmentInputs& inputs, TracedFragment& out) {
    const CombinerProgram& combiners = program.combiners;
    std::vector<RegisterFile> codes;
    std::vector<RealRegisters> exact;
    out.codes = run_combiners(combiners, machine, inputs.codes, &codes, inputs.fetch);
    const Reals color =
        run_combiners_exactly(combiners, machine, inputs.exact, &exact, inputs.fetch_exactly);
    const double one = code_of_one(machine.numbers);
    for (std::size_t c = 0; c < 4; ++c) out.color[c] = {out.codes[c] / one, color[c]};

    StageWriter writer(combiners, one, inputs.filled);
    out.stages.push_back(writer.stage("inputs", "", codes.front(), exact.front()));
    for (std::size_t s = 0; s < combiners.stages.size(); ++s) {
        const GeneralStage& stage = combiners.stages[s];
        writer.write(stage);
        out.stages.push_back(writer.stage("stage " + std::to_string(s),
                                          stage_text(combiners, stage), codes[s + 1],
                                          exact[s + 1]));
    }
    writer.write_final();
    out.stages.push_back(
        writer.stage("final", final_text(combiners.final_combiner), codes.back(), exact.back()));
}

}  // namespace burnish
