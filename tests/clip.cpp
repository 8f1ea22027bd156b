// Clipping: what is inside stays, what is outside goes, and neighbours agree on new corners.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <burnish/renderer.hpp>
#include <burnish/shapes.hpp>
#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

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

ClipVertex in_double(const HomogeneousVertex& v) {
    return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z),
            static_cast<double>(v.w), -1};
}

bool same_place(const ClipVertex& a, const ClipVertex& b) {
    return a.x == b.x && a.y == b.y && a.z == b.z && a.w == b.w;
}

/// Window coordinates that triangle setup can take, 1/256 pixel: the guard band and half a pixel
/// around it, so that they differ by 2^23 at most and |a| + |b| of an edge stays within 2^24.
constexpr std::int32_t kLowest = -(8192 * 256 + 128), kHighest = 24575 * 256 + 128;
static_assert(kHighest - kLowest == 1 << 23);

bool in_range(const ScreenVertex& v) {
    return v.x >= kLowest && v.x <= kHighest && v.y >= kLowest && v.y <= kHighest && v.z >= 0.0F &&
           v.z <= 1.0F;
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

TEST(Clip, ReturnsTrianglesInsideUnchanged) {
    for (std::uint32_t seed = 0; seed < 20000; ++seed) {
        Random random(seed);
        std::array<HomogeneousVertex, 3> t{};
        for (HomogeneousVertex& v : t) {
            const float w = std::exp2(8.0F * random.number());
            const auto across = [&] { return (8191.0F + 16383.0F * random.number()) * w; };
            v = {across(), across(), (0.5F + 0.499F * random.number()) * w, w};
        }
        const ClipPolygon p = clip_triangle(t[0], t[1], t[2]);
        ASSERT_EQ(p.count, 3) << "seed " << seed;
        for (std::size_t i = 0; i < 3; ++i) {
            const ClipVertex& v = p.corner[i];
            ASSERT_TRUE(v.original == static_cast<int>(i) && same_place(v, in_double(t[i])))
                << "seed " << seed << ", corner " << i;
        }
    }
}

// All three corners beyond the same plane, wherever they are otherwise.
TEST(Clip, LeavesNothingOutsideOfAnyPlane) {
    for (std::uint32_t seed = 0; seed < 20000; ++seed) {
        Random random(seed);
        const int plane = static_cast<int>(seed % 6);
        std::array<HomogeneousVertex, 3> t{};
        for (HomogeneousVertex& v : t) {
            v = random_vertex(random);
            const float by = 501.0F + 500.0F * random.number();  // of coordinates up to 150,000
            if (plane == 0) v.z = -0.001F * by;
            if (plane == 1) v.z = v.w + 0.001F * by;
            if (plane == 2) v.x = kGuardLow * v.w - by;
            if (plane == 3) v.x = kGuardHigh * v.w + by;
            if (plane == 4) v.y = kGuardLow * v.w - by;
            if (plane == 5) v.y = kGuardHigh * v.w + by;
        }
        ASSERT_EQ(clip_triangle(t[0], t[1], t[2]).count, 0) << "seed " << seed;
    }
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
            // Divided by w, the miss stays far below the half pixel that is allowed for it.
            if (v.w < 1e-6) continue;
            ASSERT_TRUE(project(v, view, screen)) << "seed " << seed;
            ASSERT_TRUE(in_range(screen)) << "seed " << seed;
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

/// The part of an edge inside the planes, as a range of weights of its second end; empty if
/// first > second.
std::pair<double, double> visible_part(const ClipVertex& a, const ClipVertex& b) {
    double first = 0.0, last = 1.0;
    for (int plane = 0; plane < 6; ++plane) {
        const double da = distance(a, plane), db = distance(b, plane);
        if (da < 0.0 && db < 0.0) return {1.0, 0.0};
        if (da < 0.0) first = std::max(first, da / (da - db));
        if (db < 0.0) last = std::min(last, da / (da - db));
    }
    return {first, last};
}

/// Corners that two polygons share, bit for bit.
std::vector<ClipVertex> common_corners(const ClipPolygon& p, const ClipPolygon& q) {
    std::vector<ClipVertex> result;
    for (int i = 0; i < p.count; ++i) {
        for (int k = 0; k < q.count; ++k) {
            const ClipVertex &u = p.corner[static_cast<std::size_t>(i)],
                             &v = q.corner[static_cast<std::size_t>(k)];
            if (same_place(u, v)) result.push_back(u);
        }
    }
    return result;
}

// Ends of the edge anywhere, both outside too: what is visible of it begins and ends at the same
// two corners in both triangles, in whichever direction and order their corners come.
TEST(Clip, NeighboursShareBothEndsOfTheirVisibleEdge) {
    int both_outside = 0, invisible = 0;
    for (std::uint32_t seed = 0; seed < 50000; ++seed) {
        Random random(seed);
        std::array<HomogeneousVertex, 4> v{};
        for (HomogeneousVertex& h : v) {
            h = random_vertex(random);
            if (random.number() > 0.0F) h.z *= 0.2F;
        }
        const std::array<HomogeneousVertex, 3> t{v[0], v[1], v[2]}, u{v[1], v[0], v[3]};
        const ClipPolygon p = clip_triangle(t[seed % 3], t[(seed + 1) % 3], t[(seed + 2) % 3]);
        const std::size_t k = seed / 3;
        const ClipPolygon q = clip_triangle(u[k % 3], u[(k + 1) % 3], u[(k + 2) % 3]);
        const ClipVertex a = in_double(v[0]), b = in_double(v[1]);
        const auto [first, last] = visible_part(a, b);
        if (std::abs(last - first) < 1e-6) continue;  // rounding decides
        const std::vector<ClipVertex> common = common_corners(p, q);
        if (first > last) {
            ASSERT_TRUE(common.empty()) << "seed " << seed;
            ++invisible;
            continue;
        }
        for (const double at : {first, last}) {
            const bool found = std::any_of(common.begin(), common.end(), [&](const ClipVertex& c) {
                return std::abs(c.x - (a.x + (b.x - a.x) * at)) < 1e-6 &&
                       std::abs(c.y - (a.y + (b.y - a.y) * at)) < 1e-6 &&
                       std::abs(c.w - (a.w + (b.w - a.w) * at)) < 1e-9;
            });
            ASSERT_TRUE(found) << "seed " << seed << ", end at " << at;
        }
        both_outside += first > 0.0 && last < 1.0 ? 1 : 0;
    }
    EXPECT_GT(both_outside, 1000);
    EXPECT_GT(invisible, 1000);
}

TEST(Clip, ProjectStaysInTheRangeOfTheWindow) {
    int inside = 0, outside = 0;
    for (std::uint32_t seed = 0; seed < 100000; ++seed) {
        Random random(seed);
        const auto across = [&] {  // half of them around the ends of the range
            const double end = static_cast<double>(random.number() > 0.0F ? kGuardLow : kGuardHigh);
            const auto r = static_cast<double>(random.number());
            return random.number() > 0.0F ? end + r : 8191.5 + 20000.0 * r;
        };
        const double x = across(), y = across(), z = 2.0 * static_cast<double>(random.number());
        const double w = std::exp2(60.0 * static_cast<double>(random.number()));
        const auto subpixels = static_cast<float>(16 << seed % 5);
        const Viewport view{50, 50, 100, 100, subpixels, seed % 2 == 0 ? 0.5F : 0.0F};
        ScreenVertex screen{};
        const bool kept = project({x * w, y * w, z * w, w, -1}, view, screen);
        const double beyond =
            std::max({-8192.0 - x, x - 24575.0, -8192.0 - y, y - 24575.0});  // of the guard band
        if (std::abs(beyond - 0.5) > 0.001) {
            ASSERT_EQ(kept, beyond < 0.5) << "seed " << seed;
        }
        ASSERT_TRUE(!kept || in_range(screen)) << "seed " << seed;
        ASSERT_FALSE(project({x * w, y * w, z * w, -w, -1}, view, screen));
        ++(kept ? inside : outside);
    }
    EXPECT_GT(inside, 30000);
    EXPECT_GT(outside, 30000);
    ScreenVertex screen{};
    const Viewport view{50, 50, 100, 100, 256, 0.5F};
    const double nan = std::nan(""), infinite = HUGE_VAL;
    for (const ClipVertex& v :
         {ClipVertex{1, 1, 0, 0, -1}, ClipVertex{0, 0, 0, 0, -1}, ClipVertex{nan, 1, 0, 1, -1},
          ClipVertex{1, infinite, 0, 1, -1}, ClipVertex{1, 1, 0, nan, -1}}) {
        EXPECT_FALSE(project(v, view, screen)) << v.x << ' ' << v.y << ' ' << v.w;
    }
}

/// A white floor at y = 0, half a million units to each side, before a black background.
Scene floor_scene(int cells) {
    using namespace combine;
    ProgramBuilder program;
    program.lerp(raw(Register::zero), raw(Register::zero), raw(Register::zero), one());
    auto white = std::make_shared<Material>();
    white->program.emplace();
    white->program->combiners = program.build();
    Scene scene;
    scene.machine = machine_profile("nv2a");
    scene.background = {0.0F, 0.0F, 0.0F, 0.0F};
    scene.camera.far = 2e6F;
    scene.objects.push_back({Mesh(shapes::plane(cells, cells)),
                             white,
                             placement({0.0F, 0.0F, 0.0F}, {1.0F, 0.0F, 0.0F}, -90.0F, 1e6F),
                             {}});
    return scene;
}

// A floor of many triangles under and behind the camera: every pixel from a row below the horizon
// on shows it, and none above.
TEST(Clip, AFloorUnderTheCameraHasNoCracks) {
    for (const int cells : {1, 7, 40}) {
        Scene scene = floor_scene(cells);
        scene.camera.position = {0.3F, 0.7F, 0.2F};
        scene.camera.focal_point = {0.9F, 0.7F, -3.0F};  // level: the horizon is the middle row
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

// The same with cameras that look up or down and lean to a side: the horizon is where the line of
// sight through a pixel centre is level, a straight line of the picture.
TEST(Clip, AFloorEndsAtTheHorizonOfAnyCamera) {
    int above = 0, below = 0;
    for (std::uint32_t seed = 0; seed < 60; ++seed) {
        Random random(seed);
        Scene scene = floor_scene(std::array{1, 7, 40}[seed % 3]);
        Camera& camera = scene.camera;
        camera.position = {3.0F * random.number(), 0.7F, 3.0F * random.number()};
        const glm::vec3 forward{random.number(), 0.3F * random.number(), -1.2F};
        camera.focal_point = camera.position + forward;
        camera.view_up = {random.number(), 1.0F, 0.0F};
        Framebuffer frame(171, 120);
        EXPECT_GE(Renderer().render(scene, frame).clipped_triangles, 1U);
        const glm::dvec3 ahead =
            glm::normalize(glm::dvec3(camera.focal_point) - glm::dvec3(camera.position));
        const glm::dvec3 right = glm::normalize(glm::cross(ahead, glm::dvec3(camera.view_up)));
        const glm::dvec3 up = glm::cross(right, ahead);
        const double pixel = std::tan(22.5 * 3.14159265358979 / 180.0) / 60.0;  // at distance 1
        const double per_pixel = pixel * std::hypot(right.y, up.y);
        for (int y = 0; y < frame.height(); ++y) {
            for (int x = 0; x < frame.width(); ++x) {
                const double rise =
                    ahead.y + pixel * ((x + 0.5 - 85.5) * right.y - (y + 0.5 - 60.0) * up.y);
                if (std::abs(rise) < per_pixel) continue;  // less than a pixel from the horizon
                ASSERT_EQ(std::to_integer<int>(frame.row(y)[4 * x]), rise > 0.0 ? 0 : 255)
                    << x << ", " << y << ", seed " << seed;
                ++(rise > 0.0 ? above : below);
            }
        }
    }
    EXPECT_GT(above, 200000);
    EXPECT_GT(below, 200000);
}

}  // namespace
}  // namespace burnish
