#pragma once

#include <map>
#include <string>
#include <vector>

#include "models/filled_tables.hpp"
#include "models/plan.hpp"
#include "models/terms.hpp"

namespace burnish {

/// What a quantity is over all texels.
struct QuantityValues {
    glm::dvec3 low{0.0}, high{0.0};        ///< component by component
    double shortest = 0.0, longest = 0.0;  ///< of a vector: length
    glm::dvec3 somewhere{0.0};             ///< at the first texel
    bool is_tangent = true;  ///< a vector that is perpendicular to the normal at every texel
    glm::dvec3 spread{0.0};  ///< of a vector: the largest |component| / length^2
};

/// What a plan is made for.
struct PlanTask {
    const std::vector<ModelTerm>* terms = nullptr;
    std::map<const Expr*, QuantityValues, ByAge> quantities;
    double most_tilt = 0.0;  ///< largest |x| or |y| of the normals
    bool varies = false;     ///< quantities are filtered: vectors may be shorter than at any texel
    glm::dvec3 light{1.0}, ambient{0.0};
    NumberModel numbers = NumberModel::wide;
    bool fine_tables = false;  ///< as many texels as wide numbers would have, whatever they are
    TableFilter table_filter = TableFilter::point;
    bool vertex_light = false;       ///< what depends on n_dot_l alone may come with the vertices
    bool few_stages = false;         ///< fetches in place of stages that only scale
    bool scaled_half_vector = true;  ///< the interpolators may scale it: half vectors of the pixel
};

/// Throws Error{bad_program} for what no table can hold, Shortage where there are none and one is
/// needed.
Plan make_plan(const PlanTask& task, Cover& cover, Ranges& ranges, FilledTables& tables);

}  // namespace burnish
