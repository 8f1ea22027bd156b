#include "app/output_name.hpp"

#include <fmt/format.h>

#include <burnish/error.hpp>

namespace burnish::app {
namespace {

constexpr const char kOpening[] = "{frame";

}  // namespace

bool has_frame_number(const std::string& pattern) {
    return pattern.find(kOpening) != std::string::npos;
}

std::string numbered_name(const std::string& pattern, int frame) {
    std::string name;
    std::size_t at = 0;
    while (true) {
        const std::size_t open = pattern.find(kOpening, at);
        name += pattern.substr(at, open - at);
        if (open == std::string::npos) return name;
        const std::size_t close = pattern.find('}', open);
        const std::string inside =
            close == std::string::npos ? "?" : pattern.substr(open + 6, close - open - 6);
        const bool width_given =
            inside.size() == 2 && inside[0] == ':' && inside[1] >= '1' && inside[1] <= '9';
        if (!inside.empty() && !width_given)
            throw Error(
                ErrorCode::bad_option,
                fmt::format("-o {}, expected {{frame}} or {{frame:W}} with W = 1 .. 9", pattern));
        name += fmt::format("{:0{}}", frame, width_given ? inside[1] - '0' : 1);
        at = close + 1;
    }
}

}  // namespace burnish::app
