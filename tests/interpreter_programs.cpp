#include <array>
#include <sstream>
#include <vector>

#include "kernel_test.hpp"
#include "machine/bind.hpp"
#include "machine/interpreter.hpp"

/// Random programs, bound to the kernels of each table, against the interpreter.
namespace burnish {
namespace {

INSTANTIATE_TEST_SUITE_P(Isa, KernelTest, every_table(), isa_name);

/// Few registers, so that values are overwritten, swapped and reused.
Register random_source(Random& random, const Machine& machine) {
    constexpr std::array kCommon{Register::zero, Register::const0, Register::const1, Register::col0,
                                 Register::col1, Register::spare0, Register::spare1, Register::fog};
    if (random.chance(3)) return tex(random.below(machine.texture_units));
    return random.pick(kCommon);
}

Register random_target(Random& random, const Machine& machine) {
    constexpr std::array kCommon{Register::spare0, Register::spare0, Register::spare1,
                                 Register::col0, Register::col1};
    if (random.chance(2)) return Register::discard;
    if (random.chance(4)) return tex(random.below(machine.texture_units));
    return random.pick(kCommon);
}

Input random_input(Random& random, const Machine& machine, bool scalar) {
    Input input;
    input.reg = random_source(random, machine);
    input.mapping = static_cast<Mapping>(random.below(kMappingCount));
    const Component own = scalar ? Component::blue : Component::rgb;
    input.component = random.chance(3) ? Component::alpha : own;
    // The alpha of fog is for the final combiner.
    if (input.reg == Register::fog) input.component = own;
    if (scalar && input.component == Component::blue && random.chance(2) &&
        input.reg != Register::fog)
        input.component = Component::alpha;
    return input;
}

Portion random_portion(Random& random, const Machine& machine, bool scalar) {
    Portion p;
    for (Input* input : {&p.a, &p.b, &p.c, &p.d}) *input = random_input(random, machine, scalar);
    if (random.chance(4)) p.b = p.a;
    if (!scalar) {
        p.ab_product = random.chance(3) ? Product::dot : Product::multiply;
        p.cd_product = random.chance(3) ? Product::dot : Product::multiply;
    }
    p.third = random.chance(2) ? Third::mux : Third::sum;
    p.ab_out = random_target(random, machine);
    p.cd_out = random_target(random, machine);
    p.third_out = random_target(random, machine);
    if (p.cd_out == p.ab_out) p.cd_out = Register::discard;
    if (p.third_out == p.ab_out || p.third_out == p.cd_out) p.third_out = Register::discard;
    p.scale = static_cast<Scale>(random.below(4));
    p.bias_minus_half = (p.scale == Scale::one || p.scale == Scale::two) && random.chance(2);
    p.wide = machine.numbers == NumberModel::wide && random.chance(3);
    return p;
}

glm::vec4 random_constant(Random& random) {
    glm::vec4 v;
    for (int c = 0; c < 4; ++c)
        v[c] = random.chance(4) ? static_cast<float>(random.below(3)) * 0.5F
                                : random.real(-0.1F, 1.1F);
    return v;
}

Input random_final_input(Random& random, const Machine& machine, char slot) {
    Input input = random_input(random, machine, slot == 'G');
    input.mapping = random.chance(3) ? Mapping::unsigned_invert : Mapping::unsigned_identity;
    if (input.reg == Register::fog && random.chance(2)) input.component = Component::alpha;
    const bool takes_product = slot >= 'A' && slot <= 'D';
    const bool takes_sum = slot >= 'B' && slot <= 'D';
    if (takes_product && random.chance(5))
        input = {Register::final_product, input.mapping, Component::rgb};
    if (takes_sum && random.chance(5)) input = {Register::color_sum, input.mapping, Component::rgb};
    return input;
}

CombinerProgram random_program(Random& random, const Machine& machine) {
    CombinerProgram p;
    p.stages.resize(static_cast<std::size_t>(random.between(0, machine.general_stages)));
    for (GeneralStage& stage : p.stages) {
        if (!random.chance(5)) stage.rgb = random_portion(random, machine, false);
        if (!random.chance(3)) stage.alpha = random_portion(random, machine, true);
        if (machine.stage_constants && random.chance(4)) stage.const0 = random_constant(random);
        if (machine.stage_constants && random.chance(4)) stage.const1 = random_constant(random);
    }
    FinalCombiner& f = p.final_combiner;
    Input* const inputs[] = {&f.a, &f.b, &f.c, &f.d, &f.e, &f.f, &f.g};
    for (int i = 0; i < 7; ++i)
        *inputs[i] = random_final_input(random, machine, static_cast<char>('A' + i));
    // A program whose result says something about its last stages.
    if (random.chance(2)) f.d = {Register::spare0, Mapping::unsigned_identity, Component::rgb};
    if (random.chance(2)) f.g = {Register::spare0, Mapping::unsigned_identity, Component::alpha};
    f.clamp_color_sum = random.chance(2);
    p.const0 = random_constant(random);
    p.const1 = random_constant(random);
    p.fog = random_constant(random);
    return p;
}

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

void check_programs(const KernelTable& table, Machine machine, unsigned programs) {
    for (unsigned seed = 0; seed < programs; ++seed) {
        Random random(seed);
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
