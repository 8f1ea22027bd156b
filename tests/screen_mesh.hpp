#pragma once

#include <burnish/mesh.hpp>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "geometry/camera.hpp"
#include "geometry/triangle.hpp"
#include "kernels/kernel_table.hpp"

namespace burnish {

/// A mesh's vertices on the screen, for tests of the stages after `transform`. Borrows the mesh.
class OnScreen {
  public:
    OnScreen(const KernelTable& kernels, const Mesh& mesh, const glm::mat4& clip_from_object,
             const Viewport& viewport)
        : m_indices(mesh.indices()),
          m_screen(mesh.vertex_count()),
          m_homogeneous(mesh.vertex_count()) {
        const auto [x, y, z] = mesh.positions();
        TransformCtx ctx{x,
                         y,
                         z,
                         static_cast<int>(mesh.vertex_count()),
                         {},
                         viewport,
                         m_screen.data(),
                         m_homogeneous.data()};
        for (int i = 0; i < 16; ++i) ctx.m[i] = clip_from_object[i / 4][i % 4];
        kernels.transform(ctx);
    }
    [[nodiscard]] ScreenMesh mesh() const { return {m_screen, m_homogeneous, m_indices}; }

  private:
    std::span<const std::uint32_t> m_indices;
    std::vector<ScreenVertex> m_screen;
    std::vector<HomogeneousVertex> m_homogeneous;
};

}  // namespace burnish
