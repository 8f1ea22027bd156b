#pragma once

#include <burnish/texture.hpp>
#include <cstddef>

namespace burnish {

/// A level of a material map, looked at from the texel centres of a grid of another size. Weights
/// are exact: positions are fractions of integers.
class MapSampler {
  public:
    /// Looks at `map`, two-dimensional, from a grid of width x height.
    MapSampler(const Texture& map, std::size_t level, int width, int height)
        : m_sampler(&map.sampler()),
          m_level(map.levels()[level]),
          m_width(width),
          m_height(height) {}

    /// The map at the centre of the grid's texel (x, y), filtered as its sampler says where texels
    /// are larger than pixels. `value_of(i, j)` is what the map's texel (i, j) stands for; with
    /// (-1, -1) it is asked for the border. Of a grid of the map's size it is value_of(x, y).
    template <class ValueOf>
    [[nodiscard]] auto at(int x, int y, const ValueOf& value_of) const {
        if (m_width == m_level.width && m_height == m_level.height) return value_of(x, y);
        const Sampler& sampler = *m_sampler;
        const Axis s = axis(x, m_width, m_level.width);
        const Axis t = axis(y, m_height, m_level.height);
        const auto value = [&](int i, int j) {
            const int column = wrapped(i, m_level.width, sampler.wrap_s);
            const int row = wrapped(j, m_level.height, sampler.wrap_t);
            return column < 0 || row < 0 ? value_of(-1, -1) : value_of(column, row);
        };
        if (!sampler.mag_is_linear()) return value(s.nearest, t.nearest);
        if (s.weight == 0.0 && t.weight == 0.0) return value(s.lower, t.lower);
        const auto upper =
            value(s.lower, t.lower) * (1.0 - s.weight) + value(s.lower + 1, t.lower) * s.weight;
        const auto lower = value(s.lower, t.lower + 1) * (1.0 - s.weight) +
                           value(s.lower + 1, t.lower + 1) * s.weight;
        return upper * (1.0 - t.weight) + lower * t.weight;
    }

  private:
    struct Axis {
        int nearest;    ///< the texel that the position lies in
        int lower;      ///< first of the two whose centres are around it
        double weight;  ///< of the second, [0, 1)
    };
    /// Position (at + 1/2) / grid of the axis.
    static Axis axis(int at, int grid, int size);
    /// -1: the border.
    static int wrapped(int at, int size, Wrap wrap);

    const Sampler* m_sampler;
    TextureLevel m_level;
    int m_width, m_height;
};

}  // namespace burnish
