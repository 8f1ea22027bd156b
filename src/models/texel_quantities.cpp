#include "models/texel_quantities.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>

namespace burnish {

namespace {

std::vector<const Expr*> definitions_of(const std::vector<const Expr*>& quantities) {
    std::vector<const Expr*> definitions;
    for (const Expr* q : quantities) definitions.push_back(q->args.front().get());
    return definitions;
}

using Read = glm::dvec3 (*)(const TexelParameters&);

/// How a leaf is read.
Read reader_of(const std::string& name) {
    if (name == "n") return [](const TexelParameters& p) { return p.n; };
    if (name == "t") return [](const TexelParameters& p) { return p.t; };
    if (name == "b") return [](const TexelParameters& p) { return p.b; };
    if (name == "alpha_x") return [](const TexelParameters& p) { return glm::dvec3(p.alpha_x); };
    if (name == "alpha_y") return [](const TexelParameters& p) { return glm::dvec3(p.alpha_y); };
    if (name == "N") return [](const TexelParameters& p) { return glm::dvec3(p.exponent); };
    if (name == "ks") return [](const TexelParameters& p) { return p.ks; };
    return [](const TexelParameters& p) { return p.kd; };
}

}  // namespace

std::vector<const Expr*> parameters_of(const std::vector<const Expr*>& quantities) {
    std::vector<const Expr*> found;
    std::set<const Expr*, ByAge> seen;
    const auto visit = [&](const auto& self, const Expr& e) -> void {
        if (!seen.insert(&e).second) return;
        if (e.op == ExprOp::parameter) found.push_back(&e);
        for (const ExprPtr& arg : e.args) self(self, *arg);
    };
    for (const Expr* q : quantities) visit(visit, *q);
    return found;
}

TexelTape::TexelTape(const std::vector<const Expr*>& quantities)
    : m_tape(definitions_of(quantities), parameters_of(quantities)) {
    for (const Expr* leaf : parameters_of(quantities)) m_readers.push_back(reader_of(leaf->name));
}

void TexelTape::run(const TexelParameters& texel, glm::dvec3* values) {
    glm::dvec3 leaves[8];
    for (std::size_t i = 0; i < m_readers.size(); ++i) leaves[i] = m_readers[i](texel);
    m_tape.run(leaves, values);
}

TexelQuantities::TexelQuantities(std::vector<const Expr*> quantities, const TexelSource& source,
                                 std::size_t most_kept)
    : m_quantities(std::move(quantities)), m_source(source), m_tape(m_quantities) {
    for (const Expr* q : m_quantities) {
        m_first.push_back(m_components);
        m_components += q->kind == ValueKind::scalar ? 1 : 3;
    }
    std::size_t rows = 0;
    for (int level = 0; level < source.levels(); ++level) {
        m_first_row.push_back(rows);
        rows += static_cast<std::size_t>(source.height(level));
    }
    const std::size_t row_bytes = sizeof(double) * std::max(m_components, std::size_t{1}) *
                                  static_cast<std::size_t>(source.width());
    m_kept.resize(std::min(most_kept / row_bytes, rows));
}

void TexelQuantities::seek(int level, int y) {
    const std::size_t place =
        m_first_row[static_cast<std::size_t>(level)] + static_cast<std::size_t>(y);
    const bool kept = place < m_kept.size();
    Row& row = kept ? m_kept[place] : m_other;
    if (!kept || row.width == 0) work_out(level, y, row);
    m_row = &row;
}

void TexelQuantities::work_out(int level, int y, Row& row) {
    m_source.require_wanted();
    const auto width = static_cast<std::size_t>(m_source.width(level));
    row.values.resize(m_components * width);
    row.tilt = 0.0;
    std::vector<glm::dvec3> at(m_quantities.size());
    for (std::size_t x = 0; x < width; ++x) {
        const TexelParameters texel = m_source.at(level, static_cast<int>(x), y);
        row.tilt = std::max({row.tilt, std::abs(texel.n.x), std::abs(texel.n.y)});
        m_tape.run(texel, at.data());
        for (std::size_t i = 0; i < at.size(); ++i) {
            const int components = m_quantities[i]->kind == ValueKind::scalar ? 1 : 3;
            double* to = row.values.data() + m_first[i] * width + x;
            for (int c = 0; c < components; ++c, to += width) *to = at[i][c];
        }
    }
    row.width = width;  // last: nothing of the row is kept before all of it
}

std::span<const double> TexelQuantities::component(const Expr& quantity, int c) const {
    const auto at = std::find(m_quantities.begin(), m_quantities.end(), &quantity);
    const std::size_t width = m_row->width;
    const std::size_t first = m_first[static_cast<std::size_t>(at - m_quantities.begin())];
    const std::size_t own = quantity.kind == ValueKind::scalar ? 0 : static_cast<std::size_t>(c);
    return std::span(m_row->values).subspan((first + own) * width, width);
}

}  // namespace burnish
