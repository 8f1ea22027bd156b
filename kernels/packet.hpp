#pragma once

#include <cstdint>

/// What the kernels work on. Contract header: plain data, no functions.
namespace burnish {

inline constexpr int kTileSize = 64;                          ///< pixels, both ways
inline constexpr int kTilePixels = kTileSize * kTileSize;     ///< 4096
inline constexpr int kBlockSize = 8;                          ///< pixels, both ways
inline constexpr int kBlockPixels = kBlockSize * kBlockSize;  ///< 64
inline constexpr int kTileBlocks = kTilePixels / kBlockPixels;
inline constexpr std::uint32_t kNoTriangle = 0xffffffffU;
/// In a packet's list of pixels: a fragment that is shaded and not stored. What the pixels of a
/// tile go to has room for one more at this index, which may hold anything.
inline constexpr std::uint16_t kNoPixel = kTilePixels;

/// Fragments in a packet, at most. Smaller packets pay more often for what a stage does before its
/// first fragment, and wait for stores of the one before; larger ones gain no more
/// (docs/performance.md).
inline constexpr int kPacketSize = 512;
/// Kernels compute whole groups of this many fragments; what lies beyond `Packet::count` is
/// garbage.
inline constexpr int kFragmentGroup = 32;
/// Values from one attribute plane to the next. Kernels may read up to 16 pixels and write up to 16
/// values past a run.
inline constexpr int kAttributeStride = kPacketSize + 16;

/// Pixels of a tile are numbered block by block, row by row inside a block:
/// index = (y / 8 * 8 + x / 8) * 64 + (y % 8) * 8 + x % 8, so that a whole block is contiguous.

/// Fragments of one material and tile, structure of arrays; one worker's scratch memory. All
/// pointers but `pixels` are aligned to 64 bytes.
struct Packet {
    int count;  ///< fragments in use, 1 .. kPacketSize
    /// Index within the tile, 0 .. kTilePixels - 1. Of those that are stored no two are alike; the
    /// others have kNoPixel once colours are stored.
    const std::uint16_t* pixels;
    float* attributes;       ///< plane k begins at attributes + k * kAttributeStride
    std::int16_t* planes;    ///< register plane k begins at planes + k * kPacketSize
    std::int32_t* texel;     ///< byte offset of the upper left texel from the first one
    std::int16_t* weight_x;  ///< of the right texels, 0 .. 255: 1/256
    std::int16_t* weight_y;  ///< of the lower texels, 0 .. 255: 1/256
};

}  // namespace burnish
