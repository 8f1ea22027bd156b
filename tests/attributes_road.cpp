// Colours of raw triangles from vertex to frame, against double precision: compact triangles, long
// ones, slivers, corners far in front of each other. The frame stores what the registers held.
#include <gtest/gtest.h>

#include <array>
#include <burnish/renderer.hpp>
#include <cmath>
#include <memory>

#include "core/dmath.hpp"
#include "kernel_test.hpp"
#include "tests/vertex_color.hpp"

namespace burnish {
namespace {

constexpr int kWidth = 200, kHeight = 130;

/// Window coordinates are whole steps of 1/256 pixel, so snapping moves nothing.
struct Corner {
    double x, y, w;
    std::array<float, 4> color;
};
using Corners = std::array<Corner, 3>;

double cross(double ax, double ay, double bx, double by) {
    return ax * by - ay * bx;
}

/// Colour at a point, perspective-correct.
std::array<double, 4> color_at(const Corners& t, double x, double y) {
    std::array<double, 3> part{};
    double sum = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
        const Corner &p = t[(i + 1) % 3], &q = t[(i + 2) % 3];
        part[i] = cross(p.x - x, p.y - y, q.x - x, q.y - y) / t[i].w;
        sum += part[i];
    }
    std::array<double, 4> color{};
    for (std::size_t c = 0; c < 4; ++c) {
        for (std::size_t i = 0; i < 3; ++i) {
            color[c] += part[i] / sum * static_cast<double>(t[i].color[c]);
        }
    }
    return color;
}

/// Width over length; 0 for a triangle without area.
double thickness(const Corners& t) {
    double longest = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
        const Corner &p = t[i], &q = t[(i + 1) % 3];
        longest = std::max(longest, std::hypot(q.x - p.x, q.y - p.y));
    }
    const double area =
        std::abs(cross(t[1].x - t[0].x, t[1].y - t[0].y, t[2].x - t[0].x, t[2].y - t[0].y));
    return longest > 0.0 ? area / longest : 0.0;
}

Scene scene_of(const Corners& t, const Machine& machine) {
    const auto material = vertex_color();
    Scene scene;
    scene.machine = machine;
    scene.machine.subpixel_bits = 8;
    scene.background = glm::vec4(0.0F);
    RawVertices vertices{Space::window, Topology::triangles, {}};
    for (const Corner& c : t) {
        RawVertex v;
        // As a projection with its near plane at 1/2 would give it.
        v.position = {static_cast<float>(c.x), static_cast<float>(c.y),
                      static_cast<float>(1.0 - 0.5 / c.w), static_cast<float>(c.w)};
        v.color0 = {c.color[0], c.color[1], c.color[2], c.color[3]};
        vertices.vertices.push_back(v);
    }
    scene.objects.push_back(
        {vertices, material, glm::mat4(1.0F), {.depth_test = DepthTest::always}});
    return scene;
}

/// Largest distance of a code in the frame from the exact colour, in units; alpha is at least 1/2
/// where the triangle is.
double worst_code(Renderer& renderer, const Corners& t, const Machine& machine, int& pixels) {
    const double one = machine.numbers == NumberModel::nine_bit ? 255.0 : 16384.0;
    Framebuffer frame(kWidth, kHeight, PixelFormat::rgba32f);
    renderer.render(scene_of(t, machine), frame);
    double worst = 0.0;
    for (int y = 0; y < kHeight; ++y) {
        const auto* row = reinterpret_cast<const float*>(frame.row(y));
        for (int x = 0; x < kWidth; ++x, row += 4) {
            if (row[3] == 0.0F) continue;
            ++pixels;
            const std::array<double, 4> want = color_at(t, x + 0.5, y + 0.5);
            for (std::size_t c = 0; c < 4; ++c) {
                const double code = static_cast<double>(row[c]) * one;
                worst = std::max(worst, std::abs(code - want[c] * one));
            }
        }
    }
    return worst;
}

