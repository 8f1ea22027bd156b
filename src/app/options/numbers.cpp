#include "app/options/numbers.hpp"

namespace burnish::app {

void refuse(const std::string& option, const std::string& text, const std::string& expected) {
    throw Error(ErrorCode::bad_option, fmt::format("{} {}, expected {}", option, text, expected));
}

glm::vec3 parse_vec3(const std::string& option, const std::string& text) {
    const std::vector<float> v = parse_numbers(option, text, 3, 3);
    return {v[0], v[1], v[2]};
}

bool parse_pair(const std::string& text, char separator, glm::ivec2& pair) {
    const char* const end = text.data() + text.size();
    const auto [middle, bad_first] = std::from_chars(text.data(), end, pair.x);
    if (bad_first != std::errc() || middle == end || *middle != separator) return false;
    const auto [stop, bad_second] = std::from_chars(middle + 1, end, pair.y);
    return bad_second == std::errc() && stop == end && pair.x >= 0 && pair.y >= 0;
}

}  // namespace burnish::app
