#include "lab/experiment/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <burnish/files.hpp>
#include <burnish/renderer.hpp>
#include <cmath>
#include <cstdint>

#include "core/read_text.hpp"
#include "lab/experiment/fingerprint.hpp"
#include "lab/experiment/tables.hpp"

namespace burnish::lab {
namespace {

constexpr std::string_view kStyle = R"(
body { font: 15px/1.45 sans-serif; max-width: 1240px; margin: 2em auto; padding: 0 1em;
       color: #222; background: #fff; }
table { border-collapse: collapse; margin: .8em 0; }
th, td { border: 1px solid #ccc; padding: .2em .6em; text-align: left; vertical-align: top; }
td.n { text-align: right; font-variant-numeric: tabular-nums; }
.confirmed { color: #0a7a2f; } .refuted { color: #b3261e; } .open { color: #8a6100; }
.plots svg { max-width: 100%; height: auto; }
.sheet { max-width: 100%; }
)";

std::string escaped(const std::string& text) {
    std::string result;
    for (const char c : text) {
        if (c == '&')
            result += "&amp;";
        else if (c == '<')
            result += "&lt;";
        else if (c == '>')
            result += "&gt;";
        else if (c == '"')
            result += "&quot;";
        else
            result += c;
    }
    return result;
}

std::string base64(const std::string& bytes) {
    constexpr std::string_view kDigits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const bool there = i + k < bytes.size();
            group = group << 8U | (there ? static_cast<std::uint8_t>(bytes[i + k]) : 0U);
        }
        for (std::size_t k = 0; k < 4; ++k)
            text += i + k <= bytes.size() ? kDigits[group >> (18 - 6 * k) & 63U] : '=';
    }
    return text;
}

/// Four digits that count.
std::string shown(double value) {
    return fmt::format("{:.4g}", value);
}

std::string range_of(const std::vector<double>& values) {
    if (values.empty()) return "none";
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    return *low == *high ? shown(*low) : shown(*low) + " .. " + shown(*high);
}

std::string limits_of(const ExperimentExpectation& expectation) {
    if (!expectation.at_most) return "at least " + shown(*expectation.at_least);
    if (!expectation.at_least) return "at most " + shown(*expectation.at_most);
    return shown(*expectation.at_least) + " .. " + shown(*expectation.at_most);
}

std::string choice_text(const ExperimentChoice& choice) {
    std::string text;
    for (const auto& [axis, labels] : choice) {
        text += (text.empty() ? "" : "; ") + axis + " ";
        for (std::size_t i = 0; i < labels.size(); ++i) text += (i == 0 ? "" : ", ") + labels[i];
    }
    return text;
}

/// "rmse", "slope of rmse along N", "rmse over that of method mean".
std::string measure_text(const ExperimentExpectation& expectation) {
    switch (expectation.measure) {
        case ExperimentMeasure::value:
            return expectation.metric;
        case ExperimentMeasure::ratio:
            return expectation.metric + " over that of " + choice_text(expectation.versus);
        case ExperimentMeasure::slope:
            return "exponent of " + expectation.metric + " in " + expectation.along;
        case ExperimentMeasure::halving:
            return "factor by which " + expectation.metric + " falls per unit of " +
                   expectation.along;
        case ExperimentMeasure::argmin:
            return expectation.along + " of the smallest " + expectation.metric;
        case ExperimentMeasure::argmax:
            break;
    }
    return expectation.along + " of the largest " + expectation.metric;
}

std::string verdict_rows(const Results& results, const std::vector<Judgement>& judgements) {
    std::string rows;
    for (std::size_t i = 0; i < judgements.size(); ++i) {
        const ExperimentExpectation& expectation = results.experiment.expectations[i];
        const Judgement& judgement = judgements[i];
        const std::size_t count = judgement.measures.size();
        std::string cells = fmt::format("{} of {}", judgement.inside, count);
        if (judgement.open > 0) cells += fmt::format(", {} without a number", judgement.open);
        rows += fmt::format(
            "<tr><td>{}</td><td>{}</td><td>{}<br><small>{}</small></td><td class=n>{}</td>"
            "<td class=n>{}</td><td>{}</td><td class={}>{}</td></tr>\n",
            escaped(expectation.text), escaped(expectation.predicted),
            escaped(measure_text(expectation)), escaped(choice_text(expectation.where)),
            limits_of(expectation), range_of(judgement.measures), cells,
            verdict_name(judgement.verdict), verdict_name(judgement.verdict));
    }
    return rows;
}

/// A cell of a Markdown table.
std::string cell_text(const std::string& text) {
    std::string result;
    for (const char c : text) {
        if (c == '|') result += '\\';
        result += c;
    }
    return result;
}

std::string settings_text(const std::vector<ExperimentSetting>& settings) {
    std::string text;
    for (const ExperimentSetting& setting : settings)
        text += (text.empty() ? "" : ", ") + setting.key + " = " + setting.value;
    return text.empty() ? "as in the scene" : text;
}

std::string setting_section(const Results& results) {
    const Experiment& experiment = results.experiment;
    std::string rows;
    for (const ExperimentAxis& axis : experiment.axes) {
        std::string labels;
        for (const ExperimentVariant& value : axis.values)
            if (!results.quick || value.quick) labels += (labels.empty() ? "" : ", ") + value.label;
        rows +=
            fmt::format("<tr><th>{}</th><td>{}</td></tr>\n", escaped(axis.name), escaped(labels));
    }
    rows += fmt::format("<tr><th>test</th><td>{}; {} sample(s) per pixel</td></tr>\n",
                        escaped(settings_text(experiment.test)), experiment.test_samples);
    rows += fmt::format("<tr><th>reference</th><td>{}; {} samples per pixel</td></tr>\n",
                        escaped(settings_text(experiment.reference)),
                        results.quick ? experiment.quick_samples : experiment.reference_samples);
    if (experiment.expose > 0.0F)
        rows += fmt::format(
            "<tr><th>light</th><td>such that the largest channel in double "
            "precision is {}</td></tr>\n",
            experiment.expose);
    rows += fmt::format("<tr><th>version</th><td>burnish {}, build {}, {}{}</td></tr>\n",
                        BURNISH_VERSION, build_fingerprint(), Renderer({.threads = 1}).isa(),
                        results.quick ? ", quick form" : "");
    return "<h2>Setting</h2>\n<table>\n" + rows + "</table>\n";
}

std::string plots_section(const Results& results, const DrawnPlots& plots) {
    if (results.experiment.plots.empty()) return "";
    std::string text = "<h2>Plots</h2>\n<div class=plots>\n";
    if (!plots.problem.empty()) text += fmt::format("<p>{}</p>\n", escaped(plots.problem));
    for (const std::vector<std::string>& panels : plots.svgs) {
        for (const std::string& svg : panels) {
            const std::size_t begin = svg.find("<svg");
            if (begin != std::string::npos) text += svg.substr(begin) + "\n";
        }
    }
    return text + "</div>\n";
}

std::string sheets_section(const Results& results, const DrawnSheets& drawn) {
    std::string text;
    if (!drawn.problem.empty()) text += fmt::format("<p>{}</p>\n", escaped(drawn.problem));
    for (std::size_t i = 0; i < drawn.sheets.size(); ++i) {
        text += fmt::format("<h2>{}</h2>\n", escaped(results.experiment.sheets[i].title));
        for (const SheetPage& page : drawn.sheets[i])
            text += fmt::format(
                "<p><img class=sheet alt=\"{}\" src=\"data:image/png;base64,{}\"></p>\n",
                escaped(page.rows), base64(read_text(page.png)));
    }
    return text;
}

std::string table_section(const Results& results) {
    const Experiment& experiment = results.experiment;
    std::string head, rows;
    for (const ExperimentAxis& axis : experiment.axes)
        head += fmt::format("<th>{}</th>", escaped(axis.name));
    for (const std::string& metric : experiment.metrics)
        head += fmt::format("<th>{}</th>", escaped(metric));
    for (std::size_t cell = 0; cell < results.cells.size(); ++cell) {
        if (!results.found[cell]) continue;
        rows += "<tr>";
        for (const ExperimentAxis& axis : experiment.axes)
            rows += fmt::format("<td>{}</td>",
                                escaped(label_of(experiment, results.cells[cell], axis.name)));
        if (!results.found[cell]->refusal.empty()) {
            rows += fmt::format("<td colspan={}>{}</td></tr>\n", experiment.metrics.size(),
                                escaped(results.found[cell]->refusal));
            continue;
        }
        for (const std::string& metric : experiment.metrics) {
            const std::optional<double> value = results.value(cell, metric);
            rows += fmt::format("<td class=n>{}</td>", value ? shown(*value) : std::string());
        }
        rows += "</tr>\n";
    }
    return fmt::format(
        "<h2>All cells</h2>\n<details><summary>{} cells</summary>\n<table>\n"
        "<tr>{}</tr>\n{}</table>\n</details>\n",
        results.cells.size(), head, rows);
}

}  // namespace

std::string verdicts_markdown(const Results& results, const std::vector<Judgement>& judgements) {
    std::string text = fmt::format(
        "{}\n\n**{}**, {} cells{}.\n\n| expected | predicted | limits | "
        "found | |\n|---|---|---|---|---|\n",
        results.experiment.hypothesis, verdict_name(overall(judgements)), results.cells.size(),
        results.quick ? " of the quick form" : "");
    for (std::size_t i = 0; i < judgements.size(); ++i) {
        const ExperimentExpectation& expectation = results.experiment.expectations[i];
        const Judgement& judgement = judgements[i];
        const std::size_t count = judgement.measures.size() + judgement.open;
        std::string verdict(verdict_name(judgement.verdict));
        if (judgement.verdict == Verdict::refuted && count > 1)
            verdict += fmt::format(", {} of {} inside", judgement.inside, count);
        text += fmt::format("| {} ({}) | {} | {} | {} | {} |\n", cell_text(expectation.text),
                            cell_text(measure_text(expectation)), cell_text(expectation.predicted),
                            limits_of(expectation), range_of(judgement.measures), verdict);
    }
    return text;
}

std::string report_html(const Results& results, const std::vector<Judgement>& judgements,
                        const DrawnPlots& plots, const DrawnSheets& sheets) {
    const Experiment& experiment = results.experiment;
    const std::string_view verdict = verdict_name(overall(judgements));
    std::string text = fmt::format(
        "<!DOCTYPE html>\n<html lang=en><head><meta charset=utf-8>\n<title>{0}</title>\n"
        "<style>{1}</style></head><body>\n<h1>{0}</h1>\n<p><b>Hypothesis.</b> {2}</p>\n"
        "<p><b>Verdict:</b> <b class={3}>{3}</b></p>\n",
        escaped(experiment.title), kStyle, escaped(experiment.hypothesis), verdict);
    if (results.missing() > 0)
        text += fmt::format("<p class=open>{} of {} cells are missing.</p>\n", results.missing(),
                            results.cells.size());
    if (!judgements.empty())
        text +=
            "<table>\n<tr><th>expected</th><th>predicted</th><th>measure</th><th>limits</th>"
            "<th>found</th><th>inside</th><th>verdict</th></tr>\n" +
            verdict_rows(results, judgements) + "</table>\n";
    return text + setting_section(results) + plots_section(results, plots) +
           sheets_section(results, sheets) + table_section(results) + "</body></html>\n";
}

std::string write_results(const Results& results, const Store& store) {
    std::vector<Judgement> judgements;
    for (const ExperimentExpectation& expectation : results.experiment.expectations)
        judgements.push_back(judge(results, expectation));
    const std::filesystem::path& directory = store.directory();
    save_text(results_csv(results), directory / "results.csv");
    save_text(results_json(results, judgements), directory / "results.json");
    save_text(manifest_json(results), directory / "manifest.json");
    save_text(verdicts_markdown(results, judgements), directory / "verdicts.md");
    const DrawnPlots plots = draw_plots(results, store, directory / "plots");
    const DrawnSheets sheets = draw_sheets(results, store, directory / "sheets");
    save_text(report_html(results, judgements, plots, sheets), directory / "report.html");
    return plots.problem.empty() ? sheets.problem : plots.problem;
}

}  // namespace burnish::lab
