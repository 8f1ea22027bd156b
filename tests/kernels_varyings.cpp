#include <array>
#include <cmath>
#include <vector>

#include "kernel_test.hpp"

/// From triangles to register planes: interpolation, lighting vectors, encoding.
namespace burnish {
namespace {

INSTANTIATE_TEST_SUITE_P(Isa, KernelTest, every_table(), isa_name);

/// Runs that share out `count` fragments, each with its own planes and reference pixel.
struct Runs {
    Equations equations;
    std::vector<Run> runs;

    Runs(Random& random, int count, int attributes, int longest) : equations(attributes) {
        for (int first = 0; first < count;) {
            const int length = std::min(count - first, random.between(1, longest));
            runs.push_back(
                {first, length, random.between(-8192, 24576), random.between(-8192, 24576)});
            first += length;
        }
        for (int r = 0; r < static_cast<int>(runs.size()); ++r) {
            for (int e = 0; e <= attributes; ++e) {
                if (random.chance(20)) continue;  // all 0
                equations.set(
                    e, r,
                    {random.real(-2.0F, 2.0F), random.real(-0.1F, 0.1F), random.real(-0.1F, 0.1F)});
            }
        }
    }

    [[nodiscard]] AttributesCtx context(int attributes) const {
        return {runs.data(), static_cast<int>(runs.size()), attributes, equations.data()};
    }
};

Written attribute_range(int first, int count) {
    Written written;
    for (int k = 0; k < count; ++k) written.attributes.push_back(first + k);
    return written;
}

TEST_P(KernelTest, AttributesOfRandomRuns) {
    for (int seed = 0; seed < 1500; ++seed) {
        Random random(static_cast<unsigned>(seed));
        PacketMemory packet;
        packet.count = random.chance(3) ? kPacketSize : random.between(1, kPacketSize);
        if (random.chance(2)) packet.shuffle_pixels(random);
        const int attributes = random.between(1, 20);
        const Runs runs(random, packet.count, attributes, random.chance(2) ? 9 : 200);
        ASSERT_EQ(stage_difference(table(), &KernelTable::attributes, packet,
                                   runs.context(attributes), attribute_range(0, attributes)),
                  "")
            << name("attributes") << ", seed " << seed;
    }
}

// A run may begin and end anywhere; the last of three shows what the others may have overwritten.
TEST_P(KernelTest, AttributesOfRunsOfEveryStartAndLength) {
    Random random(7);
    for (int start = 0; start <= 36; ++start) {
        for (int length = 1; length <= 70; ++length) {
            PacketMemory packet;
            packet.count = std::min(kPacketSize, start + length + random.between(0, 3));
            Runs runs(random, packet.count, 2, kPacketSize);
            for (int k = 0; k < 9; ++k)
                runs.equations.set(
                    k % 3, k / 3,
                    {random.real(0.5F, 1.0F), random.real(0.0F, 0.1F), random.real(0.0F, 0.1F)});
            runs.runs.clear();
            if (start > 0) runs.runs.push_back({0, start, 3, 5});
            runs.runs.push_back({start, length, -17, 900});
            if (packet.count > start + length)
                runs.runs.push_back({start + length, packet.count - start - length, 64, -64});
            ASSERT_EQ(stage_difference(table(), &KernelTable::attributes, packet, runs.context(2),
                                       attribute_range(0, 2)),
                      "")
                << name("attributes") << ", run of " << length << " from " << start;
        }
    }
}

/// Triangles of a small mesh and what its vertices have.
struct PlaneTriangles {
    static constexpr int kVertices = 40;
    static constexpr std::array<float, 5> kWild{0.0F, 1e-38F, 3e38F, kInfinity, kNan};
    std::vector<HomogeneousVertex> homogeneous;
    std::vector<float> rows;
    std::vector<PlaneTriangle> triangles;
    std::ptrdiff_t stride;

