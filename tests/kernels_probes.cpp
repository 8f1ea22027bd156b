#include <array>
#include <cmath>
#include <vector>

#include "kernel_test.hpp"

/// Anisotropic footprints: probes along the longer axis, and the mean of what they see.
namespace burnish {
namespace {

INSTANTIATE_TEST_SUITE_P(Isa, KernelTest, every_table(), isa_name);

constexpr int kOut = 6, kProbes = 7, kStep = 8, kTo = 10, kSum = 12;

TEST_P(KernelTest, ProbesOfRandomRuns) {
    for (int seed = 0; seed < 1500; ++seed) {
        Random random(static_cast<unsigned>(seed));
        PacketMemory packet;
        const std::vector<burnish::Run> runs = random_runs(packet, random);
        // Whole numbers meet the borders between counts of probes.
        const bool whole = random.chance(3);
        Equations equations(4);
        for (int k = 0; k < 5 * static_cast<int>(runs.size()); ++k) {
            const auto slope = [&] {
                return whole ? static_cast<float>(random.between(-20, 20)) * 0.125F
                             : random.real(-0.1F, 0.1F);
            };
            std::array plane{random.real(-2.0F, 2.0F), slope(), slope()};
            if (k % 5 == 0 && whole) plane = {1.0F, 0.0F, 0.0F};
            if (random.chance(20)) plane = {0.0F, 0.0F, 0.0F};
            if (random.chance(20))
                plane = {random.pick(kWild), random.pick(kWild), random.pick(kWild)};
            equations.set(k % 5, k / 5, plane);
        }
        FootprintCtx footprint{};
        footprint.s = random.below(4);
        footprint.t = random.below(4);
        footprint.r = -1;
        footprint.q = random.chance(2) ? -1 : random.below(4);
        footprint.out = kOut;
        for (float& scale : footprint.scale)
            scale = static_cast<float>(1 << random.below(12)) * 0.5F;
        const ProbeExtentCtx ctx{footprint,
                                 {runs.data(), static_cast<int>(runs.size()), 4, equations.data()},
                                 kProbes,
                                 kStep,
                                 static_cast<float>(random.between(2, 16))};
        ASSERT_EQ(stage_difference(table(), &KernelTable::probe_extent, packet, ctx,
                                   {.attributes = {kOut, kProbes, kStep, kStep + 1}}),
                  "")
            << name("probe_extent") << ", seed " << seed;
    }
}

/// What is written for a pixel whose steps in texels are (across, 0) along x, (0, down) along y.
std::array<float, 4> extent(const KernelTable& table, float across, float down, float most) {
    Equations equations(2);
    equations.set(0, 0, {1.0F, 0.0F, 0.0F});
    equations.set(1, 0, {0.5F, across / 64.0F, 0.0F});
    equations.set(2, 0, {0.5F, 0.0F, down / 64.0F});
    const burnish::Run run{0, 1, 0, 0};
    PacketMemory packet;
    packet.count = 1;
    Packet view = packet.view();
    table.probe_extent(view, {{0, 1, -1, -1, 0, {64.0F, 64.0F, 1.0F}, kOut},
                              {&run, 1, 2, equations.data()},
                              kProbes,
                              kStep,
                              most});
    return {packet.attribute(kProbes)[0], packet.attribute(kOut)[0], packet.attribute(kStep)[0],
            packet.attribute(kStep + 1)[0]};
}

TEST_P(KernelTest, ProbesOfKnownFootprints) {
    using Extent = std::array<float, 4>;
    // 16 texels over 2: eight probes of 2 texels each, a ninth of 16/64 apart.
    EXPECT_EQ(extent(table(), 2.0F, 16.0F, 16.0F), (Extent{8.0F, 4.0F, 0.0F, 0.25F / 9.0F}));
    EXPECT_EQ(extent(table(), 16.0F, 2.0F, 16.0F), (Extent{8.0F, 4.0F, 0.25F / 9.0F, 0.0F}));
    // Of four at most each covers 4 texels.
    EXPECT_EQ(extent(table(), 2.0F, 16.0F, 4.0F), (Extent{4.0F, 16.0F, 0.0F, 0.25F / 5.0F}));
    // More than twice as long, by more than 1/256: three.
    EXPECT_EQ(extent(table(), 2.0F, 4.0F, 16.0F)[0], 2.0F);
    EXPECT_EQ(extent(table(), 2.0F, 4.007F, 16.0F)[0], 2.0F);
    EXPECT_EQ(extent(table(), 2.0F, 4.009F, 16.0F)[0], 3.0F);
    EXPECT_EQ(extent(table(), 2.0F, std::nextafter(2.0F, 3.0F), 16.0F)[0], 1.0F);
    // The shorter axis counts as a texel at least; magnified and undefined footprints have one.
    EXPECT_EQ(extent(table(), 0.1F, 4.0F, 16.0F)[0], 4.0F);
    EXPECT_EQ(extent(table(), 0.1F, 0.9F, 16.0F), (Extent{1.0F, 0.9F * 0.9F, 0.0F, 0.0F}));
    EXPECT_EQ(extent(table(), 4.0F, 4.0F, 16.0F), (Extent{1.0F, 16.0F, 0.0F, 0.0F}));
    EXPECT_EQ(extent(table(), 2.0F, kNan, 16.0F)[0], 1.0F);
    EXPECT_EQ(extent(table(), 2.0F, kInfinity, 16.0F)[0], 1.0F) << "infinity - infinity in v";
}

void fill_counts(PacketMemory& packet) {
    for (int i = 0; i < kPacketSize; ++i)
        packet.attribute(kProbes)[i] = static_cast<float>(1 + i % 16);
}

TEST_P(KernelTest, PlacesOfEveryProbe) {
    PacketMemory packet;
    fill_counts(packet);
    for (int seed = 0; seed < 400; ++seed) {
        Random random(static_cast<unsigned>(seed));
        packet.count = random.between(1, kPacketSize);
        for (const int k : {0, 1, 2, kStep, kStep + 1}) {
            for (int i = 0; i < kPacketSize; ++i)
                packet.attribute(k)[i] =
                    random.chance(12) ? random.pick(kWild) : random.real(-3.0F, 3.0F);
        }
        const ProbePointCtx ctx{0,       1,   random.chance(2) ? 2 : -1, kStep,
                                kProbes, kTo, random.below(16)};
        ASSERT_EQ(stage_difference(table(), &KernelTable::probe_point, packet, ctx,
                                   {.attributes = {kTo, kTo + 1}}),
                  "")
            << name("probe_point") << ", seed " << seed;
    }
}

// Symmetric about the pixel: of four, 3/2 and 1/2 steps to either side; later ones stay there.
TEST_P(KernelTest, PlacesAreSymmetric) {
    PacketMemory packet;
    packet.count = 2;
    packet.attribute(kProbes)[0] = 4.0F;
    packet.attribute(kProbes)[1] = 1.0F;
    for (int i = 0; i < 2; ++i) {
        packet.attribute(0)[i] = 0.5F;
        packet.attribute(1)[i] = 2.0F;
        packet.attribute(kStep)[i] = i == 0 ? 0.25F : 0.0F;
        packet.attribute(kStep + 1)[i] = 0.0F;
    }
    constexpr std::array want{0.125F, 0.375F, 0.625F, 0.875F, 0.875F};
    for (int probe = 0; probe < 5; ++probe) {
        Packet view = packet.view();
        table().probe_point(view, {0, 1, -1, kStep, kProbes, kTo, probe});
        EXPECT_EQ(packet.attribute(kTo)[0], want[static_cast<std::size_t>(probe)]) << probe;
        EXPECT_EQ(packet.attribute(kTo + 1)[0], 2.0F) << probe;
        EXPECT_EQ(packet.attribute(kTo)[1], 0.5F) << probe;
    }
}

TEST_P(KernelTest, SumsAndMeansOfProbes) {
    constexpr std::array kEnds{-32768, 32767, -256, 254, 255, 0, 1, -1, 16384, -16384, 2, -2};
    for (int seed = 0; seed < 60; ++seed) {
        Random random(static_cast<unsigned>(seed));
        PacketMemory packet;
        fill_counts(packet);
        packet.count = random.chance(2) ? kPacketSize : random.between(1, kPacketSize);
        ProbeSumCtx ctx{};
        ctx.probes = kProbes;
        ctx.sum = kSum;
        ctx.channels = random.between(1, ProbeSumCtx::kMaxChannels);
        ctx.doubled = static_cast<std::uint16_t>(random.below(1 << 16));
        Written sums, means;
        for (int c = 0; c < ctx.channels; ++c) {
            ctx.plane[c] = static_cast<std::int16_t>(20 - c);
            sums.attributes.push_back(kSum + c);
            means.planes.push_back(20 - c);
        }
        for (ctx.probe = 0; ctx.probe < 16; ++ctx.probe) {
            for (int c = 0; c < ctx.channels; ++c) {
                for (int i = 0; i < kPacketSize; ++i) {
                    const int code =
                        random.chance(2) ? random.pick(kEnds) : random.between(-32768, 32767);
                    const bool even = (ctx.doubled >> c & 1) != 0;
                    packet.plane(20 - c)[i] = static_cast<std::int16_t>(even ? code & ~1 : code);
                }
            }
            ASSERT_EQ(stage_difference(table(), &KernelTable::probe_sum, packet, ctx, sums), "")
                << name("probe_sum") << ", seed " << seed << ", probe " << ctx.probe;
            Packet view = packet.view();
            table().probe_sum(view, ctx);
        }
        ASSERT_EQ(stage_difference(table(), &KernelTable::probe_mean, packet, ctx, means), "")
            << name("probe_mean") << ", seed " << seed;
    }
}

// Every sum of numbers of 0 .. 255, and both ends of all others, by every count.
TEST_P(KernelTest, MeansOfEverySum) {
    PacketMemory packet;
    for (int n = 1; n <= 16; ++n) {
        std::fill_n(packet.attribute(kProbes), kPacketSize, static_cast<float>(n));
        for (const int first : {-32768 * n, -256 * n, 0, 32767 * n - 4095}) {
            for (int base = first; base <= first + 4096; base += kPacketSize) {
                for (int i = 0; i < kPacketSize; ++i)
                    packet.attribute(kSum)[i] =
                        static_cast<float>(std::min(base + i, 32766 * n) & ~1);
                for (const std::uint16_t doubled : {std::uint16_t{0}, std::uint16_t{1}}) {
                    ASSERT_EQ(stage_difference(table(), &KernelTable::probe_mean, packet,
                                               ProbeSumCtx{kProbes, 0, kSum, 1, {20}, doubled},
                                               Written{.planes = {20}}),
                              "")
                        << name("probe_mean") << ", n " << n << ", from " << base;
                }
            }
        }
    }
}

// Halves go up: 1/2 -> 1, -1/2 -> 0, -3/2 -> -1; of doubled codes 2 m it is m.
TEST_P(KernelTest, MeansRoundHalvesUp) {
    PacketMemory packet;
    packet.count = 4;
    constexpr std::array sums{1.0F, -1.0F, -3.0F, 6.0F};
    constexpr std::array want{1, 0, -1, 3};
    for (std::size_t i = 0; i < sums.size(); ++i) {
        packet.attribute(kProbes)[i] = 2.0F;
        packet.attribute(kSum)[i] = packet.attribute(kSum + 1)[i] = sums[i];
    }
    for (std::size_t i = 0; i < sums.size(); ++i) packet.attribute(kSum + 1)[i] *= 2.0F;
    Packet view = packet.view();
    table().probe_mean(view, {kProbes, 0, kSum, 2, {20, 21}, 2});
    for (std::size_t i = 0; i < sums.size(); ++i) {
        EXPECT_EQ(packet.plane(20)[i], want[i]) << sums[i];
        EXPECT_EQ(packet.plane(21)[i], 2 * want[i]) << sums[i];
    }
}

}  // namespace
}  // namespace burnish
