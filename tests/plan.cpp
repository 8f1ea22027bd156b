// How models become plans: intervals hold what their expressions give, and a plan worked out in
// double precision is its expression, up to what its tables say of themselves.
#include <gtest/gtest.h>

#include <algorithm>
#include <burnish/materials.hpp>
#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "models/bake.hpp"
#include "models/make_plan.hpp"
#include "models/model_texts.hpp"
#include "tests/formulas.hpp"

namespace burnish {
namespace {

const glm::dvec3 kLight(0.9, 0.8, 0.7), kAmbient(0.05, 0.04, 0.03);

/// Surfaces about the z axis; all alike, or of different widths, exponents and directions.
std::vector<TexelParameters> texels(bool vary) {
    std::mt19937_64 engine(5);
    std::vector<TexelParameters> all;
    for (int i = 0; i < (vary ? 40 : 1); ++i) {
        TexelParameters p;
        p.n = glm::normalize(glm::dvec3(0.0, 0.0, 3.0) +
                             (vary ? 1.0 : 0.0) * random_direction(engine));
        const glm::dvec3 along = vary ? random_direction(engine) : glm::dvec3(1.0, 0.0, 0.0);
        p.t = glm::normalize(along - p.n * glm::dot(along, p.n));
        p.b = glm::cross(p.n, p.t);
        p.alpha_x = 0.2 + 0.02 * (i % 7);
        p.alpha_y = 0.3 + 0.05 * (i % 9);
        p.exponent = 8.0 + 4.0 * (i % 11);
        p.kd = {0.2, 0.1, 0.1 + 0.01 * i};
        p.ks = {0.7, 0.6 - 0.01 * i, 0.5};
        all.push_back(p);
    }
    return all;
}

/// Directions at one pixel, in the tangent frame.
struct Pixel {
    glm::dvec3 l, v, h;
    explicit Pixel(std::mt19937_64& engine)
        : l(random_direction(engine)), v(random_direction(engine)) {
        l.z = std::abs(l.z);
        v.z = std::abs(v.z);
        h = reflectance::half_vector(l, v);
    }
    [[nodiscard]] glm::dvec3 of(const std::string& name) const {
        if (name == "l") return l;
        if (name == "v") return v;
        if (name == "h") return h;
        return glm::dvec3(name == "n_dot_l" ? l.z : glm::dot(h, l));
    }
};

/// A model on the way to its program, as compile_model takes it.
struct Planned {
    ExprBuilder builder;
    ExprPtr value;
    std::vector<const Expr*> quantities;
    std::vector<ModelTerm> terms;
    Ranges ranges;
    PlanTask task;
    Plan plan;

    Planned(Model model, const std::vector<TexelParameters>& all, NumberModel numbers) {
        Material material;
        material.model = model;
        value = model_expression(material, builder);
        quantities = quantities_of(*value);
        TexelTape tape(quantities);
        std::vector<glm::dvec3> at(quantities.size());
        for (const TexelParameters& texel : all) {
            tape.run(texel, at.data());
            task.most_tilt = std::max({task.most_tilt, std::abs(texel.n.x), std::abs(texel.n.y)});
            for (std::size_t i = 0; i < at.size(); ++i) include(quantities[i], at[i]);
        }
        std::vector<std::pair<const Expr*, glm::dvec3>> constants;
        for (const auto& [q, v] : task.quantities) {
            const bool is_extreme = q->extreme != Extreme::none;
            if (is_extreme || (v.low == v.high && q->kind != ValueKind::vector))
                constants.emplace_back(q, q->extreme == Extreme::most ? v.high : v.low);
            const bool vector = q->kind == ValueKind::vector;
            ranges.set(q, vector ? Interval{v.shortest, v.longest}
                                 : Interval{std::min({v.low.x, v.low.y, v.low.z}),
                                            std::max({v.high.x, v.high.y, v.high.z})});
        }
        terms = terms_of(with_constants(value, builder, constants), builder);
        std::vector<const Expr*> roots;
        for (const ModelTerm& term : terms) {
            if (term.scalar) roots.push_back(term.scalar.get());
        }
        const bool wide = numbers == NumberModel::wide;
        Cover cover(roots, ranges, numbers, wide ? TablePrice::fetch : TablePrice::passes);
        task.terms = &terms;
        task.varies = all.size() > 1;
        task.light = kLight;
        task.ambient = kAmbient;
        task.numbers = numbers;
        FilledTables tables;
        plan = make_plan(task, cover, ranges, tables);
    }

