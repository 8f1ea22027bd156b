#include <fmt/format.h>

#include <algorithm>
#include <burnish/error.hpp>
#include <burnish/program_text.hpp>

#include "program/dialect.hpp"
#include "program/fetch_words.hpp"
#include "program/print_number.hpp"
#include "program/print_operand.hpp"

namespace burnish {
namespace {

bool is_zero(const Input& input, Mapping mapping) {
    return input.reg == Register::zero && input.mapping == mapping;
}

/// Zero as a general and as a final input has it by default.
bool is_unused(const Input& input, Place place) {
    return is_zero(input, is_final(place) ? Mapping::unsigned_identity : Mapping::signed_identity);
}

bool is_one(const Input& input) {
    return is_zero(input, Mapping::unsigned_invert);
}

bool uses_third(const Portion& portion) {
    return portion.third_out != Register::discard || portion.third == Third::mux;
}

bool uses_ab(const Portion& p) {
    return p.ab_product == Product::dot || p.ab_out != Register::discard ||
           !is_unused(p.a, Place::rgb) || !is_unused(p.b, Place::rgb);
}

bool uses_cd(const Portion& p) {
    return p.cd_product == Product::dot || p.cd_out != Register::discard ||
           !is_unused(p.c, Place::rgb) || !is_unused(p.d, Place::rgb) || uses_third(p);
}

bool is_idle(const Portion& p) {
    return !uses_ab(p) && !uses_cd(p) && p.scale == Scale::one && !p.bias_minus_half && !p.wide;
}

bool is_idle(const GeneralStage& stage) {
    return is_idle(stage.rgb) && is_idle(stage.alpha) && !stage.const0 && !stage.const1;
}

bool is_late_unit(Register reg) {
    return reg >= tex(kRc10.units) && reg <= Register::tex15;
}

bool needs_extension(const Portion& p) {
    const bool dots = p.ab_product == Product::dot || p.cd_product == Product::dot;
    return p.wide || (dots && uses_third(p)) || is_late_unit(p.a.reg) || is_late_unit(p.b.reg) ||
           is_late_unit(p.c.reg) || is_late_unit(p.d.reg) || is_late_unit(p.ab_out) ||
           is_late_unit(p.cd_out) || is_late_unit(p.third_out);
}

bool needs_extension(const CombinerProgram& program) {
    const FinalCombiner& f = program.final_combiner;
    return program.stages.size() > static_cast<std::size_t>(kRc10.stages) ||
           std::any_of(program.stages.begin(), program.stages.end(),
                       [](const GeneralStage& stage) {
                           return needs_extension(stage.rgb) || needs_extension(stage.alpha) ||
                                  !stage.fetches.empty();
                       }) ||
           is_late_unit(f.a.reg) || is_late_unit(f.b.reg) || is_late_unit(f.c.reg) ||
           is_late_unit(f.d.reg) || is_late_unit(f.e.reg) || is_late_unit(f.f.reg) ||
           is_late_unit(f.g.reg);
}

std::string product(const Input& x, const Input& y, Product kind, Place place) {
    const std::string left = print_operand(x, place);
    if (kind == Product::multiply && is_one(y)) return left;
    return fmt::format("{} {} {}", left, kind == Product::dot ? '.' : '*', print_operand(y, place));
}

std::string_view scale_word(const Portion& p) {
    if (p.bias_minus_half)
        return p.scale == Scale::two ? "bias_by_negative_one_half_scale_by_two"
                                     : "bias_by_negative_one_half";
    switch (p.scale) {
        case Scale::one:
            return "";
        case Scale::two:
            return "scale_by_two";
        case Scale::four:
            return "scale_by_four";
        case Scale::half:
            return "scale_by_one_half";
    }
    return "";
}

std::string print_portion(const Portion& p, Place place) {
    std::string text = fmt::format("    {}{} {{\n", p.wide ? "wide " : "",
                                   place == Place::alpha ? "alpha" : "rgb");
    text += fmt::format("        {} = {};\n", register_name(p.ab_out),
                        product(p.a, p.b, p.ab_product, place));
    if (uses_cd(p))
        text += fmt::format("        {} = {};\n", register_name(p.cd_out),
                            product(p.c, p.d, p.cd_product, place));
    if (uses_third(p))
        text += fmt::format("        {} = {}();\n", register_name(p.third_out),
                            p.third == Third::mux ? "mux" : "sum");
    if (!scale_word(p).empty()) text += fmt::format("        {}();\n", scale_word(p));
    return text + "    }\n";
}

std::string print_constant(std::string_view name, const glm::vec4& value) {
    const glm::vec4 v = glm::clamp(value, 0.0F, 1.0F);
    return fmt::format("{} = ({}, {}, {}, {});\n", name, print_number(v.r), print_number(v.g),
                       print_number(v.b), print_number(v.a));
}

std::string print_coordinate(const FetchCoordinate& from) {
    const std::string reg = fmt::format("{}.{}", register_name(from.reg), "rgba"[from.component]);
    return from.expand ? "expand(" + reg + ")" : reg;
}

std::string print_fetches(const std::vector<StageFetch>& fetches) {
    if (fetches.empty()) return "";
    std::string text = "fetch {\n";
    for (const StageFetch& fetch : fetches) text += fmt::format("    {};\n", print_fetch(fetch));
    return text + "}\n";
}

/// The stages that the text has to name: the parser adds the only one, and the one behind the last
/// fetches, if they are idle.
std::string print_stages(const std::vector<GeneralStage>& stages) {
    std::string text;
    for (std::size_t i = 0; i < stages.size(); ++i) {
        text += print_fetches(stages[i].fetches);
        const bool implied =
            i + 1 == stages.size() && is_idle(stages[i]) && (i == 0 || !stages[i].fetches.empty());
        if (!implied) text += print_stage(stages[i]);
    }
    return text;
}

bool reads_product(const FinalCombiner& f) {
    return f.a.reg == Register::final_product || f.b.reg == Register::final_product ||
           f.c.reg == Register::final_product || f.d.reg == Register::final_product;
}

std::string print_rgb(const FinalCombiner& f) {
    const auto unused = [](const Input& input) { return is_unused(input, Place::final_rgb); };
    const auto operand = [](const Input& input) { return print_operand(input, Place::final_rgb); };
    const std::string added = unused(f.d) ? "" : " + " + operand(f.d);
    if (!unused(f.c))
        return fmt::format("lerp({}, {}, {}){}", operand(f.a), operand(f.b), operand(f.c), added);
    if (unused(f.a) && unused(f.b)) return operand(f.d);
    if (is_one(f.b) && !added.empty()) return operand(f.a) + added;
    return fmt::format("{} * {}{}", operand(f.a), operand(f.b), added);
}

/// What stands on a material beside its program as text.
void require_sayable(const CombinerProgram& program) {
    const auto fail = [](const std::string& what) {
        throw Error(ErrorCode::bad_program,
                    what + ", which no text can say: it belongs to the material");
    };
    if (program.fog != glm::vec4(0.0F)) fail("fog has a colour");
    if (program.mux_bit != MuxBit::msb) fail("mux tests the least significant bit");
    const FinalCombiner& f = program.final_combiner;
    if (f.complement_spare0 || f.complement_secondary)
        fail("final combiner: an operand of the colour sum is complemented");
    for (std::size_t i = 0; i < program.stages.size(); ++i) {
        const Portion& rgb = program.stages[i].rgb;
        if (rgb.ab_blue_to_alpha || rgb.cd_blue_to_alpha)
            fail(fmt::format("stage {}, rgb: blue goes to alpha", i));
    }
}

}  // namespace

/// A stage needs a portion, an idle one too.
std::string print_stage(const GeneralStage& stage) {
    std::string text = "{\n";
    if (stage.const0) text += "    " + print_constant("const0", *stage.const0);
    if (stage.const1) text += "    " + print_constant("const1", *stage.const1);
    const bool idle = is_idle(stage.rgb) && is_idle(stage.alpha);
    if (!is_idle(stage.rgb) || idle) text += print_portion(stage.rgb, Place::rgb);
    if (!is_idle(stage.alpha)) text += print_portion(stage.alpha, Place::alpha);
    return text + "}\n";
}

std::string print_final(const FinalCombiner& f) {
    std::string text;
    if (f.clamp_color_sum) text += "clamp_color_sum();\n";
    if (reads_product(f) || !is_unused(f.e, Place::final_rgb) || !is_unused(f.f, Place::final_rgb))
        text += fmt::format("final_product = {} * {};\n", print_operand(f.e, Place::final_rgb),
                            print_operand(f.f, Place::final_rgb));
    text += fmt::format("out.rgb = {};\n", print_rgb(f));
    return text + fmt::format("out.a = {};\n", print_operand(f.g, Place::final_alpha));
}

std::string print_fetch(const StageFetch& fetch) {
    std::string from;
    for (int i = 0; i < coordinate_count(fetch.target); ++i)
        from +=
            (i == 0 ? "" : ", ") + print_coordinate(fetch.coordinates[static_cast<std::size_t>(i)]);
    return fmt::format("{} = {}({})", register_name(fetch.destination),
                       kFetchWords[static_cast<std::size_t>(fetch.target)], from);
}

std::string print_combiners(const CombinerProgram& program) {
    require_sayable(program);
    program.validate(Machine());
    std::string text = std::string((needs_extension(program) ? kBrn10 : kRc10).header) + "\n";
    if (program.const0 != glm::vec4(0.0F)) text += print_constant("const0", program.const0);
    if (program.const1 != glm::vec4(0.0F)) text += print_constant("const1", program.const1);
    return text + print_stages(program.stages) + print_final(program.final_combiner);
}

}  // namespace burnish
