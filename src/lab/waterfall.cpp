#include "lab/waterfall.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "lab/gnuplot.hpp"

namespace burnish::lab {

namespace {

constexpr int kHeight = 420;

/// Room for a key and for bars that can be told apart.
int width_for(std::size_t bars) {
    return std::clamp(260 + 60 * static_cast<int>(bars), 620, 1600);
}

std::string ticks(const std::vector<std::string>& names) {
    std::string text;
    for (std::size_t i = 0; i < names.size(); ++i)
        text += fmt::format("{}\"{}\" {}", i == 0 ? "" : ", ", gnuplot_text(names[i]), i);
    return fmt::format("set xtics ({}) rotate by -30 nomirror\nset xrange [-0.7:{}]\n", text,
                       static_cast<double>(names.size()) - 0.3);
}

}  // namespace

std::string waterfall(const Attribution& attribution, const std::string& title) {
    std::vector<std::string> names;
    std::string up = "$up << END\n", down = "$down << END\n", alone = "$alone << END\n",
                without = "$without << END\n";
    double before = 0.0;
    for (const StageError& stage : attribution.stages) {
        const std::size_t x = names.size();
        names.push_back(stage.stage);
        // A bar without height is still a place.
        const bool grows = stage.cumulative >= before;
        (grows ? up : down) += fmt::format("{} {} {}\n", x, before, stage.cumulative);
        alone += fmt::format("{} {}\n", x, stage.only);
        without += fmt::format("{} {}\n", x, stage.all_but);
        before = stage.cumulative;
    }
    std::string total =
        "$total << END\n" + fmt::format("{} 0 {}\n{} 0 {}\n", names.size(), attribution.all,
                                        names.size() + 1, attribution.machine);
    names.emplace_back("all");
    names.emplace_back("machine");
    // gnuplot refuses a block without lines: one that lies outside.
    for (std::string* block : {&up, &down, &alone, &without, &total}) *block += "-9 0 0\nEND\n";
    const std::string bar = "using 1:2:($1-0.36):($1+0.36):2:3 with boxxyerror";
    return svg_by_gnuplot(
        up + down + alone + without + total +
            fmt::format("set title \"{}\"\nset ylabel \"RMSE from the exact picture\"\nset grid "
                        "ytics\nset key outside right top\nset style fill solid 0.8\n"
                        "set yrange [0:*]\n{}plot $up {} lc rgb \"#c0504d\" title \"added\", \\\n"
                        "  $down {} lc rgb \"#4f9d5d\" title \"taken away\", \\\n"
                        "  $total {} lc rgb \"#7f7f7f\" title \"together\", \\\n"
                        "  $alone using 1:2 with points pt 7 ps 0.8 lc rgb \"#1f3a93\" title "
                        "\"alone\", \\\n"
                        "  $without using 1:2 with points pt 6 ps 0.8 lc rgb \"#1f3a93\" title "
                        "\"all but it\"\n",
                        gnuplot_text(title), ticks(names), bar, bar, bar),
        width_for(names.size()), kHeight);
}

std::string waterfall(const PixelAttribution& attribution, const std::string& title) {
    constexpr std::array<const char*, 3> kChannels{"red", "green", "blue"};
    constexpr std::array<const char*, 3> kColors{"#c0392b", "#2e8b57", "#2c5aa0"};
    std::vector<std::string> names;
    std::array<std::string, 3> blocks;
    const PixelStep& exact = attribution.steps.front();
    const auto add = [&](const std::string& name, const glm::dvec3& from, const glm::dvec3& to) {
        for (int c = 0; c < 3; ++c)
            blocks.at(static_cast<std::size_t>(c)) +=
                fmt::format("{} {} {}\n", static_cast<double>(names.size()) + 0.27 * (c - 1),
                            255.0 * (from[c] - exact.color[c]), 255.0 * (to[c] - exact.color[c]));
        names.push_back(name);
    };
    for (std::size_t i = 1; i < attribution.steps.size(); ++i)
        add(attribution.steps[i].stage, attribution.steps[i - 1].color, attribution.steps[i].color);
    add("machine", exact.color, attribution.machine);
    std::string data, plots;
    for (std::size_t c = 0; c < 3; ++c) {
        data += fmt::format("${} << END\n{}END\n", kChannels.at(c), blocks.at(c));
        plots += fmt::format(
            "{}${} using 1:2:($1-0.12):($1+0.12):2:3 with boxxyerror lc rgb "
            "\"{}\" title \"{}\"",
            c == 0 ? "plot " : ", \\\n  ", kChannels.at(c), kColors.at(c), kChannels.at(c));
    }
    return svg_by_gnuplot(
        data + fmt::format("set title \"{}\"\nset ylabel \"difference from the exact colour, codes "
                           "of 255\"\nset grid ytics\nset key outside right top\nset xzeroaxis\n"
                           "set style fill solid 0.8\n{}{}\n",
                           gnuplot_text(title), ticks(names), plots),
        width_for(names.size()), kHeight);
}

}  // namespace burnish::lab
