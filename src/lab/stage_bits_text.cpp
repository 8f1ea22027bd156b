#include "lab/stage_bits_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <burnish/error.hpp>
#include <charconv>
#include <optional>
#include <utility>
#include <vector>

#include "core/nearest.hpp"

namespace burnish::lab {

namespace {

struct NamedStage {
    std::string_view name;
    int StageBits::*field;
};
constexpr std::array<NamedStage, 8> kStages{{{"half_vector", &StageBits::half_vector},
                                             {"textures", &StageBits::textures},
                                             {"filter", &StageBits::filter},
                                             {"combiners", &StageBits::combiners},
                                             {"table", &StageBits::table},
                                             {"table_index", &StageBits::table_index},
                                             {"table_values", &StageBits::table_values},
                                             {"frame", &StageBits::frame}}};
constexpr std::array<std::string_view, 4> kRoundings{"nearest", "truncate", "shift8", "stochastic"};
constexpr std::array<std::string_view, 3> kAxes{"lobe", "unit", "log"};
constexpr std::array<std::string_view, 2> kFilters{"nearest", "linear"};
constexpr std::size_t kMostStages = 16;

[[noreturn]] void fail(const std::string& what) {
    throw Error(ErrorCode::bad_option, what);
}

std::optional<int> whole_number(std::string_view text) {
    int value = 0;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (failure != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return value;
}

int parse_bits(std::string_view key, std::string_view text, int fewest) {
    if (text == "exact") return kExactBits;
    const std::optional<int> bits = whole_number(text);
    if (bits && *bits >= fewest && *bits <= kMostBits) return *bits;
    fail(fmt::format("bits of {}: '{}', expected {} .. {} or exact", key, text, fewest, kMostBits));
}

/// Which of `names` it is.
template <std::size_t Count>
std::size_t parse_name(std::string_view key, std::string_view text,
                       const std::array<std::string_view, Count>& names) {
    const auto at = std::find(names.begin(), names.end(), text);
    if (at == names.end())
        fail(fmt::format("{} '{}', expected one of {}", key, text, fmt::join(names, ", ")));
    return static_cast<std::size_t>(at - names.begin());
}

}  // namespace

void set_stage_bits(StageBits& bits, std::string_view key, std::string_view value) {
    if (key == "rounding") {
        bits.rounding = static_cast<BitRounding>(parse_name(key, value, kRoundings));
        return;
    }
    if (key == "table_axis") {
        bits.table_axis = static_cast<TableSpacing>(parse_name(key, value, kAxes));
        return;
    }
    if (key == "table_filter") {
        bits.table_linear = parse_name(key, value, kFilters) == 1;
        return;
    }
    for (const NamedStage& stage : kStages) {
        if (stage.name != key) continue;
        const bool is_signed = stage.field == &StageBits::combiners;
        bits.*stage.field = parse_bits(key, value, is_signed ? 2 : 1);
        if (is_signed) bits.combiner_stages.clear();
        return;
    }
    constexpr std::string_view kOne = "stage";
    const std::optional<int> number =
        key.starts_with(kOne) ? whole_number(key.substr(kOne.size())) : std::nullopt;
    if (!number || *number < 0 || *number >= static_cast<int>(kMostStages)) {
        std::string listed;
        std::vector<std::string_view> names{"rounding", "table_axis", "table_filter"};
        for (const NamedStage& stage : kStages) {
            listed += fmt::format("{}, ", stage.name);
            names.push_back(stage.name);
        }
        const std::string_view near = nearest_name(key, names);
        fail(fmt::format(
            "bits of '{}', expected {}stage0 .. stage{}, table_axis, table_filter or rounding{}",
            key, listed, kMostStages - 1,
            near.empty() ? "" : fmt::format(", did you mean '{}'?", near)));
    }
    const auto at = static_cast<std::size_t>(*number);
    while (bits.combiner_stages.size() <= at) bits.combiner_stages.push_back(bits.combiners);
    bits.combiner_stages[at] = parse_bits(key, value, 2);
}

void set_stage_bits(StageBits& bits, std::string_view text) {
    if (const std::optional<int> all = whole_number(text)) {
        if (*all < 1 || *all >= kMostBits)
            fail(fmt::format("bits '{}', expected 1 .. {} or KEY=VALUE,..", text, kMostBits - 1));
        bits.half_vector = bits.textures = bits.filter = bits.table = bits.frame = *all;
        bits.combiners = *all + 1;
        bits.combiner_stages.clear();
        return;
    }
    while (!text.empty()) {
        const std::string_view item = text.substr(0, text.find(','));
        text.remove_prefix(std::min(item.size() + 1, text.size()));
        const std::size_t equals = item.find('=');
        if (equals == std::string_view::npos)
            fail(fmt::format("bits '{}', expected a number or KEY=VALUE,..", item));
        set_stage_bits(bits, item.substr(0, equals), item.substr(equals + 1));
    }
}

std::string bits_text(int bits) {
    return bits == kExactBits ? "exact" : fmt::format("{}", bits);
}

std::string_view rounding_name(BitRounding rounding) {
    return kRoundings.at(static_cast<std::size_t>(rounding));
}

}  // namespace burnish::lab
