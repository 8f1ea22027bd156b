#include "app/options/words.hpp"

#include <fmt/format.h>

#include <burnish/error.hpp>

#include "app/options/numbers.hpp"
#include "core/nearest.hpp"

namespace burnish::app {

std::string known_word(const std::string& option, const std::string& word,
                       std::span<const std::string_view> known) {
    for (const std::string_view name : known)
        if (name == word) return word;
    throw Error(ErrorCode::bad_option,
                fmt::format("{} {}, {}", option, word, expected_one_of(word, known)));
}

MaterialMipmaps parse_mipmaps(const std::string& option, const std::string& text) {
    const std::size_t colon = text.find(':');
    const std::string name = text.substr(0, colon);
    MaterialMipmaps mipmaps;
    mipmaps.method = *mip_method_named(known_word(option, name, mip_method_names()));
    if (colon == std::string::npos) return mipmaps;
    const std::string bits = text.substr(colon + 1);
    if (bits != "8" && bits != "16" && bits != "32")
        refuse(option, text, "8, 16 or 32 bits after the colon");
    mipmaps.bits = std::stoi(bits);
    return mipmaps;
}

std::vector<std::string_view> filtering_mip_methods() {
    std::vector<std::string_view> names = mip_method_names();
    std::erase(names, "none");
    std::erase(names, "maps");
    return names;
}

}  // namespace burnish::app
