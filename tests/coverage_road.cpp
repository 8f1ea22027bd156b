// Coverage from window coordinates given as floats to pixels of a frame, on every grid of vertices:
// subdivided triangles cover each pixel once, fans and strips add up to their outline, and pictures
// show what the oracle (tests/exact_coverage.hpp) says.
#include <gtest/gtest.h>

#include <burnish/renderer.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "geometry/camera.hpp"
#include "geometry/clip.hpp"
#include "kernel_test.hpp"
#include "tests/exact_coverage.hpp"
#include "tests/set_up.hpp"
#include "tests/tile_painter.hpp"
#include "tests/vertex_color.hpp"

namespace burnish {
namespace {

constexpr FrameSize kFrame{139, 101};  // no multiple of 8 or 64

Machine machine_with_grid(int subpixel_bits, bool floor) {
    Machine machine = machine_profile("nv2a");
    machine.subpixel_bits = subpixel_bits;
    machine.snap_floor = floor;
    return machine;
}

ScreenVertex at_window(double x, double y, const Viewport& viewport) {
    ScreenVertex screen{};
    HomogeneousVertex homogeneous{};
    place_window_vertex({static_cast<float>(x), static_cast<float>(y), 0.5F, 1.0F}, viewport,
                        screen, homogeneous);
    return screen;
}

exact::Point point(const ScreenVertex& v) {
    return {v.x, v.y};
}

/// Draws triangles one by one and adds up per pixel what they cover, as it is and with the sign of
/// their area.
class Layers {
  public:
    explicit Layers(const KernelTable& kernels)
        : m_kernels(kernels), m_painter(kernels), m_covered(pixels(), 0), m_signed(pixels(), 0) {}

    /// Fails the test where a pixel differs from the oracle.
    void draw(const ScreenVertex& a, const ScreenVertex& b, const ScreenVertex& c) {
        ++m_triangles;
        const exact::Triangle corners{point(a), point(b), point(c)};
        const OneTriangle one = set_up(m_kernels, {{a, b, c}}, kFrame);
        const SetupTriangle& triangle = one.triangle;
        ASSERT_EQ(one.counts.degenerate == 1, exact::twice_area(corners) == 0);
        if (one.counts.drawn == 0) return expect_nothing(corners);
        for (int y = triangle.box.y0 / kTileSize; y <= triangle.box.y1 / kTileSize; ++y) {
            for (int x = triangle.box.x0 / kTileSize; x <= triangle.box.x1 / kTileSize; ++x) {
                ASSERT_NO_FATAL_FAILURE(draw_in_tile(corners, triangle, x, y));
            }
        }
    }

    [[nodiscard]] int covered(int x, int y) const { return m_covered[index(x, y)]; }
    [[nodiscard]] int signed_sum(int x, int y) const { return m_signed[index(x, y)]; }
    [[nodiscard]] int triangles() const { return m_triangles; }

  private:
    static std::size_t pixels() {
        return static_cast<std::size_t>(kFrame.width) * static_cast<std::size_t>(kFrame.height);
    }
    static std::size_t index(int x, int y) {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(kFrame.width) +
               static_cast<std::size_t>(x);
    }

    /// Calls f for the pixels of the frame within the corners' box.
    template <class F>
    static void for_box(const exact::Triangle& t, F&& f) {
        const auto [low_x, high_x] = std::minmax({t[0].x, t[1].x, t[2].x});
        const auto [low_y, high_y] = std::minmax({t[0].y, t[1].y, t[2].y});
        const auto pixel = [](std::int64_t window, std::int32_t size) {
            return static_cast<int>(std::clamp<std::int64_t>(window >> 8, 0, size - 1));
        };
        for (int y = pixel(low_y, kFrame.height); y <= pixel(high_y, kFrame.height); ++y) {
            for (int x = pixel(low_x, kFrame.width); x <= pixel(high_x, kFrame.width); ++x) f(x, y);
        }
    }

    static void expect_nothing(const exact::Triangle& t) {
        for_box(t, [&](int x, int y) {
            ASSERT_EQ(exact::covers(t, x, y), 0) << "pixel " << x << ", " << y;
        });
    }

    void draw_in_tile(const exact::Triangle& corners, const SetupTriangle& triangle, int tile_x,
                      int tile_y) {
        const bool drawn = m_painter.draw(triangle, tile_x, tile_y);
        std::int64_t count = 0;
        for_box(corners, [&](int px, int py) {
            if (px / kTileSize != tile_x || py / kTileSize != tile_y) return;
            const int want = exact::covers(corners, px, py);
            const bool got = drawn && m_painter.covers(px % kTileSize, py % kTileSize);
            ASSERT_EQ(got, want != 0) << "pixel " << px << ", " << py;
            count += got ? 1 : 0;
            m_covered[index(px, py)] += got ? 1 : 0;
            m_signed[index(px, py)] += want;
        });
        const bool at_border =
            (tile_x + 1) * kTileSize > kFrame.width || (tile_y + 1) * kTileSize > kFrame.height;
        if (drawn && !at_border) {
            ASSERT_EQ(m_painter.count(), count) << "pixels outside the box are covered";
        }
    }

