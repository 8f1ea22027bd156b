#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lab/experiment/run.hpp"

namespace burnish::lab {

/// One picture of a contact sheet.
struct SheetPage {
    std::filesystem::path png;
    std::string rows;  ///< what stands above its rows, in words
};

struct DrawnSheets {
    std::vector<std::vector<SheetPage>> sheets;  ///< of each sheet of the experiment, its pages
    std::string problem;                         ///< one line, if there is no font for captions
};

/// Draws each sheet of an experiment from the pictures that `store` has: a row per cell with test,
/// reference, signed error and FLIP map, small pictures enlarged by a whole factor; above each row
/// its labels, RMSE and mean FLIP, as pixels. Files sheet-N.png and sheet-N.exr (floats of the
/// first two as they are) in `directory`, which is made; beyond 12 rows sheet-N-2 and so on.
DrawnSheets draw_sheets(const Results& results, const Store& store,
                        const std::filesystem::path& directory);

}  // namespace burnish::lab
