// What clipping leaves of a triangle is the part of it inside the planes, no more and no less; a
// surface that is cut stays whole, each pixel once; single vertices go the way of the kernels.
#include <gtest/gtest.h>

#include <array>
#include <burnish/scene.hpp>
#include <burnish/shapes.hpp>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "geometry/camera.hpp"
#include "geometry/clip.hpp"
#include "kernel_test.hpp"
#include "raster/bin.hpp"
#include "tests/screen_mesh.hpp"
#include "tests/tile_painter.hpp"

namespace burnish {
namespace {

using Vector = std::array<double, 4>;  // x, y, z, w in homogeneous window coordinates

double value(float x) {
    return static_cast<double>(x);
}
Vector vector(const HomogeneousVertex& v) {
    return {value(v.x), value(v.y), value(v.z), value(v.w)};
}

/// Least signed distance to the six planes, each relative to the size of its terms.
double inside_by(const Vector& v) {
    const double low = value(kGuardLow), high = value(kGuardHigh), w = v[3];
    const std::array<std::array<double, 2>, 6> terms{{{v[2], 0.0},
                                                      {w, v[2]},
                                                      {v[0], low * w},
                                                      {high * w, v[0]},
                                                      {v[1], low * w},
                                                      {high * w, v[1]}}};
    double least = 1.0;
    for (const auto& [a, b] : terms) {
        least = std::min(least, (a - b) / (std::abs(a) + std::abs(b) + 1e-9));
    }
    return least;
}

struct Weights {
    double b, c;  ///< of the second and the third corner
};

double turn(const Weights& p, const Weights& q, const Weights& r) {
    return (q.b - p.b) * (r.c - p.c) - (q.c - p.c) * (r.b - p.b);
}

/// Weights of the triangle's corners that give `v`, from x, y and w; nothing if it is seen edge-on.
std::optional<Weights> weights(const std::array<Vector, 3>& t, const Vector& v) {
    const auto determinant = [](const Vector& p, const Vector& q, const Vector& r) {
        return p[0] * (q[1] * r[3] - q[3] * r[1]) - p[1] * (q[0] * r[3] - q[3] * r[0]) +
               p[3] * (q[0] * r[1] - q[1] * r[0]);
    };
    const double whole = determinant(t[0], t[1], t[2]);
    if (std::abs(whole) < 1e6) return {};  // of terms around 1e10
    return Weights{determinant(t[0], v, t[2]) / whole, determinant(t[0], t[1], v) / whole};
}

HomogeneousVertex random_vertex(Random& random) {
    const float w = random.real(-2.0F, 5.0F);
    return {random.real(-60000.0F, 60000.0F), random.real(-60000.0F, 60000.0F),
            random.real(-1.0F, 1.0F) * (random.chance(2) ? 1.0F : 5.0F), w};
}

/// -1: outside of the convex polygon, +1: inside, 0: too close to its border to tell.
int place_in(const std::vector<Weights>& polygon, const Weights& p) {
    bool inside = true;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const double side = turn(polygon[i], polygon[(i + 1) % polygon.size()], p);
        if (side < -1e-9) return -1;
        inside = inside && side > 1e-9;
    }
    return inside ? 1 : 0;
}

TEST(ClipRegion, IsThePartInsideThePlanes) {
    int cut = 0, inside = 0, outside = 0;
    for (unsigned seed = 0; seed < 3000; ++seed) {
        Random random(seed);
        const std::array<HomogeneousVertex, 3> v{random_vertex(random), random_vertex(random),
                                                 random_vertex(random)};
        const std::array<Vector, 3> t{vector(v[0]), vector(v[1]), vector(v[2])};
        const ClipPolygon p = clip_triangle(v[0], v[1], v[2]);
        std::vector<Weights> polygon;
        for (int i = 0; i < p.count; ++i) {
            const ClipVertex& corner = p.corner[static_cast<std::size_t>(i)];
            const auto w = weights(t, {corner.x, corner.y, corner.z, corner.w});
            if (!w) break;
            polygon.push_back(*w);
        }
        if (!weights(t, t[0])) continue;
        cut += p.count > 3 ? 1 : 0;
        for (int b = 0; b <= 20; ++b) {
            for (int c = 0; b + c <= 20; ++c) {
                const Weights at{(b + 0.01) / 20.4, (c + 0.01) / 20.4};
                Vector point{};
                for (std::size_t k = 0; k < 4; ++k) {
                    point[k] = t[0][k] * (1.0 - at.b - at.c) + t[1][k] * at.b + t[2][k] * at.c;
                }
                const double distance = inside_by(point);
                if (std::abs(distance) < 1e-6) continue;
                const int place = polygon.empty() ? -1 : place_in(polygon, at);
                if (place == 0) continue;
                ASSERT_EQ(place > 0, distance > 0.0)
                    << "seed " << seed << ", weights " << at.b << ", " << at.c;
                ++(place > 0 ? inside : outside);
            }
        }
    }
    EXPECT_GT(cut, 500);
    EXPECT_GT(inside, 50000);
    EXPECT_GT(outside, 50000);
}

TEST(ClipRegion, IsFiniteForAnyFiniteVertices) {
    const std::array extremes{0.0F,    -0.0F, 1e-45F, -1e-45F, 1e-38F,   1.0F, -1.0F, 8192.0F,
                              24575.F, 1e20F, -1e20F, 3.4e38F, -3.4e38F, 0.5F, -0.5F, 1e-20F};
    for (unsigned seed = 0; seed < 100000; ++seed) {
        Random random(seed);
        std::array<HomogeneousVertex, 3> v;
        for (HomogeneousVertex& h : v) {
            for (float* x : {&h.x, &h.y, &h.z, &h.w}) {
                *x = random.chance(3) ? random.real(-2.0F, 2.0F) : random.pick(extremes);
            }
        }
        const ClipPolygon p = clip_triangle(v[0], v[1], v[2]);
        ASSERT_LE(p.count, ClipPolygon::kMaxCorners);
        for (int i = 0; i < p.count; ++i) {
            const ClipVertex& c = p.corner[static_cast<std::size_t>(i)];
            for (const double x : {c.x, c.y, c.z, c.w}) {
                ASSERT_TRUE(std::isfinite(x)) << "seed " << seed;
            }
        }
    }
}

// Raw vertices and meshes meet at their borders without cracks only if both are placed alike. The
// stage multiplies by one, adds zeros and takes w from the matrix.
TEST(ClipRegion, SingleVerticesGoTheWayOfTheTransformStage) {
    AlignedVector<float> x(std::size_t{16}, 0.0F), y = x, z = x;
    for (unsigned seed = 0; seed < 20000; ++seed) {
        Random random(seed);
        const float reach = random.chance(3) ? 100.0F : 1.5F;
        x[0] = random.real(-reach, reach);
        y[0] = random.real(-reach, reach);
        z[0] = random.real(-1.2F, 1.2F);
        const float w = random.chance(8) ? random.pick(std::array{0.0F, -1.0F, 1e-30F})
                                         : random.real(0.3F, 3.0F);
        Machine machine;
        machine.subpixel_bits = random.between(4, 8);
        machine.snap_floor = random.chance(2);
        const Viewport viewport =
            make_viewport(machine, random.between(1, 16384), random.between(1, 16384));
        ScreenVertex want{}, got{};
        HomogeneousVertex want_homogeneous{}, got_homogeneous{};
        table_reference().transform({x.data(),
                                     y.data(),
                                     z.data(),
                                     1,
                                     {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, w},
                                     viewport,
                                     &want,
                                     &want_homogeneous});
        place_clip_vertex({x[0], y[0], z[0], w}, viewport, got, got_homogeneous);
        ASSERT_TRUE(got.x == want.x && got.y == want.y && got.z == want.z &&
                    got.outcode == want.outcode)
            << "seed " << seed << ": got " << got.x << ' ' << got.y << ' ' << got.z << ' '
            << got.outcode << ", want " << want.x << ' ' << want.y << ' ' << want.z << ' '
            << want.outcode;
        ASSERT_TRUE(
            got_homogeneous.x == want_homogeneous.x && got_homogeneous.y == want_homogeneous.y &&
            got_homogeneous.z == want_homogeneous.z && got_homogeneous.w == want_homogeneous.w);
    }
}

// A triangle that is cut and its neighbour that is not share corners: those keep the place that the
// transform stage gave them, rounding included.
TEST(ClipRegion, VisibleCornersKeepTheirPlaces) {
    constexpr FrameSize kView{500, 300};
    const Viewport viewport = make_viewport(machine_profile("ideal"), kView.width, kView.height);
    int kept = 0;
    for (unsigned seed = 0; seed < 10000; ++seed) {
        Random random(seed);
        std::array<ScreenVertex, 3> screen{};
        std::array<HomogeneousVertex, 3> homogeneous{};
        for (std::size_t i = 0; i < 3; ++i) {
            const bool behind = i == 2;
            const float w = behind ? random.real(-2.0F, -0.1F) : random.real(0.2F, 5.0F);
            place_clip_vertex({random.real(-1, 1) * w, random.real(-1, 1) * w,
                               behind ? w - 1.0F : random.real(-1, 1) * w, w},
                              viewport, screen[i], homogeneous[i]);
        }
        const std::array<std::uint32_t, 3> indices{0, 1, 2};
        Chunk chunk;
        chunk.fill({{screen, homogeneous, indices}, 0, Facing::any, viewport, kView}, 0, 1,
                   table_reference());
        ASSERT_EQ(chunk.counts().clipped, 1U) << "seed " << seed;
        const int corners = clip_triangle(homogeneous[0], homogeneous[1], homogeneous[2]).count;
        // Parts that cover no pixel centre are dropped, and their corners with them.
        if (static_cast<int>(chunk.triangles().size()) != corners - 2) continue;
        for (std::size_t i = 0; i < 2; ++i) {
            bool found = false;
            for (const SetupTriangle& t : chunk.triangles()) {
                for (std::size_t k = 0; k < 3; ++k)
                    found |= t.x[k] == screen[i].x && t.y[k] == screen[i].y;
            }
            ASSERT_TRUE(found) << "seed " << seed << ", corner " << i;
            ++kept;
        }
    }
    EXPECT_GT(kept, 15000);
}

constexpr FrameSize kFrame{171, 117};

/// How often each pixel is covered by the triangles of a mesh, tile by tile as they are binned.
std::vector<int> layers(const KernelTable& kernels, const Mesh& mesh, const Camera& camera,
                        const glm::mat4& place, BinCounts& counts) {
    const Viewport viewport = make_viewport(machine_profile("ideal"), kFrame.width, kFrame.height);
    const glm::mat4 m(make_view(camera, kFrame.width, kFrame.height).clip_from_world *
                      glm::dmat4(place));
    const OnScreen seen(kernels, mesh, m, viewport);
    Chunk chunk;
    chunk.fill({seen.mesh(), 0, Facing::any, viewport, kFrame}, 0, mesh.triangle_count(), kernels);
    counts = chunk.counts();
    TilePainter painter(kernels);
    std::vector<int> result(static_cast<std::size_t>(kFrame.width * kFrame.height), 0);
    for (int ty = 0; ty * kTileSize < kFrame.height; ++ty) {
        for (int tx = 0; tx * kTileSize < kFrame.width; ++tx) {
            for (const TileEntry& entry : chunk.tile(tx, ty)) {
                if (!painter.draw(chunk, entry, tx, ty)) continue;
                for (int y = ty * kTileSize; y < std::min((ty + 1) * kTileSize, kFrame.height); ++y)
                    for (int x = tx * kTileSize; x < std::min((tx + 1) * kTileSize, kFrame.width);
                         ++x)
                        result[static_cast<std::size_t>(y * kFrame.width + x)] +=
                            painter.covers(x % kTileSize, y % kTileSize) ? 1 : 0;
            }
        }
    }
    return result;
}

class CutSurface : public KernelTest {};
INSTANTIATE_TEST_SUITE_P(Isa, CutSurface, every_table(), isa_name);

// A floor that passes under the camera to beyond the far plane, its cells of many sizes, cut by the
// near plane, the far plane and the guard band: once per pixel from below the last row that the far
// plane can reach, at most once everywhere, never above the horizon.
TEST_P(CutSurface, FloorIsCoveredOnce) {
    std::uint64_t clipped = 0;
    for (unsigned seed = 0; seed < (table().lanes == 1 ? 6U : 40U); ++seed) {
        Random random(seed);
        const int cells = random.pick(std::array{1, 2, 7, 40});
        MeshData data = shapes::plane(cells, cells);
        for (glm::vec3& p : data.positions) {  // uneven, but the outline stays
            if (std::abs(p.x) < 0.49F && std::abs(p.y) < 0.49F) {
                p.x += random.real(-0.3F, 0.3F) / static_cast<float>(cells);
                p.y += random.real(-0.3F, 0.3F) / static_cast<float>(cells);
            }
        }
        const float height = random.real(0.001F, 2.0F);
        Camera camera;
        camera.position = {random.real(-20, 20), height, random.real(-20, 20)};
        camera.focal_point = camera.position + glm::vec3(random.real(-1, 1), 0, random.real(-1, 1));
        camera.near = random.pick(std::array{0.0001F, 0.01F, 0.1F});
        camera.far = random.pick(std::array{900.0F, 1e5F});
        BinCounts counts;
        const std::vector<int> seen =
            layers(table(), Mesh(data), camera,
                   placement(glm::vec3(0.0F), {1.0F, 0.0F, 0.0F}, -90.0F, 2000.0F), counts);
        clipped += counts.clipped;
        // The floor reaches 900 units at least in every direction; the view is 45 degrees high.
        const double rows_per_slope = kFrame.height / 2.0 / std::tan(22.5 * 3.14159265358979 / 180);
        const double last = kFrame.height / 2.0 + value(height) / 890.0 * rows_per_slope + 1.0;
        for (int y = 0; y < kFrame.height; ++y) {
            for (int x = 0; x < kFrame.width; ++x) {
                const int got = seen[static_cast<std::size_t>(y * kFrame.width + x)];
                const std::string where = "seed " + std::to_string(seed) + ", pixel " +
                                          std::to_string(x) + ", " + std::to_string(y);
                ASSERT_LE(got, y + 1 < kFrame.height / 2 ? 0 : 1) << where;
                if (y + 0.5 > last) {
                    ASSERT_EQ(got, 1) << where;
                }
            }
        }
    }
    EXPECT_GT(clipped, table().lanes == 1 ? 15U : 200U);
}

}  // namespace
}  // namespace burnish
