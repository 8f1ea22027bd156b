// Closed surfaces through transform, clipping, setup, bins and coverage: front faces minus back
// faces behind a pixel are the winding number of the eye, 0 outside and -1 inside.
#include <gtest/gtest.h>

#include <array>
#include <burnish/scene.hpp>
#include <burnish/shapes.hpp>
#include <map>
#include <string>
#include <vector>

#include "geometry/camera.hpp"
#include "kernel_test.hpp"
#include "raster/bin.hpp"
#include "tests/tile_painter.hpp"

namespace burnish {
namespace {

constexpr FrameSize kFrame{139, 101};  // no multiple of 8 or 64

class ClosedSurface : public KernelTest {};
INSTANTIATE_TEST_SUITE_P(Isa, ClosedSurface, every_table(), isa_name);

/// Front faces minus back faces of a chunk's tile lists, per pixel.
class Balance {
  public:
    Balance(const KernelTable& kernels, const MeshData& data, const Camera& camera,
            const glm::mat4& place)
        : m_kernels(kernels),
          m_painter(kernels),
          m_mesh(data),
          m_screen(m_mesh.vertex_count()),
          m_homogeneous(m_mesh.vertex_count()) {
        const Machine machine = machine_profile("ideal");
        m_viewport = make_viewport(machine, kFrame.width, kFrame.height);
        const glm::mat4 m(make_view(camera, kFrame.width, kFrame.height).clip_from_world *
                          glm::dmat4(place));
        TransformCtx ctx{m_mesh.positions()[0],
                         m_mesh.positions()[1],
                         m_mesh.positions()[2],
                         static_cast<int>(m_mesh.vertex_count()),
                         {},
                         m_viewport,
                         m_screen.data(),
                         m_homogeneous.data()};
        for (int i = 0; i < 16; ++i) ctx.m[i] = m[i / 4][i % 4];
        kernels.transform(ctx);
        add(Facing::front_only, 1);
        add(Facing::back_only, -1);
    }

    void expect(int want, const std::string& what) const {
        for (std::size_t i = 0; i < m_count.size(); ++i) {
            ASSERT_EQ(m_count[i], want)
                << what << ", pixel " << i % kFrame.width << ", " << i / kFrame.width;
        }
    }
    [[nodiscard]] std::uint64_t clipped() const { return m_clipped; }

  private:
    void add(Facing facing, int sign) {
        Chunk chunk;
        chunk.fill({{m_screen, m_homogeneous, m_mesh.indices()}, 0, facing, m_viewport, kFrame}, 0,
                   m_mesh.triangle_count(), m_kernels);
        m_clipped += chunk.counts().clipped;
        for (int y = 0; y * kTileSize < kFrame.height; ++y) {
            for (int x = 0; x * kTileSize < kFrame.width; ++x) {
                for (const TileEntry& entry : chunk.tile(x, y)) {
                    add_in_tile(chunk, entry, x, y, sign);
                }
            }
        }
    }
    void add_in_tile(const Chunk& chunk, const TileEntry& entry, int tile_x, int tile_y, int sign) {
        if (!m_painter.draw(chunk, entry, tile_x, tile_y)) return;
        const PixelRect& box = chunk.triangles()[entry.triangle].box;
        for (int y = 0; y < kTileSize; ++y) {
            for (int x = 0; x < kTileSize; ++x) {
                const int px = tile_x * kTileSize + x, py = tile_y * kTileSize + y;
                if (px < box.x0 || px > box.x1 || py < box.y0 || py > box.y1) continue;
                if (m_painter.covers(x, y))
                    m_count[static_cast<std::size_t>(py * kFrame.width + px)] += sign;
            }
        }
    }

    const KernelTable& m_kernels;
    TilePainter m_painter;
    Mesh m_mesh;
    std::vector<ScreenVertex> m_screen;
    std::vector<HomogeneousVertex> m_homogeneous;
    Viewport m_viewport{};
    std::vector<int> m_count = std::vector<int>(kFrame.width * kFrame.height, 0);
    std::uint64_t m_clipped = 0;
};

/// A sphere's triangles between vertices that were moved: still closed, whatever crosses what.
MeshData moved_sphere(Random& random, float least, float most, bool anywhere) {
    MeshData data = shapes::sphere(24, 13);
    std::map<std::array<float, 3>, glm::vec3> moved;  // seams stay closed
    for (glm::vec3& p : data.positions) {
        const auto [at, added] = moved.try_emplace({p.x, p.y, p.z});
        if (added) {
            at->second =
                anywhere
                    ? glm::vec3(random.real(-1, 1), random.real(-1, 1), random.real(-1, 1)) * most
                    : p * random.real(least, most);
        }
        p = at->second;
    }
    return data;
}

// The eye is inside a star-shaped surface, some of it behind the eye and cut by the near plane:
// every pixel sees one more back face than front faces.
TEST_P(ClosedSurface, FromInsideEveryPixelSeesTheSurfaceOnce) {
    std::uint64_t clipped = 0;
    for (unsigned seed = 0; seed < (table().lanes == 1 ? 3U : 15U); ++seed) {
        Random random(seed);
        Camera camera;
        camera.position = glm::vec3(0.0F);
        camera.focal_point = {random.real(-1, 1), random.real(-1, 1), random.real(-1, 1)};
        camera.view_angle = random.real(60.0F, 175.0F);
        camera.near = 0.01F;
        const MeshData data = moved_sphere(random, 0.5F, 2.0F, false);
        const Balance balance(table(), data, camera,
                              placement(glm::vec3(0.0F), {1.0F, 2.0F, 3.0F}, random.real(0, 360),
                                        random.real(0.2F, 20.0F)));
        ASSERT_NO_FATAL_FAILURE(balance.expect(-1, "seed " + std::to_string(seed)));
        clipped += balance.clipped();
    }
    EXPECT_GT(clipped, 50U);
}

// Triangles all over the place, but closed: from outside as many face the eye as turn away, also
// where corners lie beyond the guard band.
TEST_P(ClosedSurface, FromOutsideFrontAndBackFacesBalance) {
    for (unsigned seed = 0; seed < (table().lanes == 1 ? 3U : 15U); ++seed) {
        Random random(400 + seed);
        const bool beyond = seed % 2 == 1;
        Camera camera;
        camera.position = {0.0F, 0.0F, beyond ? 1.01F : 3.0F};
        camera.near = 0.001F;
        camera.far = 1e5F;
        MeshData data = moved_sphere(random, 1.0F, 1.0F, true);
        // A view of 45 degrees is 101 pixels high: 500 times wider is beyond the guard band.
        if (beyond) {
            for (glm::vec3& p : data.positions) p = {500.0F * p.x, 500.0F * p.y, p.z};
        }
        const Balance balance(table(), data, camera, glm::mat4(1.0F));
        ASSERT_NO_FATAL_FAILURE(balance.expect(0, "seed " + std::to_string(seed)));
        if (beyond) {
            EXPECT_GT(balance.clipped(), 100U) << "seed " << seed;
        }
    }
}

}  // namespace
}  // namespace burnish
