#include "lab/experiment/picture_plots.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <burnish/files.hpp>
#include <cmath>
#include <filesystem>
#include <vector>

#include "core/dmath.hpp"
#include "core/parallel.hpp"
#include "lab/attribution.hpp"
#include "lab/experiment/frames.hpp"
#include "lab/experiment/pictures.hpp"
#include "lab/experiment/plots.hpp"
#include "lab/gnuplot.hpp"
#include "lab/waterfall.hpp"
#include "metrics/frame_errors.hpp"
#include "metrics/pixel.hpp"
#include "metrics/selection.hpp"

namespace burnish::lab {
namespace {

struct Pair {
    Framebuffer test, reference;
};

std::optional<Pair> pictures_of(const Results& results, std::size_t cell, const Store& store) {
    if (!results.found[cell] || !results.found[cell]->refusal.empty()) return std::nullopt;
    const PictureFiles files{store.images(), results.cells[cell].name};
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(files.exr("test"), ignored)) return std::nullopt;
    return Pair{load_frame(files.exr("test")), load_frame(files.exr("reference"))};
}

using Counts = std::array<int, 256>;

std::string steps(const char* name, const Counts& counts) {
    std::string text = fmt::format("${} << END\n", name);
    for (std::size_t code = 0; code < counts.size(); ++code)
        if (counts.at(code) > 0) text += fmt::format("{} {}\n", code, counts.at(code));
    return text + "END\n";
}

/// The mean of r, g and b between four pixels' centres.
double between(const Framebuffer& frame, double x, double y) {
    const double left = std::floor(x), top = std::floor(y);
    double sum = 0.0;
    for (const int right : {0, 1}) {
        for (const int down : {0, 1}) {
            const glm::dvec4 color = metrics::pixel(
                frame, std::clamp(static_cast<int>(left) + right, 0, frame.width() - 1),
                std::clamp(static_cast<int>(top) + down, 0, frame.height() - 1));
            const double weight = (right == 0 ? 1.0 - (x - left) : x - left) *
                                  (down == 0 ? 1.0 - (y - top) : y - top);
            sum += weight * (color.r + color.g + color.b) / 3.0;
        }
    }
    return sum;
}

/// Means along rays, a degree apart from 0 to 360.
std::vector<double> rays(const Framebuffer& frame) {
    const double x = 0.5 * (frame.width() - 1), y = 0.5 * (frame.height() - 1);
    const int length = std::min(frame.width(), frame.height()) / 2;
    std::vector<double> means;
    for (int angle = 0; angle <= 360; ++angle) {
        const double turn = angle * dmath::kPi / 180.0;
        const double right = dmath::cos(turn), up = dmath::sin(turn);
        double sum = 0.0;
        for (int r = 0; r < length; ++r) sum += between(frame, x + r * right, y - r * up);
        means.push_back(sum / length);
    }
    return means;
}

/// Appends a data block; `largest` grows to its largest value.
void add_rays(std::string& data, double& largest, const std::string& name,
              const std::vector<double>& means) {
    data += fmt::format("${} << END\n", name);
    for (std::size_t angle = 0; angle < means.size(); ++angle) {
        data += fmt::format("{} {}\n", angle, means[angle]);
        largest = std::max(largest, means[angle]);
    }
    data += "END\n";
}

}  // namespace

std::optional<std::string> codes_commands(const Results& results, std::size_t cell,
                                          const Store& store) {
    const std::optional<Pair> pair = pictures_of(results, cell, store);
    if (!pair) return std::nullopt;
    WorkerPool one(1);
    const metrics::Selection selection(pair->test, pair->reference, metrics::Region::interior, one);
    const metrics::Peak peak = metrics::peak(pair->reference, selection);
    Counts test{}, reference{};
    const auto count = [&](Counts& counts, const Framebuffer& frame, int x, int y) {
        const double code = 255.0 * metrics::pixel(frame, x, y)[peak.channel];
        const double kept = code > 0.0 ? std::min(code, 255.0) : 0.0;
        ++counts.at(static_cast<std::size_t>(std::lround(kept)));
    };
    for (int y = 0; y < pair->reference.height(); ++y) {
        for (int x = 0; x < pair->reference.width(); ++x) {
            if (!selection.contains(x, y)) continue;
            if (!(metrics::pixel(pair->reference, x, y)[peak.channel] > 0.5 * peak.value)) continue;
            count(test, pair->test, x, y);
            count(reference, pair->reference, x, y);
        }
    }
    return steps("test", test) + steps("reference", reference) +
           "set xlabel \"code of 255\"\nset ylabel \"pixels of the highlight\"\nset grid ytics\n"
           "set yrange [0:*]\nset style fill solid 0.8\nset boxwidth 0.8\n"
           "set key outside right top\n"
           "plot $test with boxes lc rgb \"#c0504d\" title \"test\", \\\n"
           "  $reference with lines lc rgb \"#1f3a93\" lw 1.5 title \"reference\"\n";
}

std::optional<std::string> polar_commands(const Results& results, const ExperimentPlot& plot,
                                          const std::string& panel, const Store& store) {
    std::string data, curves;
    double largest = 0.0;
    for (std::size_t i = 0; i < results.cells.size(); ++i) {
        if (!in_panel(results.experiment, results.cells[i], plot, panel)) continue;
        const std::optional<Pair> pair = pictures_of(results, i, store);
        if (!pair) continue;
        if (data.empty()) {
            add_rays(data, largest, "reference", rays(pair->reference));
            curves = "plot $reference with lines lw 4 lc rgb \"#b0b0b0\" title \"reference\"";
        }
        add_rays(data, largest, fmt::format("cell{}", i), rays(pair->test));
        curves += fmt::format(", \\\n  $cell{} with lines lw 1.5 title \"{}\"", i,
                              gnuplot_text(curve_name(results.experiment, results.cells[i], plot)));
    }
    if (data.empty()) return std::nullopt;
    return data +
           fmt::format(
               "set polar\nset angles degrees\nset size square\nset grid polar 30\nunset border\n"
               "unset xtics\nunset ytics\nset key outside right top\nset rrange [0:{}]\n{}\n",
               largest > 0.0 ? 1.05 * largest : 1.0, curves);
}

std::string pixel_waterfall(const Results& results, std::size_t cell, const ExperimentPlot& plot) {
    const Experiment& experiment = results.experiment;
    const Cell& of = results.cells[cell];
    const auto load = [&](const PictureSettings& picture) {
        return load_picture(experiment.scenes[picture.scene], picture);
    };
    Scene scene = load(of.test);
    if (experiment.expose > 0.0F)
        scale_lights(scene,
                     exposure(load(of.reference), static_cast<double>(experiment.expose), 1));
    const auto [x, y] = plot.pixel;
    return waterfall(
        attribute_pixel(scene, machine_bits(scene.machine), x, y, 1),
        fmt::format("{}: {}, pixel {}, {}", plot.title, curve_name(experiment, of, plot), x, y));
}

}  // namespace burnish::lab