    const KernelTable& m_kernels;
    TilePainter m_painter;
    std::vector<int> m_covered, m_signed;
    int m_triangles = 0;
};

class Road : public KernelTest {
  protected:
    /// Calls f(machine, seed) for every grid of vertices.
    template <class F>
    static void for_each_grid(F&& f) {
        unsigned seed = 0;
        for (int bits = 4; bits <= 8; ++bits) {
            for (const bool floor : {false, true}) f(machine_with_grid(bits, floor), seed++);
        }
    }
};

INSTANTIATE_TEST_SUITE_P(Isa, Road, every_table(), isa_name);

/// A triangle cut into three again and again at points of the grid inside it or on its sides.
struct Subdivision {
    exact::Triangle whole;
    std::vector<exact::Triangle> parts;

    Subdivision(Random& random, int step, int cuts) {
        do {
            for (exact::Point& p : whole) p = random_point(random, step);
        } while (exact::twice_area(whole) == 0);
        parts.push_back(whole);
        for (int i = 0; i < cuts; ++i) {
            const auto at = static_cast<std::size_t>(random.below(static_cast<int>(parts.size())));
            const exact::Triangle t = parts[at];
            const std::optional<exact::Point> inner = inner_point(t, random, step);
            if (!inner) continue;
            parts[at] = {t[0], t[1], *inner};
            parts.push_back({t[1], t[2], *inner});
            parts.push_back({t[2], t[0], *inner});
        }
    }

