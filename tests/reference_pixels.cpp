#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "kernel_test.hpp"
#include "tests/set_up.hpp"

/// Numbers worked out by hand for everything around the combiners, for every table: vertices,
/// coverage, depth, interpolation, texels, pixels.
namespace burnish {
namespace {

class ReferencePixels : public KernelTest {};
INSTANTIATE_TEST_SUITE_P(Isa, ReferencePixels, every_table(), isa_name);

int tile_pixel(int x, int y) {
    return (y / 8 * 8 + x / 8) * 64 + y % 8 * 8 + x % 8;
}

ScreenVertex transformed(const KernelTable& table, float x, float y, float z, float w,
                         float snap_bias) {
    AlignedVector<float> xs(16, x), ys(16, y), zs(16, z);
    ScreenVertex screen{};
    HomogeneousVertex homogeneous{};
    // 100 x 50 pixels, 1/16 pixel grid; w is a constant of the matrix.
    table.transform({xs.data(),
                     ys.data(),
                     zs.data(),
                     1,
                     {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, w},
                     {50, 25, 100, 50, 16, snap_bias},
                     &screen,
                     &homogeneous});
    return screen;
}

TEST_P(ReferencePixels, VerticesSnapToTheGrid) {
    // x = (0.0149 / 2 + 1) * 50 = 50.3725 pixels = 805.96 steps; y = 25 (1 - 0.25) = 18.75 = 300.
    const ScreenVertex nearest = transformed(table(), 0.0149F, 0.5F, 1.0F, 2.0F, 0.5F);
    EXPECT_EQ(nearest.x, 806 * 16);
    EXPECT_EQ(nearest.y, 300 * 16);
    EXPECT_EQ(nearest.z, 0.75F);
    EXPECT_EQ(nearest.outcode, 0U);
    EXPECT_EQ(transformed(table(), 0.0149F, 0.5F, 1.0F, 2.0F, 0.0F).x, 805 * 16);
    // Downwards, not towards zero: x = -0.5 pixels - 0.3 steps = -8.3 steps.
    EXPECT_EQ(transformed(table(), -1.010375F, 0.0F, 0.0F, 1.0F, 0.0F).x, -9 * 16);
}

TEST_P(ReferencePixels, OutcodesOfVertices) {
    const auto outcode = [&](float x, float y, float z, float w) {
        return transformed(table(), x, y, z, w, 0.5F).outcode;
    };
    EXPECT_EQ(outcode(-1.5F, 0, 0, 1), Outcode::left);
    EXPECT_EQ(outcode(1.5F, -1.5F, 0, 1), Outcode::right | Outcode::below);
    EXPECT_EQ(outcode(0, 1.5F, -1.5F, 1), Outcode::above | Outcode::near);
    EXPECT_EQ(outcode(0, 0, 1.5F, 1), Outcode::far);
    EXPECT_EQ(outcode(1000, 0, 0, 1), Outcode::right | Outcode::guard);
    EXPECT_EQ(outcode(0, 0, 0, 0), Outcode::guard);
    EXPECT_EQ(outcode(3e38F, 0, 0, 1), Outcode::nonfinite);
}

TileTriangle flat(float z) {
    TileTriangle t{};
    t.x1 = t.y1 = kTileSize - 1;
    t.z = z;
    t.z_high = 1.0F;
    t.pass_less = t.depth_write = 1;
    t.id = 1;
    return t;
}

void set_edge(TileTriangle& t, int a, int b, int c) {
    t.a[t.edges] = a;
    t.b[t.edges] = b;
    t.c[t.edges] = c;
    ++t.edges;
}

struct Tile {
    AlignedVector<float> depth = AlignedVector<float>(kTilePixels, 1.0F);
    AlignedVector<std::uint32_t> id = AlignedVector<std::uint32_t>(kTilePixels, kNoTriangle);
    AlignedVector<float> block_far = AlignedVector<float>(kTileBlocks, 1.0F);
    std::uint64_t drawn = 0;  ///< of the last triangle

