#include <array>
#include <cstdlib>
#include <sstream>
#include <vector>

#include "kernel_test.hpp"
#include "machine/bind.hpp"
#include "machine/interpreter.hpp"
#include "random_program.hpp"

/// Random programs, bound to the kernels of each table, against the interpreter.
namespace burnish {
namespace {

INSTANTIATE_TEST_SUITE_P(Isa, KernelTest, every_table(), isa_name);

/// Inputs of every fragment: extremes of the register's range and anything between; what a
/// disabled unit delivers where `enabled_units` lacks it.
std::vector<RegisterFile> random_inputs(Random& random, const Machine& machine, int count,
                                        std::uint32_t enabled_units) {
    const bool wide = machine.numbers == NumberModel::wide;
    const int low = wide ? -32768 : -256;
    const int high = wide ? 32767 : 255;
    const int one = wide ? 16384 : 255;
    const std::array extremes{low,     low + 1,     -one,    -1,  0,   1,
                              one / 2, one / 2 + 1, one - 1, one, high};
    std::vector<RegisterFile> files(static_cast<std::size_t>(count));
    for (RegisterFile& file : files) {
        for (int r = 0; r < 2 + machine.texture_units; ++r) {
            const Register reg = r == 0 ? Register::col0 : r == 1 ? Register::col1 : tex(r - 2);
            for (int& code : file[reg])
                code = random.chance(3) ? random.pick(extremes) : random.between(low, high);
            if (r >= 2 && (enabled_units >> (r - 2) & 1) == 0) file[reg] = {0, 0, 0, one};
        }
    }
    return files;
}

/// Planes for a bound program, which may need more than the tests of single stages.
struct ProgramPacket {
    AlignedVector<std::int16_t> planes;
    Packet packet{};

    ProgramPacket(const BoundProgram& bound, const std::vector<RegisterFile>& inputs)
        : planes(static_cast<std::size_t>(bound.plane_count) * kPacketSize, -12345) {
        packet.count = static_cast<int>(inputs.size());
        packet.planes = planes.data();
        load_constants(bound, packet);
        for (std::size_t r = 0; r < bound.input.size(); ++r) {
            for (std::size_t c = 0; c < 4; ++c) {
                if (bound.input[r][c] < 0) continue;
                for (std::size_t i = 0; i < inputs.size(); ++i)
                    plane(bound.input[r][c])[i] = static_cast<std::int16_t>(inputs[i].values[r][c]);
            }
        }
    }
    std::int16_t* plane(int k) { return planes.data() + std::ptrdiff_t{k} * kPacketSize; }
    Codes result(const FinalCtx& final, int i) {
        return {plane(final.out[0])[i], plane(final.out[1])[i], plane(final.out[2])[i],
                plane(final.out[3])[i]};
    }
};

std::string text(const Codes& codes) {
    std::ostringstream out;
    out << '(' << codes[0] << ", " << codes[1] << ", " << codes[2] << ", " << codes[3] << ')';
    return out.str();
}

/// The machine with other choices of the nine-bit model, every other time.
Machine with_choices(Random& random, Machine machine) {
    if (machine.numbers != NumberModel::nine_bit || random.chance(2)) return machine;
    machine.product_rounding = static_cast<ProductRounding>(random.below(3));
    machine.expand = random.chance(2) ? ExpandRule::ideal : ExpandRule::hardware;
    machine.halving = random.chance(2) ? Halving::down : Halving::half_up;
    machine.lerp_rounding = random.chance(2) ? LerpRounding::each : LerpRounding::once;
    return machine;
}

/// BURNISH_PROGRAMS asks for more than the usual number.
unsigned program_count(unsigned usual) {
    const char* const asked = std::getenv("BURNISH_PROGRAMS");
    return asked != nullptr ? static_cast<unsigned>(std::atoi(asked)) : usual;
}

void check_programs(const KernelTable& table, const Machine& profile, unsigned usual) {
    const unsigned programs = program_count(usual);
    for (unsigned seed = 0; seed < programs; ++seed) {
        Random random(seed);
        const Machine machine = with_choices(random, profile);
        const CombinerProgram program = random_program(random, machine);
        const auto enabled = static_cast<std::uint32_t>(random.below(1 << machine.texture_units)) |
                             static_cast<std::uint32_t>(random.below(1 << machine.texture_units));
        const BoundProgram bound = bind(program, machine, enabled);
        const int count = random.between(1, 40);
        const std::vector<RegisterFile> inputs = random_inputs(random, machine, count, enabled);
        ProgramPacket memory(bound, inputs);
        run(bound, table, memory.packet);
        for (int i = 0; i < count; ++i) {
            const Codes want = run_combiners(program, machine, inputs[static_cast<std::size_t>(i)]);
            const Codes got = memory.result(bound.final_combiner, i);
            ASSERT_EQ(got, want) << table.isa << ", " << machine.name << ", seed " << seed
                                 << ", fragment " << i << ": got " << text(got) << ", want "
                                 << text(want) << ", " << program.stages.size() << " stages";
        }
    }
}

TEST_P(KernelTest, BoundNineBitProgramsEqualTheInterpreter) {
    check_programs(table(), machine_profile("nv2a"), 2500);
    check_programs(table(), machine_profile("geforce256"), 1000);
}

TEST_P(KernelTest, BoundWideProgramsEqualTheInterpreter) {
    check_programs(table(), machine_profile("ideal"), 2500);
}

}  // namespace
}  // namespace burnish
