#pragma once

#include <burnish/machine.hpp>
#include <burnish/texture.hpp>

namespace burnish {

/// A cube map that normalises the direction which addresses it: the texel at direction d holds
/// d / |d| as x/2 + 1/2, to 8, 9 or 16 bits (docs/numbers.md). `size`: texels a side, 1 or more.
TexturePtr normalisation_cube(int size, int bits);

/// The one that a machine's half vectors go through, kept from frame to frame.
class HalfVectorCube {
  public:
    /// Null where the machine has none.
    TexturePtr of(const Machine& machine);

  private:
    int m_size = 0, m_bits = 0;
    TexturePtr m_cube;
};

}  // namespace burnish
