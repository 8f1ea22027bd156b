#include "models/mips/parameter_mips.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <burnish/error.hpp>
#include <cstddef>

#include "core/covered.hpp"
#include "core/tile_watch.hpp"
#include "models/mips/filtered_texel.hpp"
#include "models/mips/texel_moments.hpp"

namespace burnish::mips {

namespace {

struct MomentGrid {
    int width, height;
    std::vector<TexelMoments> texels;

    [[nodiscard]] const TexelMoments& at(int x, int y) const {
        return texels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                      static_cast<std::size_t>(x)];
    }
};

/// The level after one of width x height whose texels are from(x, y).
template <class From>
MomentGrid next_level(int width, int height, MipMethod method, const MomentStorage& storage,
                      const std::function<bool()>& stop, const From& from) {
    MomentGrid next{std::max(width / 2, 1), std::max(height / 2, 1), {}};
    next.texels.reserve(static_cast<std::size_t>(next.width) *
                        static_cast<std::size_t>(next.height));
    for (int y = 0; y < next.height; ++y) {
        require_wanted(stop);
        const Covered rows(height, next.height, y);
        for (int x = 0; x < next.width; ++x) {
            const Covered columns(width, next.width, x);
            MomentSum sum(method);
            for (int j = rows.first; j <= rows.last; ++j) {
                for (int i = columns.first; i <= columns.last; ++i)
                    sum.add(from(i, j), static_cast<double>(rows.weight(j) * columns.weight(i)));
            }
            next.texels.push_back(storage.stored(sum.mean()));
        }
    }
    return next;
}

}  // namespace

void require_room(int width, int height) {
    constexpr std::size_t kMost = std::size_t{2} << 30;
    const std::size_t texels =
        static_cast<std::size_t>(width / 2) * static_cast<std::size_t>(height / 2);
    if (texels * (sizeof(TexelMoments) + sizeof(TexelParameters)) <= kMost) return;
    throw Error(ErrorCode::limit,
                fmt::format("mip levels of a material of {} x {} texels take more than 2 GiB, "
                            "expected smaller maps or no 'mipmaps' of the material",
                            width, height));
}

std::vector<ParameterGrid> parameter_mips(const TexelReader& level0, int width, int height,
                                          const LobeShape& shape, const MaterialMipmaps& mipmaps,
                                          const std::function<bool()>& stop) {
    std::vector<ParameterGrid> levels;
    const MipMethod method = mipmaps.method;
    if (method == MipMethod::none || (width == 1 && height == 1)) return levels;
    require_room(width, height);
    MomentStorage storage(mipmaps.bits);
    const auto moments_at = [&](int x, int y) { return moments_of(level0(x, y), shape, method); };
    for (int y = 0; y < height && !storage.is_exact(); ++y) {
        require_wanted(stop);
        for (int x = 0; x < width; ++x) storage.include(moments_at(x, y));
    }
    MomentGrid grid = next_level(width, height, method, storage, stop,
                                 [&](int x, int y) { return storage.stored(moments_at(x, y)); });
    for (;;) {
        ParameterGrid& level = levels.emplace_back(ParameterGrid{grid.width, grid.height, {}});
        level.texels.reserve(grid.texels.size());
        for (const TexelMoments& m : grid.texels)
            level.texels.push_back(filtered_texel(m, shape, method, storage.least_variance()));
        if (grid.width == 1 && grid.height == 1) return levels;
        grid = next_level(grid.width, grid.height, method, storage, stop,
                          [&](int x, int y) -> const TexelMoments& { return grid.at(x, y); });
    }
}

}  // namespace burnish::mips
