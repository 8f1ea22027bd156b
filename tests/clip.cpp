// Clipping: what is inside stays, what is outside goes, and neighbours agree on new corners.
#include <gtest/gtest.h>

#include <array>
#include <burnish/renderer.hpp>
#include <burnish/shapes.hpp>
#include <cmath>
#include <memory>

#include "geometry/clip.hpp"

namespace burnish {
namespace {

/// Numbers in [-1, 1), the same everywhere.
class Random {
  public:
    explicit Random(std::uint32_t seed) : m_state(seed * 2654435761U + 1) {}
    float number() {
        m_state = m_state * 1664525U + 1013904223U;
        return static_cast<float>(m_state >> 8) / 8388608.0F - 1.0F;
    }

  private:
    std::uint32_t m_state;
};

/// Homogeneous window coordinates of many kinds: in front, behind, beyond the guard band.
HomogeneousVertex random_vertex(Random& random) {
    const float w = random.number() * 4.0F + 1.5F;
    return {random.number() * 60000.0F, random.number() * 60000.0F, random.number() * 5.0F, w};
}

double distance(const ClipVertex& v, int plane) {
    const double low = static_cast<double>(kGuardLow), high = static_cast<double>(kGuardHigh);
    const std::array<double, 6> d{
        v.z, v.w - v.z, v.x - low * v.w, high * v.w - v.x, v.y - low * v.w, high * v.w - v.y};
    return d[static_cast<std::size_t>(plane)];
}

TEST(Clip, KeepsWhatIsInside) {
    const HomogeneousVertex a{100.0F, 50.0F, 0.2F, 1.0F}, b{900.0F, 70.0F, 1.5F, 3.0F},
        c{-20.0F, 400.0F, 0.0F, 2.0F};
    const ClipPolygon p = clip_triangle(a, b, c);
    ASSERT_EQ(p.count, 3);
    for (int i = 0; i < 3; ++i) EXPECT_EQ(p.corner[static_cast<std::size_t>(i)].original, i);
    EXPECT_EQ(p.corner[1].x, 900.0);
    EXPECT_EQ(p.corner[1].w, 3.0);
}

TEST(Clip, DropsWhatIsOutsideOfOnePlane) {
    const auto count = [](float x, float y, float z, float w) {
        const HomogeneousVertex v{x, y, z, w};
        return clip_triangle(v, {v.x + 1.0F, v.y, v.z, v.w}, {v.x, v.y + 1.0F, v.z, v.w}).count;
    };
    EXPECT_EQ(count(10.0F, 10.0F, 0.5F, 1.0F), 3);
    EXPECT_EQ(count(10.0F, 10.0F, -0.5F, 1.0F), 0);  // before the near plane
    EXPECT_EQ(count(10.0F, 10.0F, 1.5F, 1.0F), 0);   // behind the far plane
    EXPECT_EQ(count(10.0F, 10.0F, 0.5F, -1.0F), 0);  // behind the eye
    EXPECT_EQ(count(-9000.0F, 10.0F, 0.5F, 1.0F), 0);
    EXPECT_EQ(count(25000.0F, 10.0F, 0.5F, 1.0F), 0);
    EXPECT_EQ(count(10.0F, -9000.0F, 0.5F, 1.0F), 0);
    EXPECT_EQ(count(10.0F, 25000.0F, 0.5F, 1.0F), 0);
}

// A cut is x + (y - x) t in double, so a corner misses its plane by a few roundings of its terms.
TEST(Clip, CornersLieInsideAllPlanes) {
    int cut = 0;
    for (std::uint32_t seed = 0; seed < 20000; ++seed) {
        Random random(seed);
        const HomogeneousVertex a = random_vertex(random), b = random_vertex(random),
                                c = random_vertex(random);
        const ClipPolygon p = clip_triangle(a, b, c);
        ASSERT_LE(p.count, ClipPolygon::kMaxCorners);
        cut += p.count > 3 ? 1 : 0;
        for (int i = 0; i < p.count; ++i) {
            const ClipVertex& v = p.corner[static_cast<std::size_t>(i)];
            const double size = 60000.0 + 25000.0 * 6.0;  // of the terms of a distance
            for (int plane = 0; plane < 6; ++plane) {
                ASSERT_GE(distance(v, plane), -size * 1e-15 * 16.0)
                    << "seed " << seed << ", plane " << plane;
            }
            ScreenVertex screen{};
            const Viewport view{960.0F, 540.0F, 1920.0F, 1080.0F, 256.0F, 0.5F};
            if (!project(v, view, screen)) continue;
            ASSERT_GE(screen.x, -8193 * 256);
            ASSERT_LT(screen.x, 24576 * 256);
            ASSERT_TRUE(screen.z >= 0.0F && screen.z <= 1.0F);
        }
    }
    EXPECT_GT(cut, 1000);
}

// Both triangles of an edge cut it from the inside to the outside, whichever way they run along it.
TEST(Clip, NeighboursGetTheSameNewCorners) {
    int shared = 0;
    for (std::uint32_t seed = 0; seed < 5000; ++seed) {
        Random random(seed);
        const HomogeneousVertex a{500.0F + random.number(), 300.0F, 0.3F, 1.0F};
        const HomogeneousVertex b = random_vertex(random);
        const HomogeneousVertex left{400.0F, 200.0F, 0.4F, 1.1F}, right{700.0F, 900.0F, 0.2F, 0.9F};
        const ClipPolygon p = clip_triangle(a, b, left), q = clip_triangle(b, a, right);
        if (p.count == 0 || q.count == 0) continue;
        // The corner after a in p, and the one before a in q, lie on the edge.
        const auto beside = [](const ClipPolygon& polygon, int original, int step) {
            for (int i = 0; i < polygon.count; ++i) {
                if (polygon.corner[static_cast<std::size_t>(i)].original != original) continue;
                return polygon
                    .corner[static_cast<std::size_t>((i + step + polygon.count) % polygon.count)];
            }
            return ClipVertex{};
        };
        const ClipVertex u = beside(p, 0, 1), v = beside(q, 1, -1);
        ASSERT_EQ(u.x, v.x) << "seed " << seed;
        ASSERT_EQ(u.y, v.y) << "seed " << seed;
        ASSERT_EQ(u.z, v.z) << "seed " << seed;
        ASSERT_EQ(u.w, v.w) << "seed " << seed;
        shared += u.original < 0 ? 1 : 0;
    }
    EXPECT_GT(shared, 1000);
}

// A floor of many triangles under and behind the camera: every pixel from a row below the horizon
// on shows it, and none above.
TEST(Clip, AFloorUnderTheCameraHasNoCracks) {
    using namespace combine;
    ProgramBuilder program;
    program.lerp(raw(Register::zero), raw(Register::zero), raw(Register::zero), one());
    auto white = std::make_shared<Material>();
    white->program.emplace();
    white->program->combiners = program.build();
    for (const int cells : {1, 7, 40}) {
        Scene scene;
        scene.machine = machine_profile("nv2a");
        scene.background = {0.0F, 0.0F, 0.0F, 0.0F};
        scene.camera.position = {0.3F, 0.7F, 0.2F};
        scene.camera.focal_point = {0.9F, 0.7F, -3.0F};  // level: the horizon is the middle row
        scene.camera.far = 2e6F;
        scene.objects.push_back({Mesh(shapes::plane(cells, cells)),
                                 white,
                                 placement({0.0F, 0.0F, 0.0F}, {1.0F, 0.0F, 0.0F}, -90.0F, 1e6F),
                                 {}});
        Framebuffer frame(171, 120);
        const FrameStats stats = Renderer().render(scene, frame);
        EXPECT_GE(stats.clipped_triangles, 1U);
        for (int y = 0; y < frame.height(); ++y) {
            for (int x = 0; x < frame.width(); ++x) {
                const int red = std::to_integer<int>(frame.row(y)[4 * x]);
                if (y == 59 || y == 60) continue;
                ASSERT_EQ(red, y < 59 ? 0 : 255) << x << ", " << y << ", cells " << cells;
            }
        }
    }
}

}  // namespace
}  // namespace burnish
