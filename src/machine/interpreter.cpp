#include "machine/interpreter.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include "machine/fetches.hpp"

namespace burnish {

namespace {

/// Where the two number models differ.
struct Numbers {
    int one, half;
    int low, high;  ///< range of a register
    bool wide;
};

constexpr Numbers kNineBit{255, 128, -256, 255, false};
constexpr Numbers kWide{16384, 8192, -32768, 32767, true};

const Numbers& numbers_of(NumberModel model) {
    return model == NumberModel::wide ? kWide : kNineBit;
}

/// floor(x / y + 1/2) for y > 0.
int round_quotient(std::int64_t x, int y) {
    const std::int64_t twice = 2 * x + y;
    const std::int64_t quotient = twice / (2 * y);
    return static_cast<int>(twice % (2 * y) < 0 ? quotient - 1 : quotient);
}

/// Value of a register component as an operand. Nine-bit operands reach -256 .. 256.
int map(Mapping mapping, int e, const Numbers& n) {
    const int positive = std::max(e, 0);
    int x = e;
    switch (mapping) {
        case Mapping::unsigned_identity:
            x = positive;
            break;
        case Mapping::unsigned_invert:
            x = n.one - std::min(positive, n.one);
            break;
        case Mapping::expand:
            x = 2 * (positive - n.half);
            break;
        case Mapping::expand_negate:
            x = 2 * (n.half - positive);
            break;
        case Mapping::half_bias:
            x = positive - n.half;
            break;
        case Mapping::half_bias_negate:
            x = n.half - positive;
            break;
        case Mapping::signed_identity:
            break;
        case Mapping::signed_negate:
            x = -e;
            break;
    }
    return n.wide ? std::clamp(x, n.low, n.high) : x;
}

/// The four components that an input reads, mapped. `blue` and `alpha` fill all of them.
Codes read(const RegisterFile& registers, const Input& input, const Numbers& n) {
    const Codes& source = registers[input.reg];
    Codes result;
    for (std::size_t c = 0; c < 4; ++c) {
        const std::size_t from = input.component == Component::alpha  ? 3
                                 : input.component == Component::blue ? 2
                                                                      : c;
        result[c] = map(input.mapping, source[from], n);
    }
    return result;
}

Codes multiply(const Codes& x, const Codes& y, const Numbers& n) {
    Codes result;
    for (std::size_t c = 0; c < 4; ++c) result[c] = round_quotient(x[c] * y[c], n.one);
    return result;
}

/// Only r, g, b of a dot product mean anything.
Codes product(Product kind, const Codes& x, const Codes& y, const Numbers& n) {
    const Codes terms = multiply(x, y, n);
    if (kind == Product::multiply) return terms;
    const int sum = terms[0] + terms[1] + terms[2];
    return {sum, sum, sum, sum};
}

/// Bias before scale, both before the clamp.
int output(const Portion& portion, int x, const Numbers& n) {
    if (portion.bias_minus_half) x -= n.half;
    switch (portion.scale) {
        case Scale::one:
            break;
        case Scale::two:
            x *= 2;
            break;
        case Scale::four:
            x *= 4;
            break;
        case Scale::half:
            x = round_quotient(x, 2);
            break;
    }
    if (n.wide && portion.wide) return std::clamp(x, n.low, n.high);
    return std::clamp(x, -n.one, n.one);
}

/// Writes components first .. last of the three outputs to `after`.
void run_portion(const Portion& portion, const RegisterFile& before, RegisterFile& after,
                 std::size_t first, std::size_t last, const Numbers& n) {
    const auto in = [&](const Input& input) { return read(before, input, n); };
    const Codes ab = product(portion.ab_product, in(portion.a), in(portion.b), n);
    const Codes cd = product(portion.cd_product, in(portion.c), in(portion.d), n);
    const bool mux_takes_cd = before[Register::spare0][3] >= n.half;
    for (std::size_t c = first; c <= last; ++c) {
        const int sum = ab[c] + cd[c];
        const int mux = mux_takes_cd ? cd[c] : ab[c];
        const auto write = [&](Register out, int x) {
            if (out != Register::discard) after[out][c] = output(portion, x, n);
        };
        write(portion.ab_out, ab[c]);
        write(portion.cd_out, cd[c]);
        write(portion.third_out, portion.third == Third::sum ? sum : mux);
    }
}

Codes color_codes(const glm::vec4& color, NumberModel model) {
    return {color_code(color.r, model), color_code(color.g, model), color_code(color.b, model),
            color_code(color.a, model)};
}

RegisterFile initial_registers(const CombinerProgram& program, NumberModel model,
                               const RegisterFile& inputs) {
    RegisterFile registers = inputs;
    registers[Register::zero] = {};
    registers[Register::const0] = color_codes(program.const0, model);
    registers[Register::const1] = color_codes(program.const1, model);
    registers[Register::fog] = color_codes(program.fog, model);
    registers[Register::spare0] = {0, 0, 0, inputs[Register::tex0][3]};
    registers[Register::spare1] = {};
    registers[Register::color_sum] = {};
    registers[Register::final_product] = {};
    registers[Register::discard] = {};
    return registers;
}

/// Inputs of the final combiner stop at 1; only the colour sum may pass it.
Codes read_final(const RegisterFile& registers, const Input& input, const Numbers& n) {
    Codes result = read(registers, input, n);
    if (input.reg == Register::color_sum) return result;
    for (int& x : result) x = std::min(x, n.one);
    return result;
}

Codes color_sum(const FinalCombiner& final, const RegisterFile& registers, const Numbers& n) {
    Codes sum{};
    for (std::size_t c = 0; c < 3; ++c) {
        const int spare0 = std::clamp(registers[Register::spare0][c], 0, n.one);
        const int secondary = std::clamp(registers[Register::col1][c], 0, n.one);
        sum[c] = spare0 + secondary;
        if (n.wide) sum[c] = std::min(sum[c], n.high);
        if (final.clamp_color_sum) sum[c] = std::min(sum[c], n.one);
    }
    return sum;
}

/// Sets color_sum and final_product in `registers`.
Codes run_final(const FinalCombiner& final, RegisterFile& registers, const Numbers& n) {
    registers[Register::color_sum] = color_sum(final, registers, n);
    const Codes e = read_final(registers, final.e, n);
    const Codes f = read_final(registers, final.f, n);
    registers[Register::final_product] = multiply(e, f, n);
    registers[Register::final_product][3] = 0;

    const Codes a = read_final(registers, final.a, n);
    const Codes b = read_final(registers, final.b, n);
    const Codes c = read_final(registers, final.c, n);
    const Codes d = read_final(registers, final.d, n);
    Codes result;
    for (std::size_t i = 0; i < 3; ++i) {
        const int blended = round_quotient(a[i] * b[i] + (n.one - a[i]) * c[i], n.one);
        result[i] = std::min(n.one, blended + d[i]);
    }
    result[3] = read_final(registers, final.g, n)[3];
    return result;
}

}  // namespace

int color_code(float x, NumberModel model) {
    const int one = numbers_of(model).one;
    const float code = std::floor(x * static_cast<float>(one) + 0.5F);
    if (!(code > 0.0F)) return 0;
    return code < static_cast<float>(one) ? static_cast<int>(code) : one;
}

Codes run_combiners(const CombinerProgram& program, const Machine& machine,
                    const RegisterFile& inputs, std::vector<RegisterFile>* trace) {
    require_no_fetches(program);
    const Numbers& n = numbers_of(machine.numbers);
    RegisterFile registers = initial_registers(program, machine.numbers, inputs);
    const Codes global0 = registers[Register::const0];
    const Codes global1 = registers[Register::const1];
    const auto constant = [&](const std::optional<glm::vec4>& own, const Codes& global) {
        return own ? color_codes(*own, machine.numbers) : global;
    };
    if (trace != nullptr) trace->push_back(registers);

    for (const GeneralStage& stage : program.stages) {
        registers[Register::const0] = constant(stage.const0, global0);
        registers[Register::const1] = constant(stage.const1, global1);
        const RegisterFile before = registers;
        run_portion(stage.rgb, before, registers, 0, 2, n);
        run_portion(stage.alpha, before, registers, 3, 3, n);
        if (trace != nullptr) trace->push_back(registers);
    }

    registers[Register::const0] = global0;
    registers[Register::const1] = global1;
    const Codes result = run_final(program.final_combiner, registers, n);
    if (trace != nullptr) trace->push_back(registers);
    return result;
}

}  // namespace burnish
