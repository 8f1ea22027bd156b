#include "machine/interpreter.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include "machine/fetches.hpp"

namespace burnish {

namespace {

/// floor(x / y) for y > 0.
int floor_quotient(std::int64_t x, int y) {
    return static_cast<int>(x % y < 0 ? x / y - 1 : x / y);
}
/// floor(x / y + 1/2) for y > 0.
int round_quotient(std::int64_t x, int y) {
    return floor_quotient(2 * x + y, 2 * y);
}

/// Register codes of the two number models.
struct CodeNumbers {
    using Value = int;
    using Coordinate = float;
    int one, half;
    int low, high;  ///< range of a register
    bool wide;
    ProductRounding product_rounding = ProductRounding::nearest;
    ExpandRule expand_rule = ExpandRule::hardware;
    Halving halving = Halving::half_up;
    LerpRounding lerp_rounding = LerpRounding::once;

    /// A product of two codes, or a sum of such products, as a code.
    [[nodiscard]] int from_product(int x) const {
        switch (product_rounding) {
            case ProductRounding::nearest:
                break;
            case ProductRounding::truncate:
                return x / one;
            case ProductRounding::shift8:
                return floor_quotient(x, 256);
        }
        return round_quotient(x, one);
    }
    [[nodiscard]] int halved(int x) const {
        return halving == Halving::down ? floor_quotient(x, 2) : round_quotient(x, 2);
    }
    /// 2 (x - 1/2) and x - 1/2 for x >= 0.
    [[nodiscard]] int expanded(int x) const {
        return expand_rule == ExpandRule::ideal ? 2 * x - one : 2 * (x - half);
    }
    [[nodiscard]] int half_biased(int x) const {
        const int below = x - half;
        if (expand_rule == ExpandRule::hardware || below % 2 == 0) return below;
        return below + 1;  // of the two neighbours of x - 127.5, the even one
    }
    [[nodiscard]] int blend(int ab, int rest) const {
        if (lerp_rounding == LerpRounding::each) return from_product(ab) + from_product(rest);
        return from_product(ab + rest);
    }
    [[nodiscard]] static bool is_odd(int x) { return x % 2 != 0; }
    /// The number of a code, or twice what of it is positive minus 1.
    [[nodiscard]] float coordinate(int e, bool expand) const {
        const float middle = static_cast<float>(one) * 0.5F;
        if (expand) return (static_cast<float>(std::max(e, 0)) - middle) / middle;
        return static_cast<float>(e) / static_cast<float>(one);
    }
    [[nodiscard]] int constant(float x) const {
        return color_code(x, wide ? NumberModel::wide : NumberModel::nine_bit);
    }
    [[nodiscard]] static int from_output(int x) { return x; }
    [[nodiscard]] const CodeNumbers& of_stage(std::size_t /*stage*/) const { return *this; }
    [[nodiscard]] const CodeNumbers& of_final() const { return *this; }
};

/// The real numbers that the codes stand for, rounded to any number of bits or not at all.
struct RealNumbers {
    using Value = double;
    using Coordinate = double;
    double one, half;
    double low, high;
    bool wide;
    CombinerRounding rounding = {};
    bool half_is_rounded = false;  ///< up to a code, as the hardware does
    int bits = kExactBits;         ///< of the stage at work, with a sign

