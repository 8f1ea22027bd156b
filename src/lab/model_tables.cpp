#include "lab/model_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <burnish/materials.hpp>
#include <map>
#include <vector>

namespace burnish::lab {

namespace {

constexpr std::string_view kShiftVariant = "corrosion";

std::string_view name_of(Model model) {
    return model_names()[static_cast<std::size_t>(model)];
}

template <class Get>
auto distinct(std::span<const ModelMeasurement> measurements, Get get) {
    std::vector<decltype(get(measurements.front()))> values;
    for (const ModelMeasurement& m : measurements)
        if (std::find(values.begin(), values.end(), get(m)) == values.end())
            values.push_back(get(m));
    return values;
}

const ModelMeasurement* find(std::span<const ModelMeasurement> measurements, Model model,
                             const std::string& machine, std::string_view parameters) {
    for (const ModelMeasurement& m : measurements)
        if (m.model == model && m.machine == machine && m.parameters == parameters) return &m;
    return nullptr;
}

/// Five cells: passes, units and stages in one; RMSE, P99, bias, step.
std::string cells(const ModelMeasurement* m) {
    if (m == nullptr || !m->refusal.empty()) return " no | | | | |";
    const metrics::FrameErrors& e = m->errors;
    return fmt::format(" {}, {}, {} | {:.4f} | {:.4f} | {:+.4f} | {:.1f} |", m->passes, m->units,
                       m->stages, e.rmse, e.p99, e.bias, e.step_excess * 255.0);
}

std::string summary(std::span<const ModelMeasurement> measurements,
                    const std::vector<std::string>& machines, const std::vector<Model>& models,
                    const std::string& constant) {
    std::string text = fmt::format(
        "| model | machine | alpha {} | RMSE | P99 | bias | step | {} | RMSE | P99 | bias | step "
        "|\n"
        "|---|---|---|---|---|---|---|---|---|---|---|---|\n",
        constant, kShiftVariant);
    for (const Model model : models) {
        for (const std::string& machine : machines) {
            text += fmt::format("| `{}` | {} |{}{}\n", name_of(model), machine,
                                cells(find(measurements, model, machine, constant)),
                                cells(find(measurements, model, machine, kShiftVariant)));
        }
    }
    return text;
}

/// Which double picture a machine's is compared with.
enum class Against { exact, its_grid };

std::string short_cell(const ModelMeasurement* m, Against against) {
    if (m == nullptr) return "";
    if (!m->refusal.empty()) return "no";
    const metrics::FrameErrors& errors =
        against == Against::exact ? m->errors : m->on_its_grid.value();
    return fmt::format("{:.4f}, {:.1f}", errors.rmse, errors.step_excess * 255.0);
}

/// Models by parameters, each cell RMSE and step.
std::string everything(std::span<const ModelMeasurement> measurements, const std::string& machine,
                       const std::vector<Model>& models, const std::vector<std::string>& parameters,
                       Against against = Against::exact) {
    std::string text = "| model |";
    std::string rule = "|---|";
    for (const std::string& p : parameters) {
        text += fmt::format(" {} |", p);
        rule += "---|";
    }
    text += "\n" + rule + "\n";
    for (const Model model : models) {
        text += fmt::format("| `{}` |", name_of(model));
        for (const std::string& p : parameters)
            text +=
                fmt::format(" {} |", short_cell(find(measurements, model, machine, p), against));
        text += "\n";
    }
    return text;
}

/// Where the estimates of one kind lie, as parts of what was measured: least, median, largest.
std::string ratios(std::vector<double> ratio) {
    std::sort(ratio.begin(), ratio.end());
    return fmt::format("{:.2f}, {:.2f}, {:.1f}", ratio.front(), ratio[ratio.size() / 2],
                       ratio.back());
}

/// Whether estimates bound what they are for.
std::string estimates(std::span<const ModelMeasurement> measurements,
                      const std::vector<std::string>& machines) {
    std::string text =
        "| machine | pictures | RMSE within rms | rms / RMSE | P99 within largest | largest / P99 "
        "|\n|---|---|---|---|---|---|\n";
    for (const std::string& machine : machines) {
        std::vector<double> rms, largest;
        std::size_t within_rms = 0, within_largest = 0;
        for (const ModelMeasurement& m : measurements) {
            if (m.machine != machine || !m.refusal.empty()) continue;
            rms.push_back(m.estimate.rms / m.errors.rmse);
            largest.push_back(m.estimate.largest / m.errors.p99);
            within_rms += m.errors.rmse <= m.estimate.rms ? 1 : 0;
            within_largest += m.errors.p99 <= m.estimate.largest ? 1 : 0;
        }
        if (rms.empty()) continue;
        text += fmt::format("| {} | {} | {} | {} | {} | {} |\n", machine, rms.size(), within_rms,
                            ratios(rms), within_largest, ratios(largest));
    }
    return text;
}

/// A message once for all models and parameters that it stands for.
std::string refusals(std::span<const ModelMeasurement> measurements) {
    std::map<std::string, std::string> refused;  // by "model on machine": the first message
    std::string text;
    for (const ModelMeasurement& m : measurements) {
        if (m.refusal.empty()) continue;
        const std::string what = fmt::format("`{}` on {}", name_of(m.model), m.machine);
        if (!refused.emplace(what, m.refusal).second) continue;
        text += fmt::format("- {}, {}: {}\n", what, m.parameters, m.refusal);
    }
    return text;
}

std::string json_text(std::string_view text) {
    std::string quoted = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') quoted += '\\';
        quoted += c;
    }
    return quoted + '"';
}

}  // namespace

