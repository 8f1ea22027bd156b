#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "core/aligned.hpp"
#include "kernels/kernel_table.hpp"

/// Packets with known contents before a stage and a comparison after it, for the tests and the
/// benchmarks of the kernels.
namespace burnish {

/// Draws that are the same with every standard library.
struct Random {
    std::mt19937 engine;

    explicit Random(unsigned seed) : engine(seed) {}
    /// 0 .. n - 1
    int below(int n) { return static_cast<int>(engine() % static_cast<unsigned>(n)); }
    /// low .. high
    int between(int low, int high) { return low + below(high - low + 1); }
    bool chance(int one_in) { return below(one_in) == 0; }
    /// [0, 1) in steps of 2^-24
    float unit() { return static_cast<float>(engine() >> 8) * 0x1p-24F; }
    float real(float low, float high) { return low + (high - low) * unit(); }
    template <class List>
    auto pick(const List& list) {
        return list[static_cast<std::size_t>(below(static_cast<int>(list.size())))];
    }
};

/// Memory of one packet, all of it filled with poison that depends on the place.
struct PacketMemory {
    static constexpr int kBytes = 256;  ///< a count with which i is every byte
    static_assert(kBytes <= kPacketSize && kBytes % kFragmentGroup == 0);
    static constexpr int kPlanes = 40;
    static constexpr int kAttributes = 32;

    AlignedVector<std::uint16_t> pixels;
    AlignedVector<float> attributes;
    AlignedVector<std::int16_t> planes;
    AlignedVector<std::int32_t> texel;
    AlignedVector<std::int16_t> weight_x, weight_y;
    int count = kPacketSize;

    PacketMemory()
        : pixels(kPacketSize + 16),
          attributes(std::size_t{kAttributes} * kAttributeStride),
          planes(std::size_t{kPlanes} * kPacketSize),
          texel(kPacketSize),
          weight_x(kPacketSize),
          weight_y(kPacketSize) {
        for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] = static_cast<std::uint16_t>(i);
        for (std::size_t i = 0; i < attributes.size(); ++i)
            attributes[i] = -1000.0F - static_cast<float>(i);
        for (std::size_t i = 0; i < planes.size(); ++i)
            planes[i] = static_cast<std::int16_t>(-20000 - static_cast<int>(i) % 1009);
        for (std::size_t i = 0; i < texel.size(); ++i) {
            texel[i] = -7000 - static_cast<int>(i);
            weight_x[i] = static_cast<std::int16_t>(-300 - static_cast<int>(i));
            weight_y[i] = static_cast<std::int16_t>(-600 - static_cast<int>(i));
        }
    }

    std::int16_t* plane(int k) { return planes.data() + std::ptrdiff_t{k} * kPacketSize; }
    float* attribute(int k) { return attributes.data() + std::ptrdiff_t{k} * kAttributeStride; }
    Packet view() {
        return {count,        pixels.data(),   attributes.data(), planes.data(),
                texel.data(), weight_x.data(), weight_y.data()};
    }
    /// `count` pixels of the tile in any order, no two alike.
    void shuffle_pixels(Random& random) {
        std::vector<std::uint16_t> all(kTilePixels);
        for (int i = 0; i < kTilePixels; ++i) all[std::size_t(i)] = static_cast<std::uint16_t>(i);
        for (std::size_t i = 0; i < kPacketSize; ++i) {
            const auto left = static_cast<int>(all.size() - i);
            std::swap(all[i], all[i + static_cast<std::size_t>(random.below(left))]);
            pixels[i] = all[i];
        }
    }
};

/// Equations of a packet's runs, as AttributesCtx takes them.
struct Equations {
    explicit Equations(int attributes)
        : rows(std::size_t{3} * (static_cast<std::size_t>(attributes) + 1) * kAttributeStride) {}
    /// Equation e of run r.
    void set(int e, int r, const std::array<float, 3>& origin_dx_dy) {
        for (std::size_t c = 0; c < 3; ++c) {
            const std::size_t row = 3 * static_cast<std::size_t>(e) + c;
            rows[row * kAttributeStride + static_cast<std::size_t>(r)] = origin_dx_dy[c];
        }
    }
    [[nodiscard]] const float* data() const { return rows.data(); }

