#include <fmt/format.h>

#include <burnish/program_text.hpp>

#include "app/compile_model.hpp"
#include "app/stats.hpp"
#include "models/program_inputs.hpp"

namespace burnish::app {
namespace {

std::string json_vector(const glm::dvec3& v) {
    return fmt::format("[{}, {}, {}]", v.x, v.y, v.z);
}

/// `list` with `element` of each, in brackets.
template <class List, class Element>
std::string json_list(const List& list, const Element& element) {
    std::string text;
    for (const auto& item : list) text += (text.empty() ? "" : ", ") + element(item);
    return "[" + text + "]";
}

std::string json_budget(const CompiledModel& compiled) {
    const ModelNeeds& needs = compiled.needs;
    return fmt::format(
        "{{\"passes\": {}, \"texture_units\": {}, \"material_units\": {}, \"tables\": {}, "
        "\"general_stages\": {}}}",
        pass_count(compiled), needs.units, map_count(needs), needs.tables, needs.stages);
}

std::string json_material(const ModelReport& report) {
    const Material& m = report.material;
    return fmt::format(
        "{{\"file\": {}, \"name\": {}, \"kd\": {}, \"ks\": {}, \"alpha_x\": {}, \"alpha_y\": {}, "
        "\"exponent\": {}}}",
        report.material_file.empty() ? "null" : json_string(report.material_file),
        json_string(m.name), json_vector(m.kd), json_vector(m.ks), m.alpha_x, m.alpha_y,
        m.exponent);
}

std::string json_inputs(const ProgramMaterial& m) {
    return fmt::format(
        "{{\"col0_rgb\": \"{}\", \"col0_a\": \"{}\", \"col1_rgb\": \"{}\", \"col1_a\": \"{}\", "
        "\"uv\": {}, \"half_scale\": {}, \"lit_tint\": {}, \"lit_base\": {}}}",
        input_name(m.col0_rgb), input_name(m.col0_a), input_name(m.col1_rgb), input_name(m.col1_a),
        json_list(m.uv,
                  [](CoordinateInput uv) { return json_string(std::string(input_name(uv))); }),
        json_vector(m.half_scale), json_vector(m.lit_tint), json_vector(m.lit_base));
}

std::string json_quantity(const LayerQuantity& q, const CompiledModel& compiled) {
    const std::string names =
        fmt::format("\"name\": {}, \"definition\": {}, \"components\": {}", json_string(q.name),
                    json_string(q.definition), q.components);
    if (!q.texture) return fmt::format("{{{}, \"constant\": {}}}", names, json_vector(q.constant));
    return fmt::format(
        "{{{}, \"unit\": {}, \"channel\": {}, \"scale\": {}, \"offset\": {}, \"logarithmic\": {}}}",
        names, unit_of(q, compiled.program), q.channel, json_vector(q.scale), json_vector(q.offset),
        q.logarithmic);
}

std::string json_axis(const AxisReport& axis) {
    return fmt::format(
        "{{\"argument\": {}, \"first\": {}, \"last\": {}, \"logarithmic\": {}, \"texels\": {}}}",
        json_string(axis.argument), axis.first, axis.last, axis.logarithmic, axis.texels);
}

std::string json_table(const TableReport& table) {
    return fmt::format("{{\"unit\": {}, \"function\": {}, \"axes\": {}, \"interpolation\": {}}}",
                       table.unit, json_string(table.function), json_list(table.axes, json_axis),
                       table.interpolation);
}

std::string json_pass(const ProgramPass& pass, bool is_last) {
    const auto texts = [](const std::vector<std::string>& list) {
        return json_list(list, json_string);
    };
    return fmt::format("{{\"general_stages\": {}, \"leaves\": {}, \"units\": {}, \"text\": {}}}",
                       pass.program.stages.size(), is_last ? "null" : texts(registers_left(pass)),
                       texts(units_read(pass)), json_string(print_combiners(pass.program)));
}

}  // namespace

std::string model_report_json(const ModelReport& report) {
    const CompiledModel& compiled = report.compiled;
    const auto quantity = [&](const LayerQuantity& q) { return json_quantity(q, compiled); };
    const auto pass = [&](const ProgramPass& p) {
        return json_pass(p, &p == &compiled.passes.back());
    };
    return fmt::format(
        "{{\"model\": \"{}\", \"machine\": \"{}\", \"material\": {}, \"budget\": {}, \"inputs\": "
        "{}, \"layer\": {}, \"tables\": {}, \"passes\": {}, \"texture_shader\": {}, \"combiners\": "
        "{}, \"estimate\": {{\"rms\": {}, \"largest\": {}}}, \"profiles\": [{}]}}",
        report.model, report.machine, json_material(report), json_budget(compiled),
        json_inputs(compiled.program), json_list(compiled.layer, quantity),
        json_list(compiled.tables, json_table), json_list(compiled.passes, pass),
        texture_shader_json(compiled.program.texture_shader, {}),
        combiners_json(compiled.program.combiners, {}), report.estimate.rms,
        report.estimate.largest, profiles_json(report.profiles));
}

}  // namespace burnish::app
