#include "app/by_stage.hpp"

#include <fmt/format.h>

#include <burnish/error.hpp>
#include <burnish/files.hpp>

#include "app/picture.hpp"
#include "app/progress.hpp"
#include "app/stats.hpp"
#include "app/text_table.hpp"
#include "lab/attribution.hpp"
#include "lab/stage_bits_text.hpp"
#include "lab/waterfall.hpp"

namespace burnish::app {
namespace {

std::string text_of(const lab::Attribution& of) {
    std::vector<TableRow> rows{{"stage", "bits", "alone", "bias", "all but it", "so far"}};
    for (const lab::StageError& stage : of.stages)
        rows.push_back({stage.stage, lab::bits_text(stage.bits), fmt::format("{:.6f}", stage.only),
                        fmt::format("{:+.6f}", stage.bias), fmt::format("{:.6f}", stage.all_but),
                        fmt::format("{:.6f}", stage.cumulative)});
    rows.push_back({"all", "", fmt::format("{:.6f}", of.all), fmt::format("{:+.6f}", of.all_bias)});
    rows.push_back({"machine", "", fmt::format("{:.6f}", of.machine)});
    std::string text = fmt::format(
        "RMSE from the exact picture over {} pixels with a surface, 1 is white\n{}\n"
        "{:.6f} between the machine's picture and that with all stages rounded\n",
        of.pixels, text_table(rows, 0), of.rest);
    if (of.plan)
        text += fmt::format("{:.6f} between the exact picture and the model's formula\n", *of.plan);
    for (const lab::StageError& stage : of.stages) {
        if (!stage.text.empty()) text += fmt::format("\n{}\n{}", stage.stage, stage.text);
    }
    return text;
}

std::string json_of(const lab::Attribution& of) {
    std::string stages;
    for (const lab::StageError& s : of.stages)
        stages += fmt::format(
            "{}{{\"stage\": \"{}\", \"text\": {}, \"bits\": {}, \"alone\": {}, \"bias\": {}, "
            "\"all_but\": {}, \"cumulative\": {}}}",
            stages.empty() ? "" : ", ", s.stage, json_string(s.text),
            s.bits == kExactBits ? "null" : fmt::format("{}", s.bits), s.only, s.bias, s.all_but,
            s.cumulative);
    return fmt::format(
        "\"pixels\": {}, \"stages\": [{}], \"all\": {}, \"all_bias\": {}, "
        "\"machine_rmse\": {}, \"rest\": {}, \"plan\": {}",
        of.pixels, stages, of.all, of.all_bias, of.machine, of.rest,
        of.plan ? fmt::format("{}", *of.plan) : "null");
}

TableRow row_of(const std::string& name, const glm::dvec3& color, const glm::dvec3& change) {
    TableRow row{name};
    for (int c = 0; c < 3; ++c) row.push_back(fmt::format("{:.6f}", color[c]));
    for (int c = 0; c < 3; ++c) row.push_back(fmt::format("{:+.3f}", 255.0 * change[c]));
    return row;
}

std::string text_of(const lab::PixelAttribution& of) {
    std::vector<TableRow> rows{{"stage", "r", "g", "b", "r, codes", "g, codes", "b, codes"}};
    for (const lab::PixelStep& step : of.steps)
        rows.push_back(row_of(step.stage, step.color, step.change));
    rows.push_back(row_of("machine", of.machine, of.machine - of.steps.back().color));
    return text_table(rows, 0);
}

std::string json_of(const lab::PixelAttribution& of) {
    const auto list = [](const glm::dvec3& v) {
        return fmt::format("[{}, {}, {}]", v.x, v.y, v.z);
    };
    std::string steps;
    for (const lab::PixelStep& step : of.steps)
        steps +=
            fmt::format("{}{{\"stage\": \"{}\", \"color\": {}, \"change\": {}}}",
                        steps.empty() ? "" : ", ", step.stage, list(step.color), list(step.change));
    return fmt::format("\"steps\": [{}], \"machine_color\": {}", steps, list(of.machine));
}

}  // namespace

void trace_by_stage(const TraceOptions& options) {
    const Scene scene = load_picture(options.picture);
    lab::StageBits bits = lab::machine_bits(scene.machine);
    lab::set_stage_bits(bits, options.bits);
    if (!options.rounding.empty()) lab::set_stage_bits(bits, "rounding", options.rounding);
    Progress progress(options.picture.quiet);
    const auto show = [&](const auto& attribution, const std::string& where) {
        progress.finish();
        const std::string title =
            fmt::format("{}{} on {}, rounding {}", options.picture.input.string(), where,
                        scene.machine.name, lab::rounding_name(bits.rounding));
        if (options.json)
            fmt::print("{{\"input\": {}, \"machine\": {}, \"rounding\": \"{}\", {}}}\n",
                       json_string(options.picture.input.string()), json_string(scene.machine.name),
                       lab::rounding_name(bits.rounding), json_of(attribution));
        else
            fmt::print("{}\n{}", title, text_of(attribution));
        if (!options.output.empty()) save_text(lab::waterfall(attribution, title), options.output);
    };
    const int threads = options.picture.threads;
    if (options.pixel) {
        const glm::ivec2 at = *options.pixel;
        show(lab::attribute_pixel(scene, bits, at.x, at.y, threads),
             fmt::format(", pixel {},{}", at.x, at.y));
        return;
    }
    show(lab::attribute_error(
             scene, bits, threads,
             [&](std::size_t done, std::size_t total) { progress.done(done, total); }),
         "");
}

}  // namespace burnish::app
