#include <fmt/format.h>

#include <burnish/program_text.hpp>

#include "app/compile.hpp"
#include "app/text_table.hpp"

namespace burnish::app {
namespace {

/// "A . B -> spare0"; without the arrow if only the third output has a use for it.
std::string product(const char* terms, Register to, const Portion& portion) {
    if (to != Register::discard) return fmt::format("{} -> {}", terms, register_name(to));
    return portion.third_out != Register::discard ? terms : "-";
}

std::string third(const Portion& portion) {
    if (portion.third_out == Register::discard) return "-";
    return fmt::format("{} -> {}", portion.third == Third::mux ? "mux" : "sum",
                       register_name(portion.third_out));
}

/// What becomes of an output x.
std::string scaled(const Portion& portion) {
    std::string text = portion.bias_minus_half ? "(x - 1/2)" : "x";
    if (portion.scale == Scale::half) text += " / 2";
    if (portion.scale == Scale::two) text += " * 2";
    if (portion.scale == Scale::four) text += " * 4";
    return portion.wide ? text + ", wide" : text;
}

TableRow portion_row(std::size_t stage, std::string_view name, const Portion& p) {
    return {fmt::format("{}", stage),
            std::string(name),
            print_input(p.a),
            print_input(p.b),
            print_input(p.c),
            print_input(p.d),
            product(p.ab_product == Product::dot ? "A . B" : "A * B", p.ab_out, p),
            product(p.cd_product == Product::dot ? "C . D" : "C * D", p.cd_out, p),
            third(p),
            p.writes() ? scaled(p) : "-"};
}

std::string stages_text(const CombinerProgram& program) {
    std::vector<TableRow> rows{
        {"stage", "portion", "A", "B", "C", "D", "AB", "CD", "third", "output"}};
    for (std::size_t i = 0; i < program.stages.size(); ++i) {
        const GeneralStage& stage = program.stages[i];
        rows.push_back(portion_row(i, "rgb", stage.rgb));
        rows.push_back(portion_row(i, "alpha", stage.alpha));
    }
    return "general stages\n" + text_table(rows, 2);
}

std::string fetches_text(const CombinerProgram& program) {
    std::vector<TableRow> rows;
    for (std::size_t i = 0; i < program.stages.size(); ++i) {
        for (const StageFetch& fetch : program.stages[i].fetches)
            rows.push_back({fmt::format("before stage {}", i), print_fetch(fetch)});
    }
    return rows.empty() ? "" : "fetches\n" + text_table(rows, 2);
}

std::string final_text(const FinalCombiner& f) {
    const std::vector<TableRow> rows{
        {"A", "B", "C", "D", "E", "F", "G", "color_sum"},
        {print_input(f.a), print_input(f.b), print_input(f.c), print_input(f.d), print_input(f.e),
         print_input(f.f), print_input(f.g), f.clamp_color_sum ? "clamped" : "not clamped"}};
    return "final combiner: rgb = A * B + (1 - A) * C + D, alpha = G, final_product = E * F\n" +
           text_table(rows, 2);
}

TableRow constant_row(std::string where, const glm::vec4& v) {
    return {std::move(where), fmt::format("{}", v.r), fmt::format("{}", v.g),
            fmt::format("{}", v.b), fmt::format("{}", v.a)};
}

std::string constants_text(const CombinerProgram& program) {
    std::vector<TableRow> rows{constant_row("const0", program.const0),
                               constant_row("const1", program.const1)};
    for (std::size_t i = 0; i < program.stages.size(); ++i) {
        const GeneralStage& stage = program.stages[i];
        if (stage.const0)
            rows.push_back(constant_row(fmt::format("const0 in stage {}", i), *stage.const0));
        if (stage.const1)
            rows.push_back(constant_row(fmt::format("const1 in stage {}", i), *stage.const1));
    }
    return "constants\n" + text_table(rows, 2);
}

std::string units_text(const TextureShader& shader) {
    std::vector<TableRow> rows;
    for (int i = 0; i < kTextureShaderUnits; ++i)
        rows.push_back({fmt::format("tex{}", i), print_texture_unit(shader, i)});
    return "texture units\n" + text_table(rows, 2);
}

std::string verdict_text(const ProfileVerdict& verdict) {
    if (verdict.complaint.empty()) return "runs it";
    if (verdict.passes == 0) return "cannot: " + verdict.complaint;
    return fmt::format("in {} passes: {}", verdict.passes, verdict.complaint);
}

std::string profiles_text(const std::vector<ProfileVerdict>& profiles) {
    std::vector<TableRow> rows;
    for (const ProfileVerdict& verdict : profiles)
        rows.push_back({std::string(verdict.profile), verdict_text(verdict)});
    return "machines\n" + text_table(rows, 2);
}

}  // namespace

std::string compiled_text(const Compiled& compiled) {
    const CombinerProgram& program = compiled.combiners;
    std::string text =
        fmt::format("{}: {}, {} general stage{}\n", compiled.combiners_file, language_of(program),
                    program.stages.size(), program.stages.size() == 1 ? "" : "s");
    if (compiled.texture_shader)
        text += fmt::format("{}: TS1.0\n", compiled.texture_shader_file) +
                units_text(*compiled.texture_shader);
    return text + constants_text(program) + fetches_text(program) + stages_text(program) +
           final_text(program.final_combiner) + profiles_text(compiled.profiles);
}

}  // namespace burnish::app
