#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <vector>

#include "core/cpu.hpp"
#include "kernel_packet.hpp"

/// One set of kernels per test: each is compared with the scalar reference, bit for bit.
namespace burnish {

class KernelTest : public testing::TestWithParam<const KernelTable*> {
  protected:
    static const KernelTable& table() { return *GetParam(); }
    /// Beginning of a failure line.
    static std::string name(const char* stage) { return std::string(table().isa) + " " + stage; }
};

inline std::string isa_name(const testing::TestParamInfo<const KernelTable*>& info) {
    return info.param->isa;
}

inline auto every_table() {
    const auto tables = available_tables();
    return testing::ValuesIn(tables.begin(), tables.end());
}

inline constexpr float kInfinity = std::numeric_limits<float>::infinity();
inline constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// Numbers that break careless arithmetic.
inline constexpr std::array<float, 24> kWild{
    0.0F,   -0.0F,    1.0F,      -1.0F,      0.5F,  -0.75F, 1e-45F, 1e-38F,
    1e-20F, 1e20F,    3e38F,     -3e38F,     kNan,  -kNan,  3.0F,   -2.0F,
    2.1e9F, 65536.0F, kInfinity, -kInfinity, 1e-8F, 0.999F, 255.0F, -1e-3F};

/// Gives `packet` a random number of fragments, half of the time of pixels out of order, and runs
/// that cover them, at places in and around a large frame.
inline std::vector<Run> random_runs(PacketMemory& packet, Random& random) {
    packet.count = random.chance(3) ? kPacketSize : random.between(1, kPacketSize);
    if (random.chance(2)) packet.shuffle_pixels(random);
    std::vector<Run> runs;
    const int longest = random.chance(2) ? 9 : 200;
    for (int first = 0; first < packet.count;) {
        const int length = std::min(packet.count - first, random.between(1, longest));
        runs.push_back({first, length, random.between(-8192, 24576), random.between(-8192, 24576)});
        first += length;
    }
    return runs;
}

}  // namespace burnish
