#include "shade/pixel_list.hpp"

#include <bit>

namespace burnish {

namespace {

/// Calls f(index of the first pixel, word) for every block that has pixels.
template <class F>
void for_each_block(const PixelMask& mask, F&& f) {
    for (std::uint64_t rest = mask.blocks; rest != 0; rest &= rest - 1) {
        const int block = std::countr_zero(rest);
        f(block * kBlockPixels, mask.word[static_cast<std::size_t>(block)]);
    }
}

}  // namespace

void list_pixels(const PixelMask& mask, PixelList& out) {
    std::uint16_t* to = out.shaded;
    for_each_block(mask, [&](int first, std::uint64_t word) {
        if (word == ~std::uint64_t{0}) {
            for (int i = 0; i < kBlockPixels; ++i) to[i] = static_cast<std::uint16_t>(first + i);
            to += kBlockPixels;
            return;
        }
        for (; word != 0; word &= word - 1) {
            *to++ = static_cast<std::uint16_t>(first + std::countr_zero(word));
        }
    });
    out.count = static_cast<int>(to - out.shaded);
}

void list_quads(const PixelMask& mask, PixelList& out) {
    constexpr std::uint64_t kUpperLeft = 0x0055005500550055U;
    constexpr int kOffset[4] = {0, 1, kBlockSize, kBlockSize + 1};
    int n = 0;
    for_each_block(mask, [&](int first, std::uint64_t word) {
        std::uint64_t quads = word | word >> 1;
        quads = (quads | quads >> kBlockSize) & kUpperLeft;
        for (; quads != 0; quads &= quads - 1) {
            const int corner = std::countr_zero(quads);
            for (const int offset : kOffset) {
                const auto pixel = static_cast<std::uint16_t>(first + corner + offset);
                out.shaded[n] = pixel;
                out.stored[n++] = (word >> (corner + offset) & 1) != 0 ? pixel : kNoPixel;
            }
        }
    });
    out.count = n;
}

void mask_pixels(const std::uint16_t* pixels, int count, PixelMask& out) {
    out.blocks = 0;
    for (int i = 0; i < count; ++i) {
        const std::uint64_t block = std::uint64_t{1} << pixels[i] / kBlockPixels;
        std::uint64_t& word = out.word[pixels[i] / kBlockPixels];
        if ((out.blocks & block) == 0) word = 0;
        out.blocks |= block;
        word |= std::uint64_t{1} << pixels[i] % kBlockPixels;
    }
}

}  // namespace burnish
