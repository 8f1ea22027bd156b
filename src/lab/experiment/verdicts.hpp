#pragma once

#include <string_view>
#include <vector>

#include "lab/experiment/run.hpp"

namespace burnish::lab {

enum class Verdict { confirmed, refuted, open };
std::string_view verdict_name(Verdict verdict);

/// What an expectation came to.
struct Judgement {
    Verdict verdict = Verdict::open;  ///< open: no cell, or a cell that is missing or refused
    std::vector<double> measures;     ///< of each group of cells, in the order of their first cells
    std::size_t inside = 0;           ///< how many lie where they were expected
    std::size_t open = 0;             ///< cells or groups without a number
};

/// Confirmed if every measure lies within the limits, refuted if one does not.
Judgement judge(const Results& results, const ExperimentExpectation& expectation);

/// Refuted if one is, else open if one is or there is none, else confirmed.
Verdict overall(const std::vector<Judgement>& judgements);

}  // namespace burnish::lab