  private:
    void include(const Expr* quantity, const glm::dvec3& at) {
        const auto [place, is_new] = task.quantities.try_emplace(quantity);
        QuantityValues& v = place->second;
        const double length = glm::length(at);
        v.low = is_new ? at : glm::min(v.low, at);
        v.high = is_new ? at : glm::max(v.high, at);
        v.shortest = is_new ? length : std::min(v.shortest, length);
        v.longest = is_new ? length : std::max(v.longest, length);
        if (is_new) v.somewhere = at;
        v.spread = glm::max(v.spread, glm::abs(at) / (length * length));
    }
};

/// A plan as registers without steps compute it.
class Registers {
  public:
    /// @param off_table  whose values are off by `off`, in its own numbers; -1: none
    Registers(const Plan& plan, const std::vector<glm::dvec3>& quantities, const Pixel& pixel,
              int off_table = -1, double off = 0.0)
        : m_plan(plan), m_off_table(off_table), m_off(off) {
        for (const PlanValue& v : plan.values) m_values.push_back(result(v, quantities, pixel));
    }
    [[nodiscard]] glm::dvec3 color() const {
        const PlanFinal& f = m_plan.final;
        const auto factor = [&](const PlanInput& i) { return glm::clamp(operand(i), 0.0, 1.0); };
        const glm::dvec3 b = f.has_product ? factor(f.e) * factor(f.f) : factor(f.b);
        return glm::clamp(factor(f.a) * b + factor(f.d), 0.0, 1.0);
    }

  private:
    [[nodiscard]] glm::dvec3 operand(const PlanInput& i) const {
        const glm::dvec3 x =
            i.value < 0 ? glm::dvec3(0.0) : m_values[static_cast<std::size_t>(i.value)];
        const glm::dvec3 positive = glm::max(x, 0.0);
        switch (i.mapping) {
            case Mapping::unsigned_identity:
                return positive;
            case Mapping::unsigned_invert:
                return 1.0 - glm::min(positive, 1.0);
            case Mapping::expand:
                return 2.0 * positive - 1.0;
            case Mapping::expand_negate:
                return 1.0 - 2.0 * positive;
            case Mapping::signed_negate:
                return -x;
            default:
                EXPECT_EQ(i.mapping, Mapping::signed_identity);
                return x;
        }
    }
    glm::dvec3 result(const PlanValue& v, const std::vector<glm::dvec3>& quantities,
                      const Pixel& pixel) const {
        const auto coded = [](const glm::dvec3& x) { return glm::clamp(x, -1.0, 1.0) * 0.5 + 0.5; };
        switch (v.op) {
            case PlanOp::constant:
                return v.constant;
            case PlanOp::input: {
                if (v.name == "lit")
                    return glm::clamp(pixel.l.z * m_plan.lit_tint + m_plan.lit_base, 0.0, 1.0);
                const glm::dvec3 x = pixel.of(v.name);
                if (v.kind != ValueKind::vector) return glm::clamp(x, 0.0, 1.0);
                return coded(v.name == "h" ? x * m_plan.half_scale : x);
            }
            case PlanOp::quantity: {
                const auto index = static_cast<std::size_t>(v.index);
                const PlanQuantity& q = m_plan.quantities[index];
                if (q.logarithmic)
                    return glm::dvec3((std::log2(quantities[index].x) - q.low) / q.unit.x);
                const glm::dvec3 x = quantities[index] / q.unit;
                return q.is_coded() ? coded(x) : glm::clamp(x, 0.0, 1.0);
            }
            case PlanOp::table:
                return looked_up(v.index);
            case PlanOp::arithmetic:
                break;
        }
        glm::dvec3 sum(0.0);
        for (std::size_t k = 0; k < static_cast<std::size_t>(v.products); ++k) {
            const glm::dvec3 a = operand(v.factors[2 * k]), b = operand(v.factors[2 * k + 1]);
            sum += v.is_dot ? glm::dvec3(glm::dot(a, b)) : a * b;
        }
        return glm::clamp(sum * std::exp2(v.doublings), -1.0, 1.0);
    }
    glm::dvec3 looked_up(int index) const {
        const PlanTable& t = m_plan.tables[static_cast<std::size_t>(index)];
        int low[2] = {0, 0}, high[2] = {0, 0};
        double weight[2] = {0.0, 0.0};
        for (std::size_t k = 0; k < t.axes.size(); ++k) {
            const PlanAxis& axis = t.axes[k];
            const int value = axis.input.value;
            EXPECT_GE(value, 0);
            double x = m_values[static_cast<std::size_t>(value)].x;
            if (axis.is_signed) x = 0.5 * x + 0.5;
            x = std::clamp(x, 0.0, 1.0) * (axis.size - 1);
            low[k] = std::min(static_cast<int>(x), axis.size - 1);
            high[k] = std::min(low[k] + 1, axis.size - 1);
            weight[k] = x - low[k];
        }
        const auto texel = [&](int x, int y) {
            return t.values[static_cast<std::size_t>(y * t.axes[0].size + x)];
        };
        const auto row = [&](int y) {
            return texel(low[0], y) * (1.0 - weight[0]) + texel(high[0], y) * weight[0];
        };
        double f = row(low[1]) * (1.0 - weight[1]) + row(high[1]) * weight[1];
        if (index == m_off_table) f += m_off / t.unit;
        f = std::clamp(f, t.coded ? -1.0 : 0.0, 1.0);
        return glm::dvec3(t.coded ? 0.5 * f + 0.5 : f);
    }