    void draw(const KernelTable& table, const TileTriangle& t) {
        table.rasterize({&t, 1, depth.data(), id.data(), block_far.data(), &drawn});
    }
    [[nodiscard]] std::uint32_t at(int x, int y) const {
        return id[static_cast<std::size_t>(tile_pixel(x, y))];
    }
};

// The square (0, 0) .. (4, 4) cut from (4, 0) to (0, 4). Pixel centres on the cut belong to the
// lower right half, whose left edge it is: 6 + 10 pixels.
TEST_P(ReferencePixels, TopLeftRuleSharesTheDiagonal) {
    TileTriangle upper = flat(0.5F);
    set_edge(upper, 1024, 0, 512);        // x > 0
    set_edge(upper, 0, 1024, 512);        // y > 0
    set_edge(upper, -1024, -1024, 3071);  // x + y < 4
    upper.x1 = upper.y1 = 3;
    TileTriangle lower = flat(0.5F);
    set_edge(lower, 1024, 1024, -3072);  // x + y >= 4
    set_edge(lower, -1024, 0, 3583);     // x < 4
    set_edge(lower, 0, -1024, 3583);     // y < 4
    lower.x1 = lower.y1 = 3;
    lower.id = 2;
    for (const bool upper_first : {true, false}) {
        Tile tile;
        tile.draw(table(), upper_first ? upper : lower);
        tile.draw(table(), upper_first ? lower : upper);
        for (int y = 0; y < 5; ++y) {
            for (int x = 0; x < 5; ++x) {
                const std::uint32_t wanted = x > 3 || y > 3 ? kNoTriangle : x + y < 3 ? 1 : 2;
                EXPECT_EQ(tile.at(x, y), wanted) << x << ", " << y;
            }
        }
    }
}

// Corners at pixels (1, 1), (4, 1) and (1, 4). Of the centres in the box those at x + y = 5 lie on
// the edge to the lower right, which is neither a left nor a top one: 3 pixels are left.
TEST_P(ReferencePixels, TinyTriangle) {
    const std::array vertices{ScreenVertex{256, 256, 0.25F, 0}, ScreenVertex{1024, 256, 0.5F, 0},
                              ScreenVertex{256, 1024, 0.75F, 0}};
    for (const bool backwards : {false, true}) {
        const OneTriangle one = set_up(
            table(), {{vertices[0], vertices[backwards ? 2 : 1], vertices[backwards ? 1 : 2]}},
            {100, 100});
        ASSERT_EQ(one.counts.drawn, 1);
        EXPECT_EQ(one.covered, 0x103U);
        const SetupTriangle& t = one.triangle;
        EXPECT_EQ(t.swapped, backwards ? 1U : 0U);
        EXPECT_TRUE(t.box.x0 == 1 && t.box.y0 == 1 && t.box.x1 == 3 && t.box.y1 == 3);
        // The last corner is the farthest; 1/4 over 3 pixels and 1/2 over 3 pixels. At (1.5, 4.5):
        // 1/4 + 1/2 / 12 + 7/2 / 6 = 7/8.
        EXPECT_EQ(t.reference_x, 1);
        EXPECT_EQ(t.reference_y, 4);
        EXPECT_FLOAT_EQ(t.zx, 1.0F / 12);
        EXPECT_FLOAT_EQ(t.zy, 1.0F / 6);
        EXPECT_FLOAT_EQ(t.z, 0.875F);
        EXPECT_EQ(std::pair(t.z_low, t.z_high), std::pair(0.25F, 0.75F));
    }
}

// Its mask at (7, 7) of a tile: pixels (7, 7), (8, 7) and (7, 8) of blocks 0, 1 and 8, the second
// of which shows something nearer.
TEST_P(ReferencePixels, MaskAcrossBlocks) {
    const TileEntry entry{0x103, 0, 7, 7, 0};
    SetupTriangle triangle{};
    triangle.z = triangle.z_low = triangle.z_high = 0.5F;
    AlignedVector<float> depth(kTilePixels + 1, 1.0F), far(kTileBlocks, 1.0F);
    AlignedVector<std::uint32_t> id(kTilePixels + 1, kNoTriangle);
    depth[64 + 56] = 0.25F;
    std::uint64_t drawn = 0;
    std::vector<std::uint8_t> blank_depths(kTileBlocks), blank_ids(kTileBlocks);
    table().rasterize_tiny({&entry,
                            1,
                            &triangle,
                            {1, 0, 0, 1},
                            0,
                            0,
                            9,
                            depth.data(),
                            id.data(),
                            far.data(),
                            &drawn,
                            blank_depths.data(),
                            blank_ids.data()});
    EXPECT_EQ(drawn, 0x101U);
    EXPECT_EQ(std::count(id.begin(), id.begin() + kTilePixels, 9U), 2);
    EXPECT_EQ(std::pair(id[63], depth[63]), std::pair(9U, 0.5F));
    EXPECT_EQ(std::pair(id[8 * 64 + 7], depth[8 * 64 + 7]), std::pair(9U, 0.5F));
    EXPECT_EQ(depth[64 + 56], 0.25F);
}

TEST_P(ReferencePixels, DepthIsOneExpressionClampedToTheTriangle) {
    TileTriangle t = flat(0.25F);
    t.zx = 1.0F / 64;
    t.zy = 1.0F / 128;
    t.offset_x = 10;
    t.offset_y = -3;
    t.z_low = 0.375F;
    t.z_high = 0.5F;
    Tile tile;
    tile.draw(table(), t);
    const auto depth = [&](int x, int y) {
        return tile.depth[static_cast<std::size_t>(tile_pixel(x, y))];
    };
    EXPECT_EQ(depth(2, 5), 0.453125F);  // 0.25 + 12 / 64 + 2 / 128
    EXPECT_EQ(depth(63, 63), 0.5F);
    EXPECT_EQ(depth(0, 0), 0.3828125F);
    t.offset_x = 0;
    Tile near;
    near.draw(table(), t);
    EXPECT_EQ(near.depth[0], 0.375F);
}

TEST_P(ReferencePixels, DepthTestsAndWrites) {
    for (int pass = 0; pass < 8; ++pass) {
        const std::array<float, 3> depths{0.25F, 0.5F, 0.75F};  // less, equal, greater than 0.5
        for (std::size_t k = 0; k < 3; ++k) {
            Tile tile;
            std::fill(tile.depth.begin(), tile.depth.end(), 0.5F);
            std::fill(tile.block_far.begin(), tile.block_far.end(), 0.5F);
            TileTriangle t = flat(depths[k]);
            t.pass_less = pass & 1;
            t.pass_equal = pass >> 1 & 1;
            t.pass_greater = static_cast<std::uint8_t>(pass >> 2);
            t.depth_write = k == 0 ? 0 : 1;
            tile.draw(table(), t);
            const bool passes = (pass >> k & 1) != 0;
            EXPECT_EQ(tile.at(5, 9), passes ? 1 : kNoTriangle) << "pass bits " << pass;
            EXPECT_EQ(tile.depth[0], passes && k != 0 ? depths[k] : 0.5F) << "pass bits " << pass;
        }
    }
}

TEST_P(ReferencePixels, FragmentsTriangleByTriangle) {
    AlignedVector<std::uint32_t> id(kTilePixels, kNoTriangle);
    id[643] = id[703] = id[64] = 2;
    id[644] = 0;
    id[5] = 3;  // not of these triangles
    const std::array<std::uint64_t, 3> drawn{1U << 10, ~std::uint64_t{0}, 1U << 10 | 1U << 1};
    std::vector<std::uint16_t> pixels(kTilePixels + 16);
    std::array<std::uint32_t, 5> first{};
    table().collect({id.data(), drawn.data(), 3, pixels.data(), first.data()});
    EXPECT_EQ(std::vector(first.begin(), first.end() - 1),
              (std::vector<std::uint32_t>{0, 1, 1, 4}));
    EXPECT_EQ(pixels[0], 644);
    EXPECT_EQ(pixels[1], 64);
    EXPECT_EQ(pixels[2], 643);
    EXPECT_EQ(pixels[3], 703);
}

TEST_P(ReferencePixels, DrawnBlocksAreThoseWhereAFragmentPassed) {
    Tile tile;
    TileTriangle t = flat(0.5F);
    t.x0 = 7;  // columns 7 .. 8, rows 0 .. 15: blocks 0, 1, 8, 9
    t.x1 = 8;
    t.y1 = 15;
    set_edge(t, 1, 0, -7);
    set_edge(t, -1, 0, 8);
    set_edge(t, 0, -1, 15);
    tile.depth[static_cast<std::size_t>(tile_pixel(7, 3))] = 0.75F;
    for (int y = 0; y < 8; ++y) {  // nothing passes in block 1
        tile.depth[static_cast<std::size_t>(tile_pixel(8, y))] = 0.25F;
    }
    tile.draw(table(), t);
    EXPECT_EQ(tile.drawn, 1U | 1U << 8 | 1U << 9);
}

TEST_P(ReferencePixels, AttributesAreDividedByTheInterpolatedOneOverW) {
    // Tile pixel (9, 2) is pixel (1, 12) from the reference pixel.
    Equations equations(2);
    equations.set(0, 0, {1.0F, 1.0F, 0.0F});
    equations.set(1, 0, {0.0F, 1.0F, 0.0F});
    equations.set(2, 0, {0.25F, 0.0F, 0.5F});
    const burnish::Run run{0, 1, -8, 10};
    PacketMemory packet;
    packet.count = 1;
    packet.pixels[0] = static_cast<std::uint16_t>(tile_pixel(9, 2));
    Packet view = packet.view();
    table().attributes(view, {&run, 1, 2, equations.data()});
    EXPECT_EQ(packet.attribute(0)[0], 0.5F);    // 1 / (1 + 1)
    EXPECT_EQ(packet.attribute(1)[0], 3.125F);  // (0.25 + 6) / 2
}

TEST_P(ReferencePixels, LightingInTheFrameOfTheSurface) {
    PacketMemory packet;
    packet.count = 1;
    const std::array<float, 12> frame{1, 0, 0, 0, 1, 0, 0, 0, 1, 5, 6, 7};
    for (int k = 0; k < 12; ++k) packet.attribute(k)[0] = frame[static_cast<std::size_t>(k)];
    // Light (3, 0, 4) away: (0.6, 0, 0.8). Eye straight above.
    LightingCtx ctx{0, {8, 6, 11}, 1.0F, {5, 6, 9}, -1, 12, 15, 18, 19};
    Packet view = packet.view();
    table().lighting(view, ctx);
    EXPECT_FLOAT_EQ(packet.attribute(12)[0], 0.8F);
    EXPECT_FLOAT_EQ(packet.attribute(13)[0], 0.5F);
    EXPECT_FLOAT_EQ(packet.attribute(14)[0], 0.9F);
    EXPECT_EQ(packet.attribute(15)[0], 0.5F);
    EXPECT_EQ(packet.attribute(17)[0], 1.0F);
    EXPECT_FLOAT_EQ(packet.attribute(18)[0], 0.8F);
    EXPECT_FLOAT_EQ(packet.attribute(19)[0], std::sqrt(0.9F));  // half the angle: (1 + 0.8) / 2
    // A directional light is no position; from below the surface it gives no light.
    ctx = {0, {0, 0, -2}, 0.0F, {5, 6, 9}, -1, -1, -1, 18, -1};
    table().lighting(view, ctx);
    EXPECT_EQ(packet.attribute(18)[0], 0.0F);
}

// Normal 3 long, tangent with a part along it, bitangent on the side that mirrored uv have.
TEST_P(ReferencePixels, LightingInAnOrthonormalFrame) {
    PacketMemory packet;
    packet.count = 1;
    const std::array<float, 12> frame{4, 3, 7, 0, -5, 1, 0, 0, 3, 0, 0, 0};
    for (int k = 0; k < 12; ++k) packet.attribute(k)[0] = frame[static_cast<std::size_t>(k)];
    // T = (0.8, 0.6, 0), N x T = (-0.6, 0.8, 0), B = (0.6, -0.8, 0). The viewer, not a place:
    // (0, 0, 1); light (1, 0, 0); half their sum is (1/2, 0, 1/2).
    LightingCtx ctx{0, {2, 0, 0}, 0.0F, {0, 0, 9}, 12, 15, 18, 21, 22};
    ctx.eye_w = 0.0F;
    ctx.raw_half = ctx.orthonormal = 1;
    Packet view = packet.view();
    table().lighting(view, ctx);
    const std::array<float, 11> want{0.7F, 0.65F, 0.75F, 0.9F, 0.8F, 0.5F,
                                     0.5F, 0.5F,  1.0F,  0.0F, 0.5F};
    for (int k = 0; k < 11; ++k)
        EXPECT_NEAR(packet.attribute(12 + k)[0], want[static_cast<std::size_t>(k)], 1e-6F) << k;
}

struct Addressed {
    std::int32_t texel;
    int weight;
};

Addressed addressed(const KernelTable& table, float u, AddressMode mode, bool linear) {
    PacketMemory packet;
    packet.count = 1;
    std::fill_n(packet.attribute(0), kFragmentGroup, u);
    std::fill_n(packet.attribute(1), kFragmentGroup, 0.5F);
    Packet view = packet.view();
    table.address(view, {0, 1, -1, 4, 1, 20, mode, AddressMode::clamp_to_edge,
                         static_cast<std::uint8_t>(linear ? 1 : 0)});
    return {packet.texel[0] / 4, packet.weight_x[0]};
}

TEST_P(ReferencePixels, AddressesInARowOfFourTexels) {
    const auto expect = [&](float u, AddressMode mode, bool linear, int texel, int weight) {
        const Addressed a = addressed(table(), u, mode, linear);
        EXPECT_EQ(a.texel, texel) << "u " << u;
        EXPECT_EQ(a.weight, weight) << "u " << u;
    };
    expect(0.375F, AddressMode::repeat, true, 1, 0);  // the centre of texel 1
    expect(0.4375F, AddressMode::repeat, true, 1, 64);
    expect(0.0F, AddressMode::repeat, true, 3, 128);
    expect(0.0F, AddressMode::clamp_to_edge, true, 0, 0);
    expect(1.0F, AddressMode::clamp_to_edge, true, 3, 128);
    expect(1.0F, AddressMode::clamp_to_edge, false, 3, 0);
    expect(-0.125F, AddressMode::repeat, false, 3, 0);
    expect(0.4375F, AddressMode::repeat, false, 1, 0);
}

TEST_P(ReferencePixels, FilterRoundsAcrossThenDown) {
    // Channels: corners (0, 1; 0, 0), (0, 255; 0, 255), white, and 128 everywhere; all weights 1/2.
    std::array<std::uint8_t, 16> texels{0, 0, 255, 128, 1, 255, 255, 128,
                                        0, 0, 255, 128, 0, 255, 255, 128};
    for (std::uint8_t& t : texels) t = static_cast<std::uint8_t>(127 - t);  // as FetchCtx has them
    PacketMemory packet;
    std::fill(packet.texel.begin(), packet.texel.end(), 0);
    std::fill(packet.weight_x.begin(), packet.weight_x.end(), std::int16_t{128});
    packet.weight_y = packet.weight_x;
    packet.count = 1;
    Packet view = packet.view();
    table().fetch_nine_bit(view, {{texels.data()}, {0}, {0}, 1, 8});
    // 1/4 comes out as 1: 1/2 rounds up across, then again down. 127.5 rounds up.
    const std::array<int, 4> nine_bit{1, 128, 255, 128};
    for (int c = 0; c < 4; ++c)
        EXPECT_EQ(packet.plane(c)[0], nine_bit[static_cast<std::size_t>(c)]) << "channel " << c;
    table().fetch_wide(view, {{texels.data()}, {0}, {0}, 1, 8});
    // 1/4 * 16384 / 255 = 16.06, 16384 / 2, 16384, 128 * 16384 / 255 = 8224.25
    const std::array<int, 4> wide{16, 8192, 16384, 8224};
    for (int c = 0; c < 4; ++c)
        EXPECT_EQ(packet.plane(c)[0], wide[static_cast<std::size_t>(c)]) << "channel " << c;
}

TEST_P(ReferencePixels, PixelsInThreeFormats) {
    PacketMemory packet;
    packet.count = 1;
    packet.pixels[0] = 7;
    const std::array<int, 4> codes{0, 1, 128, 255};
    const std::array<int, 4> wide_codes{0, 8192, 33, 16384};
    for (int c = 0; c < 4; ++c) {
        packet.plane(c)[0] = static_cast<std::int16_t>(codes[static_cast<std::size_t>(c)]);
        packet.plane(4 + c)[0] = static_cast<std::int16_t>(wide_codes[static_cast<std::size_t>(c)]);
    }
    AlignedVector<std::uint8_t> bytes(std::size_t{4} * kTilePixels);
    AlignedVector<std::uint16_t> words(std::size_t{4} * kTilePixels);
    AlignedVector<float> floats(std::size_t{4} * kTilePixels);
    Packet view = packet.view();
    const auto expect = [&](const std::array<int, 4>& byte, const std::array<int, 4>& word,
                            const std::array<float, 4>& real) {
        for (std::size_t c = 0; c < 4; ++c) {
            EXPECT_EQ(int{bytes[28 + c]}, byte[c]);
            EXPECT_EQ(int{words[28 + c]}, word[c]);
            EXPECT_EQ(floats[28 + c], real[c]);
        }
    };
    table().store_nine_bit(view, {{0, 1, 2, 3}, StoreFormat::rgba8, bytes.data()});
    table().store_nine_bit(view, {{0, 1, 2, 3}, StoreFormat::rgba16, words.data()});
    table().store_nine_bit(view, {{0, 1, 2, 3}, StoreFormat::rgba32f, floats.data()});
    expect(codes, {0, 257, 32896, 65535}, {0.0F, 1.0F / 255, 128.0F / 255, 1.0F});
    table().store_wide(view, {{4, 5, 6, 7}, StoreFormat::rgba8, bytes.data()});
    table().store_wide(view, {{4, 5, 6, 7}, StoreFormat::rgba16, words.data()});
    table().store_wide(view, {{4, 5, 6, 7}, StoreFormat::rgba32f, floats.data()});
    // 127.5 and 32767.5 round up; 33 is 0.514 of a byte and 131.998 of a word.
    expect({0, 128, 1, 255}, {0, 32768, 132, 65535}, {0.0F, 0.5F, 33.0F / 16384, 1.0F});
    // Floats show registers, too, below 0 and above 1.
    packet.plane(0)[0] = -256;
    packet.plane(4)[0] = -32768;
    packet.plane(5)[0] = 32767;
    table().store_nine_bit(view, {{0, 1, 2, 3}, StoreFormat::rgba32f, floats.data()});
    EXPECT_EQ(floats[28], -256.0F / 255);
    table().store_wide(view, {{4, 5, 6, 7}, StoreFormat::rgba32f, floats.data()});
    EXPECT_EQ(floats[28], -2.0F);
    EXPECT_EQ(floats[29], 32767.0F / 16384);
}

}  // namespace
}  // namespace burnish