std::string model_tables(std::span<const ModelMeasurement> measurements,
                         std::span<const ModelParameters> parameters) {
    const auto machines = distinct(measurements, [](const auto& m) { return m.machine; });
    const auto models = distinct(measurements, [](const auto& m) { return m.model; });
    std::vector<std::string> constants, sets;
    for (const ModelParameters& p : parameters)
        (p.shift_variant ? sets : constants).push_back(p.name);

    std::string text =
        "Passes, units and stages; errors of numbers 0 .. 1; the step in 1/255.\n\n" +
        summary(measurements, machines, models, constants.front());
    for (const std::string& machine : machines) {
        text +=
            fmt::format("\nRMSE and step on {}, alpha_x, alpha_y and N the same everywhere:\n\n{}",
                        machine, everything(measurements, machine, models, constants));
        text += fmt::format("\nOn {}, generated sets:\n\n{}", machine,
                            everything(measurements, machine, models, sets));
    }
    text += fmt::format("\nOn {}, generated sets, against its corners and texel coordinates:\n\n{}",
                        machines.back(),
                        everything(measurements, machines.back(), models, sets, Against::its_grid));
    text += "\nError estimates, and what they bound; ratios: least, median, largest:\n\n" +
            estimates(measurements, machines);
    if (const std::string no = refusals(measurements); !no.empty())
        text += "\n\"no\", at its first place:\n\n" + no;
    return text;
}

std::string model_json(std::span<const ModelMeasurement> measurements) {
    std::string text = "[";
    for (const ModelMeasurement& m : measurements) {
        text += fmt::format("{}\n  {{\"model\": \"{}\", \"machine\": \"{}\", \"parameters\": {}, ",
                            &m == &measurements.front() ? "" : ",", name_of(m.model), m.machine,
                            json_text(m.parameters));
        if (!m.refusal.empty()) {
            text += fmt::format("\"refusal\": {}}}", json_text(m.refusal));
            continue;
        }
        const metrics::FrameErrors& e = m.errors;
        text += fmt::format(
            "\"passes\": {}, \"units\": {}, \"stages\": {}, \"pixels\": {}, \"rmse\": {:.6f}, "
            "\"p99\": {:.6f}, \"largest\": {:.6f}, \"bias\": {:.6f}, \"step_excess\": {:.6f}, "
            "\"estimated_rms\": {:.6f}, \"estimated_largest\": {:.6f}}}",
            m.passes, m.units, m.stages, e.pixels, e.rmse, e.p99, e.largest, e.bias, e.step_excess,
            m.estimate.rms, m.estimate.largest);
    }
    return text + "\n]\n";
}

}  // namespace burnish::lab
