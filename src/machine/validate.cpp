#include <fmt/format.h>

#include <array>
#include <burnish/combiner.hpp>
#include <burnish/error.hpp>
#include <burnish/program_place.hpp>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>

namespace burnish {
namespace {

enum class Place { rgb, alpha, final_rgb, final_alpha };

bool is_pseudo(Register reg) {
    return reg == Register::color_sum || reg == Register::final_product;
}

bool is_texture(Register reg) {
    return reg >= Register::tex0 && reg <= Register::tex15;
}

using Part = ProgramPlace::Part;

/// The statement that says what input `slot` reads.
std::uint8_t statement_of(char slot, Place place) {
    if (place == Place::final_alpha) return ProgramPlace::kOutAlpha;
    if (place == Place::final_rgb)
        return slot < 'E' ? ProgramPlace::kOutRgb : ProgramPlace::kFinalProduct;
    return slot < 'C' ? ProgramPlace::kAb : ProgramPlace::kCd;
}

/// Checks the operands of one portion, of fetches or of the final combiner; messages begin with
/// `where`.
class Checker {
  public:
    Checker(std::string where, Part part, std::size_t stage, const Machine& machine)
        : m_where(std::move(where)), m_part(part), m_stage(stage), m_machine(machine) {}

    [[noreturn]] void fail(std::uint8_t statement, const std::string& message) const {
        throw ProgramFault({m_part, m_stage, statement}, m_where + ": " + message);
    }

    void require_unit(std::uint8_t statement, Register reg, char const* verb) const {
        const int unit = static_cast<int>(reg) - static_cast<int>(Register::tex0);
        if (!is_texture(reg) || unit < m_machine.texture_units) return;
        fail(statement,
             fmt::format("{} {}, machine '{}' has texture units tex0 .. tex{}", verb,
                         register_name(reg), m_machine.name, m_machine.texture_units - 1));
    }

    /// What every place that reads a register has in common: the register exists, and the component
    /// is one that the place can select. Zero is the same in all components.
    void require_readable(std::uint8_t statement, char slot, const Input& input,
                          Place place) const {
        if (input.reg > Register::discard)
            fail(statement, fmt::format("{} reads an unknown register", slot));
        if (input.reg == Register::discard)
            fail(statement, fmt::format("{} reads discard, which can only be written", slot));
        require_unit(statement, input.reg, "reads");
        if (input.reg == Register::zero) return;
        const bool scalar = place == Place::alpha || place == Place::final_alpha;
        if (scalar && input.component == Component::rgb)
            fail(statement, fmt::format("{} reads the rgb of {}, expected its alpha or blue", slot,
                                        register_name(input.reg)));
        if (!scalar && input.component == Component::blue)
            fail(statement, fmt::format("{} reads the blue of {}, expected its rgb or alpha", slot,
                                        register_name(input.reg)));
    }

    void general_input(std::uint8_t statement, char slot, const Input& input, Place place) const {
        require_readable(statement, slot, input, place);
        if (is_pseudo(input.reg))
            fail(statement, fmt::format("{} reads {}, which only the final combiner can", slot,
                                        register_name(input.reg)));
        if (input.reg == Register::fog && input.component == Component::alpha)
            fail(statement,
                 fmt::format("{} reads the alpha of fog, which only the final combiner can", slot));
    }
    void general_input(char slot, const Input& input, Place place) const {
        general_input(statement_of(slot, place), slot, input, place);
    }

    void final_input(char slot, const Input& input, Place place) const {
        const std::uint8_t statement = statement_of(slot, place);
        require_readable(statement, slot, input, place);
        if (input.mapping != Mapping::unsigned_identity &&
            input.mapping != Mapping::unsigned_invert)
            fail(statement,
                 fmt::format("{} has a signed or expanding mapping, expected unsigned or "
                             "unsigned_invert",
                             slot));
        if (!is_pseudo(input.reg)) return;
        const bool a_product = slot == 'A' && input.reg == Register::final_product;
        if (!a_product && !(slot >= 'B' && slot <= 'D'))
            fail(statement,
                 fmt::format("{} reads {}, which is for {}", slot, register_name(input.reg),
                             input.reg == Register::color_sum ? "B, C and D" : "A, B, C and D"));
        if (input.component != Component::rgb)
            fail(statement, fmt::format("{} reads the alpha of {}, which has none", slot,
                                        register_name(input.reg)));
    }

