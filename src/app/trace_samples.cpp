#include <fmt/format.h>

#include "app/text_table.hpp"
#include "app/trace_print.hpp"

namespace burnish::app {
namespace {

TableRow row_of(const std::string& name, const std::string& place,
                const std::array<double, 4>& color) {
    TableRow row{name, place};
    for (const double channel : color) row.push_back(fmt::format("{}", channel));
    return row;
}

}  // namespace

std::string samples_text(const TracedSamples& traced, const Scene& scene, const Scene& large) {
    const std::size_t count = traced.samples.size();
    std::vector<TableRow> rows{{"", "in the pixel", "r", "g", "b", "a"}};
    for (std::size_t i = 0; i < count; ++i) {
        const PixelTrace& sample = traced.samples[i];
        const auto share = [&](int at) { return (at % traced.side + 0.5) / traced.side; };
        rows.push_back(row_of(fmt::format("sample {}", i + 1),
                              fmt::format("{:.3g}, {:.3g}", share(sample.x), share(sample.y)),
                              sample.stored));
    }
    rows.push_back(row_of("mean", format_name(scene.format), traced.stored));
    std::string text = fmt::format(
        "pixel {},{} of {} x {}: the mean of {} samples, which are {} pixels of {} x {}\n{}",
        traced.x, traced.y, scene.width, scene.height, count, format_name(large.format),
        large.width, large.height, text_table(rows, 0));
    for (std::size_t i = 0; i < count; ++i)
        text += fmt::format("\nsample {} of {}\n{}", i + 1, count,
                            trace_text(traced.samples[i], large));
    return text;
}

}  // namespace burnish::app
