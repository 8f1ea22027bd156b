// Which pixels a triangle covers, against exact integers on its snapped corners: an independent
// oracle for single triangles, "exactly once" for planar subdivisions, and as many front as back
// faces behind every pixel of a closed surface.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <burnish/scene.hpp>
#include <burnish/shapes.hpp>
#include <cstdint>
#include <numeric>
#include <vector>

#include "core/aligned.hpp"
#include "geometry/camera.hpp"
#include "kernel_test.hpp"
#include "raster/bin.hpp"
#include "tests/screen_mesh.hpp"
#include "tests/set_up.hpp"

namespace burnish {
namespace {

constexpr FrameSize kFrame{200, 130};   // no multiple of 8 or 64
constexpr int kColumns = 4, kRows = 3;  // of tiles

struct Point {
    std::int64_t x, y;  ///< 1/256 pixel
};

/// Twice the signed area; positive if a, b, c turn clockwise on a screen whose y goes down.
std::int64_t turn(Point a, Point b, Point c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// The top-left rule in its own words: a centre on an edge counts if the edge goes up (the inside
/// is to its right) or runs level to the right (the inside is below).
bool on_inner_side(Point a, Point b, Point p) {
    const std::int64_t side = turn(a, b, p);
    if (side != 0) return side > 0;
    return b.y < a.y || (b.y == a.y && b.x > a.x);
}

bool oracle_covers(Point a, Point b, Point c, int px, int py) {
    const std::int64_t area = turn(a, b, c);
    if (area == 0) return false;
    if (area < 0) std::swap(b, c);
    const Point p{256 * px + 128, 256 * py + 128};
    return on_inner_side(a, b, p) && on_inner_side(b, c, p) && on_inner_side(c, a, p);
}

ScreenVertex vertex(Point p) {
    return {static_cast<std::int32_t>(p.x), static_cast<std::int32_t>(p.y), 0.5F, 0};
}

/// Draws triangles one by one through tile_triangle and the rasterize kernel, into a whole frame.
class Canvas {
  public:
    explicit Canvas(const KernelTable& kernels)
        : m_kernels(kernels),
          m_depth(kPixels, 1.0F),
          m_id(kPixels, kNoTriangle),
          m_far(static_cast<std::size_t>(kColumns * kRows * kTileBlocks), 1.0F) {}

    /// Calls f(x, y) for every pixel of the frame that the triangle covers; returns their number.
    template <class F>
    int draw(const SetupTriangle& triangle, F&& f) {
        ++m_next_id;
        const PixelRect& box = triangle.box;
        int covered = 0;
        for (int ty = box.y0 / kTileSize; ty <= box.y1 / kTileSize; ++ty) {
            for (int tx = box.x0 / kTileSize; tx <= box.x1 / kTileSize; ++tx) {
                covered += draw_in_tile(triangle, tx, ty, f);
            }
        }
        return covered;
    }

    /// Corners to a triangle and its pixels; nothing for one without area or inside the frame.
    template <class F>
    int draw(Point a, Point b, Point c, F&& f) {
        const OneTriangle one = set_up(m_kernels, {{vertex(a), vertex(b), vertex(c)}}, kFrame);
        if (one.counts.drawn == 0) return 0;
        std::uint64_t mask = 0;
        const int covered = draw(one.triangle, [&](int x, int y) {
            f(x, y);
            const PixelRect& box = one.triangle.box;
            if (one.covered != 0)
                mask |= std::uint64_t{1} << ((y - box.y0) * kTinySize + x - box.x0);
        });
        EXPECT_EQ(one.covered, mask) << "mask of a tiny triangle";
        return covered;
    }

  private:
    static constexpr std::size_t kPixels = static_cast<std::size_t>(kColumns * kRows) * kTilePixels;

    template <class F>
    int draw_in_tile(const SetupTriangle& triangle, int tx, int ty, F&& f) {
        TileTriangle seen{};
        if (!tile_triangle(triangle, tx, ty, seen)) return 0;
        seen.id = m_next_id;
        seen.pass_less = seen.pass_equal = seen.pass_greater = 1;
        const auto tile = static_cast<std::size_t>(ty * kColumns + tx);
        std::uint64_t drawn = 0;
        m_kernels.rasterize({&seen, 1, m_depth.data() + tile * kTilePixels,
                             m_id.data() + tile * kTilePixels, m_far.data() + tile * kTileBlocks,
                             &drawn});
        int covered = 0;
        // All blocks that the box touches, so that pixels beside the triangle would be seen.
        for (int y = seen.y0 & ~7; y <= (seen.y1 | 7); ++y) {
            for (int x = seen.x0 & ~7; x <= (seen.x1 | 7); ++x) {
                const int index = (y / 8 * 8 + x / 8) * 64 + y % 8 * 8 + x % 8;
                const int px = tx * kTileSize + x, py = ty * kTileSize + y;
                if (m_id[tile * kTilePixels + static_cast<std::size_t>(index)] != m_next_id)
                    continue;
                if (px >= kFrame.width || py >= kFrame.height) continue;
                f(px, py);
                ++covered;
            }
        }
        return covered;
    }

    const KernelTable& m_kernels;
    AlignedVector<float> m_depth;
    AlignedVector<std::uint32_t> m_id;
    AlignedVector<float> m_far;
    std::uint32_t m_next_id = 0;
};

/// How often every pixel of the frame was covered.
class Counts {
  public:
    Counts() : m_count(static_cast<std::size_t>(kFrame.width * kFrame.height), 0) {}
    int& at(int x, int y) { return m_count[static_cast<std::size_t>(y * kFrame.width + x)]; }
    /// First pixel whose count is not `want`, as text; empty if there is none.
    [[nodiscard]] std::string unlike(int want) const {
        for (std::size_t i = 0; i < m_count.size(); ++i) {
            if (m_count[i] == want) continue;
            const auto width = static_cast<std::size_t>(kFrame.width);
            return "pixel " + std::to_string(i % width) + ", " + std::to_string(i / width) + ": " +
                   std::to_string(m_count[i]);
        }
        return {};
    }

  private:
    std::vector<int> m_count;
};

class Coverage : public KernelTest {
  protected:
    static bool scalar() { return table().lanes == 1; }
};

/// Corners of many kinds: anywhere, on pixel centres, close together, at the ends of the window
/// range.
Point random_corner(Random& random, Point near) {
    constexpr std::int32_t kLow = -8192 * 256, kHigh = 24575 * 256;
    switch (random.between(0, 5)) {
        case 0:
            return {256 * random.between(-20, 220) + 128, 256 * random.between(-20, 150) + 128};
        case 1:
            return {near.x + random.between(-300, 300), near.y + random.between(-300, 300)};
        case 2:
            return {near.x + random.between(-3, 3), near.y + random.between(-2000, 2000)};
        case 3:
            return {random.between(kLow, kHigh), random.between(kLow, kHigh)};
        case 4:
            return {random.between(0, 1) == 0 ? kLow : kHigh, random.between(0, 130 * 256)};
        default:
            return {random.between(-4000, 55000), random.between(-4000, 37000)};
    }
}

TEST_P(Coverage, OfSingleTrianglesIsExact) {
    Canvas canvas(table());
    const int count = scalar() ? 1500 : 6000;
    for (int i = 0; i < count; ++i) {
        Random random(static_cast<unsigned>(i));
        const Point a{random.between(-2000, 53000), random.between(-2000, 35000)};
        const Point b = random_corner(random, a), c = random_corner(random, a);
        std::string wrong;
        const int covered = canvas.draw(a, b, c, [&](int x, int y) {
            if (!oracle_covers(a, b, c, x, y)) wrong = std::to_string(x) + ", " + std::to_string(y);
        });
        ASSERT_EQ(wrong, "") << "triangle " << i << ": covered, but outside";
        int want = 0;
        const auto pixels = [](std::int64_t low, std::int64_t high, int size) {
            return std::pair{static_cast<int>(std::clamp<std::int64_t>(low >> 8, 0, size)),
                             static_cast<int>(std::clamp<std::int64_t>((high >> 8) + 1, 0, size))};
        };
        const auto [x0, x1] =
            pixels(std::min({a.x, b.x, c.x}), std::max({a.x, b.x, c.x}), kFrame.width);
        const auto [y0, y1] =
            pixels(std::min({a.y, b.y, c.y}), std::max({a.y, b.y, c.y}), kFrame.height);
        for (int y = y0; y < y1; ++y) {
            for (int x = x0; x < x1; ++x) want += oracle_covers(a, b, c, x, y) ? 1 : 0;
        }
        ASSERT_EQ(covered, want) << "triangle " << i;
    }
}

// A grid with moved nodes whose border lies outside the frame, on every vertex grid of the
// machines.
TEST_P(Coverage, OfAPlanarGridIsOnce) {
    Canvas canvas(table());
    int triangles = 0;
    for (int round = 0; round < (scalar() ? 5 : 50); ++round) {
        Random random(1000 + static_cast<unsigned>(round));
        const std::int32_t cell = random.between(3, 11) * 256, step = 1 << random.between(0, 4);
        const int columns = (kFrame.width + 30) * 256 / cell + 2,
                  rows = (kFrame.height + 30) * 256 / cell + 2;
        std::vector<Point> node;
        for (int y = 0; y <= rows; ++y) {
            for (int x = 0; x <= columns; ++x) {
                const std::int32_t move = cell * 2 / 5;
                Point p{x * cell - 15 * 256 + random.between(-move, move),
                        y * cell - 15 * 256 + random.between(-move, move)};
                if (random.between(0, 9) == 0) p = {(p.x & ~255) + 128, (p.y & ~255) + 128};
                node.push_back({p.x / step * step, p.y / step * step});
            }
        }
        Counts counts;
        const auto at = [&](int x, int y) {
            return node[static_cast<std::size_t>(y * (columns + 1) + x)];
        };
        const auto draw = [&](Point a, Point b, Point c) {
            canvas.draw(a, b, c, [&](int x, int y) { ++counts.at(x, y); });
            ++triangles;
        };
        for (int y = 0; y < rows; ++y) {
            for (int x = 0; x < columns; ++x) {
                // Either diagonal lies inside the cell, so long as nodes move less than half of it
                // and the quad stays convex there; the one that keeps both turns alike is taken.
                const Point p = at(x, y), q = at(x + 1, y), r = at(x + 1, y + 1), s = at(x, y + 1);
                const bool first = turn(p, q, r) > 0 && turn(p, r, s) > 0;
                draw(p, q, first ? r : s);
                draw(first ? p : q, r, s);
            }
        }
        ASSERT_EQ(counts.unlike(1), "")
            << "round " << round << ", cells of " << cell << ", grid " << step;
    }
    EXPECT_GT(triangles, scalar() ? 3000 : 30000);
}

// Fans around a point of the frame with corners far outside, slivers among them.
TEST_P(Coverage, OfAFanIsOnce) {
    Canvas canvas(table());
    for (int round = 0; round < (scalar() ? 4 : 60); ++round) {
        Random random(5000 + static_cast<unsigned>(round));
        const bool on_centre = random.between(0, 2) == 0;
        Point hub{random.between(0, kFrame.width * 256), random.between(0, kFrame.height * 256)};
        if (on_centre) hub = {(hub.x & ~255) + 128, (hub.y & ~255) + 128};
        // A square outline far outside, its corners and random points of its sides in order.
        const std::int64_t reach = 256 * random.between(400, 8000);
        std::vector<Point> outline;
        const std::array<Point, 4> square{
            {{-reach, -reach}, {reach, -reach}, {reach, reach}, {-reach, reach}}};
        for (std::size_t side = 0; side < 4; ++side) {
            const Point from = square[side], to = square[(side + 1) % 4];
            std::vector<std::int32_t> steps{0};
            for (int i = random.between(1, 60); i > 0; --i)
                steps.push_back(random.between(1, 65535));
            std::sort(steps.begin(), steps.end());
            for (const std::int64_t s : steps) {
                outline.push_back({hub.x + from.x + (to.x - from.x) * s / 65536,
                                   hub.y + from.y + (to.y - from.y) * s / 65536});
            }
        }
        Counts counts;
        for (std::size_t i = 0; i < outline.size(); ++i) {
            canvas.draw(hub, outline[i], outline[(i + 1) % outline.size()],
                        [&](int x, int y) { ++counts.at(x, y); });
        }
        ASSERT_EQ(counts.unlike(1), "") << "round " << round;
    }
}

// Strips of long thin triangles across the frame.
TEST_P(Coverage, OfAStripIsOnce) {
    Canvas canvas(table());
    for (int round = 0; round < (scalar() ? 3 : 40); ++round) {
        Random random(9000 + static_cast<unsigned>(round));
        // Steps wider than the corners stray, so that both sides run on and no two triangles
        // overlap.
        std::vector<Point> top, bottom;
        for (std::int64_t x = -30 * 256; x < 250 * 256; x += random.between(401, 1500)) {
            top.push_back({x + random.between(-200, 200), -20 * 256 + random.between(-999, 999)});
            bottom.push_back(
                {x + random.between(-200, 200), 200 * 256 + random.between(-999, 999)});
        }
        Counts counts;
        const auto count = [&](int x, int y) { ++counts.at(x, y); };
        for (std::size_t i = 1; i < top.size(); ++i) {
            canvas.draw(top[i - 1], top[i], bottom[i - 1], count);
            canvas.draw(top[i], bottom[i], bottom[i - 1], count);
        }
        ASSERT_EQ(counts.unlike(1), "") << "round " << round;
    }
}

/// Front faces minus back faces behind every pixel of a closed surface in front of the camera: the
/// winding number outside of it, 0. `clipped` gets the number of triangles that were cut.
void check_closed(const MeshData& data, const glm::mat4& place, const KernelTable& kernels,
                  int round, std::uint64_t& clipped) {
    const Mesh mesh(data);
    Camera camera;
    camera.near = 0.001F;
    camera.far = 5000.0F;
    Machine machine = machine_profile("ideal");
    machine.subpixel_bits = 4 + round % 5;
    machine.snap_floor = round % 2 == 1;
    const Viewport viewport = make_viewport(machine, kFrame.width, kFrame.height);
    const glm::mat4 m(make_view(camera, kFrame.width, kFrame.height).clip_from_world *
                      glm::dmat4(place));
    const OnScreen seen(kernels, mesh, m, viewport);
    Canvas canvas(kernels);
    Counts counts;
    for (const auto& [facing, sign] :
         {std::pair{Facing::front_only, 1}, std::pair{Facing::back_only, -1}}) {
        Chunk chunk;
        chunk.fill({seen.mesh(), 0, facing, viewport, kFrame}, 0, mesh.triangle_count(), kernels);
        clipped += chunk.counts().clipped;
        for (const SetupTriangle& t : chunk.triangles()) {
            canvas.draw(t, [&, s = sign](int x, int y) { counts.at(x, y) += s; });
        }
    }
    ASSERT_EQ(counts.unlike(0), "") << "round " << round;
}

TEST_P(Coverage, OfClosedSurfacesIsBalanced) {
    std::uint64_t clipped = 0;
    for (int round = 0; round < (scalar() ? 4 : 24); ++round) {
        Random random(12000 + static_cast<unsigned>(round));
        // Some with corners beyond the guard band; coarse ones, whose triangles reach from the
        // frame to there.
        const bool beyond = round % 4 == 3;
        MeshData data = round % 3 == 0   ? shapes::sphere(beyond ? 7 : 40, beyond ? 5 : 20)
                        : round % 3 == 1 ? shapes::torus_knot(beyond ? 9 : 120, beyond ? 3 : 12)
                                         : shapes::cube();
        const auto number = [&](int low, int high) {
            return static_cast<float>(random.between(low, high)) / 100.0F;
        };
        glm::mat4 place = placement({number(-100, 100), number(-80, 80), number(-60, 60)},
                                    {number(-100, 100), 1.01F, number(-100, 100)}, number(0, 36000),
                                    number(20, 120));
        // All before the eye, 0.1 to 2.6 units away. What is 53 times as far to the side as ahead
        // is at pixel -8192.
        if (beyond) {
            for (glm::vec3& p : data.positions) p = {300.0F * p.x, 0.3F * p.y, p.z};
            place = placement({0.0F, 0.0F, 1.9F}, {0.0F, 0.0F, 1.0F}, number(0, 36000), 1.0F);
        }
        ASSERT_NO_FATAL_FAILURE(check_closed(data, place, table(), round, clipped));
    }
    EXPECT_GT(clipped, scalar() ? 10U : 100U);
}

INSTANTIATE_TEST_SUITE_P(Isa, Coverage, every_table(), isa_name);

// What TileTriangle promises of its numbers, at the ends of the window range.
TEST(TileTriangles, KeepTheirRanges) {
    constexpr FrameSize kLargest{16384, 16384};
    int kept = 0;
    for (int i = 0; i < 20000; ++i) {
        Random random(20000 + static_cast<unsigned>(i));
        const auto corner = [&] {
            return Point{random.between(-8192 * 256, 24576 * 256 - 1),
                         random.between(-8192 * 256, 24576 * 256 - 1)};
        };
        const std::array corners{vertex(corner()), vertex(corner()), vertex(corner())};
        const OneTriangle one = set_up(table_reference(), corners, kLargest);
        if (one.counts.drawn == 0) continue;
        const std::int32_t tx = random.between(0, 255), ty = random.between(0, 255);
        TileTriangle seen{};
        if (!tile_triangle(one.triangle, tx, ty, seen)) continue;
        for (int e = 0; e < seen.edges; ++e) {
            EXPECT_LE(std::int64_t{std::abs(seen.a[e])} + std::abs(seen.b[e]),
                      std::int64_t{1} << 24);
            EXPECT_LT(std::abs(std::int64_t{seen.c[e]}), std::int64_t{1} << 30);
            ++kept;
        }
    }
    EXPECT_GT(kept, 100);
}

}  // namespace
}  // namespace burnish