    PlaneTriangles(Random& random, int count, int attributes, bool wild)
        : stride(attributes + random.below(4)) {
        const auto number = [&](float low, float high) {
            return wild && random.chance(30) ? random.pick(kWild) : random.real(low, high);
        };
        for (int v = 0; v < kVertices; ++v) {
            const float w = number(0.1F, 100.0F);
            homogeneous.push_back(
                {number(-8192.0F, 24575.0F) * w, number(-8192.0F, 24575.0F) * w, w / 2, w});
        }
        for (std::ptrdiff_t i = 0; i < kVertices * stride + 3; ++i)
            rows.push_back(number(-2.0F, 2.0F));
        for (int k = 0; k < count; ++k) {
            PlaneTriangle t{};
            for (int i = 0; i < 3; ++i) {
                t.x[i] = random.between(-8192 * 256, 24575 * 256);
                t.y[i] = random.between(-8192 * 256, 24575 * 256);
                t.vertex[i] = static_cast<std::uint32_t>(random.below(kVertices));
            }
            if (random.chance(20)) t.x[1] = t.x[2] = t.x[0];  // edge-on
            if (random.chance(20)) t.vertex[2] = t.vertex[1];
            t.reference_x = random.below(16384);
            t.reference_y = random.below(16384);
            t.clipped = random.chance(4) ? 1 : 0;
            triangles.push_back(t);
        }
    }
};

TEST_P(KernelTest, AttributePlanesOfRandomTriangles) {
    for (int seed = 0; seed < 600; ++seed) {
        Random random(static_cast<unsigned>(seed));
        const int count = random.chance(4) ? kPacketSize : random.between(1, 70);
        const int attributes = random.below(20);
        const PlaneTriangles of(random, count, attributes, random.chance(2));
        const auto made_by = [&](const KernelTable& kernels) {
            Equations out(attributes + 1);  // one more, which stays as it is
            std::fill(out.rows.begin(), out.rows.end(), -77.5F);
            kernels.attribute_planes({of.triangles.data(), count, of.homogeneous.data(),
                                      of.rows.data(), of.stride, attributes, out.rows.data()});
            return out;
        };
        const Equations got = made_by(table()), want = made_by(table_reference());
        for (std::size_t i = 0; i < got.rows.size(); ++i) {
            const std::size_t column = i % kAttributeStride, row = i / kAttributeStride;
            const auto end = static_cast<std::size_t>(count);
            const bool written = row < static_cast<std::size_t>(3 * (attributes + 1));
            if (written && column >= end && column < end + 16) continue;
            ASSERT_TRUE(same_bits(got.rows[i], want.rows[i]))
                << name("attribute_planes") << ", seed " << seed << ", row " << row << ", triangle "
                << column << " of " << count << ": got " << got.rows[i] << ", want "
                << want.rows[i];
        }
    }
}

// Corners at (0, 0), (8, 0) and (0, 8) pixels: 1/w = 1 there, and u is x / 8.
TEST_P(KernelTest, AttributePlanesOfATriangleThatFacesTheEye) {
    const std::vector<HomogeneousVertex> corners{{0, 0, 0, 1}, {8, 0, 0, 1}, {0, 8, 0, 1}};
    const std::vector<float> rows{0.0F, 1.0F, 0.0F, 0.0F, 0.0F, 0.0F};
    for (const int clipped : {0, 1}) {
        const PlaneTriangle t{{0, 2048, 0}, {0, 0, 2048}, {0, 1, 2}, 2, 1, clipped};
        Equations out(1);
        table().attribute_planes({&t, 1, corners.data(), rows.data(), 1, 1, out.rows.data()});
        const std::array want{1.0F, 0.0F, 0.0F, 2.5F / 8, 1.0F / 8, 0.0F};  // at pixel (2, 1)
        for (std::size_t row = 0; row < want.size(); ++row)
            EXPECT_EQ(out.rows[row * kAttributeStride], want[row]) << row << ' ' << clipped;
    }
}

// All corners in one plane through the eye: nothing can be interpolated.
TEST_P(KernelTest, AttributePlanesOfATriangleSeenEdgeOnAreTheFirstCorner) {
    const std::vector<HomogeneousVertex> corners(3, {4, 4, 0, 1});
    const std::vector<float> rows{0.25F, 1.0F, 0.0F, 0.0F, 0.0F, 0.0F};
    const PlaneTriangle t{{0, 256, 512}, {0, 256, 512}, {0, 1, 2}, 0, 0, 0};
    Equations out(1);
    table().attribute_planes({&t, 1, corners.data(), rows.data(), 1, 1, out.rows.data()});
    const std::array want{1.0F, 0.0F, 0.0F, 0.25F, 0.0F, 0.0F};
    for (std::size_t row = 0; row < want.size(); ++row)
        EXPECT_EQ(out.rows[row * kAttributeStride], want[row]) << row;
}

TEST_P(KernelTest, LightingOfRandomFrames) {
    for (int seed = 0; seed < 1500; ++seed) {
        Random random(static_cast<unsigned>(seed));
        PacketMemory packet;
        packet.count = random.chance(3) ? kPacketSize : random.between(1, kPacketSize);
        LightingCtx ctx{};
        ctx.frame = random.below(4);
        for (int i = 0; i < 3; ++i) {
            ctx.light[i] = random.real(-10.0F, 10.0F);
            ctx.eye[i] = random.real(-10.0F, 10.0F);
        }
        ctx.light_w = random.chance(2) ? 1.0F : 0.0F;
        ctx.eye_w = random.chance(3) ? 0.0F : 1.0F;
        ctx.raw_half = random.chance(3) ? 1 : 0;
        ctx.orthonormal = random.chance(2) ? 1 : 0;
        ctx.half_vector = random.chance(3) ? -1 : 17;
        ctx.light_vector = random.chance(3) ? -1 : 20;
        ctx.view_vector = random.chance(3) ? -1 : 23;
        ctx.n_dot_l = random.chance(3) ? -1 : 26;
        ctx.h_dot_l = random.chance(3) ? -1 : 27;
        for (int k = 0; k < 12; ++k) {
            for (int i = 0; i < packet.count; ++i)
                packet.attribute(ctx.frame + k)[i] = random.real(-1.5F, 1.5F);
        }
        // Zero frames, huge ones, and an eye or a light in the surface: 0 / 0 and overflow.
        for (int i = 0; i < packet.count; i += 1 + random.below(50)) {
            const float value = random.pick(std::array{0.0F, 1e20F, kInfinity, kNan, 1e-30F});
            packet.attribute(ctx.frame + random.below(12))[i] = value;
            for (int c = 0; c < 3 && random.chance(2); ++c)
                packet.attribute(ctx.frame + 9 + c)[i] =
                    random.chance(2) ? ctx.eye[c] : ctx.light[c];
        }
        Written written;
        for (const int first : {ctx.half_vector, ctx.light_vector, ctx.view_vector})
            for (int c = 0; c < 3 && first >= 0; ++c) written.attributes.push_back(first + c);
        for (const int plane : {ctx.n_dot_l, ctx.h_dot_l})
            if (plane >= 0) written.attributes.push_back(plane);
        ASSERT_EQ(stage_difference(table(), &KernelTable::lighting, packet, ctx, written), "")
            << name("lighting") << ", seed " << seed;
    }
}

using EncodeStage = void (*KernelTable::*)(Packet&, const EncodeCtx&) noexcept;

void check_encode(const KernelTable& table, EncodeStage stage, const std::vector<float>& values) {
    for (std::size_t first = 0; first < values.size(); first += kPacketSize) {
        PacketMemory packet;
        packet.count = static_cast<int>(std::min<std::size_t>(kPacketSize, values.size() - first));
        std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(first), packet.count,
                    packet.attribute(3));
        ASSERT_EQ(stage_difference(table, stage, packet, EncodeCtx{3, 11}, {.planes = {11}}), "")
            << table.isa << " encode, values from " << values[first];
    }
}

/// The border below every code with its neighbours, and everything that is not in [0, 1].
std::vector<float> borders(int one) {
    std::vector<float> values{kNan,    -kNan, kInfinity, -kInfinity, -0.0F,  0.0F, 1e-45F,
                              -1e-45F, 3e38F, -3e38F,    1e10F,      -1e10F, 2.0F, -1.0F};
    for (int code = -2; code <= one + 2; ++code) {
        const auto border = (static_cast<float>(code) - 0.5F) / static_cast<float>(one);
        const float below = std::nextafter(border, -kInfinity);
        const float above = std::nextafter(border, kInfinity);
        values.insert(values.end(), {border, below, above, std::nextafter(below, -kInfinity),
                                     std::nextafter(above, kInfinity),
                                     static_cast<float>(code) / static_cast<float>(one)});
    }
    return values;
}

TEST_P(KernelTest, NineBitEncodeAroundEveryBorder) {
    check_encode(table(), &KernelTable::encode_nine_bit, borders(255));
}

TEST_P(KernelTest, WideEncodeAroundEveryBorder) {
    check_encode(table(), &KernelTable::encode_wide, borders(16384));
}

}  // namespace
}  // namespace burnish
