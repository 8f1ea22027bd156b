#pragma once

#include <array>
#include <charconv>
#include <string>

namespace burnish {

/// The shortest digits that a parser turns into `x` again, without an exponent, which the languages
/// do not have. `x` is finite.
inline std::string print_number(float x) {
    std::array<char, 128> digits;  // 2^-149 takes 50
    const auto result = std::to_chars(digits.data(), digits.data() + digits.size(),
                                      x == 0.0F ? 0.0F : x, std::chars_format::fixed);
    return {digits.data(), result.ptr};
}

}  // namespace burnish
