#pragma once

#include <array>
#include <burnish/combiner.hpp>
#include <initializer_list>
#include <vector>

#include "kernel_packet.hpp"

/// Random programs that pass CombinerProgram::validate.
namespace burnish {

/// Few registers, so that values are overwritten, swapped and reused.
inline Register random_source(Random& random, const Machine& machine) {
    constexpr std::array kCommon{Register::zero, Register::const0, Register::const1, Register::col0,
                                 Register::col1, Register::spare0, Register::spare1, Register::fog};
    if (random.chance(3)) return tex(random.below(machine.texture_units));
    return random.pick(kCommon);
}

inline Register random_target(Random& random, const Machine& machine) {
    constexpr std::array kCommon{Register::spare0, Register::spare0, Register::spare1,
                                 Register::col0, Register::col1};
    if (random.chance(2)) return Register::discard;
    if (random.chance(4)) return tex(random.below(machine.texture_units));
    return random.pick(kCommon);
}

inline Input random_input(Random& random, const Machine& machine, bool scalar) {
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

inline Portion random_portion(Random& random, const Machine& machine, bool scalar) {
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

inline glm::vec4 random_constant(Random& random) {
    glm::vec4 v;
    for (int c = 0; c < 4; ++c)
        v[c] = random.chance(4) ? static_cast<float>(random.below(3)) * 0.5F
                                : random.real(-0.1F, 1.1F);
    return v;
}

inline Input random_final_input(Random& random, const Machine& machine, char slot) {
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

/// Switches of the hardware that no text syntax has.
inline void add_switches(Random& random, const Machine& machine, CombinerProgram& p) {
    if (machine.numbers == NumberModel::nine_bit && random.chance(4)) p.mux_bit = MuxBit::lsb;
    p.final_combiner.complement_spare0 = random.chance(4);
    p.final_combiner.complement_secondary = random.chance(4);
    for (GeneralStage& stage : p.stages) {
        const Portion& a = stage.alpha;
        const auto may_get_blue = [&](Register out) {
            return random.chance(4) && out != Register::discard && out != a.ab_out &&
                   out != a.cd_out && out != a.third_out;
        };
        stage.rgb.ab_blue_to_alpha = may_get_blue(stage.rgb.ab_out);
        stage.rgb.cd_blue_to_alpha = may_get_blue(stage.rgb.cd_out);
    }
}

/// Any program that `machine` runs, fog and constants beyond [0, 1] included; no fetches.
inline CombinerProgram random_program(Random& random, const Machine& machine) {
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
    add_switches(random, machine, p);
    p.const0 = random_constant(random);
    p.const1 = random_constant(random);
    p.fog = random_constant(random);
    return p;
}

/// Up to three fetches in front of a stage.
inline std::vector<StageFetch> random_fetches(Random& random, const Machine& machine) {
    std::vector<StageFetch> fetches;
    for (int unit = random.below(machine.texture_units); unit < machine.texture_units; unit += 5) {
        StageFetch& fetch = fetches.emplace_back();
        fetch.destination = tex(unit);
        fetch.target = static_cast<FetchTarget>(random.below(5));
        for (int i = 0; i < coordinate_count(fetch.target); ++i) {
            FetchCoordinate& from = fetch.coordinates[static_cast<std::size_t>(i)];
            from.reg = random_source(random, machine);
            from.component = static_cast<std::uint8_t>(random.below(4));
            if (from.reg == Register::fog) from.component = 1;
            from.expand = random.chance(2);
        }
    }
    return fetches;
}

/// `program` as a text can say it: constants within [0, 1], no fog, zero with the component that
/// its place has by default, at least one stage, no switches.
inline CombinerProgram sayable(CombinerProgram program) {
    const auto plain = [](std::initializer_list<Input*> inputs, Component own) {
        for (Input* input : inputs) {
            if (input->reg == Register::zero) input->component = own;
        }
    };
    const auto clamp = [](glm::vec4& v) { v = glm::clamp(v, 0.0F, 1.0F); };
    if (program.stages.empty()) program.stages.push_back(idle_stage());
    for (GeneralStage& stage : program.stages) {
        Portion& rgb = stage.rgb;
        Portion& alpha = stage.alpha;
        plain({&rgb.a, &rgb.b, &rgb.c, &rgb.d}, Component::rgb);
        plain({&alpha.a, &alpha.b, &alpha.c, &alpha.d}, Component::alpha);
        if (stage.const0) clamp(*stage.const0);
        if (stage.const1) clamp(*stage.const1);
    }
    FinalCombiner& f = program.final_combiner;
    plain({&f.a, &f.b, &f.c, &f.d, &f.e, &f.f}, Component::rgb);
    plain({&f.g}, Component::alpha);
    clamp(program.const0);
    clamp(program.const1);
    program.fog = glm::vec4(0.0F);
    program.mux_bit = MuxBit::msb;
    f.complement_spare0 = f.complement_secondary = false;
    for (GeneralStage& stage : program.stages) {
        stage.rgb.ab_blue_to_alpha = stage.rgb.cd_blue_to_alpha = false;
    }
    return program;
}

}  // namespace burnish