    [[nodiscard]] double from_product(double x) const {
        return rounding.quantiser == nullptr ? x : rounding.quantiser->product(x, bits);
    }
    [[nodiscard]] static double halved(double x) { return 0.5 * x; }
    [[nodiscard]] double expanded(double x) const { return 2.0 * (x - half); }
    [[nodiscard]] double half_biased(double x) const { return x - half; }
    [[nodiscard]] double blend(double ab, double rest) const { return from_product(ab + rest); }
    /// After bias and scale, which may leave halves.
    [[nodiscard]] double from_output(double x) const {
        return rounding.quantiser == nullptr ? x : rounding.quantiser->signed_number(x, bits);
    }
    [[nodiscard]] RealNumbers of_stage(std::size_t stage) const {
        RealNumbers n = *this;
        if (stage < rounding.stages.size()) n.bits = rounding.stages[stage];
        if (half_is_rounded && n.bits != kExactBits)
            n.half = std::ldexp(1.0, n.bits - 2) / (std::ldexp(1.0, n.bits - 1) - 1.0);
        return n;
    }
    [[nodiscard]] RealNumbers of_final() const {
        RealNumbers n = *this;
        if (rounding.final_bits != kExactBits) n.bits = rounding.final_bits + 1;
        return n;
    }
    /// The nearest nine-bit code is.
    [[nodiscard]] static bool is_odd(double x) {
        return std::fmod(std::floor(x * 255.0 + 0.5), 2.0) != 0.0;
    }
    [[nodiscard]] static double coordinate(double e, bool expand) {
        return expand ? 2.0 * std::max(e, 0.0) - 1.0 : e;
    }
    [[nodiscard]] double constant(float x) const {
        return from_output(x > 0.0F ? std::min(static_cast<double>(x), 1.0) : 0.0);
    }
};

constexpr CodeNumbers kNineBit{255, 128, -256, 255, false};
constexpr CodeNumbers kWide{16384, 8192, -32768, 32767, true};
constexpr RealNumbers kNineBitReals{1.0, 0.5, -256.0 / 255.0, 1.0, false};
constexpr RealNumbers kWideReals{1.0, 0.5, -2.0, 32767.0 / 16384.0, true};

template <class N>
using Components = std::array<typename N::Value, 4>;

/// Value of a register component as an operand. Nine-bit operands reach -256 .. 256.
template <class N, class Value = typename N::Value>
Value map(Mapping mapping, Value e, const N& n) {
    const Value positive = std::max(e, Value{0});
    Value x = e;
    switch (mapping) {
        case Mapping::unsigned_identity:
            x = positive;
            break;
        case Mapping::unsigned_invert:
            x = n.one - std::min(positive, n.one);
            break;
        case Mapping::expand:
            x = n.expanded(positive);
            break;
        case Mapping::expand_negate:
            x = -n.expanded(positive);
            break;
        case Mapping::half_bias:
            x = n.half_biased(positive);
            break;
        case Mapping::half_bias_negate:
            x = -n.half_biased(positive);
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
template <class N>
Components<N> read(const Registers<typename N::Value>& registers, const Input& input, const N& n) {
    const Components<N>& source = registers[input.reg];
    Components<N> result;
    for (std::size_t c = 0; c < 4; ++c) {
        const std::size_t from = input.component == Component::alpha  ? 3
                                 : input.component == Component::blue ? 2
                                                                      : c;
        result[c] = map(input.mapping, source[from], n);
    }
    return result;
}

template <class N>
Components<N> multiply(const Components<N>& x, const Components<N>& y, const N& n) {
    Components<N> result;
    for (std::size_t c = 0; c < 4; ++c) result[c] = n.from_product(x[c] * y[c]);
    return result;
}

/// Only r, g, b of a dot product mean anything.
template <class N>
Components<N> product(Product kind, const Components<N>& x, const Components<N>& y, const N& n) {
    const Components<N> terms = multiply(x, y, n);
    if (kind == Product::multiply) return terms;
    const auto sum = terms[0] + terms[1] + terms[2];
    return {sum, sum, sum, sum};
}

/// Bias before scale, both before the clamp.
template <class N, class Value = typename N::Value>
Value output(const Portion& portion, Value x, const N& n) {
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
            x = n.halved(x);
            break;
    }
    x = n.from_output(x);
    if (n.wide && portion.wide) return std::clamp(x, n.low, n.high);
    return std::clamp(x, -n.one, n.one);
}

/// Writes components first .. last of the three outputs to `after`.
template <class N, class Value = typename N::Value>
void run_portion(const Portion& portion, MuxBit mux_bit, const Registers<Value>& before,
                 Registers<Value>& after, std::size_t first, std::size_t last, const N& n) {
    const auto in = [&](const Input& input) { return read(before, input, n); };
    const Components<N> ab = product(portion.ab_product, in(portion.a), in(portion.b), n);
    const Components<N> cd = product(portion.cd_product, in(portion.c), in(portion.d), n);
    const Value selector = before[Register::spare0][3];
    const bool mux_takes_cd = mux_bit == MuxBit::msb ? selector >= n.half : n.is_odd(selector);
    for (std::size_t c = first; c <= last; ++c) {
        const Value sum = ab[c] + cd[c];
        const Value mux = mux_takes_cd ? cd[c] : ab[c];
        const auto write = [&](Register out, Value x) {
            if (out != Register::discard) after[out][c] = output(portion, x, n);
        };
        write(portion.ab_out, ab[c]);
        write(portion.cd_out, cd[c]);
        write(portion.third_out, portion.third == Third::sum ? sum : mux);
    }
    if (portion.ab_blue_to_alpha) after[portion.ab_out][3] = after[portion.ab_out][2];
    if (portion.cd_blue_to_alpha) after[portion.cd_out][3] = after[portion.cd_out][2];
}

template <class N>
Components<N> constants(const glm::vec4& color, const N& n) {
    return {n.constant(color.r), n.constant(color.g), n.constant(color.b), n.constant(color.a)};
}

template <class N, class Value = typename N::Value>
Registers<Value> initial_registers(const CombinerProgram& program, const Registers<Value>& inputs,
                                   const N& n) {
    Registers<Value> registers = inputs;
    registers[Register::zero] = {};
    registers[Register::const0] = constants(program.const0, n);
    registers[Register::const1] = constants(program.const1, n);
    registers[Register::fog] = constants(program.fog, n);
    registers[Register::spare0] = {0, 0, 0, inputs[Register::tex0][3]};
    registers[Register::spare1] = {};
    registers[Register::color_sum] = {};
    registers[Register::final_product] = {};
    registers[Register::discard] = {};
    return registers;
}

/// Inputs of the final combiner stop at 1; only the colour sum may pass it.
template <class N>
Components<N> read_final(const Registers<typename N::Value>& registers, const Input& input,
                         const N& n) {
    Components<N> result = read(registers, input, n);
    if (input.reg == Register::color_sum) return result;
    for (auto& x : result) x = std::min(x, n.one);
    return result;
}

template <class N, class Value = typename N::Value>
Components<N> color_sum(const FinalCombiner& final, const Registers<Value>& registers, const N& n) {
    Components<N> sum{};
    for (std::size_t c = 0; c < 3; ++c) {
        const Value spare0 = std::clamp(registers[Register::spare0][c], Value{0}, n.one);
        const Value secondary = std::clamp(registers[Register::col1][c], Value{0}, n.one);
        sum[c] = (final.complement_spare0 ? n.one - spare0 : spare0) +
                 (final.complement_secondary ? n.one - secondary : secondary);
        if (n.wide) sum[c] = std::min(sum[c], n.high);
        if (final.clamp_color_sum) sum[c] = std::min(sum[c], n.one);
    }
    return sum;
}

/// Sets color_sum and final_product in `registers`.
template <class N>
Components<N> run_final(const FinalCombiner& final, Registers<typename N::Value>& registers,
                        const N& n) {
    registers[Register::color_sum] = color_sum(final, registers, n);
    const Components<N> e = read_final(registers, final.e, n);
    const Components<N> f = read_final(registers, final.f, n);
    registers[Register::final_product] = multiply(e, f, n);
    registers[Register::final_product][3] = 0;

    const Components<N> a = read_final(registers, final.a, n);
    const Components<N> b = read_final(registers, final.b, n);
    const Components<N> c = read_final(registers, final.c, n);
    const Components<N> d = read_final(registers, final.d, n);
    Components<N> result;
    for (std::size_t i = 0; i < 3; ++i) {
        const auto blended = n.blend(a[i] * b[i], (n.one - a[i]) * c[i]);
        result[i] = n.from_output(std::min(n.one, blended + d[i]));
    }
    result[3] = n.from_output(read_final(registers, final.g, n)[3]);
    return result;
}

/// One after the other: each may read what an earlier one brought.
template <class N, class Fetch>
void run_fetches(const GeneralStage& stage, Registers<typename N::Value>& registers,
                 const Fetch& fetch, const N& n) {
    for (const StageFetch& f : stage.fetches) {
        std::array<typename N::Coordinate, 3> at{};
        for (int i = 0; i < coordinate_count(f.target); ++i) {
            const auto index = static_cast<std::size_t>(i);
            const FetchCoordinate& from = f.coordinates[index];
            at[index] = n.coordinate(registers[from.reg][from.component], from.expand);
        }
        registers[f.destination] = fetch(f, at);
    }
}

template <class N, class Fetch, class Value = typename N::Value>
Components<N> run_program(const CombinerProgram& program, const Registers<Value>& inputs,
                          std::vector<Registers<Value>>* trace, const Fetch& fetch, const N& n) {
    Registers<Value> registers = initial_registers(program, inputs, n);
    if (trace != nullptr) trace->push_back(registers);

    for (std::size_t s = 0; s < program.stages.size(); ++s) {
        const GeneralStage& stage = program.stages[s];
        const N& own = n.of_stage(s);
        registers[Register::const0] = constants(stage.const0.value_or(program.const0), own);
        registers[Register::const1] = constants(stage.const1.value_or(program.const1), own);
        run_fetches(stage, registers, fetch, own);
        const Registers<Value> before = registers;
        run_portion(stage.rgb, program.mux_bit, before, registers, 0, 2, own);
        run_portion(stage.alpha, program.mux_bit, before, registers, 3, 3, own);
        if (trace != nullptr) trace->push_back(registers);
    }

    const N& last = n.of_final();
    registers[Register::const0] = constants(program.const0, last);
    registers[Register::const1] = constants(program.const1, last);
    const Components<N> result = run_final(program.final_combiner, registers, last);
    if (trace != nullptr) trace->push_back(registers);
    return result;
}

}  // namespace

int code_of_one(NumberModel numbers) {
    return numbers == NumberModel::wide ? kWide.one : kNineBit.one;
}

int color_code(float x, NumberModel numbers) {
    const int one = code_of_one(numbers);
    const float code = std::floor(x * static_cast<float>(one) + 0.5F);
    if (!(code > 0.0F)) return 0;
    return code < static_cast<float>(one) ? static_cast<int>(code) : one;
}

Codes run_combiners(const CombinerProgram& program, const Machine& machine,
                    const RegisterFile& inputs, std::vector<RegisterFile>* trace,
                    const FetchCodes& fetch) {
    if (!fetch) require_no_fetches(program);
    CodeNumbers numbers = machine.numbers == NumberModel::wide ? kWide : kNineBit;
    numbers.product_rounding = machine.product_rounding;
    numbers.expand_rule = machine.expand;
    numbers.halving = machine.halving;
    numbers.lerp_rounding = machine.lerp_rounding;
    return run_program(program, inputs, trace, fetch, numbers);
}

Reals run_combiners_exactly(const CombinerProgram& program, const Machine& machine,
                            const RealRegisters& inputs, std::vector<RealRegisters>* trace,
                            const FetchReals& fetch, const CombinerRounding& rounding) {
    if (!fetch) require_no_fetches(program);
    RealNumbers numbers = machine.numbers == NumberModel::wide ? kWideReals : kNineBitReals;
    numbers.rounding = rounding;
    numbers.half_is_rounded =
        machine.numbers == NumberModel::nine_bit && machine.expand == ExpandRule::hardware;
    return run_program(program, inputs, trace, fetch, numbers);
}

}  // namespace burnish
