#include "lab/experiment/verdicts.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>

#include "core/dmath.hpp"

namespace burnish::lab {
namespace {

/// A cell's label on an axis, as a number, and its metric.
struct Point {
    double label, value;
};

/// Of value over label, by least squares; nothing for fewer than two labels.
std::optional<double> slope(const std::vector<Point>& points) {
    double x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
    for (const Point& point : points) {
        x += point.label;
        y += point.value;
    }
    const auto count = static_cast<double>(points.size());
    for (const Point& point : points) {
        xx += (point.label - x / count) * (point.label - x / count);
        xy += (point.label - x / count) * (point.value - y / count);
    }
    if (!(xx > 0.0)) return std::nullopt;
    return xy / xx;
}

std::optional<double> extreme(const std::vector<Point>& points, bool smallest) {
    if (points.empty()) return std::nullopt;
    const auto less = [](const Point& a, const Point& b) { return a.value < b.value; };
    return (smallest ? std::min_element(points.begin(), points.end(), less)
                     : std::max_element(points.begin(), points.end(), less))
        ->label;
}

std::optional<double> measure_of(ExperimentMeasure measure, std::vector<Point> points) {
    if (measure == ExperimentMeasure::argmin) return extreme(points, true);
    if (measure == ExperimentMeasure::argmax) return extreme(points, false);
    for (Point& point : points) {
        if (!(point.value > 0.0)) return std::nullopt;
        point.value = dmath::log2(point.value);
        if (measure == ExperimentMeasure::halving) continue;
        if (!(point.label > 0.0)) return std::nullopt;
        point.label = dmath::log2(point.label);
    }
    const std::optional<double> found = slope(points);
    if (!found || measure == ExperimentMeasure::slope) return found;
    return dmath::exp2(-*found);
}

class Judge {
  public:
    Judge(const Results& results, const ExperimentExpectation& expectation)
        : m_results(results), m_expectation(expectation) {}

    Judgement run() {
        const auto measure = m_expectation.measure;
        if (measure == ExperimentMeasure::value || measure == ExperimentMeasure::ratio)
            judge_cells();
        else
            judge_groups();
        if (m_judgement.inside < m_judgement.measures.size())
            m_judgement.verdict = Verdict::refuted;
        else if (m_judgement.open == 0 && !m_judgement.measures.empty())
            m_judgement.verdict = Verdict::confirmed;
        return m_judgement;
    }

  private:
    bool wanted(std::size_t cell) const {
        return matches(m_results.experiment, m_results.cells[cell], m_expectation.where);
    }

    void add(const std::optional<double>& measure) {
        if (!measure) {
            ++m_judgement.open;
            return;
        }
        m_judgement.measures.push_back(*measure);
        const bool inside = (!m_expectation.at_least || *measure >= *m_expectation.at_least) &&
                            (!m_expectation.at_most || *measure <= *m_expectation.at_most);
        if (inside) ++m_judgement.inside;
    }

    /// The cell with the values of `versus`, otherwise like `cell`.
    std::optional<std::size_t> partner(std::size_t cell) const {
        std::vector<std::size_t> values = m_results.cells[cell].values;
        for (const auto& [name, labels] : m_expectation.versus) {
            const std::size_t axis = axis_index(m_results.experiment, name);
            const auto& of = m_results.experiment.axes[axis].values;
            for (std::size_t i = 0; i < of.size(); ++i)
                if (of[i].label == labels.front()) values[axis] = i;
        }
        for (std::size_t i = 0; i < m_results.cells.size(); ++i)
            if (m_results.cells[i].values == values) return i;
        return std::nullopt;
    }

    std::optional<double> ratio(std::size_t cell) const {
        const std::optional<std::size_t> other = partner(cell);
        if (!other) return std::nullopt;
        const std::optional<double> above = m_results.value(cell, m_expectation.metric);
        const std::optional<double> below = m_results.value(*other, m_expectation.metric);
        if (!above || !below || *below == 0.0) return std::nullopt;
        return *above / *below;
    }

    void judge_cells() {
        for (std::size_t cell = 0; cell < m_results.cells.size(); ++cell) {
            if (!wanted(cell)) continue;
            add(m_expectation.measure == ExperimentMeasure::ratio
                    ? ratio(cell)
                    : m_results.value(cell, m_expectation.metric));
        }
    }

    void judge_groups() {
        const std::size_t along = axis_index(m_results.experiment, m_expectation.along);
        std::map<std::vector<std::size_t>, std::vector<std::size_t>> groups;
        for (std::size_t cell = 0; cell < m_results.cells.size(); ++cell) {
            if (!wanted(cell)) continue;
            std::vector<std::size_t> key = m_results.cells[cell].values;
            key[along] = 0;
            groups[key].push_back(cell);
        }
        for (const auto& [key, cells] : groups) {
            std::vector<Point> points;
            bool complete = true;
            for (const std::size_t cell : cells) {
                const auto value = m_results.value(cell, m_expectation.metric);
                const auto label = label_number(
                    label_of(m_results.experiment, m_results.cells[cell], m_expectation.along));
                complete = complete && value && label;
                if (value && label) points.push_back({*label, *value});
            }
            add(complete ? measure_of(m_expectation.measure, std::move(points)) : std::nullopt);
        }
    }

    const Results& m_results;
    const ExperimentExpectation& m_expectation;
    Judgement m_judgement;
};

}  // namespace

std::string_view verdict_name(Verdict verdict) {
    switch (verdict) {
        case Verdict::confirmed:
            return "confirmed";
        case Verdict::refuted:
            return "refuted";
        case Verdict::open:
            break;
    }
    return "open";
}

Judgement judge(const Results& results, const ExperimentExpectation& expectation) {
    return Judge(results, expectation).run();
}

Verdict overall(const std::vector<Judgement>& judgements) {
    const auto any = [&](Verdict verdict) {
        return std::any_of(judgements.begin(), judgements.end(),
                           [&](const Judgement& each) { return each.verdict == verdict; });
    };
    if (any(Verdict::refuted)) return Verdict::refuted;
    return judgements.empty() || any(Verdict::open) ? Verdict::open : Verdict::confirmed;
}

}  // namespace burnish::lab
