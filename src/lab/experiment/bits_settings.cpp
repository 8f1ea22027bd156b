#include "lab/experiment/bits_settings.hpp"

#include <fmt/format.h>

#include <burnish/error.hpp>
#include <string_view>

#include "lab/stage_bits_text.hpp"

namespace burnish::lab {
namespace {

constexpr std::string_view kPrefix = "bits.";

/// A word without its quotation marks, anything else as it is.
std::string_view unquoted(std::string_view value) {
    const bool quoted = value.size() >= 2 && value.front() == '"' && value.back() == '"';
    return quoted ? value.substr(1, value.size() - 2) : value;
}

}  // namespace

std::optional<StageBits> bits_of(const std::vector<ExperimentSetting>& settings) {
    std::optional<StageBits> bits;
    for (const ExperimentSetting& setting : settings) {
        if (!setting.key.starts_with(kPrefix)) continue;
        if (!bits) bits.emplace();
        try {
            set_stage_bits(*bits, std::string_view(setting.key).substr(kPrefix.size()),
                           unquoted(setting.value));
        } catch (const Error& error) {
            throw Error(ErrorCode::bad_input,
                        fmt::format("{} = {}: {}", setting.key, setting.value, error.what()));
        }
    }
    return bits;
}

}  // namespace burnish::lab
