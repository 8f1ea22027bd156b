#include "lab/sheet.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

namespace burnish::lab {

namespace {

constexpr int kGap = 4;
constexpr std::array<std::uint8_t, 4> kGapColor{16, 16, 18, 255};
constexpr std::array<std::uint8_t, 4> kEmptyColor{128, 128, 128, 255};

}  // namespace

Sheet::Sheet(int columns, int rows, int cell_width, int cell_height)
    : m_cell_width(cell_width),
      m_cell_height(cell_height),
      m_image(columns * (cell_width + kGap) - kGap, rows * (cell_height + kGap) - kGap) {
    for (int y = 0; y < m_image.height; ++y) {
        for (int x = 0; x < m_image.width; ++x) {
            const bool in_gap =
                x % (cell_width + kGap) >= cell_width || y % (cell_height + kGap) >= cell_height;
            const auto& color = in_gap ? kGapColor : kEmptyColor;
            std::copy(color.begin(), color.end(), m_image.at(x, y));
        }
    }
}

void Sheet::place(int column, int row, const Framebuffer& frame) {
    for (int y = 0; y < m_cell_height; ++y) {
        const auto* above = reinterpret_cast<const std::uint8_t*>(frame.row(2 * y));
        const auto* below = reinterpret_cast<const std::uint8_t*>(frame.row(2 * y + 1));
        for (int x = 0; x < m_cell_width; ++x) {
            std::uint8_t* to =
                m_image.at(column * (m_cell_width + kGap) + x, row * (m_cell_height + kGap) + y);
            for (int c = 0; c < 3; ++c) {
                const int i = 8 * x + c;
                to[c] = static_cast<std::uint8_t>(
                    (above[i] + above[i + 4] + below[i] + below[i + 4] + 2) / 4);
            }
        }
    }
}

}  // namespace burnish::lab
