#include "models/map_sampler.hpp"

#include <cstdint>

namespace burnish {

MapSampler::Axis MapSampler::axis(int at, int grid, int size) {
    // Texels times 2 grid: (2 at + 1) size; centres lie half a texel on.
    const std::int64_t unit = 2 * static_cast<std::int64_t>(grid);
    const std::int64_t position = (2 * static_cast<std::int64_t>(at) + 1) * size;
    const std::int64_t from_first_centre = position - grid + unit;  // one texel more: not negative
    const std::int64_t rest = from_first_centre % unit;
    return {static_cast<int>(position / unit), static_cast<int>(from_first_centre / unit) - 1,
            static_cast<double>(rest) / static_cast<double>(unit)};
}

int MapSampler::wrapped(int at, int size, Wrap wrap) {
    if (at >= 0 && at < size) return at;
    switch (wrap) {
        case Wrap::repeat:
            return at < 0 ? size - 1 : 0;
        case Wrap::clamp_to_edge:
        case Wrap::mirrored_repeat:
            return at < 0 ? 0 : size - 1;
        case Wrap::clamp_to_border:
            break;
    }
    return -1;
}

}  // namespace burnish