    void output(std::uint8_t statement, const char* name, Register out) const {
        if (out == Register::discard) return;
        require_unit(statement, out, "writes");
        const bool writable = is_texture(out) || out == Register::col0 || out == Register::col1 ||
                              out == Register::spare0 || out == Register::spare1;
        if (!writable)
            fail(statement,
                 fmt::format("{} goes to {}, which cannot be written", name, register_name(out)));
    }

  private:
    std::string m_where;
    Part m_part;
    std::size_t m_stage;
    const Machine& m_machine;
};

void check_portion(const Portion& portion, Place place, const Checker& check,
                   const Machine& machine) {
    check.general_input('A', portion.a, place);
    check.general_input('B', portion.b, place);
    check.general_input('C', portion.c, place);
    check.general_input('D', portion.d, place);
    constexpr auto kAb = ProgramPlace::kAb, kCd = ProgramPlace::kCd, kThird = ProgramPlace::kThird;
    for (const auto& [statement, kind] :
         {std::pair{kAb, portion.ab_product}, std::pair{kCd, portion.cd_product}}) {
        if (place == Place::alpha && kind == Product::dot)
            check.fail(statement,
                       "dot product, expected multiply: dots exist in rgb portions only");
    }

    check.output(kAb, "AB", portion.ab_out);
    check.output(kCd, "CD", portion.cd_out);
    check.output(kThird, portion.third == Third::sum ? "the sum" : "the mux", portion.third_out);
    const auto check_twice = [&](std::uint8_t statement, Register one, Register other) {
        if (one == other && one != Register::discard)
            check.fail(statement, fmt::format("{} is written twice", register_name(one)));
    };
    check_twice(kCd, portion.ab_out, portion.cd_out);
    check_twice(kThird, portion.ab_out, portion.third_out);
    check_twice(kThird, portion.cd_out, portion.third_out);

    if (portion.bias_minus_half && (portion.scale == Scale::four || portion.scale == Scale::half))
        check.fail(ProgramPlace::kScale,
                   fmt::format("bias by -1/2 with scale {}, expected scale 1 or 2",
                               portion.scale == Scale::four ? "4" : "1/2"));
    const auto check_blue = [&](std::uint8_t statement, bool set, const char* name, Register out) {
        if (!set) return;
        if (place == Place::alpha)
            check.fail(statement,
                       fmt::format("blue of {} to alpha, which only rgb portions can do", name));
        if (out == Register::discard)
            check.fail(statement,
                       fmt::format("blue of {} to alpha, but {} is discarded", name, name));
    };
    check_blue(kAb, portion.ab_blue_to_alpha, "AB", portion.ab_out);
    check_blue(kCd, portion.cd_blue_to_alpha, "CD", portion.cd_out);
    if (portion.wide && machine.numbers != NumberModel::wide)
        check.fail(ProgramPlace::kAll,
                   fmt::format("wide results, machine '{}' has 9-bit registers", machine.name));
}

void check_fetch(std::uint8_t number, const StageFetch& fetch, const Checker& check) {
    if (!is_texture(fetch.destination))
        check.fail(number, fmt::format("the destination is {}, expected a texture register",
                                       register_name(fetch.destination)));
    check.require_unit(number, fetch.destination, "writes");
    if (fetch.target > FetchTarget::table_rectangle) check.fail(number, "an unknown target");
    for (int i = 0; i < coordinate_count(fetch.target); ++i) {
        const FetchCoordinate& from = fetch.coordinates[static_cast<std::size_t>(i)];
        if (from.component > 3)
            check.fail(number, fmt::format("component {}, expected 0 .. 3", from.component));
        const Component component = from.component == 3 ? Component::alpha : Component::rgb;
        check.general_input(
            number, "STR" [i], { from.reg, Mapping::signed_identity, component }, Place::rgb);
    }
}

void check_fetches(std::size_t index, const GeneralStage& stage, const Machine& machine) {
    if (stage.fetches.empty()) return;
    const Checker check(fmt::format("stage {}, fetch", index), Part::fetches, index, machine);
    if (!machine.stage_fetches)
        check.fail(ProgramPlace::kAll,
                   fmt::format("machine '{}' has no fetches between general stages", machine.name));
    std::array<bool, 16> written{};
    std::uint8_t number = 0;
    for (const StageFetch& fetch : stage.fetches) {
        check_fetch(++number, fetch, check);
        bool& taken = written[static_cast<std::size_t>(fetch.destination) -
                              static_cast<std::size_t>(Register::tex0)];
        if (taken)
            check.fail(number,
                       fmt::format("{} is written twice", register_name(fetch.destination)));
        taken = true;
    }
}

void check_constant(std::string_view name, const glm::vec4& value) {
    for (int i = 0; i < 4; ++i) {
        if (!std::isfinite(value[i]))
            throw Error(ErrorCode::bad_program,
                        fmt::format("{}: a component is not a finite number", name));
    }
}

void check_stage(std::size_t index, const GeneralStage& stage, const Machine& machine) {
    if ((stage.const0 || stage.const1) && !machine.stage_constants)
        throw ProgramFault({Part::constants, index},
                           fmt::format("stage {}: has constants of its own, machine '{}' has only "
                                       "global ones",
                                       index, machine.name));
    if (stage.const0) check_constant(fmt::format("stage {}, const0", index), *stage.const0);
    if (stage.const1) check_constant(fmt::format("stage {}, const1", index), *stage.const1);
    check_fetches(index, stage, machine);
    const Checker colors(fmt::format("stage {}, rgb", index), Part::rgb, index, machine);
    check_portion(stage.rgb, Place::rgb, colors, machine);
    const Checker alpha(fmt::format("stage {}, alpha", index), Part::alpha, index, machine);
    check_portion(stage.alpha, Place::alpha, alpha, machine);
    const Portion &rgb = stage.rgb, &a = stage.alpha;
    std::uint8_t statement = ProgramPlace::kAll;
    for (const Register out : {a.ab_out, a.cd_out, a.third_out}) {
        ++statement;
        if (out == Register::discard) continue;
        if ((rgb.ab_blue_to_alpha && rgb.ab_out == out) ||
            (rgb.cd_blue_to_alpha && rgb.cd_out == out))
            alpha.fail(statement,
                       fmt::format("writes {}, whose alpha gets the blue of the rgb portion",
                                   register_name(out)));
    }
}

}  // namespace

void CombinerProgram::validate(const Machine& machine) const {
    if (stages.size() > static_cast<std::size_t>(machine.general_stages))
        throw ProgramFault({Part::stage, static_cast<std::size_t>(machine.general_stages)},
                           fmt::format("{} general stages, machine '{}' has {}", stages.size(),
                                       machine.name, machine.general_stages));
    if (mux_bit == MuxBit::lsb && machine.numbers != NumberModel::nine_bit)
        throw Error(ErrorCode::bad_program,
                    fmt::format("mux by the lowest bit of 8, machine '{}' has wide registers",
                                machine.name));
    for (std::size_t i = 0; i < stages.size(); ++i) check_stage(i, stages[i], machine);
    const Checker check("final combiner", Part::final_combiner, 0, machine);
    check.final_input('A', final_combiner.a, Place::final_rgb);
    check.final_input('B', final_combiner.b, Place::final_rgb);
    check.final_input('C', final_combiner.c, Place::final_rgb);
    check.final_input('D', final_combiner.d, Place::final_rgb);
    check.final_input('E', final_combiner.e, Place::final_rgb);
    check.final_input('F', final_combiner.f, Place::final_rgb);
    check.final_input('G', final_combiner.g, Place::final_alpha);
    check_constant("const0", const0);
    check_constant("const1", const1);
    check_constant("fog", fog);
}

}  // namespace burnish
