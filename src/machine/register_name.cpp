#include <array>
#include <burnish/combiner.hpp>
#include <string_view>

namespace burnish {
namespace {

/// In the order of the enumeration.
constexpr std::array<std::string_view, static_cast<std::size_t>(Register::discard) + 1> kNames{
    "zero",  "const0", "const1", "fog",       "col0",          "col1",   "tex0",
    "tex1",  "tex2",   "tex3",   "tex4",      "tex5",          "tex6",   "tex7",
    "tex8",  "tex9",   "tex10",  "tex11",     "tex12",         "tex13",  "tex14",
    "tex15", "spare0", "spare1", "color_sum", "final_product", "discard"};

}  // namespace

std::string_view register_name(Register reg) {
    const auto index = static_cast<std::size_t>(reg);
    return index < kNames.size() ? kNames[index] : "unknown register";
}

}  // namespace burnish
