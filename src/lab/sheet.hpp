#pragma once

#include <burnish/framebuffer.hpp>
#include <burnish/texture.hpp>

namespace burnish::lab {

/// Pictures of one size side by side, a gap of four dark pixels between them.
class Sheet {
  public:
    /// All grey: what stays where no picture is placed.
    Sheet(int columns, int rows, int cell_width, int cell_height);

    /// Puts an rgba8 frame of twice the cell's size there, each pixel the mean of four, opaque.
    void place(int column, int row, const Framebuffer& frame);

    [[nodiscard]] const Image8& image() const { return m_image; }

  private:
    int m_cell_width, m_cell_height;
    Image8 m_image;
};

}  // namespace burnish::lab