    const Plan& m_plan;
    int m_off_table;
    double m_off;
    std::vector<glm::dvec3> m_values;
};

class PlanNumbers : public testing::TestWithParam<NumberModel> {};

void expect_tables_of_one_or_two_arguments(const Plan& plan) {
    for (const PlanTable& t : plan.tables) {
        ASSERT_TRUE(t.axes.size() == 1 || t.axes.size() == 2) << t.function;
        const int count = t.axes[0].size * (t.axes.size() == 2 ? t.axes[1].size : 1);
        EXPECT_EQ(t.values.size(), static_cast<std::size_t>(count)) << t.function;
        const auto [low, high] = std::minmax_element(t.values.begin(), t.values.end());
        EXPECT_NEAR(std::max(-*low, *high), 1.0, 1e-12) << t.function;
    }
}

// The tail that a table leaves out is 2^-12 or 2^-9 of its height (docs/architecture.md), halfway
// between texels it is off by what it says, and elsewhere, at kinks, by at most twice that.
TEST_P(PlanNumbers, InDoublePrecisionIsItsExpression) {
    const double rest = GetParam() == NumberModel::wide ? 0x1p-12 : 0x1p-9;
    for (const bool vary : {false, true}) {
        const std::vector<TexelParameters> all = texels(vary);
        for (const std::string_view name : model_names()) {
            // Large tables take their time.
            const bool is_chosen = name == "abp" || name == "banks" || name == "lean";
            if (vary && GetParam() == NumberModel::wide && !is_chosen) continue;
            if (name == "lean" && GetParam() == NumberModel::nine_bit) continue;  // is refused
            const Planned planned(*model_named(name), all, GetParam());
            const Plan& plan = planned.plan;
            expect_tables_of_one_or_two_arguments(plan);
            std::vector<const Expr*> inputs = planned.quantities;
            std::vector<ExprPtr> geometry;
            for (const char* leaf : {"l", "v", "h", "n_dot_l", "h_dot_l"})
                geometry.push_back(const_cast<ExprBuilder&>(planned.builder).leaf(leaf));
            for (const ExprPtr& leaf : geometry) inputs.push_back(leaf.get());
            Tape value({planned.value.get()}, inputs);
            TexelTape quantities(planned.quantities);
            std::vector<const Expr*> layer;
            for (const PlanQuantity& q : plan.quantities) layer.push_back(q.expr);
            TexelTape layer_values(layer);
            std::mt19937_64 engine(29);
            double worst = 0.0;
            for (int i = 0; i < 100; ++i) {
                const TexelParameters& texel = all[static_cast<std::size_t>(i) % all.size()];
                const Pixel pixel(engine);
                std::vector<glm::dvec3> at(inputs.size());
                quantities.run(texel, at.data());
                for (std::size_t k = 0; k < geometry.size(); ++k)
                    at[planned.quantities.size() + k] = pixel.of(geometry[k]->name);
                glm::dvec3 expected;
                value.run(at.data(), &expected);
                expected = glm::clamp(kLight * expected + kAmbient, 0.0, 1.0);
                std::vector<glm::dvec3> of_layer(layer.size());
                layer_values.run(texel, of_layer.data());
                const glm::dvec3 color = Registers(plan, of_layer, pixel).color();
                double allowed = 1e-9;
                for (std::size_t k = 0; k < plan.tables.size(); ++k) {
                    const PlanTable& t = plan.tables[k];
                    const double off = 2.0 * t.interpolation + rest * t.unit;
                    double most = 0.0;
                    for (const double sign : {-1.0, 1.0}) {
                        const glm::dvec3 moved = glm::abs(
                            Registers(plan, of_layer, pixel, static_cast<int>(k), sign * off)
                                .color() -
                            color);
                        most = std::max({most, moved.x, moved.y, moved.z});
                    }
                    allowed += most;
                }
                const glm::dvec3 wrong = glm::abs(color - expected);
                worst = std::max(worst, std::max({wrong.x, wrong.y, wrong.z}) / allowed);
            }
            EXPECT_LT(worst, 1.0) << name << (vary ? " of maps" : "");
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Of, PlanNumbers, testing::Values(NumberModel::wide, NumberModel::nine_bit),
                         [](const auto& numbers) {
                             return numbers.param == NumberModel::wide ? "Wide" : "NineBit";
                         });

/// All nodes at or below `e`.
void collect(const Expr& e, std::set<const Expr*, ByAge>& nodes) {
    if (!nodes.insert(&e).second) return;
    if (e.op == ExprOp::quantity) return;
    for (const ExprPtr& arg : e.args) collect(*arg, nodes);
}

TEST(RangesTest, HoldWhatTheExpressionGives) {
    const std::vector<TexelParameters> all = texels(true);
    for (const std::string_view name : model_names()) {
        Planned planned(*model_named(name), all, NumberModel::nine_bit);
        std::set<const Expr*, ByAge> nodes;
        for (const ModelTerm& term : planned.terms) {
            if (term.scalar) collect(*term.scalar, nodes);
        }
        const std::vector<const Expr*> roots(nodes.begin(), nodes.end());
        std::vector<const Expr*> inputs;
        std::copy_if(roots.begin(), roots.end(), std::back_inserter(inputs), [](const Expr* e) {
            return e->op == ExprOp::quantity || e->op == ExprOp::geometry;
        });
        Tape tape(roots, inputs);
        TexelTape quantities(planned.quantities);
        std::vector<glm::dvec3> of_texel(planned.quantities.size()), at, values(roots.size());
        std::mt19937_64 engine(31);
        for (int i = 0; i < 500; ++i) {
            quantities.run(all[static_cast<std::size_t>(i) % all.size()], of_texel.data());
            const Pixel pixel(engine);
            at.clear();
            for (const Expr* e : inputs) {
                const auto place =
                    std::find(planned.quantities.begin(), planned.quantities.end(), e);
                at.push_back(
                    e->op == ExprOp::geometry
                        ? pixel.of(e->name)
                        : of_texel[static_cast<std::size_t>(place - planned.quantities.begin())]);
            }
            tape.run(at.data(), values.data());
            for (std::size_t k = 0; k < roots.size(); ++k) {
                if (roots[k]->kind != ValueKind::scalar) continue;
                const Interval range = planned.ranges.of(*roots[k]);
                const double slack = 1e-12 * std::max(1.0, std::abs(values[k].x));
                EXPECT_TRUE(values[k].x >= range.low - slack && values[k].x <= range.high + slack)
                    << name << ": " << print_expression(*roots[k]) << " = " << values[k].x << " of "
                    << range.low << " .. " << range.high;
            }
        }
    }
}

TEST(PlanTest, TheSameTaskGivesTheSamePlan) {
    for (const bool vary : {false, true}) {
        const std::vector<TexelParameters> all = texels(vary);
        for (const Model model : {Model::abp, Model::ward, Model::ggx}) {
            const Plan a = Planned(model, all, NumberModel::nine_bit).plan,
                       b = Planned(model, all, NumberModel::nine_bit).plan;
            ASSERT_EQ(a.values.size(), b.values.size());
            for (std::size_t i = 0; i < a.values.size(); ++i) {
                EXPECT_EQ(a.values[i].op, b.values[i].op);
                EXPECT_EQ(a.values[i].unit, b.values[i].unit);
                EXPECT_EQ(a.values[i].factors, b.values[i].factors);
                EXPECT_EQ(a.values[i].doublings, b.values[i].doublings);
                EXPECT_EQ(a.values[i].constant, b.values[i].constant);
            }
            ASSERT_EQ(a.tables.size(), b.tables.size());
            for (std::size_t i = 0; i < a.tables.size(); ++i) {
                EXPECT_EQ(a.tables[i].function, b.tables[i].function);
                EXPECT_EQ(a.tables[i].values, b.tables[i].values);
                EXPECT_EQ(a.tables[i].unit, b.tables[i].unit);
            }
            EXPECT_EQ(a.half_scale, b.half_scale);
        }
    }
}

}  // namespace
}  // namespace burnish
