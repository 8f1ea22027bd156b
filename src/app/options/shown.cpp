#include <fmt/format.h>

#include <array>
#include <burnish/error.hpp>
#include <charconv>

#include "app/options/groups.hpp"
#include "app/options/numbers.hpp"
#include "core/nearest.hpp"

namespace burnish::app {
namespace {

constexpr std::array<std::pair<std::string_view, Aov>, 7> kAovs{{{"depth", Aov::depth},
                                                                 {"normal", Aov::normal},
                                                                 {"tangent", Aov::tangent},
                                                                 {"bitangent", Aov::bitangent},
                                                                 {"stripes", Aov::stripes},
                                                                 {"uv", Aov::uv},
                                                                 {"triangle", Aov::triangle}}};
constexpr std::string_view kRegister = "register:";

Register parse_register(const std::string& option, const std::string& name) {
    std::vector<std::string_view> known;
    for (int r = 0; r < static_cast<int>(Register::discard); ++r) {
        const auto reg = static_cast<Register>(r);
        if (register_name(reg) == name) return reg;
        known.push_back(register_name(reg));
    }
    throw Error(ErrorCode::bad_option, fmt::format("{}: unknown register '{}', {}", option, name,
                                                   expected_one_of(name, known)));
}

/// register:NAME, register:NAME@STAGE, register:NAME@inputs or register:NAME@final.
ShownRegister parse_shown_register(const std::string& option, const std::string& text) {
    const std::string_view rest = std::string_view(text).substr(kRegister.size());
    const std::size_t at = rest.find('@');
    ShownRegister shown{.reg = parse_register(option, std::string(rest.substr(0, at)))};
    if (at == std::string_view::npos) return shown;
    const std::string_view place = rest.substr(at + 1);
    if (place == "final") return shown;
    if (place == "inputs") {
        shown.stages = 0;
        return shown;
    }
    std::size_t stage = 0;
    const char* const end = place.data() + place.size();
    const auto [stop, failure] = std::from_chars(place.data(), end, stage);
    if (failure != std::errc() || stop != end || stage >= ShownRegister::kAllStages) {
        refuse(option, text,
               fmt::format("a stage of 0 .. {}, inputs or final after @",
                           ShownRegister::kAllStages - 1));
    }
    shown.stages = stage + 1;
    return shown;
}

Shown parse_shown(const std::string& option, const std::string& text) {
    if (text.starts_with(kRegister)) return parse_shown_register(option, text);
    for (const auto& [name, aov] : kAovs)
        if (text == name) return aov;
    refuse(option, text,
           "depth, normal, tangent, bitangent, stripes, uv, triangle, register:NAME or "
           "register:NAME@STAGE");
}

}  // namespace

Option shown_option(std::optional<Shown>& shown) {
    std::vector<std::string_view> words;
    for (const auto& [name, aov] : kAovs) words.push_back(name);
    words.push_back(kRegister);
    return {.names = "--aov",
            .value = "WHAT",
            .text =
                "Shown instead of colours: depth, normal, tangent, bitangent, stripes, uv, "
                "triangle, or a register, e.g. register:spare0@1 after stage 1, ...@inputs, "
                "@final",
            .words = words,
            .open_words = true,
            .set = [&shown](const std::string& option, const std::string& text) {
                shown = parse_shown(option, text);
            }};
}

}  // namespace burnish::app
