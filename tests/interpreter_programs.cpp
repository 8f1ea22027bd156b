#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <sstream>
#include <vector>

#include "kernel_test.hpp"
#include "machine/bind.hpp"
#include "machine/interpreter.hpp"
#include "random_program.hpp"
#include "shade/shading.hpp"
#include "unit_oracle.hpp"
#include "unit_scene.hpp"

/// Random programs, bound to the kernels of each table, against the interpreter.
namespace burnish {
namespace {

INSTANTIATE_TEST_SUITE_P(Isa, KernelTest, every_table(), isa_name);

/// Colours and texels within [-1, 1], or any register's, and some texels within [0, 1].
void bound_inputs(Random& random, UnitStates& states) {
    states.bounded_colors = random.chance(2);
    states.bounded = states.bounded_colors ? ~0U : 0U;
    states.positive = static_cast<std::uint32_t>(random.below(1 << 16));
}

/// Inputs of every fragment: extremes of the range and anything between; what a disabled unit
/// delivers where that is its state.
std::vector<RegisterFile> random_inputs(Random& random, const Machine& machine, int count,
                                        const UnitStates& states) {
    const bool wide = machine.numbers == NumberModel::wide;
    const int one = wide ? 16384 : 255;
    const int low = states.bounded_colors ? -one : wide ? -32768 : -256;
    const int high = states.bounded_colors || !wide ? one : 32767;
    const std::array extremes{low,     low + 1,     -one,    -1,  0,   1,
                              one / 2, one / 2 + 1, one - 1, one, high};
    std::vector<RegisterFile> files(static_cast<std::size_t>(count));
    for (RegisterFile& file : files) {
        for (int r = 0; r < 2 + machine.texture_units; ++r) {
            const Register reg = r == 0 ? Register::col0 : r == 1 ? Register::col1 : tex(r - 2);
            for (int& code : file[reg])
                code = random.chance(3) ? random.pick(extremes) : random.between(low, high);
            if (r >= 2 && (states.positive >> (r - 2) & 1) != 0)
                for (int& code : file[reg]) code = std::clamp(code, 0, one);
            if (r >= 2 && (states.enabled >> (r - 2) & 1) == 0) file[reg] = {0, 0, 0, one};
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
    Codes result(const BoundProgram& bound, int i) {
        return {plane(bound.result[0])[i], plane(bound.result[1])[i], plane(bound.result[2])[i],
                plane(bound.result[3])[i]};
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

/// The program's final combiner with D and G alone: texels, constants, and now and then 1 - one.
void copy_registers(Random& random, const Machine& machine, CombinerProgram& program) {
    const auto copied = [&](Component component) {
        const Register texel = tex(random.below(machine.texture_units));
        return Input{random.chance(3) ? Register::const0 : texel,
                     random.chance(4) ? Mapping::unsigned_invert : Mapping::unsigned_identity,
                     component};
    };
    FinalCombiner& f = program.final_combiner;
    f.b = f.c = {Register::zero, Mapping::unsigned_identity, Component::rgb};
    f.d = copied(random.chance(3) ? Component::alpha : Component::rgb);
    f.g = copied(Component::alpha);
}

void check_programs(const KernelTable& table, const Machine& profile, unsigned usual) {
    const unsigned programs = program_count(usual);
    for (unsigned seed = 0; seed < programs; ++seed) {
        Random random(seed);
        const Machine machine = with_choices(random, profile);
        CombinerProgram program = random_program(random, machine);
        if (seed % 8 == 0) copy_registers(random, machine, program);
        const auto enabled = static_cast<std::uint32_t>(random.below(1 << machine.texture_units)) |
                             static_cast<std::uint32_t>(random.below(1 << machine.texture_units));
        UnitStates states{.enabled = enabled};
        bound_inputs(random, states);
        const BoundProgram bound = bind(program, machine, states);
        const int count = random.between(1, 40);
        const std::vector<RegisterFile> inputs = random_inputs(random, machine, count, states);
        ProgramPacket memory(bound, inputs);
        run(bound, table, memory.packet);
        for (int i = 0; i < count; ++i) {
            const Codes want = run_combiners(program, machine, inputs[static_cast<std::size_t>(i)]);
            const Codes got = memory.result(bound, i);
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

// rgb of the first stage is read as blue alone: one product instead of three, of the blue planes.
TEST(BoundProgram, ComputesTheComponentThatIsRead) {
    GeneralStage first, second;
    first.rgb.a = combine::in(Register::col0);
    first.rgb.b = combine::in(Register::col1);
    first.rgb.ab_out = Register::spare0;
    second.alpha.a = second.alpha.b = {Register::spare0, Mapping::signed_identity, Component::blue};
    second.alpha.ab_out = Register::spare1;
    CombinerProgram program;
    program.stages = {first, second};
    program.final_combiner.d = combine::alpha(combine::raw(Register::spare1));
    const auto bound_as = [&](bool everything) {
        return bind(program, machine_profile("ideal"), {}, {.everything = everything});
    };
    const BoundProgram bound = bound_as(false);
    EXPECT_EQ(bound.portions.at(0).components, 1);
    EXPECT_EQ(bound.portions.at(0).a.plane[0],
              bound.input[static_cast<std::size_t>(Register::col0)][2]);
    EXPECT_EQ(bound_as(true).portions.at(0).components, 3);
}

// --- fetches between stages

/// A small texture of any target and format, or none, by chance.
TexturePtr random_texture(Random& random) {
    constexpr std::array kFormats{TexelFormat::rgba8,      TexelFormat::signed_rgba8,
                                  TexelFormat::luminance8, TexelFormat::hilo16,
                                  TexelFormat::dsdt8,      TexelFormat::dsdt8_mag8_intensity8};
    if (random.chance(5)) return nullptr;
    return random_unit_texture(random, static_cast<TextureTarget>(random.below(5)),
                               random.pick(kFormats));
}

/// What a fetch brings, by the rules of docs/numbers.md.
Codes nearest_fetch(const Texture& texture, const std::array<float, 3>& at, NumberModel numbers) {
    const std::array<int, 4> texel = nearest_numbers(texture, at);
    const TexelClass kind = format_class(texture.format());
    Codes codes{};
    for (std::size_t c = 0; c < 4; ++c) {
        const bool intensity = kind == TexelClass::dsdt_mag_intensity && c == 3;
        if (kind > TexelClass::mixed && !intensity) continue;
        codes[c] = code_of_number(texel[c], texture.is_signed(static_cast<int>(c)), numbers);
    }
    return codes;
}

/// Every second stage fetches; coordinates are any registers.
void add_fetches(Random& random, const Machine& machine, const std::vector<TexturePtr>& textures,
                 CombinerProgram& program) {
    for (GeneralStage& stage : program.stages) {
        if (random.chance(2)) continue;
        stage.fetches = random_fetches(random, machine);
        for (StageFetch& fetch : stage.fetches) {
            const auto unit = static_cast<std::size_t>(fetch.destination) -
                              static_cast<std::size_t>(Register::tex0);
            if (textures[unit]) fetch.target = table_for(textures[unit]->target());
        }
    }
}

/// A program with fetches as the renderer runs it.
struct FetchingProgram {
    Shading shading;

    FetchingProgram(const CombinerProgram& program, const Machine& machine,
                    const UnitStates& states, const std::vector<TexturePtr>& textures) {
        shading.program = bind(program, machine, states);
        int planes = shading.program.plane_count;
        for (const BoundFetch& fetch : shading.program.fetches) {
            SamplePlan sampling{machine.numbers, 0, shading.program.plane_count};
            FreePlanes free{kSampleAttributes, shading.program.plane_count + kSamplePlanes};
            const Texture& texture = *textures[static_cast<std::size_t>(fetch.unit)];
            shading.stage_fetches.push_back(
                {fetch.before, plan_stage_fetch(fetch, texture, sampling, free)});
            planes = std::max(planes, free.reg);
        }
        shading.program.plane_count = planes;
    }
};

void check_fetches(const KernelTable& table, const Machine& machine, unsigned usual) {
    const unsigned programs = program_count(usual);
    AlignedVector<float> attributes(std::size_t{kMaxAttributes} * kAttributeStride);
    AlignedVector<std::int32_t> texel(kPacketSize);
    AlignedVector<std::int16_t> weights(2 * kPacketSize);
    for (unsigned seed = 0; seed < programs; ++seed) {
        Random random(seed);
        CombinerProgram program = random_program(random, machine);
        UnitStates states;
        std::vector<TexturePtr> textures;
        for (int unit = 0; unit < machine.texture_units; ++unit) {
            textures.push_back(random_texture(random));
            if (textures.back()) states.textured |= 1U << unit;
        }
        add_fetches(random, machine, textures, program);
        states.enabled = states.textured & static_cast<std::uint32_t>(random.below(1 << 16));
        bound_inputs(random, states);
        const int count = random.between(1, 40);
        const std::vector<RegisterFile> inputs = random_inputs(random, machine, count, states);
        const FetchingProgram bound(program, machine, states, textures);
        ProgramPacket memory(bound.shading.program, inputs);
        memory.packet.attributes = attributes.data();
        memory.packet.texel = texel.data();
        memory.packet.weight_x = weights.data();
        memory.packet.weight_y = weights.data() + kPacketSize;
        run_program(bound.shading, table, {}, memory.packet);
        const auto fetch = [&](const StageFetch& f, const std::array<float, 3>& at) {
            const auto unit =
                static_cast<std::size_t>(f.destination) - static_cast<std::size_t>(Register::tex0);
            if (!textures[unit]) return Codes{0, 0, 0, code_of_one(machine.numbers)};
            return nearest_fetch(*textures[unit], at, machine.numbers);
        };
        for (int i = 0; i < count; ++i) {
            const Codes want = run_combiners(program, machine, inputs[static_cast<std::size_t>(i)],
                                             nullptr, fetch);
            const Codes got = memory.result(bound.shading.program, i);
            ASSERT_EQ(got, want) << table.isa << ", " << machine.name << ", seed " << seed
                                 << ", fragment " << i << ": got " << text(got) << ", want "
                                 << text(want);
        }
    }
}

TEST_P(KernelTest, FetchesBetweenStagesEqualTheInterpreter) {
    check_fetches(table(), machine_profile("ideal"), 1500);
    Machine nine_bit = machine_profile("nv2a");
    nine_bit.stage_fetches = true;
    check_fetches(table(), nine_bit, 500);
}

}  // namespace
}  // namespace burnish