  private:
    static exact::Point random_point(Random& random, int step) {
        const auto coordinate = [&](int size) {
            const int window = random.between(-30 * 256, (size + 30) * 256);
            // A centre is on every grid that has at least two steps per pixel.
            return std::int64_t{random.chance(3) ? (window & ~255) + 128 : window / step * step};
        };
        return {coordinate(kFrame.width), coordinate(kFrame.height)};
    }
    /// Often close to a corner or a side, where slivers come from.
    static std::optional<exact::Point> inner_point(const exact::Triangle& t, Random& random,
                                                   int step) {
        std::int64_t weight[3], sum = 0;
        for (std::int64_t& w : weight) sum += w = random.chance(3) ? 1 : random.between(0, 1000);
        if (sum == 0) return {};
        exact::Point p{0, 0};
        for (std::size_t i = 0; i < 3; ++i) {
            p.x += weight[i] * t[i].x;
            p.y += weight[i] * t[i].y;
        }
        p = {p.x / sum / step * step, p.y / sum / step * step};
        if (random.chance(4)) p = {(p.x & ~255) + 128, (p.y & ~255) + 128};
        const std::int64_t whole = exact::twice_area(t);
        for (std::size_t i = 0; i < 3; ++i) {
            const std::int64_t part = exact::twice_area({t[i], t[(i + 1) % 3], p});
            if (part != 0 && (part > 0) != (whole > 0)) return {};
        }
        return p;
    }
};

TEST_P(Road, SubdividedTriangleIsCoveredOnce) {
    int triangles = 0;
    for_each_grid([&](const Machine& machine, unsigned seed) {
        const Viewport viewport = make_viewport(machine, kFrame.width, kFrame.height);
        if (testing::Test::HasFatalFailure()) return;
        const int rounds = table().lanes == 1 ? 12 : 72;
        for (int round = 0; round < rounds; ++round) {
            Random random(100 * seed + static_cast<unsigned>(round));
            const Subdivision s(random, 256 >> machine.subpixel_bits, 150);
            Layers layers(table());
            for (const exact::Triangle& t : s.parts) {
                const auto vertex = [&](const exact::Point& p) {
                    return at_window(static_cast<double>(p.x) / 256.0,
                                     static_cast<double>(p.y) / 256.0, viewport);
                };
                const ScreenVertex a = vertex(t[0]), b = vertex(t[1]), c = vertex(t[2]);
                ASSERT_TRUE(a.x == t[0].x && a.y == t[0].y) << "a grid point moved";
                ASSERT_NO_FATAL_FAILURE(layers.draw(a, b, c)) << "seed " << seed << '/' << round;
            }
            triangles += layers.triangles();
            for (int y = 0; y < kFrame.height; ++y) {
                for (int x = 0; x < kFrame.width; ++x) {
                    const int want = exact::covers(s.whole, x, y) != 0 ? 1 : 0;
                    ASSERT_EQ(layers.covered(x, y), want)
                        << "pixel " << x << ", " << y << ", seed " << seed << '/' << round;
                }
            }
        }
    });
    EXPECT_GT(triangles, table().lanes == 1 ? 15000 : 100000);
}

// Corners anywhere, also between the steps of the grid: triangles may fold over each other, but
// around every pixel they turn as often as their common outline does.
TEST_P(Road, FansAndStripsAddUpToTheirOutline) {
    for_each_grid([&](const Machine& machine, unsigned seed) {
        const Viewport viewport = make_viewport(machine, kFrame.width, kFrame.height);
        for (int round = 0; round < (table().lanes == 1 ? 5 : 40); ++round) {
            if (testing::Test::HasFatalFailure()) return;
            Random random(7000 + 100 * seed + static_cast<unsigned>(round));
            std::vector<ScreenVertex> v;
            const double reach = random.chance(3) ? 4000.0 : 100.0;
            for (int i = random.between(4, 40); i > 0; --i) {
                v.push_back(at_window(70.0 + reach * static_cast<double>(random.real(-1, 1)),
                                      50.0 + reach * static_cast<double>(random.real(-1, 1)),
                                      viewport));
            }
            const bool fan = random.chance(2);
            Layers layers(table());
            std::vector<exact::Point> outline, other_side;
            for (std::size_t i = 0; i < v.size(); ++i) {
                const bool other = !fan && i % 2 == 1;
                (other ? other_side : outline).push_back(point(v[i]));
                if (i < 2) continue;
                const ScreenVertex& first = fan ? v[0] : i % 2 == 0 ? v[i - 2] : v[i - 1];
                const ScreenVertex& second = fan || i % 2 == 0 ? v[i - 1] : v[i - 2];
                ASSERT_NO_FATAL_FAILURE(layers.draw(first, second, v[i]));
            }
            // A strip runs down its even corners and back along the odd ones, the other way round.
            if (!fan) {
                std::swap(outline, other_side);
                outline.insert(outline.end(), other_side.rbegin(), other_side.rend());
            }
            for (int y = 0; y < kFrame.height; ++y) {
                for (int x = 0; x < kFrame.width; ++x) {
                    ASSERT_EQ(layers.signed_sum(x, y), exact::winding(outline, x, y))
                        << (fan ? "fan" : "strip") << ", pixel " << x << ", " << y << ", seed "
                        << seed << '/' << round;
                }
            }
        }
    });
}

glm::vec4 color_of(std::size_t number) {
    return {static_cast<float>(number % 256) / 255.0F, static_cast<float>(number / 256) / 255.0F,
            1.0F, 1.0F};
}

// Every triangle in a colour of its own: each pixel shows the only one that covers it, whether the
// triangles are drawn forwards or backwards.
TEST_P(Road, PictureShowsTheOnlyTriangle) {
    for_each_grid([&](const Machine& machine, unsigned seed) {
        Random random(300 + seed);
        const Subdivision s(random, 256 >> machine.subpixel_bits, 900);
        Scene scene;
        scene.machine = machine;
        scene.background = glm::vec4(0.0F);
        for (const bool backwards : {false, true}) {
            RawVertices raw{Space::window, Topology::triangles, {}};
            for (std::size_t i = 0; i < s.parts.size(); ++i) {
                const std::size_t number = backwards ? s.parts.size() - 1 - i : i;
                for (const exact::Point& p : s.parts[number]) {
                    RawVertex v;
                    v.position = {static_cast<float>(p.x) / 256.0F,
                                  static_cast<float>(p.y) / 256.0F, 0.5F, 1.0F};
                    v.color0 = color_of(number);
                    raw.vertices.push_back(v);
                }
            }
            scene.objects = {
                {raw, vertex_color(), glm::mat4(1.0F), {.depth_test = DepthTest::always}}};
            Framebuffer frame(kFrame.width, kFrame.height);
            Renderer({.threads = 2, .isa = table().isa}).render(scene, frame);
            for (int y = 0; y < kFrame.height; ++y) {
                const auto* row = reinterpret_cast<const std::uint8_t*>(frame.row(y));
                for (int x = 0; x < kFrame.width; ++x, row += 4) {
                    const bool shown = row[2] != 0;
                    ASSERT_EQ(shown, exact::covers(s.whole, x, y) != 0) << x << ", " << y;
                    if (!shown) continue;
                    const auto number = static_cast<std::size_t>(row[0] + 256 * row[1]);
                    ASSERT_LT(number, s.parts.size()) << x << ", " << y;
                    ASSERT_NE(exact::covers(s.parts[number], x, y), 0) << x << ", " << y;
                }
            }
        }
    });
}

}  // namespace
}  // namespace burnish
