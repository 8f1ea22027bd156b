#pragma once

#include <array>
#include <string_view>

namespace burnish {

/// What sets the two languages for combiners apart. !!BRN1.0 has, beyond these numbers, `wide`,
/// `fetch`, and a third output after dot products.
struct Dialect {
    std::string_view header;
    int units;
    int stages;
    bool extended;
};

inline constexpr Dialect kRc10{"!!RC1.0", 4, 8, false};
inline constexpr Dialect kBrn10{"!!BRN1.0", 16, 16, true};

}  // namespace burnish