    AlignedVector<float> rows;
};

/// What a stage may change. Everything else keeps its bits, fragments past the group too.
struct Written {
    std::vector<int> planes = {};
    std::vector<int> attributes = {};
    bool addresses = false;
    int trash_plane = -1;  ///< of no interest afterwards
};

/// The first fragment past those that a kernel may write garbage to.
inline int end_of_group(int count) {
    return (count + kFragmentGroup - 1) / kFragmentGroup * kFragmentGroup;
}

inline bool same_bits(float a, float b) {
    return std::memcmp(&a, &b, sizeof a) == 0 || (std::isnan(a) && std::isnan(b));
}
inline bool same_bits(std::int32_t a, std::int32_t b) {
    return a == b;
}

namespace detail {

/// Compares elements 0 .. count - 1 and end .. size - 1; describes the first difference.
template <class T>
std::string array_difference(const char* what, int index, const T* got, const T* want, int count,
                             int end, int size) {
    for (int i = 0; i < size; ++i) {
        if (i == count) i = end;
        if (i >= size || same_bits(got[i], want[i])) continue;
        std::ostringstream text;
        text.precision(9);
        text << what << ' ' << index << ", fragment " << i << " of " << count << ": got " << got[i]
             << ", want " << want[i];
        return text.str();
    }
    return {};
}

inline bool contains(const std::vector<int>& list, int value) {
    return std::find(list.begin(), list.end(), value) != list.end();
}

}  // namespace detail

/// Empty if both packets agree wherever the contract says what must be there, else the first
/// difference.
inline std::string difference(PacketMemory& got, PacketMemory& want, const Written& written) {
    const int count = want.count;
    const int group = end_of_group(count);
    std::string text;
    for (int k = 0; k < PacketMemory::kPlanes && text.empty(); ++k) {
        const bool same =
            std::memcmp(got.plane(k), want.plane(k), kPacketSize * sizeof(std::int16_t)) == 0;
        if (same || k == written.trash_plane) continue;
        const int end = detail::contains(written.planes, k) ? group : count;
        text = detail::array_difference("plane", k, got.plane(k), want.plane(k), count, end,
                                        kPacketSize);
    }
    for (int k = 0; k < PacketMemory::kAttributes && text.empty(); ++k) {
        const bool same =
            std::memcmp(got.attribute(k), want.attribute(k), kAttributeStride * sizeof(float)) == 0;
        if (same) continue;
        const bool out = detail::contains(written.attributes, k);
        const int end = out ? std::max(group, count + 16) : count;
        text = detail::array_difference("attribute", k, got.attribute(k), want.attribute(k), count,
                                        end, kAttributeStride);
    }
    const int end = written.addresses ? group : count;
    const auto compare = [&](const char* what, const auto& g, const auto& w) {
        if (text.empty())
            text = detail::array_difference(what, 0, g.data(), w.data(), count, end, kPacketSize);
    };
    compare("texel", got.texel, want.texel);
    compare("weight_x", got.weight_x, want.weight_x);
    compare("weight_y", got.weight_y, want.weight_y);
    return text;
}

/// Runs `stage` of both tables on copies of `before`; describes the first difference.
template <class Ctx>
std::string stage_difference(const KernelTable& table,
                             void (*KernelTable::*stage)(Packet&, const Ctx&) noexcept,
                             const PacketMemory& before, const Ctx& ctx, const Written& written) {
    static PacketMemory got;
    static PacketMemory want;
    got = before;
    want = before;
    Packet got_view = got.view();
    Packet want_view = want.view();
    (table.*stage)(got_view, ctx);
    (table_reference().*stage)(want_view, ctx);
    return difference(got, want, written);
}

}  // namespace burnish
