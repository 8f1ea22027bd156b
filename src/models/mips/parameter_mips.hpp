#pragma once

#include <burnish/scene.hpp>
#include <functional>
#include <vector>

#include "models/mips/lobe_shape.hpp"
#include "models/texel.hpp"

namespace burnish::mips {

/// Parameters texel by texel, rows packed, row 0 on top.
struct ParameterGrid {
    int width = 1, height = 1;
    std::vector<TexelParameters> texels;

    [[nodiscard]] const TexelParameters& at(int x, int y) const {
        return texels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                      static_cast<std::size_t>(x)];
    }
};

/// Texel (x, y) of level 0.
using TexelReader = std::function<TexelParameters(int x, int y)>;

/// Throws Error{limit} for a material of so many texels that its levels would need more than 2 GiB:
/// beyond about 4400 x 4400.
void require_room(int width, int height);

/// Mip levels 1, 2, ... down to 1 x 1 of a material of width x height texels; none for
/// MipMethod::none; all others but MipMethod::maps are made here. Sides are half of those before,
/// rounded down, at least 1; a texel stands for what it covers of the level before. Level k is made
/// from what level k - 1 has stored, never from its parameters. In double, of + - * / and sqrt
/// alone: the same bits everywhere.
/// Throws what require_room() throws, and Error{stopped} when `stop`, which is asked for every row,
/// says so.
std::vector<ParameterGrid> parameter_mips(const TexelReader& level0, int width, int height,
                                          const LobeShape& shape, const MaterialMipmaps& mipmaps,
                                          const std::function<bool()>& stop = {});

}  // namespace burnish::mips
