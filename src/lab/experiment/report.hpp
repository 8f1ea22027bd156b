#pragma once

#include <string>
#include <vector>

#include "lab/experiment/contact_sheet.hpp"
#include "lab/experiment/plots.hpp"
#include "lab/experiment/run.hpp"
#include "lab/experiment/verdicts.hpp"

namespace burnish::lab {

/// A page that needs no other file: hypothesis, verdict, setting, plots, contact sheets and the
/// table of all cells.
std::string report_html(const Results& results, const std::vector<Judgement>& judgements,
                        const DrawnPlots& plots, const DrawnSheets& sheets);

/// Hypothesis, verdict and what each expectation came to, as docs/experiments.md has it.
std::string verdicts_markdown(const Results& results, const std::vector<Judgement>& judgements);

/// Writes report.html, results.csv, results.json, verdicts.md, manifest.json, plots and sheets into
/// the store's directory.
/// Returns what could not be drawn, one line, or nothing.
std::string write_results(const Results& results, const Store& store);

}  // namespace burnish::lab
