#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <vector>

#include "kernel_test.hpp"
#include "kernels/log2_steps.hpp"

/// Cube faces, levels of detail, texels of levels and slices, words.
namespace burnish {
namespace {

INSTANTIATE_TEST_SUITE_P(Isa, KernelTest, every_table(), isa_name);

void fill(PacketMemory& packet, int attribute, Random& random) {
    for (int i = 0; i < kPacketSize; ++i)
        packet.attribute(attribute)[i] =
            random.chance(3) ? random.pick(kWild) : random.real(-3.0F, 3.0F);
}

TEST_P(KernelTest, CubeFacesOfEveryKindOfDirection) {
    const auto count = static_cast<int>(kWild.size());
    const CubeFaceCtx ctx{0, 1, 2, 3, 4, 5};
    const Written written{.planes = {5}, .attributes = {3, 4}};
    PacketMemory packet;
    for (int s = 0; s < count; ++s) {
        for (int t = 0; t < count; t += 8) {
            for (int i = 0; i < kPacketSize; ++i) {
                packet.attribute(0)[i] = kWild[static_cast<std::size_t>(s)];
                packet.attribute(1)[i] = kWild[static_cast<std::size_t>(t + i / count % 8)];
                packet.attribute(2)[i] = kWild[static_cast<std::size_t>(i % count)];
            }
            ASSERT_EQ(stage_difference(table(), &KernelTable::cube_face, packet, ctx, written), "")
                << name("cube_face") << ", s " << kWild[static_cast<std::size_t>(s)];
        }
    }
    for (int seed = 0; seed < 200; ++seed) {
        Random random(static_cast<unsigned>(seed));
        packet.count = random.between(1, kPacketSize);
        for (int k = 0; k < 3; ++k) fill(packet, k, random);
        ASSERT_EQ(stage_difference(table(), &KernelTable::cube_face, packet, ctx, written), "")
            << name("cube_face") << ", seed " << seed;
    }
}

FootprintCtx random_footprint(Random& random) {
    FootprintCtx ctx{};
    ctx.s = random.below(4);
    ctx.t = random.below(4);
    ctx.cube = random.chance(3) ? 1 : 0;
    ctx.r = ctx.cube != 0 || random.chance(2) ? random.below(4) : -1;
    ctx.q = ctx.cube != 0 || random.chance(2) ? -1 : random.below(4);
    for (float& scale : ctx.scale) scale = static_cast<float>(1 << random.below(12)) * 0.5F;
    ctx.out = 6;
    return ctx;
}

TEST_P(KernelTest, FootprintsOfRandomRuns) {
    for (int seed = 0; seed < 1500; ++seed) {
        Random random(static_cast<unsigned>(seed));
        PacketMemory packet;
        const std::vector<burnish::Run> runs = random_runs(packet, random);
        Equations equations(4);
        for (int k = 0; k < 5 * static_cast<int>(runs.size()); ++k) {
            std::array plane{random.real(-2.0F, 2.0F), random.real(-0.1F, 0.1F),
                             random.real(-0.1F, 0.1F)};
            if (random.chance(20)) plane = {0.0F, 0.0F, 0.0F};
            if (random.chance(20))
                plane = {random.pick(kWild), random.pick(kWild), random.pick(kWild)};
            equations.set(k % 5, k / 5, plane);
        }
        const PlaneFootprintCtx ctx{
            random_footprint(random),
            {runs.data(), static_cast<int>(runs.size()), 4, equations.data()}};
        ASSERT_EQ(stage_difference(table(), &KernelTable::plane_footprint, packet, ctx,
                                   {.attributes = {6}}),
                  "")
            << name("plane_footprint") << ", seed " << seed;
    }
}

TEST_P(KernelTest, FootprintsOfRandomQuads) {
    for (int seed = 0; seed < 1500; ++seed) {
        Random random(static_cast<unsigned>(seed));
        PacketMemory packet;
        packet.count = 4 * random.between(1, kPacketSize / 4);
        for (int k = 0; k < 4; ++k) fill(packet, k, random);
        const QuadFootprintCtx ctx{random_footprint(random)};
        ASSERT_EQ(stage_difference(table(), &KernelTable::quad_footprint, packet, ctx,
                                   {.attributes = {6}}),
                  "")
            << name("quad_footprint") << ", seed " << seed;
    }
}

TEST(Log2Steps, AreTheLeastMantissasThatRoundUp) {
    // (1 + m / 2^23)^256 >= 2^(2 k + 1) for m, not for m - 1. Eight squarings in 64 bits err by
    // 2^-55 at most; two neighbours are 2^-15 apart.
    const auto power_256 = [](std::int32_t m) {
        long double x = 1.0L + static_cast<long double>(m) * 0x1p-23L;
        for (int i = 0; i < 8; ++i) x *= x;
        return x;
    };
    for (int k = 0; k < kLog2Steps; ++k) {
        const long double border = std::ldexp(1.0L, 2 * k + 1);
        EXPECT_GE(power_256(kLog2Step[k]), border) << k;
        EXPECT_LT(power_256(kLog2Step[k] - 1), border) << k;
    }
}

TEST_P(KernelTest, LevelOfDetailAroundEveryStep) {
    std::vector<float> footprints(kWild.begin(), kWild.end());
    for (int exponent = -66; exponent <= 66; exponent += exponent < -8 || exponent > 28 ? 7 : 1) {
        const float octave = std::ldexp(1.0F, exponent);
        footprints.push_back(octave);
        footprints.push_back(std::nextafter(octave, 0.0F));
        for (const std::int32_t step : kLog2Step) {
            const float at = octave * (1.0F + static_cast<float>(step) * 0x1p-23F);
            footprints.push_back(at);
            footprints.push_back(std::nextafter(at, 0.0F));
        }
    }
    while (footprints.size() % kPacketSize != 0) footprints.push_back(64.0F);
    PacketMemory packet;
    for (const LevelOfDetailCtx& ctx :
         {LevelOfDetailCtx{0, 3, 0, 14 * 256}, LevelOfDetailCtx{0, 3, -4096, 9 * 256},
          LevelOfDetailCtx{0, 3, 4095, 14 * 256}, LevelOfDetailCtx{0, 3, 51, 1},
          LevelOfDetailCtx{0, 3, 4096, 32767}}) {
        for (std::size_t first = 0; first < footprints.size(); first += kPacketSize) {
            std::copy_n(footprints.begin() + static_cast<std::ptrdiff_t>(first), kPacketSize,
                        packet.attribute(0));
            ASSERT_EQ(stage_difference(table(), &KernelTable::level_of_detail, packet, ctx,
                                       {.planes = {3}}),
                      "")
                << name("level_of_detail") << ", from " << footprints[first];
        }
    }
}

TEST_P(KernelTest, LevelOfDetailOfKnownFootprints) {
    // 128 log2: 64 -> 768 (level 3); 1 -> 0; 2 -> 128 (level 1/2); 1/4 -> below 0; NaN -> below 0;
    // infinity -> 64 octaves; 3: 128 * 1.58496 = 202.9 -> 203; 2^(1/128) = 1.00543 -> 1.
    PacketMemory packet;
    const std::array<std::pair<float, int>, 8> cases{{{64.0F, 768},
                                                      {1.0F, 0},
                                                      {2.0F, 128},
                                                      {0.25F, 0},
                                                      {kNan, 0},
                                                      {kInfinity, 3000},
                                                      {3.0F, 203},
                                                      {1.00543F, 1}}};
    for (std::size_t i = 0; i < cases.size(); ++i) packet.attribute(0)[i] = cases[i].first;
    packet.count = static_cast<int>(cases.size());
    Packet view = packet.view();
    table().level_of_detail(view, {0, 3, 0, 3000});
    for (std::size_t i = 0; i < cases.size(); ++i)
        EXPECT_EQ(packet.plane(3)[i], cases[i].second) << cases[i].first;
}

constexpr std::array kModes{AddressMode::repeat, AddressMode::clamp_to_edge,
                            AddressMode::clamp_to_border, AddressMode::mirrored_repeat};

TEST_P(KernelTest, AddressesInLevelsFacesAndSlices) {
    for (int seed = 0; seed < 3000; ++seed) {
        Random random(static_cast<unsigned>(seed));
        LevelAddressCtx ctx{};
        ctx.u = 0;
        ctx.v = 1;
        ctx.q = random.chance(2) ? 3 : -1;
        ctx.r = random.chance(2) ? 2 : -1;
        ctx.face = ctx.r < 0 && random.chance(2) ? 4 : -1;
        ctx.lambda = random.chance(4) ? -1 : 5;
        ctx.slice_weight = ctx.r >= 0 && random.chance(2) ? 6 : -1;
        ctx.mode_s = random.pick(kModes);
        ctx.mode_t = random.pick(kModes);
        ctx.mode_r = random.pick(kModes);
        ctx.choice = static_cast<LevelChoice>(random.below(4));
        ctx.behind = static_cast<std::uint8_t>(random.below(2));
        ctx.mag_linear = static_cast<std::uint8_t>(random.below(2));
        ctx.min_linear = static_cast<std::uint8_t>(random.below(2));
        if (random.chance(6)) {
            ctx.rectangle = 1;
            ctx.mode_s = kModes[static_cast<std::size_t>(random.between(1, 2))];
            ctx.mode_t = kModes[static_cast<std::size_t>(random.between(1, 2))];
        }
        ctx.pitch = 64 * random.between(1, 1025);
        ctx.layer_bytes = ctx.pitch * 7;
        ctx.texel_bytes = random.chance(2) ? 8 : 4;
        ctx.level_count = random.between(1, LevelAddressCtx::kMaxLevels);
        for (int k = 0; k < ctx.level_count; ++k)
            ctx.levels[k] = {1 << random.below(15), random.between(1, 16384),
                             random.between(1, 300), random.below(1 << 20)};
        PacketMemory packet;
        packet.count = random.between(1, kPacketSize);
        for (int k = 0; k < 4; ++k) fill(packet, k, random);
        for (int i = 0; i < kPacketSize; ++i) {
            packet.plane(4)[i] = static_cast<std::int16_t>(random.below(6));
            packet.plane(5)[i] = static_cast<std::int16_t>(
                random.chance(4) ? 0 : random.below(256 * (ctx.level_count - 1) + 1));
        }
        Written written{.addresses = true};
        if (ctx.slice_weight >= 0) written.planes.push_back(6);
        ASSERT_EQ(stage_difference(table(), &KernelTable::level_address, packet, ctx, written), "")
            << name("level_address") << ", seed " << seed;
    }
}

/// Texels of words, with extremes, for any offset below 4096.
std::vector<std::uint8_t> random_words(Random& random) {
    std::vector<std::uint8_t> bytes(8192);
    for (std::size_t i = 0; i < bytes.size(); i += 2) {
        const int word =
            random.chance(3) ? (random.chance(2) ? -32768 : 32767) : random.between(-32768, 32767);
        bytes[i] = static_cast<std::uint8_t>(word & 255);
        bytes[i + 1] = static_cast<std::uint8_t>(word >> 8 & 255);
    }
    return bytes;
}

template <class Ctx>
void check_words(const KernelTable& table,
                 void (*KernelTable::*stage)(Packet&, const Ctx&) noexcept, int channels) {
    for (int seed = 0; seed < 1000; ++seed) {
        Random random(static_cast<unsigned>(seed));
        const std::vector<std::uint8_t> texels = random_words(random);
        PacketMemory packet;
        packet.count = random.between(1, kPacketSize);
        for (std::size_t i = 0; i < kPacketSize; ++i) {
            packet.texel[i] = 8 * random.below(256);
            packet.weight_x[i] = static_cast<std::int16_t>(random.chance(4) ? 255 * random.below(2)
                                                                            : random.below(256));
            packet.weight_y[i] = static_cast<std::int16_t>(random.below(256));
        }
        Written written;
        for (int c = 0; c < channels; ++c) written.planes.push_back(20 + c);
        ASSERT_EQ(stage_difference(table, stage, packet, Ctx{texels.data(), 20, 2112}, written), "")
            << table.isa << " fetch of words, seed " << seed;
    }
}

TEST_P(KernelTest, HiloTexels) {
    check_words(table(), &KernelTable::fetch_hilo, 2);
}

TEST_P(KernelTest, TexelsOfFourWords) {
    check_words(table(), &KernelTable::fetch_words, 4);
}

TEST_P(KernelTest, TexelsOfFourTexturesOfWords) {
    for (int seed = 0; seed < 1000; ++seed) {
        Random random(static_cast<unsigned>(seed));
        const std::vector<std::uint8_t> texels = random_words(random);
        PacketMemory packet;
        packet.count = random.between(1, kPacketSize);
        for (std::size_t i = 0; i < kPacketSize; ++i) {
            packet.texel[i] = FetchQuartetCtx::kTexelBytes * random.below(64);
            for (std::int16_t* weight : {&packet.weight_x[i], &packet.weight_y[i]})
                *weight = static_cast<std::int16_t>(random.chance(4) ? 255 * random.below(2)
                                                                     : random.below(256));
        }
        FetchQuartetCtx ctx{texels.data(), {20, -1, 4, 28}, 2112};
        if (random.chance(2)) ctx.plane[1] = 8;
        if (random.chance(4)) ctx.plane[random.below(4)] = -1;
        if (random.chance(2))
            for (std::uint8_t& channels : ctx.channels)
                channels = static_cast<std::uint8_t>(random.below(16));
        Written written;
        for (std::size_t k = 0; k < 4; ++k)
            for (int c = 0; c < 4 && ctx.plane[k] >= 0; ++c)
                if ((ctx.channels[k] >> c & 1) != 0) written.planes.push_back(ctx.plane[k] + c);
        ASSERT_EQ(stage_difference(table(), &KernelTable::fetch_quartet, packet, ctx, written), "")
            << name("fetch_quartet") << ", seed " << seed;
        const PrefetchQuartetCtx prefetch{ctx.texels, ctx.pitch};
        ASSERT_EQ(stage_difference(table(), &KernelTable::prefetch_quartet, packet, prefetch, {}),
                  "")
            << name("prefetch_quartet") << ", seed " << seed;
    }
}

/// Axes of any size, whose ends are edges or centres of texels.
LookUpTableCtx::Axis random_axis(Random& random, int plane, int most) {
    const int size = random.chance(2) ? 1 << random.below(5) : random.between(1, most);
    const auto n = static_cast<float>(size);
    switch (random.below(3)) {
        case 0:
            return {plane, size, 1.0F, 0.0F, 1.0F};
        case 1:
            return {plane, size, n - 1.0F, 0.5F, n};
        default:
            return {plane, size, 0.5F * (n - 1.0F), 0.5F * n, n};
    }
}

/// What the reference finds for every code of a register.
std::vector<std::int16_t> codes_of(LookUpTableCtx ctx) {
    PacketMemory packet;
    ctx.s.plane = 0;
    for (int& out : ctx.out) out = -1;
    ctx.out[0] = 1;
    std::vector<std::int16_t> codes;
    for (int first = 0; first < 65536; first += kPacketSize) {
        for (int i = 0; i < kPacketSize; ++i)
            packet.plane(0)[i] = static_cast<std::int16_t>(first + i);
        Packet view = packet.view();
        table_reference().look_up_table(view, ctx);
        codes.insert(codes.end(), packet.plane(1), packet.plane(2));
    }
    return codes;
}

TEST_P(KernelTest, TablesAtAnyRegister) {
    for (int seed = 0; seed < 1000; ++seed) {
        Random random(static_cast<unsigned>(seed));
        const std::vector<std::uint8_t> texels = random_words(random);
        PacketMemory packet;
        packet.count = random.between(1, kPacketSize);
        for (int k = 4; k < 6; ++k)
            for (int i = 0; i < kPacketSize; ++i)
                packet.plane(k)[i] = static_cast<std::int16_t>(
                    random.chance(8) ? random.between(-32768, 32767) : random.between(-16, 16400));
        LookUpTableCtx ctx{texels.data(),
                           random_axis(random, 4, 60),
                           random_axis(random, 5, 31),
                           252,
                           {-1, 20, -1, -1}};
        if (random.chance(2)) ctx.t.plane = -1;
        std::vector<std::int16_t> codes;
        if (ctx.t.plane < 0 && random.chance(20)) {
            codes = codes_of(ctx);
            ctx.codes = codes.data();
        }
        Written written{.planes = {20}};
        for (const int c : {0, 2, 3}) {
            if (random.chance(2)) continue;
            ctx.out[c] = 21 + c;
            written.planes.push_back(21 + c);
        }
        ASSERT_EQ(stage_difference(table(), &KernelTable::look_up_table, packet, ctx, written), "")
            << name("look_up_table") << ", seed " << seed;
    }
}

/// The summed table of random words: rows of `columns` texels, the last two rows the same.
std::vector<std::uint8_t> random_sums(Random& random, int columns, int rows, int pitch) {
    std::vector<std::uint8_t> texels(static_cast<std::size_t>((rows + 1) * pitch));
    const bool wild = random.chance(2);
    for (int y = 0; y < rows; ++y) {
        std::vector<std::int16_t> words;
        for (int x = 0; x < columns; ++x)
            words.push_back(static_cast<std::int16_t>(wild && random.chance(2)
                                                          ? random.pick(std::array{-32768, 32767})
                                                          : random.between(-32768, 32767)));
        words.push_back(words.back());
        std::int32_t sum = 0;
        for (std::size_t x = 0; x + 1 < words.size(); ++x) {
            std::uint8_t* const at = texels.data() + y * pitch + 8 * static_cast<int>(x);
            std::memcpy(at, &words[x], 2);
            std::memcpy(at + 2, &words[x + 1], 2);
            std::memcpy(at + 4, &sum, 4);
            sum += words[x] + words[x + 1];
        }
    }
    std::copy_n(texels.end() - 2 * pitch, pitch, texels.end() - pitch);
    return texels;
}

TEST_P(KernelTest, MeansOfTablesAtAnyRegister) {
    for (int seed = 0; seed < 1000; ++seed) {
        Random random(static_cast<unsigned>(seed));
        AverageTableCtx ctx{nullptr,
                            random_axis(random, 4, 60),
                            random_axis(random, 5, 31),
                            std::ldexp(1.0F, random.between(-31, 1)),
                            -8.0F,
                            8.0F,
                            520,
                            {-1, 20, -1, -1}};
        if (random.chance(2)) ctx.least = random.real(-1.0F, 0.5F);
        if (random.chance(2)) ctx.most = random.real(0.5F, 1.0F);
        if (random.chance(2)) ctx.t.plane = -1;
        const std::vector<std::uint8_t> texels =
            random_sums(random, ctx.s.size, ctx.t.size, ctx.pitch);
        ctx.texels = texels.data();
        PacketMemory packet;
        packet.count = 4 * random.between(1, kPacketSize / 4);
        const int spread = random.pick(std::array{0, 3, 300, 32767});
        for (int i = 0; i < kPacketSize; i += 4) {
            const int middle = random.between(-16, 16400);
            for (int k = i; k < i + 4; ++k) {
                packet.plane(4)[k] = static_cast<std::int16_t>(
                    std::clamp(middle + random.between(-spread, spread), -32768, 32767));
                packet.plane(5)[k] = static_cast<std::int16_t>(random.between(-16, 16400));
            }
        }
        Written written{.planes = {20}};
        if (random.chance(2)) {
            ctx.out[2] = 23;
            written.planes.push_back(23);
        }
        ASSERT_EQ(stage_difference(table(), &KernelTable::average_table, packet, ctx, written), "")
            << name("average_table") << ", seed " << seed;
    }
}

TEST_P(KernelTest, EveryWordAsHilo) {
    PacketMemory packet;
    for (int first = -32768; first < 32768; first += kPacketSize) {
        for (int i = 0; i < kPacketSize; ++i) {
            packet.plane(3)[i] = static_cast<std::int16_t>(first + i);
            packet.plane(4)[i] = static_cast<std::int16_t>(-1 - first - i);
        }
        for (const std::uint8_t is_signed : {std::uint8_t{0}, std::uint8_t{1}}) {
            ASSERT_EQ(stage_difference(table(), &KernelTable::hilo, packet,
                                       HiloCtx{3, 7, is_signed}, {.attributes = {7, 8}}),
                      "")
                << name("hilo") << ", from " << first;
        }
    }
}

TEST_P(KernelTest, BlendsWithEveryWeight) {
    constexpr std::array kEnds{-32768, 32767, -256, 254, 255, 0, 1, -1, 16384, -16384, 2, -2};
    for (int seed = 0; seed < 500; ++seed) {
        Random random(static_cast<unsigned>(seed));
        PacketMemory packet;
        packet.count = random.chance(2) ? kPacketSize : random.between(1, kPacketSize);
        const int channels = random.between(1, 4);
        const auto doubled = static_cast<std::uint8_t>(random.below(16));
        const int range = random.chance(2) ? 1 : 2;  // words, or differences below 2^15
        const auto words = static_cast<std::uint8_t>(range == 1 ? 1 : 0);
        for (int c = 0; c < 4; ++c) {
            for (int i = 0; i < kPacketSize; ++i) {
                for (const int plane : {10 + c, 14 + c}) {
                    const int code =
                        (random.chance(2) ? random.pick(kEnds) : random.between(-32768, 32767)) /
                        range;
                    const int even = (doubled >> c & 1) != 0 ? code & ~1 : code;
                    packet.plane(plane)[i] = static_cast<std::int16_t>(even);
                }
            }
        }
        for (int i = 0; i < kPacketSize; ++i)
            packet.plane(5)[i] = static_cast<std::int16_t>(i % 256 + 256 * random.below(14));
        const int out = std::array{10, 14, 20}[static_cast<std::size_t>(random.below(3))];
        Written written;
        for (int c = 0; c < channels; ++c) written.planes.push_back(out + c);
        ASSERT_EQ(
            stage_difference(table(), &KernelTable::blend_levels, packet,
                             BlendLevelsCtx{10, 14, out, channels, 5, doubled, words}, written),
            "")
            << name("blend_levels") << ", seed " << seed;
    }
}

}  // namespace
}  // namespace burnish
