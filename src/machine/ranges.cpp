#include "machine/ranges.hpp"

#include <algorithm>

#include "machine/interpreter.hpp"

namespace burnish {

namespace {

constexpr int kOne = 255, kHalf = 128;

CodeRange hull(CodeRange a, CodeRange b) {
    return {std::min(a.low, b.low), std::max(a.high, b.high)};
}

CodeRange sum(CodeRange a, CodeRange b) {
    return {a.low + b.low, a.high + b.high};
}

CodeRange negated(CodeRange x) {
    return {-x.high, -x.low};
}

/// A function that never falls, on both ends.
template <class Rising>
CodeRange image(CodeRange x, Rising&& f) {
    return {f(x.low), f(x.high)};
}

class StageRanges {
  public:
    explicit StageRanges(const Machine& machine) : m_machine(machine) {}

    void run(const GeneralStage& stage, const RegisterRanges& before, RegisterRanges& after) const {
        run(stage.rgb, false, before, after);
        run(stage.alpha, true, before, after);
    }

  private:
    [[nodiscard]] CodeRange operand(const Input& input, const RegisterRanges& registers) const {
        const bool ideal = m_machine.expand == ExpandRule::ideal;
        const CodeRange e = registers[part_of(input)];
        const CodeRange positive{std::max(e.low, 0), std::max(e.high, 0)};
        const auto expanded =
            image(positive, [&](int x) { return ideal ? 2 * x - kOne : 2 * (x - kHalf); });
        // x - 127.5 rounds to x - 127 or x - 128.
        const CodeRange biased{positive.low - kHalf, positive.high - kHalf + (ideal ? 1 : 0)};
        switch (input.mapping) {
            case Mapping::unsigned_identity:
                return positive;
            case Mapping::unsigned_invert:
                return negated(image(positive, [](int x) { return std::min(x, kOne) - kOne; }));
            case Mapping::expand:
                return expanded;
            case Mapping::expand_negate:
                return negated(expanded);
            case Mapping::half_bias:
                return biased;
            case Mapping::half_bias_negate:
                return negated(biased);
            case Mapping::signed_identity:
                break;
            case Mapping::signed_negate:
                return negated(e);
        }
        return e;
    }

    [[nodiscard]] int quotient(int p) const {
        switch (m_machine.product_rounding) {
            case ProductRounding::nearest:
                break;
            case ProductRounding::truncate:
                return p / kOne;
            case ProductRounding::shift8:
                return p >> 8;
        }
        return p < 0 ? -((-2 * p + kOne) / (2 * kOne)) : (2 * p + kOne) / (2 * kOne);
    }

    /// Of one product, rounded.
    [[nodiscard]] CodeRange product(const Input& a, const Input& b,
                                    const RegisterRanges& registers) const {
        const CodeRange x = operand(a, registers), y = operand(b, registers);
        const auto [low, high] =
            std::minmax({x.low * y.low, x.low * y.high, x.high * y.low, x.high * y.high});
        CodeRange range = image(CodeRange{low, high}, [&](int p) { return quotient(p); });
        if (a == b) range.low = std::max(range.low, 0);
        return range;
    }

    [[nodiscard]] CodeRange output(CodeRange x, const Portion& p) const {
        return image(x, [&](int v) {
            v += p.bias_minus_half ? -kHalf : 0;
            switch (p.scale) {
                case Scale::one:
                    break;
                case Scale::two:
                    v *= 2;
                    break;
                case Scale::four:
                    v *= 4;
                    break;
                case Scale::half:
                    v = (v + (m_machine.halving == Halving::half_up ? 1 : 0)) >> 1;
                    break;
            }
            return std::clamp(v, -kOne, kOne);
        });
    }

    void run(const Portion& p, bool alpha, const RegisterRanges& before,
             RegisterRanges& after) const {
        const auto times_three = [](CodeRange x) { return CodeRange{3 * x.low, 3 * x.high}; };
        CodeRange ab = product(p.a, p.b, before), cd = product(p.c, p.d, before);
        if (p.ab_product == Product::dot) ab = times_three(ab);
        if (p.cd_product == Product::dot) cd = times_three(cd);
        const CodeRange third = p.third == Third::sum ? sum(ab, cd) : hull(ab, cd);
        const auto write = [&](Register out, CodeRange value, bool blue_to_alpha) {
            if (out == Register::discard) return;
            after[{out, alpha}] = output(value, p);
            if (blue_to_alpha) after[{out, true}] = output(value, p);
        };
        write(p.ab_out, ab, p.ab_blue_to_alpha);
        write(p.cd_out, cd, p.cd_blue_to_alpha);
        write(p.third_out, third, false);
    }

    const Machine& m_machine;
};

CodeRange of_constant(const glm::vec4& value, bool alpha) {
    if (alpha) {
        const int code = color_code(value.a, NumberModel::nine_bit);
        return {code, code};
    }
    const auto [low, high] = std::minmax({color_code(value.r, NumberModel::nine_bit),
                                          color_code(value.g, NumberModel::nine_bit),
                                          color_code(value.b, NumberModel::nine_bit)});
    return {low, high};
}

void set_constants(const CombinerProgram& program, const GeneralStage* stage,
                   RegisterRanges& ranges) {
    const auto& own0 = stage != nullptr && stage->const0 ? *stage->const0 : program.const0;
    const auto& own1 = stage != nullptr && stage->const1 ? *stage->const1 : program.const1;
    for (const bool alpha : {false, true}) {
        ranges[{Register::const0, alpha}] = of_constant(own0, alpha);
        ranges[{Register::const1, alpha}] = of_constant(own1, alpha);
    }
}

}  // namespace

RegisterPart part_of(const Input& input) {
    return {input.reg, input.component == Component::alpha};
}

std::vector<RegisterRanges> register_ranges(const CombinerProgram& program, const Machine& machine,
                                            std::span<const UnitTexels> units) {
    RegisterRanges ranges;
    for (const bool alpha : {false, true}) {
        for (const Register reg : {Register::col0, Register::col1, Register::fog})
            ranges[{reg, alpha}] = {0, kOne};
        for (std::size_t i = 0; i < units.size(); ++i) {
            const Register reg = tex(static_cast<int>(i));
            if (units[i] == UnitTexels::unsigned_texels) ranges[{reg, alpha}] = {0, kOne};
            if (units[i] == UnitTexels::signed_texels) ranges[{reg, alpha}] = {-kOne - 1, kOne};
        }
    }
    for (int i = 0; i < 16; ++i) {
        const auto unit = static_cast<std::size_t>(i);
        const bool off = unit >= units.size() || units[unit] == UnitTexels::none;
        if (off) ranges[{tex(i), true}] = {kOne, kOne};
    }
    ranges[{Register::spare0, true}] = ranges[{Register::tex0, true}];
    std::vector<RegisterRanges> after{ranges};
    for (const GeneralStage& stage : program.stages) {
        RegisterRanges before = after.back();
        for (const StageFetch& fetch : stage.fetches) {
            const auto unit = static_cast<std::size_t>(fetch.destination) -
                              static_cast<std::size_t>(Register::tex0);
            const bool is_signed = unit < units.size() && units[unit] == UnitTexels::signed_texels;
            for (const bool alpha : {false, true})
                before[{fetch.destination, alpha}] = {is_signed ? -kOne - 1 : 0, kOne};
        }
        set_constants(program, &stage, before);
        after.push_back(before);
        StageRanges(machine).run(stage, before, after.back());
    }
    set_constants(program, nullptr, after.back());
    return after;
}

}  // namespace burnish
