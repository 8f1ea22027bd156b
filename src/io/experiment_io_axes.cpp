#include "io/experiment_io_axes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <burnish/error.hpp>
#include <utility>

#include "core/nearest.hpp"

namespace burnish {
namespace {

constexpr std::string_view kSceneAxis = "scene";

std::string quoted(const std::string& text) {
    std::string result = "\"";
    for (const char c : text) {
        if (static_cast<unsigned char>(c) < 0x20) {
            result += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
            continue;
        }
        if (c == '"' || c == '\\') result += '\\';
        result += c;
    }
    return result + '"';
}

/// A value as TOML text.
std::string value_text(const toml::node& node, std::string_view key) {
    if (node.is_string()) return quoted(node.as_string()->get());
    if (node.is_integer()) return fmt::format("{}", node.as_integer()->get());
    if (node.is_floating_point()) return fmt::format("{}", node.as_floating_point()->get());
    if (node.is_boolean()) return node.as_boolean()->get() ? "true" : "false";
    const toml::array* array = node.as_array();
    if (array == nullptr)
        fail_at(node, fmt::format("'{}' is neither a number nor text, true, false or an array of "
                                  "these; a key of a scene stands in quotes: "
                                  "\"machine.profile\" = \"nv2a\"",
                                  key));
    std::string text = "[";
    for (const toml::node& element : *array)
        text += (text.size() > 1 ? ", " : "") + value_text(element, key);
    return text + "]";
}

/// The same as people read it: text without its quotes.
std::string label_of(const toml::node& node, std::string_view key) {
    return node.is_string() ? node.as_string()->get() : value_text(node, key);
}

/// Labels of an array, or of a single value.
std::vector<std::string> labels_of(const toml::node& node, std::string_view key) {
    std::vector<std::string> labels;
    if (const toml::array* array = node.as_array()) {
        for (const toml::node& element : *array) labels.push_back(label_of(element, key));
    } else {
        labels.push_back(label_of(node, key));
    }
    return labels;
}

[[noreturn]] void fail_unknown_label(const Section& section, std::string_view key,
                                     const std::string& label, const ExperimentAxis& axis) {
    std::vector<std::string_view> known;
    for (const ExperimentVariant& value : axis.values) known.push_back(value.label);
    section.fail(key, fmt::format("'{}' in {}: '{}' has no value '{}', {}", key, section.label(),
                                  axis.name, label, expected_one_of(label, known)));
}

/// Marks the values that the key "quick" lists, or all of them.
void read_quick(const Section& section, ExperimentAxis& axis) {
    for (ExperimentVariant& value : axis.values) value.quick = !section.has("quick");
    if (!section.has("quick")) return;
    for (const std::string& label : labels_of(section.required_node("quick"), "quick")) {
        const auto at = std::find_if(axis.values.begin(), axis.values.end(),
                                     [&](const auto& value) { return value.label == label; });
        if (at == axis.values.end()) fail_unknown_label(section, "quick", label, axis);
        at->quick = true;
    }
}

std::vector<ExperimentVariant> read_variants(const Section& section) {
    std::vector<ExperimentVariant> values;
    for (const toml::table* table : section.tables("variants")) {
        const Section variant(*table, "a variant", {"label", "set"});
        values.push_back(
            {label_of(variant.required_node("label"), "label"), read_settings(variant, "set")});
    }
    return values;
}

std::vector<ExperimentVariant> read_values(const Section& section) {
    std::vector<ExperimentVariant> values;
    const std::string key = section.required_text("key");
    const toml::node& list = section.required_node("values");
    if (!list.is_array()) section.fail("values", "'values' in [[sweeps]], expected an array");
    for (const toml::node& element : *list.as_array())
        values.push_back({label_of(element, "values"), {{key, value_text(element, "values")}}});
    return values;
}

void check_labels(const Section& section, const ExperimentAxis& axis) {
    if (axis.values.empty())
        section.fail("name", fmt::format("'{}' in {} has no values", axis.name, section.label()));
    for (auto value = axis.values.begin(); value != axis.values.end(); ++value) {
        if (std::any_of(axis.values.begin(), value,
                        [&](const auto& other) { return other.label == value->label; }))
            section.fail("name", fmt::format("'{}' in {} has the value '{}' twice", axis.name,
                                             section.label(), value->label));
    }
}

ExperimentAxis read_sweep(const toml::table& table) {
    const Section section(table, "[[sweeps]]",
                          {"name", "key", "values", "variants", "quick", "test_only"});
    ExperimentAxis axis;
    axis.name = section.required_text("name");
    axis.test_only = section.boolean("test_only").value_or(false);
    if (section.has("key") == section.has("variants"))
        section.fail("key", "[[sweeps]] needs 'key' and 'values', or 'variants'");
    axis.values = section.has("key") ? read_values(section) : read_variants(section);
    check_labels(section, axis);
    read_quick(section, axis);
    return axis;
}

}  // namespace

std::vector<ExperimentSetting> read_settings(const Section& section, std::string_view key) {
    std::vector<ExperimentSetting> settings;
    const toml::table* table = section.table(key);
    if (table == nullptr) return settings;
    for (const auto& [name, node] : *table)
        settings.push_back({std::string(name.str()), value_text(node, name.str())});
    return settings;
}

void read_scenes(const Section& root, const std::filesystem::path& directory,
                 Experiment& experiment) {
    ExperimentAxis axis;
    axis.name = kSceneAxis;
    for (const toml::table* table : root.tables("scenes")) {
        const Section section(*table, "[[scenes]]", {"name", "file", "set", "quick"});
        const std::filesystem::path file = directory / section.required_text("file");
        std::error_code ignored;
        if (!std::filesystem::is_regular_file(file, ignored))
            section.fail("file",
                         fmt::format("'file' in [[scenes]]: {} is not there", file.string()));
        axis.values.push_back({section.text("name").value_or(file.stem().string()),
                               read_settings(section, "set"),
                               section.boolean("quick").value_or(true)});
        experiment.scenes.push_back(file);
    }
    if (axis.values.empty()) root.fail("scenes", "the experiment has no [[scenes]]");
    check_labels(root, axis);
    experiment.axes.push_back(std::move(axis));
}

void read_sweeps(const Section& root, Experiment& experiment) {
    for (const toml::table* table : root.tables("sweeps")) {
        ExperimentAxis axis = read_sweep(*table);
        for (const ExperimentAxis& other : experiment.axes) {
            if (other.name == axis.name)
                fail_at(*table, fmt::format("second axis with the name '{}'", axis.name));
        }
        experiment.axes.push_back(std::move(axis));
    }
}

const ExperimentAxis& Axes::named(const Section& section, std::string_view key,
                                  std::string_view name) const {
    std::vector<std::string_view> known;
    for (const ExperimentAxis& axis : m_axes) {
        if (axis.name == name) return axis;
        known.push_back(axis.name);
    }
    section.fail(key, fmt::format("'{}' in {}: no axis '{}', {}", key, section.label(), name,
                                  expected_one_of(name, known)));
}

std::string Axes::required_axis(const Section& section, std::string_view key) const {
    return named(section, key, section.required_text(key)).name;
}

ExperimentChoice Axes::read_choice(const Section& section, std::string_view key) const {
    ExperimentChoice choice;
    const toml::table* table = section.table(key);
    if (table == nullptr) return choice;
    for (const auto& [name, node] : *table) {
        const ExperimentAxis& axis = named(section, key, name.str());
        std::vector<std::string> labels = labels_of(node, name.str());
        for (const std::string& label : labels) {
            if (std::none_of(axis.values.begin(), axis.values.end(),
                             [&](const auto& value) { return value.label == label; }))
                fail_unknown_label(section, key, label, axis);
        }
        choice.emplace_back(axis.name, std::move(labels));
    }
    return choice;
}

}  // namespace burnish
