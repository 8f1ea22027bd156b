#pragma once

#include <algorithm>
#include <vector>

#include "shade/attributes.hpp"

namespace burnish {

/// Triangles of one draw in the order of their fragments, each with a column of equations, which
/// are made for many at once: a packet may hold a part of one triangle.
class PlaneBatch {
  public:
    PlaneBatch() { m_triangles.reserve(kPacketSize); }

    void clear() {
        m_triangles.clear();
        m_made = 0;
    }
    /// Forgets the first `count` columns.
    void drop(std::size_t count) {
        m_triangles.erase(m_triangles.begin(),
                          m_triangles.begin() + static_cast<std::ptrdiff_t>(count));
        m_made = 0;
    }
    /// Only if it is not full.
    void push(const SetupTriangle& triangle) { m_triangles.push_back(&triangle); }

    [[nodiscard]] std::size_t size() const { return m_triangles.size(); }
    [[nodiscard]] bool full() const { return size() == kPacketSize; }
    [[nodiscard]] const SetupTriangle& triangle(std::size_t column) const {
        return *m_triangles[column];
    }

    /// Equations as AttributesCtx has them, column by column.
    const float* equations(const Shading& shading, const ScreenMesh& mesh,
                           const KernelTable& kernels) {
        if (m_made_for != &shading) m_made = 0;
        m_made_for = &shading;
        if (m_made < size()) {
            const std::size_t rows = equation_rows(shading);
            if (m_equations.size() < rows * kAttributeStride)
                m_equations.resize(rows * kAttributeStride);
            attribute_planes(shading, mesh, std::span(m_triangles).subspan(m_made), kernels,
                             m_inputs, m_equations.data() + m_made);
            m_made = size();
        }
        return m_equations.data();
    }

  private:
    std::vector<const SetupTriangle*> m_triangles;
    std::size_t m_made = 0;  ///< columns that have their equations
    const Shading* m_made_for = nullptr;
    PlaneInputs m_inputs;
    AlignedVector<float> m_equations;
};

}  // namespace burnish
