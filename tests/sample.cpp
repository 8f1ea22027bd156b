// What plan_sample hands to dependent texture operations: raw texels, words as numbers, levels from
// quads. Packets are fed here, on every set of kernels.
#include "shade/sample.hpp"

#include <gtest/gtest.h>

#include <burnish/error.hpp>
#include <burnish/program_text.hpp>

#include "kernel_test.hpp"
#include "shade/shading.hpp"
#include "tests/textured_quad.hpp"

namespace burnish {
namespace {

INSTANTIATE_TEST_SUITE_P(Isa, KernelTest, every_table(), isa_name);

constexpr int kRegisters = 0, kValues = 8, kScratchPlanes = 8, kScratchAttributes = 12;

/// Samples `texture` at s, t, r = attributes 0, 1, 2.
void sample(const Texture& texture, NumberModel numbers, const KernelTable& kernels,
            PacketMemory& memory) {
    SamplePlan plan{numbers, kScratchAttributes, kScratchPlanes};
    std::vector<InputOp> ops;
    plan_sample(texture, {0, 1, 2, -1, false}, {kRegisters, kValues}, plan, ops);
    Packet packet = memory.view();
    feed_inputs(ops, numbers, kernels, {}, packet);
}

/// A row of words.
Texture words(std::vector<std::uint16_t> rg, TexelFormat format, Filter filter) {
    Image16 image(static_cast<int>(rg.size() / 2), 1);
    for (std::size_t i = 0; i < rg.size(); ++i) image.rgba[i / 2 * 4 + i % 2] = rg[i];
    Sampler sampler;
    sampler.filter = filter;
    sampler.wrap_s = Wrap::clamp_to_edge;
    return {std::span<const Image16>(&image, 1), {.format = format, .sampler = sampler}};
}

TEST_P(KernelTest, HiloTexelsAreNumbersOf16Bits) {
    PacketMemory memory;
    memory.count = 4;
    // Texel centres, halfway between, and 1/512 texel right of the first: a weight of 0.
    const std::array<float, 4> s{0.25F, 0.75F, 0.5F, 0.25F + 1.0F / 1024.0F};
    std::copy(s.begin(), s.end(), memory.attribute(0));
    std::fill_n(memory.attribute(1), 4, 0.5F);
    sample(words({0, 65535, 1001, 32768}, TexelFormat::hilo16, Filter::linear),
           NumberModel::nine_bit, table(), memory);
    EXPECT_EQ(memory.attribute(kValues)[0], 0.0F);
    EXPECT_EQ(memory.attribute(kValues + 1)[0], 1.0F);
    EXPECT_EQ(memory.attribute(kValues)[1], 1001.0F / 65535.0F);
    EXPECT_EQ(memory.attribute(kValues + 1)[1], 32768.0F / 65535.0F);
    EXPECT_EQ(memory.attribute(kValues)[2], 501.0F / 65535.0F);        // 500.5
    EXPECT_EQ(memory.attribute(kValues + 1)[2], 49152.0F / 65535.0F);  // 49151.5
    EXPECT_EQ(memory.attribute(kValues)[3], 0.0F);

    sample(words({0x8000, 0x7fff, 0xffff, 0}, TexelFormat::signed_hilo16, Filter::linear),
           NumberModel::wide, table(), memory);
    EXPECT_EQ(memory.attribute(kValues)[0], -1.0F);
    EXPECT_EQ(memory.attribute(kValues + 1)[0], 32767.0F / 32768.0F);
    EXPECT_EQ(memory.attribute(kValues)[1], -1.0F / 32768.0F);
    EXPECT_EQ(memory.attribute(kValues)[2], -16384.0F / 32768.0F);     // -16384.5
    EXPECT_EQ(memory.attribute(kValues + 1)[2], 16384.0F / 32768.0F);  // 16383.5
}

// Bytes are stored as 8 bits and filtered as 16: halfway between 0 and 1 is 257 / 2, not 0 or 1.
TEST_P(KernelTest, HiloOfBytesFiltersAt16Bits) {
    PacketMemory memory;
    memory.count = 1;
    memory.attribute(0)[0] = memory.attribute(1)[0] = 0.5F;
    Image8 image(2, 1);
    image.at(1, 0)[0] = 1;
    image.at(1, 0)[1] = 255;
    sample(Texture(image, {}, TexelFormat::hilo8), NumberModel::wide, table(), memory);
    EXPECT_EQ(memory.attribute(kValues)[0], 129.0F / 65535.0F);        // 128.5
    EXPECT_EQ(memory.attribute(kValues + 1)[0], 32768.0F / 65535.0F);  // 32767.5
    sample(Texture(image, {}, TexelFormat::signed_hilo8), NumberModel::wide, table(), memory);
    EXPECT_EQ(memory.attribute(kValues)[0], 128.0F / 32768.0F);
    EXPECT_EQ(memory.attribute(kValues + 1)[0], -128.0F / 32768.0F);  // 255 is -1, -256 of words
}

TEST_P(KernelTest, DsdtTexelsArriveAsTheyAre) {
    PacketMemory memory;
    memory.count = 1;
    memory.attribute(0)[0] = memory.attribute(1)[0] = 0.5F;
    const Texture texture(plain_image(1, 1, {200, 100, 60, 130}), {},
                          TexelFormat::dsdt8_mag8_intensity8);
    const auto codes = [&](NumberModel numbers) -> Bytes {
        sample(texture, numbers, table(), memory);
        return {memory.plane(0)[0], memory.plane(1)[0], memory.plane(2)[0], memory.plane(3)[0]};
    };
    // 200 is -56. Codes of signed bytes are 2 n and 128 n; 60 / 255 * 2^14 is 3855.06, 130: 8352.6.
    EXPECT_EQ(codes(NumberModel::nine_bit), (Bytes{-112, 200, 60, 130}));
    EXPECT_EQ(codes(NumberModel::wide), (Bytes{-56 * 128, 12800, 3855, 8353}));
}

// Of a packet whose fragments are all at whole levels the second one is not even fetched. Level k
// is 10 (k + 1); steps of 3 texels are level log2(3), 406 / 256.
TEST_P(KernelTest, LevelsAreFetchedWhereAFragmentBlendsThem) {
    std::vector<Image8> images;
    for (int side = 16, grey = 10; side >= 1; side /= 2, grey += 10)
        images.push_back(plain_image(side, side, {grey, grey, grey, grey}));
    Sampler sampler;
    sampler.filter = Filter::linear_mipmap_linear;
    const TexturePtr texture = make_texture(images, {.sampler = sampler});
    PacketMemory memory;
    memory.count = kPacketSize;
    constexpr std::int16_t kUntouched = 12345;
    const auto planes_written = [&](float step, float last_step) {
        for (int k = 0; k < kSamplePlanes; ++k)
            std::fill_n(memory.plane(kScratchPlanes + k), kPacketSize, kUntouched);
        for (int i = 0; i < kPacketSize; ++i) {
            const float texels = i < kPacketSize - 4 ? step : last_step;
            memory.attribute(0)[i] = static_cast<float>(i % 2) * texels / 16.0F;
            memory.attribute(1)[i] = static_cast<float>(i / 2 % 2) * texels / 16.0F;
        }
        sample(*texture, NumberModel::nine_bit, table(), memory);
        int written = 0;
        for (int k = 0; k < kSamplePlanes; ++k)
            written += memory.plane(kScratchPlanes + k)[0] != kUntouched ? 1 : 0;
        return written;
    };
    const std::int16_t* const codes = memory.plane(kRegisters);
    const int blended = planes_written(2.0F, 3.0F);
    EXPECT_EQ(codes[0], 20);
    EXPECT_EQ(codes[kPacketSize - 1], 26);  // (106 * 20 + 150 * 30 + 128) >> 8
    EXPECT_EQ(planes_written(2.0F, 4.0F), blended - 4);
    EXPECT_EQ(codes[0], 20);
    EXPECT_EQ(codes[kPacketSize - 1], 30);
}

// Level k of a 16 x 16 texture is 10 (k + 1). Two quads: the first 4 texels wide and 2 high, the
// second with one fragment that strays: each takes the differences of its own row and column.
TEST_P(KernelTest, QuadsGiveLevelsOfComputedCoordinates) {
    std::vector<Image8> images;
    for (int side = 16, grey = 10; side >= 1; side /= 2, grey += 10)
        images.push_back(plain_image(side, side, {grey, grey, grey, grey}));
    Sampler sampler;
    sampler.filter = Filter::linear_mipmap_linear;
    const TexturePtr texture = make_texture(images, {.sampler = sampler});
    EXPECT_TRUE(needs_level_of_detail(*texture));
    PacketMemory memory;
    memory.count = 8;
    const std::array<float, 8> s{0.0F, 4.0F, 0.0F, 4.0F, 0.0F, 1.0F, 0.0F, 8.0F};
    const std::array<float, 8> t{0.0F, 0.0F, 2.0F, 2.0F, 0.0F, 0.0F, 1.0F, 1.0F};
    for (std::size_t i = 0; i < 8; ++i) {
        memory.attribute(0)[i] = s[i] / 16.0F;
        memory.attribute(1)[i] = t[i] / 16.0F;
    }
    sample(*texture, NumberModel::nine_bit, table(), memory);
    const std::int16_t* codes = memory.plane(kRegisters);
    for (int i = 0; i < 4; ++i) EXPECT_EQ(codes[i], 30) << i;  // level 2
    EXPECT_EQ(codes[4], 10);                                   // 1 to the right, 1 down
    // 1 along its row; down 7 and 1: sqrt(50) is 2^2.8219, 722 / 256 after rounding: level 2 and
    // 210 / 256, (46 * 30 + 210 * 40 + 128) >> 8 = 38.7 -> 38.
    EXPECT_EQ(codes[5], 38);
    EXPECT_EQ(codes[6], 40);  // 8 to the right
    EXPECT_EQ(codes[7], 40);  // 8 to the left; down 7 and 1
}

/// Three textures of words, 7 x 5 with a border, each with its own texels.
std::vector<TexturePtr> three_of_words(Filter filter) {
    std::vector<TexturePtr> textures;
    for (unsigned seed = 0; seed < 3; ++seed) {
        Random random(seed);
        Image16 image(7, 5);
        for (std::uint16_t& word : image.rgba)
            word = static_cast<std::uint16_t>(random.below(65536));
        TextureDescription d{.format = TexelFormat::rgba16, .box_mipmaps = true};
        d.sampler.filter = filter;
        d.sampler.wrap_s = Wrap::clamp_to_border;
        d.sampler.border = {0.25F, 0.5F, 1.0F, 0.0F};
        textures.push_back(std::make_shared<const Texture>(std::span(&image, 1), d));
    }
    return textures;
}

// The same texels lie elsewhere; one fetch serves all.
TEST_P(KernelTest, QuartetsAreSampledAsTheirTextures) {
    for (const Filter filter : {Filter::linear, Filter::linear_mipmap_nearest}) {
        const std::vector<TexturePtr> singles = three_of_words(filter);
        const std::vector<TexturePtr> quartet = Texture::quartet(singles);
        PacketMemory memory;
        Random random(7);
        for (int k = 0; k < 2; ++k)
            for (int i = 0; i < kPacketSize; ++i) memory.attribute(k)[i] = random.real(-1.0F, 2.0F);
        const auto sampled = [&](const std::vector<TexturePtr>& textures, std::size_t operations) {
            PacketMemory own = memory;
            SamplePlan plan{NumberModel::wide, kScratchAttributes, 12};
            std::vector<InputOp> ops;
            for (int k = 0; k < 3; ++k)
                plan_sample(*textures[static_cast<std::size_t>(k)], {0, 1, -1, -1, true},
                            {4 * k, kValues}, plan, ops);
            if (filter == Filter::linear) {
                EXPECT_EQ(ops.size(), operations);
            }
            Equations equations(2);
            equations.set(0, 0, {1.0F, 0.0F, 0.0F});
            equations.set(1, 0, {0.2F, 0.1F, 0.3F});
            equations.set(2, 0, {0.4F, 0.5F, 0.2F});
            const burnish::Run run{0, kPacketSize, 0, 0};
            Packet packet = own.view();
            for (const InputOp& op : ops)
                feed_input(op, NumberModel::wide, table(), {&run, 1, 2, equations.data()}, packet);
            return std::vector(own.plane(0), own.plane(12));
        };
        EXPECT_EQ(sampled(quartet, 2), sampled(singles, 4));
    }
}

/// A material of four maps of words with `side` texels both ways, lit per pixel.
Shading lit_with_maps(int side) {
    const Image16 image(side, side);
    std::vector<TexturePtr> maps;
    for (int k = 0; k < 4; ++k) {
        maps.push_back(std::make_shared<const Texture>(
            std::span(&image, 1), TextureDescription{.format = TexelFormat::rgba16}));
    }
    ProgramMaterial material;
    material.units = Texture::quartet(maps);
    material.combiners = parse_combiners(R"(!!RC1.0
{ rgb { spare0 = tex0 . tex1; } }
{ rgb { discard = spare0 * tex2; discard = tex3 * col0; spare1 = sum(); } }
out.rgb = spare1;
out.a = unsigned_invert(zero);
)")
                             .program.value();
    material.col0_rgb = ColorInput::half_tangent;
    Shading shading;
    plan_shading(shading, {&material, 1}, machine_profile("ideal"), true);
    return shading;
}

// Packets have the addresses of a large quartet before lighting and ask for its texels; colours are
// what they are otherwise, without the channels that nobody reads.
TEST_P(KernelTest, TexelsOfLargeQuartetsAreAskedForBeforeLighting) {
    const Shading small = lit_with_maps(64), large = lit_with_maps(200);
    ASSERT_TRUE(std::holds_alternative<LightingCtx>(small.packet_inputs.front()));
    EXPECT_EQ(small.packet_inputs.size(), small.inputs.size());
    const std::vector<InputOp>& ops = large.packet_inputs;
    ASSERT_EQ(ops.size(), large.inputs.size() + 1);
    EXPECT_TRUE(std::holds_alternative<AddressCtx>(ops[0]));
    EXPECT_TRUE(std::holds_alternative<PrefetchQuartetCtx>(ops[1]));
    EXPECT_TRUE(std::holds_alternative<LightingCtx>(ops[2]));
    Random random(5);
    AlignedVector<float> attributes(std::size_t{kMaxAttributes} * kAttributeStride);
    for (float& x : attributes) x = random.real(-1.0F, 2.0F);
    // The program reads no alpha.
    const auto quartet = std::find_if(ops.begin(), ops.end(), [](const InputOp& op) {
        return std::holds_alternative<FetchQuartetCtx>(op);
    });
    for (const int channels : std::get<FetchQuartetCtx>(*quartet).channels) EXPECT_EQ(channels, 7);
    const auto fed = [&](const std::vector<InputOp>& inputs) {
        PacketMemory memory;
        AlignedVector<float> own = attributes;
        AlignedVector<std::int16_t> planes(
            static_cast<std::size_t>(large.program.plane_count) * kPacketSize, 77);
        Packet packet = memory.view();
        packet.attributes = own.data();
        packet.planes = planes.data();
        load_constants(large.program, packet);
        feed_inputs(inputs, NumberModel::wide, table(), {}, packet);
        run_program(large, table(), {}, packet);
        std::vector<std::int16_t> colors;
        for (const int plane : large.result)
            colors.insert(colors.end(), packet.planes + plane * kPacketSize,
                          packet.planes + (plane + 1) * kPacketSize);
        return colors;
    };
    EXPECT_EQ(fed(ops), fed(large.inputs));
}

// Between stages a table brings what its texture does, to the channels that are wanted.
TEST_P(KernelTest, TablesAreLookedUpAsTheirTextures) {
    for (unsigned seed = 0; seed < 40; ++seed) {
        Random random(seed);
        const bool one_d = random.chance(3);
        Image16 image(random.between(1, 40), one_d ? 1 : random.between(1, 20));
        for (std::size_t i = 0; i < image.rgba.size(); ++i)
            image.rgba[i] = i % 4 == 0 ? static_cast<std::uint16_t>(random.below(65536))
                                       : image.rgba[i / 4 * 4];
        TextureDescription d{.target = one_d ? TextureTarget::one_d : TextureTarget::two_d,
                             .format = TexelFormat::rgba16};
        d.sampler.wrap_s = d.sampler.wrap_t = Wrap::clamp_to_edge;
        constexpr std::array kSpans{TexelSpan::edges, TexelSpan::centers,
                                    TexelSpan::signed_centers};
        d.sampler.span_s = random.pick(kSpans);
        d.sampler.span_t = random.pick(kSpans);
        const Texture texture(std::span(&image, 1), d);
        PacketMemory memory;
        for (int k = 4; k < 6; ++k)
            for (int i = 0; i < kPacketSize; ++i)
                memory.plane(k)[i] = static_cast<std::int16_t>(random.between(-17000, 17000));
        BoundFetch fetch;
        fetch.target = one_d ? FetchTarget::table_1d : FetchTarget::table_2d;
        fetch.plane = {4, 5, 0};
        fetch.live = static_cast<std::uint8_t>(random.between(1, 15));
        const auto fetched = [&](const Texture& from) {
            PacketMemory own = memory;
            SamplePlan plan{NumberModel::wide, kScratchAttributes, 8};
            FreePlanes free{16, 35};
            Packet packet = own.view();
            for (const InputOp& op : plan_stage_fetch(fetch, from, plan, free))
                feed_input(op, NumberModel::wide, table(), {}, packet);
            std::vector<std::int16_t> live;
            for (int c = 0; c < 4; ++c)
                if ((fetch.live >> c & 1) != 0)
                    live.insert(live.end(), own.plane(c), own.plane(c + 1));
            return live;
        };
        const TexturePtr lean = Texture::table(texture);
        EXPECT_EQ(lean->texel(0, 0, texture.width(), 0, 3),
                  texture.texel(0, 0, texture.width(), 0, 3));
        ASSERT_EQ(fetched(*lean), fetched(texture)) << seed;
    }
}

TEST(Sample, RefusesWhatCannotBe) {
    SamplePlan plan{NumberModel::nine_bit, kScratchAttributes, kScratchPlanes};
    std::vector<InputOp> ops;
    const Image16 image(1, 1);
    const Texture wide(std::span(&image, 1), {.format = TexelFormat::rgba16});
    EXPECT_THROW(plan_sample(wide, {0, 1, -1, -1, true}, {0, 0}, plan, ops), Error);
    const TexturePtr cube = make_texture(std::vector<Image8>(6, plain_image(1, 1, {})),
                                         {.target = TextureTarget::cube});
    EXPECT_THROW(plan_sample(*cube, {0, 1, -1, -1, true}, {0, 0}, plan, ops), Error);
    EXPECT_FALSE(needs_level_of_detail(*cube));
}

}  // namespace
}  // namespace burnish
