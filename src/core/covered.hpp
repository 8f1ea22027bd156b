#pragma once

#include <algorithm>
#include <cstdint>

namespace burnish {

/// What texel `at` of a mip level of `size` covers along an axis: texels first .. last of `from` in
/// the level before, each by weight(), which add up to `from`.
struct Covered {
    int first, last;
    int from, size, at;

    Covered(int from_texels, int to_texels, int index)
        : first(static_cast<int>(std::int64_t{index} * from_texels / to_texels)),
          last(static_cast<int>(((std::int64_t{index} + 1) * from_texels - 1) / to_texels)),
          from(from_texels),
          size(to_texels),
          at(index) {}
    [[nodiscard]] std::int64_t weight(int texel) const {
        const std::int64_t low = std::max(std::int64_t{at} * from, std::int64_t{texel} * size);
        const std::int64_t high =
            std::min((std::int64_t{at} + 1) * from, (std::int64_t{texel} + 1) * size);
        return high - low;
    }
};

}  // namespace burnish
