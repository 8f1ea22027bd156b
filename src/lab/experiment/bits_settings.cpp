#include "lab/experiment/bits_settings.hpp"

#include <fmt/format.h>

#include <array>
#include <burnish/error.hpp>
#include <charconv>
#include <string_view>
#include <utility>

#include "core/nearest.hpp"

namespace burnish::lab {
namespace {

constexpr std::string_view kPrefix = "bits.";
constexpr std::array<std::pair<std::string_view, int StageBits::*>, 6> kStages{
    {{"half_vector", &StageBits::half_vector},
     {"textures", &StageBits::textures},
     {"filter", &StageBits::filter},
     {"combiners", &StageBits::combiners},
     {"table", &StageBits::table},
     {"frame", &StageBits::frame}}};
constexpr std::array<std::pair<std::string_view, BitRounding>, 4> kRoundings{
    {{"\"nearest\"", BitRounding::nearest},
     {"\"truncate\"", BitRounding::truncate},
     {"\"shift8\"", BitRounding::shift8},
     {"\"stochastic\"", BitRounding::stochastic}}};

[[noreturn]] void fail(const ExperimentSetting& setting, std::string_view expected) {
    throw Error(ErrorCode::bad_input,
                fmt::format("{} = {}, expected {}", setting.key, setting.value, expected));
}

int read_bits(const ExperimentSetting& setting) {
    if (setting.value == "\"exact\"") return kExactBits;
    int bits = 0;
    const char* const end = setting.value.data() + setting.value.size();
    const auto [stop, failure] = std::from_chars(setting.value.data(), end, bits);
    if (failure != std::errc() || stop != end || bits < 1 || bits > kMostBits)
        fail(setting, fmt::format("an integer of 1 .. {} or \"exact\"", kMostBits));
    return bits;
}

BitRounding read_rounding(const ExperimentSetting& setting) {
    for (const auto& [word, rounding] : kRoundings)
        if (setting.value == word) return rounding;
    fail(setting, "nearest, truncate, shift8, stochastic");
}

}  // namespace

std::optional<StageBits> bits_of(const std::vector<ExperimentSetting>& settings) {
    std::optional<StageBits> bits;
    for (const ExperimentSetting& setting : settings) {
        if (!setting.key.starts_with(kPrefix)) continue;
        if (!bits) bits.emplace();
        const std::string_view stage = std::string_view(setting.key).substr(kPrefix.size());
        if (stage == "rounding") {
            bits->rounding = read_rounding(setting);
            continue;
        }
        std::vector<std::string_view> known{"rounding"};
        int StageBits::*member = nullptr;
        for (const auto& [name, of] : kStages) {
            known.push_back(name);
            if (name == stage) member = of;
        }
        if (member == nullptr)
            throw Error(ErrorCode::bad_input, fmt::format("unknown key '{}', {}", setting.key,
                                                          expected_one_of(stage, known)));
        (*bits).*member = read_bits(setting);
    }
    return bits;
}

}  // namespace burnish::lab
