#pragma once

#include <burnish/trace.hpp>
#include <string>
#include <vector>

/// Parts of a trace as tables of Dear ImGui, inside a panel.
namespace burnish::view {

/// Four numbers of one kind of colour, beside what they would be without rounding.
struct ColorRow {
    std::string name;
    std::array<int, 4> codes;
    std::array<TracedNumber, 4> color;
    std::array<bool, 4> filled{true, true, true, true};
    bool changed = false;  ///< stands out
};

/// Code, value, exact value and the error in codes. `id` tells tables of a panel apart.
void color_table(const std::string& id, const std::vector<ColorRow>& rows, int one);
/// Value, exact value and error.
void number_table(const std::string& id, const std::vector<TracedInterpolant>& rows);
/// Where a fetch looked, its texels and what they gave.
void fetch_table(const std::string& id, const TracedFetch& fetch, int one);
/// What blending did to the pixel, in the frame's numbers.
void blend_table(const std::string& id, const TracedBlend& blend);

}  // namespace burnish::view
