#include "app/options/threshold.hpp"

#include "app/options/numbers.hpp"
#include "app/options/words.hpp"

namespace burnish::app {
namespace {

Threshold parse_threshold(const std::string& option, const std::string& text) {
    const std::size_t sign = text.find('=');
    if (sign == std::string::npos) refuse(option, text, "NAME=VALUE, such as rmse=0.01");
    const std::string name = known_word(option, text.substr(0, sign), metrics::metric_names());
    const std::string number = text.substr(sign + 1);
    return {*metrics::metric_named(name),
            parse_numbers<double>(option + " " + name, number, 1, 1).front()};
}

/// "rmse="
std::vector<std::string_view> limit_words() {
    static const std::vector<std::string> kOwned = [] {
        std::vector<std::string> words;
        for (const std::string_view name : metrics::metric_names())
            words.push_back(std::string(name) + "=");
        return words;
    }();
    return {kOwned.begin(), kOwned.end()};
}

}  // namespace

Option threshold_option(std::vector<Threshold>& thresholds) {
    return {
        .names = "--threshold",
        .value = "NAME=VALUE",
        .text =
            "Exit code 1 if a metric is worse; of bias and energy_ratio, the distance from 0 and 1",
        .words = limit_words(),
        .open_words = true,
        .repeated = true,
        .separator = ',',
        .set = [&thresholds](const std::string& option, const std::string& text) {
            thresholds.push_back(parse_threshold(option, text));
        }};
}

Option reference_threshold_option(std::vector<Threshold>& limits) {
    return {.names = "--reference-threshold",
            .value = "NAME=VALUE",
            .text =
                "What --reference allows, as --threshold of compare: rmse=0.01,flip=0.05; a "
                "number alone is meant for rmse",
            .normal = "max=0, the same picture",
            .words = limit_words(),
            .open_words = true,
            .repeated = true,
            .separator = ',',
            .needs = "--reference",
            .set = [&limits](const std::string& option, const std::string& text) {
                const bool alone = text.find_first_not_of("0123456789.") == std::string::npos;
                limits.push_back(parse_threshold(option, alone ? "rmse=" + text : text));
            }};
}

}  // namespace burnish::app
