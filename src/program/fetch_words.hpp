#pragma once

#include <array>
#include <string_view>

namespace burnish {

/// In the order of FetchTarget.
inline constexpr std::array<std::string_view, 5> kFetchWords{"table_1d", "table_2d", "table_3d",
                                                             "table_cube_map", "table_rectangle"};

}  // namespace burnish
