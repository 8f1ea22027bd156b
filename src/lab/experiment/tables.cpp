#include "lab/experiment/tables.hpp"

#include <fmt/format.h>

#include <burnish/renderer.hpp>
#include <cmath>

#include "lab/experiment/fingerprint.hpp"

namespace burnish::lab {
namespace {

std::string csv_field(const std::string& text) {
    if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
    return quoted + '"';
}

std::string json_text(const std::string& text) {
    std::string quoted = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\')
            quoted += {'\\', c};
        else if (static_cast<unsigned char>(c) < 0x20)
            quoted += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
        else
            quoted += c;
    }
    return quoted + '"';
}

/// JSON has no infinity.
std::string json_number(double value) {
    return std::isfinite(value) ? fmt::format("{}", value) : "null";
}

std::string json_settings(const PictureSettings& picture) {
    std::string text = "{";
    for (const ExperimentSetting& setting : picture.settings)
        text += fmt::format("{}: {}, ", json_text(setting.key), json_text(setting.value));
    return text + fmt::format("\"samples\": {}}}", picture.samples);
}

std::string json_labels(const Results& results, const Cell& cell) {
    std::string text;
    for (std::size_t axis = 0; axis < results.experiment.axes.size(); ++axis) {
        const ExperimentAxis& of = results.experiment.axes[axis];
        text += fmt::format("{}: {}, ", json_text(of.name),
                            json_text(of.values[cell.values[axis]].label));
    }
    return text;
}

std::string json_cell(const Results& results, std::size_t cell) {
    std::string text = "  {" + json_labels(results, results.cells[cell]);
    const CellResult& result = *results.found[cell];
    for (const std::string& metric : results.experiment.metrics)
        if (const auto value = results.value(cell, metric))
            text += fmt::format("{}: {}, ", json_text(metric), json_number(*value));
    if (!result.refusal.empty())
        text += fmt::format("\"refused\": {}, ", json_text(result.refusal));
    return text + fmt::format("\"ms\": {}, \"ms_low\": {}, \"ms_high\": {}}}", result.ms,
                              result.ms_low, result.ms_high);
}

std::string json_judgement(const ExperimentExpectation& expectation, const Judgement& judgement) {
    std::string measures;
    for (const double each : judgement.measures)
        measures += (measures.empty() ? "" : ", ") + json_number(each);
    return fmt::format(
        "  {{\"text\": {}, \"predicted\": {}, \"verdict\": \"{}\", \"measures\": [{}]}}",
        json_text(expectation.text), json_text(expectation.predicted),
        verdict_name(judgement.verdict), measures);
}

}  // namespace

std::string results_csv(const Results& results) {
    std::string text;
    for (const ExperimentAxis& axis : results.experiment.axes) text += csv_field(axis.name) + ",";
    for (const std::string& metric : results.experiment.metrics) text += csv_field(metric) + ",";
    text += "refused\r\n";
    for (std::size_t i = 0; i < results.cells.size(); ++i) {
        if (!results.found[i]) continue;
        for (const ExperimentAxis& axis : results.experiment.axes)
            text += csv_field(label_of(results.experiment, results.cells[i], axis.name)) + ",";
        for (const std::string& metric : results.experiment.metrics) {
            const std::optional<double> value = results.value(i, metric);
            text += (value ? fmt::format("{}", *value) : std::string()) + ",";
        }
        text += csv_field(results.found[i]->refusal) + "\r\n";
    }
    return text;
}

std::string results_json(const Results& results, const std::vector<Judgement>& judgements) {
    std::string cells, verdicts;
    for (std::size_t i = 0; i < results.cells.size(); ++i)
        if (results.found[i]) cells += (cells.empty() ? "" : ",\n") + json_cell(results, i);
    for (std::size_t i = 0; i < judgements.size(); ++i)
        verdicts += (i == 0 ? "" : ",\n") +
                    json_judgement(results.experiment.expectations[i], judgements[i]);
    return fmt::format(
        "{{\n\"experiment\": {},\n\"title\": {},\n\"quick\": {},\n\"verdict\": \"{}\",\n"
        "\"expectations\": [\n{}\n],\n\"cells\": [\n{}\n]\n}}\n",
        json_text(results.experiment.name), json_text(results.experiment.title), results.quick,
        verdict_name(overall(judgements)), verdicts, cells);
}

std::string manifest_json(const Results& results) {
    const Experiment& experiment = results.experiment;
    std::string inputs, cells;
    for (const std::filesystem::path& file : experiment.inputs)
        inputs += fmt::format(
            "{}\n  {}: \"{}\"", inputs.empty() ? "" : ",",
            json_text(file.lexically_relative(experiment.file.parent_path()).generic_string()),
            file_fingerprint(file));
    for (std::size_t i = 0; i < results.cells.size(); ++i) {
        const Cell& cell = results.cells[i];
        cells += fmt::format("{}\n  {{{}\"files\": {}, \"test\": {}, \"reference\": {}}}",
                             i == 0 ? "" : ",", json_labels(results, cell), json_text(cell.name),
                             json_settings(cell.test), json_settings(cell.reference));
    }
    const ExperimentPan& pan = experiment.pan;
    return fmt::format(
        "{{\n\"experiment\": {},\n\"quick\": {},\n\"version\": \"{}\",\n\"build\": \"{}\",\n"
        "\"isa\": \"{}\",\n\"hash\": \"FNV-1a, 64 bits\",\n\"inputs\": {{{}\n}},\n"
        "\"expose\": {},\n\"pan\": {{\"frames\": {}, \"samples\": {}, \"pixels\": [{}, {}]}},\n"
        "\"cells\": [{}\n]\n}}\n",
        json_text(experiment.name), results.quick, BURNISH_VERSION, build_fingerprint(),
        Renderer({.threads = 1}).isa(), inputs, experiment.expose,
        results.quick ? pan.quick_frames : pan.frames, pan.samples, pan.pixels[0], pan.pixels[1],
        cells);
}

}  // namespace burnish::lab
