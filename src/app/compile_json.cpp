#include <fmt/format.h>

#include <burnish/program_text.hpp>

#include "app/compile.hpp"
#include "app/stats.hpp"

namespace burnish::app {
namespace {

std::string json_input(const Input& input) {
    return json_string(print_input(input));
}

std::string json_constant(const glm::vec4& v) {
    return fmt::format("[{}, {}, {}, {}]", v.r, v.g, v.b, v.a);
}

std::string json_constant(const std::optional<glm::vec4>& v) {
    return v ? json_constant(*v) : "null";
}

std::string json_output(std::string_view operation, Register to) {
    return fmt::format("{{\"operation\": \"{}\", \"to\": \"{}\"}}", operation, register_name(to));
}

double scale_factor(Scale scale) {
    switch (scale) {
        case Scale::one:
            return 1.0;
        case Scale::two:
            return 2.0;
        case Scale::four:
            return 4.0;
        case Scale::half:
            return 0.5;
    }
    return 1.0;
}

std::string json_portion(const Portion& p) {
    const auto name = [](Product product) { return product == Product::dot ? "dot" : "multiply"; };
    return fmt::format(
        "{{\"a\": {}, \"b\": {}, \"c\": {}, \"d\": {}, \"ab\": {}, \"cd\": {}, \"third\": {}, "
        "\"scale\": {}, \"bias\": {}, \"wide\": {}}}",
        json_input(p.a), json_input(p.b), json_input(p.c), json_input(p.d),
        json_output(name(p.ab_product), p.ab_out), json_output(name(p.cd_product), p.cd_out),
        json_output(p.third == Third::mux ? "mux" : "sum", p.third_out), scale_factor(p.scale),
        p.bias_minus_half ? -0.5 : 0.0, p.wide);
}

std::string json_stage(const GeneralStage& stage) {
    std::string fetches;
    for (const StageFetch& fetch : stage.fetches)
        fetches += (fetches.empty() ? "" : ", ") + json_string(print_fetch(fetch));
    return fmt::format(
        "{{\"const0\": {}, \"const1\": {}, \"fetches\": [{}], \"rgb\": {}, \"alpha\": {}}}",
        json_constant(stage.const0), json_constant(stage.const1), fetches, json_portion(stage.rgb),
        json_portion(stage.alpha));
}

std::string json_final(const FinalCombiner& f) {
    return fmt::format(
        "{{\"a\": {}, \"b\": {}, \"c\": {}, \"d\": {}, \"e\": {}, \"f\": {}, \"g\": {}, "
        "\"clamp_color_sum\": {}}}",
        json_input(f.a), json_input(f.b), json_input(f.c), json_input(f.d), json_input(f.e),
        json_input(f.f), json_input(f.g), f.clamp_color_sum);
}

std::string json_file(const std::string& file) {
    return file.empty() ? "null" : json_string(file);
}

}  // namespace

std::string combiners_json(const CombinerProgram& program, const std::string& file) {
    std::string stages;
    for (const GeneralStage& stage : program.stages)
        stages += (stages.empty() ? "" : ", ") + json_stage(stage);
    return fmt::format(
        "{{\"file\": {}, \"language\": \"{}\", \"const0\": {}, \"const1\": {}, \"stages\": [{}], "
        "\"final\": {}, \"text\": {}}}",
        json_file(file), language_of(program), json_constant(program.const0),
        json_constant(program.const1), stages, json_final(program.final_combiner),
        json_string(print_combiners(program)));
}

std::string texture_shader_json(const std::optional<TextureShader>& shader,
                                const std::string& file) {
    if (!shader) return "null";
    std::string units;
    for (int i = 0; i < kTextureShaderUnits; ++i) {
        const TextureUnit& unit = shader->units[static_cast<std::size_t>(i)];
        units += fmt::format("{}{{\"operation\": \"{}\", \"statement\": {}}}", i == 0 ? "" : ", ",
                             texture_operation_name(unit.operation),
                             json_string(print_texture_unit(*shader, i)));
    }
    return fmt::format("{{\"file\": {}, \"units\": [{}], \"text\": {}}}", json_file(file), units,
                       json_string(print_texture_shader(*shader)));
}

std::string profiles_json(const std::vector<ProfileVerdict>& profiles) {
    std::string list;
    for (const ProfileVerdict& verdict : profiles)
        list += fmt::format(
            "{}{{\"name\": \"{}\", \"runs\": {}, \"complaint\": {}, \"passes\": {}}}",
            list.empty() ? "" : ", ", verdict.profile, verdict.complaint.empty(),
            verdict.complaint.empty() ? std::string("null") : json_string(verdict.complaint),
            verdict.passes);
    return list;
}

std::string compiled_json(const Compiled& compiled) {
    return fmt::format("{{\"combiners\": {}, \"texture_shader\": {}, \"profiles\": [{}]}}",
                       combiners_json(compiled.combiners, compiled.combiners_file),
                       texture_shader_json(compiled.texture_shader, compiled.texture_shader_file),
                       profiles_json(compiled.profiles));
}

}  // namespace burnish::app
