#include <fmt/format.h>

#include <burnish/program_text.hpp>

#include "app/compile_model.hpp"
#include "app/text_table.hpp"
#include "models/program_inputs.hpp"

namespace burnish::app {
namespace {

std::string counted(int count, std::string_view what) {
    return fmt::format("{} {}{}", count, what, count == 1 ? "" : (what == "pass" ? "es" : "s"));
}

std::string heading(const ModelReport& report) {
    const ModelNeeds& needs = report.compiled.needs;
    return fmt::format("{} on {}: {}, {} ({} of the material, {}{}), {}\n", report.model,
                       report.machine, counted(pass_count(report.compiled), "pass"),
                       counted(needs.units, "texture unit"), map_count(needs),
                       counted(needs.tables, "table"), needs.third_vector ? ", 1 vector" : "",
                       counted(needs.stages, "general stage"));
}

std::string material_text(const ModelReport& report) {
    const Material& m = report.material;
    if (!report.material_file.empty())
        return fmt::format("material: '{}' of {}\n", m.name, report.material_file);
    return fmt::format("material: the default, kd {}, ks {}, alpha_x {}, alpha_y {}, N {}\n",
                       numbers_text(m.kd), numbers_text(m.ks), m.alpha_x, m.alpha_y, m.exponent);
}

std::string estimate_text(const ErrorEstimate& estimate) {
    return fmt::format("estimate: RMS {:.2g}, largest {:.2g}\n", estimate.rms, estimate.largest);
}

std::string inputs_text(const ProgramMaterial& m) {
    std::vector<TableRow> rows;
    for (const ProgramInput& input : interpolated_inputs(m))
        rows.push_back({input.name, input.value});
    return rows.empty() ? "" : "inputs\n" + text_table(rows, 2);
}

/// How a channel's x of 0 .. 1 becomes the quantity.
std::string decoding(const LayerQuantity& quantity) {
    if (!quantity.texture) return numbers_text(quantity.constant);
    const bool below = glm::all(glm::lessThan(quantity.offset, glm::dvec3(0.0)));
    const bool shifted = quantity.offset != glm::dvec3(0.0);
    const std::string linear =
        fmt::format("{} x{}", numbers_text(quantity.scale),
                    shifted ? fmt::format(" {} {}", below ? '-' : '+',
                                          numbers_text(below ? -quantity.offset : quantity.offset))
                            : "");
    return quantity.logarithmic ? fmt::format("2^({})", linear) : linear;
}

std::string layer_text(const CompiledModel& compiled) {
    std::vector<TableRow> rows{{"unit", "channels", "quantity", "definition", "value"}};
    for (const LayerQuantity& q : compiled.layer) {
        const int unit = unit_of(q, compiled.program);
        rows.push_back({unit < 0 ? "constant" : fmt::format("tex{}", unit),
                        unit < 0 ? "-" : std::string(channels_of(q)), q.name,
                        q.definition == q.name ? "" : q.definition, decoding(q)});
    }
    return "material, x a texel's channel of 0 .. 1\n" + text_table(rows, 2);
}

std::string axis_text(const AxisReport& axis) {
    return fmt::format("{} = {:.6g} .. {:.6g}, {}", axis.argument, axis.first, axis.last,
                       axis.logarithmic ? "logarithmic" : "linear");
}

std::string tables_text(const std::vector<TableReport>& tables) {
    if (tables.empty()) return "";
    std::vector<TableRow> rows{{"unit", "texels", "interpolation", "function and axes"}};
    for (const TableReport& table : tables) {
        std::string texels;
        for (const AxisReport& axis : table.axes)
            texels += fmt::format("{}{}", texels.empty() ? "" : " x ", axis.texels);
        rows.push_back({fmt::format("tex{}", table.unit), texels,
                        fmt::format("{:.2g}", table.interpolation), table.function});
        for (const AxisReport& axis : table.axes)
            rows.push_back({"", "", "", "  " + axis_text(axis)});
    }
    return "tables, interpolation: the largest error between texels\n" + text_table(rows, 2);
}

std::string passes_text(const std::vector<ProgramPass>& passes) {
    if (passes.size() < 2) return "";
    std::vector<TableRow> rows{{"pass", "stages", "leaves", "units"}};
    for (std::size_t i = 0; i < passes.size(); ++i) {
        const bool last = i + 1 == passes.size();
        rows.push_back(
            {fmt::format("{}", i + 1), fmt::format("{}", passes[i].program.stages.size()),
             last ? "the colour" : fmt::format("{}", fmt::join(registers_left(passes[i]), ", ")),
             fmt::format("{}", fmt::join(units_read(passes[i]), ", "))});
    }
    return "passes of the program below\n" + text_table(rows, 2);
}

std::string machines_text(const std::vector<ProfileVerdict>& profiles) {
    std::vector<TableRow> rows;
    for (const ProfileVerdict& verdict : profiles)
        rows.push_back({std::string(verdict.profile), verdict.complaint.empty()
                                                          ? counted(verdict.passes, "pass")
                                                          : "cannot: " + verdict.complaint});
    return "machines\n" + text_table(rows, 2);
}

}  // namespace

std::string model_report_text(const ModelReport& report) {
    const CompiledModel& compiled = report.compiled;
    const ProgramMaterial& program = compiled.program;
    std::string text = heading(report) + material_text(report) +
                       "light: 1, without ambient light\n" + estimate_text(report.estimate) +
                       inputs_text(program) + layer_text(compiled) + tables_text(compiled.tables) +
                       passes_text(compiled.passes) + machines_text(report.profiles) + "\n";
    if (program.texture_shader) text += print_texture_shader(*program.texture_shader) + "\n";
    return text + print_combiners(program.combiners);
}

}  // namespace burnish::app
