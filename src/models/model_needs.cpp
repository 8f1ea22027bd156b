#include "models/model_needs.hpp"

#include <fmt/format.h>

#include <string_view>
#include <vector>

namespace burnish {

std::string shortages(const ModelNeeds& needs, const Machine& machine) {
    std::vector<std::string> all;
    const auto add = [&](const std::string& what, std::string_view has) {
        all.push_back(
            fmt::format("needs {}, {} has {}", what, all.empty() ? "the machine" : "it", has));
    };
    const auto counted = [](int count, std::string_view what) {
        return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
    };
    if (needs.tables > 0 && !machine.stage_fetches) {
        const bool plain = machine.texture_operations == TextureOperations::plain;
        add(counted(needs.tables, "dependent table"),
            plain ? "no dependent fetch" : "no fetch between general stages");
    }
    if (needs.units > machine.texture_units) {
        const bool cube = machine.half_vector == HalfVector::cube;
        add(counted(needs.units, "texture unit"),
            fmt::format("{}{}", machine.texture_units,
                        cube ? " besides the one that normalises half vectors" : ""));
    }
    if (needs.stages > machine.general_stages)
        add(counted(needs.stages, "general stage"), fmt::format("{}", machine.general_stages));
    if (needs.stage_constants && !machine.stage_constants)
        add("constants that differ from stage to stage", "one pair for all");
    if (needs.third_vector && machine.texture_operations == TextureOperations::plain)
        add("three vectors at a pixel", "colours for two and no pass_through");
    return fmt::format("{}", fmt::join(all, "; "));
}

}  // namespace burnish
