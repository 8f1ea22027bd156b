#include <fmt/format.h>

#include <burnish/error.hpp>
#include <burnish/trace.hpp>
#include <cstdio>
#include <cstring>
#include <utility>
#include <vector>

#include "app/by_stage.hpp"
#include "app/picture.hpp"
#include "app/progress.hpp"
#include "app/supersample.hpp"
#include "app/trace_print.hpp"
#include "app/verbs.hpp"

namespace burnish::app {
namespace {

template <class Channel>
std::array<double, 4> channels_at(const Framebuffer& frame, int x, int y) {
    Channel values[4];
    std::memcpy(values, frame.row(y) + static_cast<std::size_t>(x) * sizeof values, sizeof values);
    return {static_cast<double>(values[0]), static_cast<double>(values[1]),
            static_cast<double>(values[2]), static_cast<double>(values[3])};
}

std::array<double, 4> pixel_of(const Framebuffer& frame, int x, int y) {
    switch (frame.format()) {
        case PixelFormat::rgba8:
            return channels_at<std::uint8_t>(frame, x, y);
        case PixelFormat::rgba16:
            return channels_at<std::uint16_t>(frame, x, y);
        case PixelFormat::rgba32f:
            return channels_at<float>(frame, x, y);
        case PixelFormat::depth32f:  // refused by trace_pixel
            break;
    }
    return {};
}

/// The whole picture is drawn, too: what the trace says must be what a user sees.
void require_same_pixel(const PixelTrace& trace, const Framebuffer& frame) {
    const std::array<double, 4> drawn = pixel_of(frame, trace.x, trace.y);
    if (drawn == trace.stored) return;
    throw Error(ErrorCode::bad_program,
                fmt::format("pixel {},{}: the renderer stored {}, the trace {}: a fault of burnish",
                            trace.x, trace.y, fmt::join(drawn, " "), fmt::join(trace.stored, " ")));
}

}  // namespace

void run(const TraceOptions& options) {
    if (options.by_stage) return trace_by_stage(options);
    Progress progress(options.picture.quiet);
    Renderer renderer(renderer_options(options.picture));
    const Scene scene = load_picture(options.picture);
    const glm::ivec2 pixel = options.pixel.value();
    if (pixel.x >= scene.width || pixel.y >= scene.height)
        throw Error(ErrorCode::bad_option,
                    fmt::format("--pixel {},{}, expected one inside the picture of {} x {} pixels",
                                pixel.x, pixel.y, scene.width, scene.height));
    const int side = enlargement(options.samples_side, scene);
    const Scene large = enlarged(scene, side);
    Framebuffer frame(large.width, large.height, large.format);
    draw(renderer, large, frame);
    std::vector<PixelTrace> samples;
    for (int i = 0; i < side * side; ++i) {
        const glm::ivec2 at = pixel * side + glm::ivec2(i % side, i / side);
        require_same_pixel(samples.emplace_back(trace_pixel(large, at.x, at.y)), frame);
        progress.done(samples.size(), static_cast<std::size_t>(side * side));
    }
    progress.finish();
    if (side == 1) {
        fmt::print("{}", options.json ? trace_json(samples.front(), scene) + "\n"
                                      : trace_text(samples.front(), scene));
        return;
    }
    Framebuffer means(scene.width, scene.height, scene.format);
    shrink(frame, side, means);
    const TracedSamples traced{.x = pixel.x,
                               .y = pixel.y,
                               .side = side,
                               .samples = std::move(samples),
                               .stored = pixel_of(means, pixel.x, pixel.y)};
    fmt::print("{}", options.json ? samples_json(traced, scene, large) + "\n"
                                  : samples_text(traced, scene, large));
}

}  // namespace burnish::app