Corner random_corner(Random& random, double reach, float depth_range) {
    const auto step = [&](double size) {
        return random.between(static_cast<int>(-reach * 256),
                              static_cast<int>((size + reach) * 256)) /
               256.0;
    };
    Corner c{step(kWidth), step(kHeight), 1.0, {}};
    const double depth =
        dmath::pow(static_cast<double>(depth_range), static_cast<double>(random.unit()));
    c.w = static_cast<double>(static_cast<float>(depth));
    for (float& x : c.color) x = random.unit();
    c.color[3] = random.real(0.5F, 1.0F);
    return c;
}

/// Corners up to `reach` pixels outside the frame whose w differ by a factor of up to
/// `depth_range`; every other triangle is drawn out to a sliver.
Corners random_triangle(unsigned seed, double reach, float depth_range) {
    Random random(seed);
    Corners t;
    for (Corner& c : t) c = random_corner(random, reach, depth_range);
    if (seed % 2 == 0) return t;
    const auto along = static_cast<double>(random.unit());
    const auto step = [](double x) { return std::floor(x * 256.0) / 256.0; };
    t[2].x = step(t[0].x + (t[1].x - t[0].x) * along + static_cast<double>(random.real(-2, 2)));
    t[2].y = step(t[0].y + (t[1].y - t[0].y) * along + static_cast<double>(random.real(-2, 2)));
    return t;
}

/// Half a unit is the rounding to a code. Planes are floats: their three numbers, two products and
/// two sums are rounded to 2^-24 of terms that reach, across the frame's diagonal of 240 pixels,
/// 240 / thickness times the colour, both for colour / w and for 1 / w; where w is largest, that is
/// range times more of what is left. Four such errors are the most that was seen (2.5).
double bound(const Corners& t, const Machine& machine) {
    const auto [low, high] = std::minmax({t[0].w, t[1].w, t[2].w});
    const double one = machine.numbers == NumberModel::nine_bit ? 255.0 : 16384.0;
    return 0.5 + 4.0 * one * 0x1p-24 * (high / low) * (1.0 + 240.0 / thickness(t));
}

class RawColors : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Machine, RawColors, testing::Values("nv2a", "ideal"),
                         [](const testing::TestParamInfo<const char*>& test) {
                             return std::string(test.param);
                         });

TEST_P(RawColors, MissTheirCodeByNoMoreThanFloatPlanesMust) {
    const Machine machine = machine_profile(GetParam());
    Renderer renderer({.threads = 1});
    int pixels = 0;
    for (const double reach : {20.0, 500.0, 6000.0}) {
        for (const float range : {1.0F, 10.0F, 1000.0F}) {
            for (unsigned seed = 0; seed < 300; ++seed) {
                const Corners t = random_triangle(seed, reach, range);
                if (thickness(t) < 1.0 / 256.0) continue;
                ASSERT_LE(worst_code(renderer, t, machine, pixels), bound(t, machine))
                    << "seed " << seed << ", reach " << reach << ", range " << range;
            }
        }
    }
    EXPECT_GT(pixels, 1000000);
}

// Within 0.51 units: nine-bit colours of whatever is a pixel wide and up to ten times as deep at
// one end as at the other, wide colours of triangles of 16 pixels that face the eye.
TEST_P(RawColors, AreWithinHalfAUnitOnOrdinaryTriangles) {
    const Machine machine = machine_profile(GetParam());
    const bool wide = machine.numbers == NumberModel::wide;
    Renderer renderer({.threads = 1});
    int pixels = 0;
    for (const double reach : {20.0, 500.0}) {
        for (unsigned seed = 0; seed < 600; ++seed) {
            const Corners t = random_triangle(seed, reach, wide ? 1.0F : 10.0F);
            if (thickness(t) < (wide ? 16.0 : 1.0)) continue;
            ASSERT_LE(worst_code(renderer, t, machine, pixels), 0.51)
                << "seed " << seed << ", reach " << reach;
        }
    }
    EXPECT_GT(pixels, 1000000);
}

}  // namespace
}  // namespace burnish
