#include "view/picture.hpp"

#include <algorithm>
#include <array>
#include <burnish/error.hpp>
#include <chrono>
#include <cmath>
#include <cstring>
#include <new>

#include "metrics/heat_map.hpp"

namespace burnish::view {
namespace {

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

/// Vertices that are given in pixels do not shrink with the picture.
bool can_shrink(const Scene& scene) {
    return std::none_of(scene.objects.begin(), scene.objects.end(), [](const Object& object) {
        const auto* raw = std::get_if<RawVertices>(&object.geometry);
        return raw != nullptr && raw->space == Space::window;
    });
}

struct Columns {
    int from, to;
};

Columns columns_of(const Pane& pane, int width) {
    const auto column = [width](float share) {
        return static_cast<int>(std::lround(share * static_cast<float>(width)));
    };
    return {std::clamp(column(pane.from), 0, width), std::clamp(column(pane.to), 0, width)};
}

std::uint32_t pixel_at(const Framebuffer& frame, int x, int y) {
    std::uint32_t value;
    std::memcpy(&value, frame.row(y) + 4 * static_cast<std::size_t>(x), sizeof value);
    return value;
}

/// Columns of `target` from a frame whose sides are `divisor` times smaller.
void put_columns(const Framebuffer& source, int divisor, const Columns& columns,
                 Framebuffer& target) {
    const auto count = static_cast<std::size_t>(std::max(columns.to - columns.from, 0));
    for (int y = 0; y < target.height(); ++y) {
        std::byte* out = target.row(y) + 4 * static_cast<std::size_t>(columns.from);
        if (divisor == 1) {
            std::memcpy(out, source.row(y) + 4 * static_cast<std::size_t>(columns.from), 4 * count);
            continue;
        }
        for (int x = columns.from; x < columns.to; ++x, out += 4) {
            const std::uint32_t value = pixel_at(source, x / divisor, y / divisor);
            std::memcpy(out, &value, sizeof value);
        }
    }
}

void fill_columns(const Columns& columns, Framebuffer& target) {
    constexpr std::array<std::uint8_t, 4> kNothing{40, 24, 28, 255};
    for (int y = 0; y < target.height(); ++y) {
        for (int x = columns.from; x < columns.to; ++x)
            std::memcpy(target.row(y) + 4 * static_cast<std::size_t>(x), kNothing.data(), 4);
    }
}

/// Mean over r, g, b of |a - b|, times `gain`.
metrics::Plane difference(const Framebuffer& a, const Framebuffer& b, double gain) {
    metrics::Plane plane(a.width(), a.height());
    for (int y = 0; y < a.height(); ++y) {
        const auto* left = reinterpret_cast<const float*>(a.row(y));
        const auto* right = reinterpret_cast<const float*>(b.row(y));
        double* out = plane.row(y);
        for (int x = 0; x < a.width(); ++x, left += 4, right += 4) {
            double sum = 0.0;
            for (int c = 0; c < 3; ++c)
                sum += std::abs(static_cast<double>(left[c]) -
                                static_cast<double>(std::min(right[c], 1.0F)));
            out[x] = gain * sum / 3.0;
        }
    }
    return plane;
}

Framebuffer frame_of(const Image8& image) {
    Framebuffer frame(image.width, image.height);
    std::memcpy(frame.pixels(), image.rgba.data(), image.rgba.size());
    return frame;
}

Machine double_precision(const Machine& machine) {
    Machine result = machine_profile("double");
    result.filter_order = machine.filter_order;
    return result;
}

int side_of(Fineness fineness) {
    return fineness == Fineness::smooth ? 2 : fineness == Fineness::smoothest ? 4 : 1;
}

}  // namespace

Renderer& PictureMaker::renderer_for(const RendererOptions& options) {
    if (!m_renderer || options.threads != m_options.threads || options.isa != m_options.isa) {
        m_renderer = std::make_unique<Renderer>(options);
        m_options = options;
    }
    return *m_renderer;
}

void PictureMaker::draw_pane(const Wish& wish, Fineness fineness, std::size_t index,
                             Picture& picture) {
    const Pane& pane = wish.panes[index];
    PaneReport& report = picture.panes[index];
    report.machine = pane.machine.name;
    const Columns columns = columns_of(pane, wish.scene->width);
    if (columns.from >= columns.to) return;
    const Clock::time_point start = Clock::now();
    try {
        Scene scene = *wish.scene;
        scene.machine = pane.machine;
        const double pixels = static_cast<double>(scene.width) * scene.height;
        const int drawn = static_cast<int>(wish.panes.size()) * (wish.heat_map ? 2 : 1);
        const std::string pace = wish.heat_map ? "double" : pane.machine.name;
        if (fineness == Fineness::within_budget && can_shrink(scene))
            report.divisor = m_pace.divisor(pace, pixels, drawn);
        const int width = (scene.width + report.divisor - 1) / report.divisor;
        const int height = (scene.height + report.divisor - 1) / report.divisor;
        Renderer& renderer = renderer_for(wish.renderer);
        if (wish.heat_map) {
            Framebuffer test(width, height, PixelFormat::rgba32f);
            Framebuffer truth(width, height, PixelFormat::rgba32f);
            picture.stats = renderer.render(scene, test);
            scene.machine = double_precision(pane.machine);
            renderer.render(scene, truth);
            const Image8 map =
                metrics::heat_map(difference(test, truth, static_cast<double>(wish.gain)));
            put_columns(frame_of(map), report.divisor, columns, picture.frame);
        } else {
            const int side = side_of(fineness);
            report.samples = side * side;
            Framebuffer frame(width, height);
            picture.stats = m_draw(renderer, scene, side, frame);
            put_columns(frame, report.divisor, columns, picture.frame);
        }
        report.ms = ms_since(start);
        m_pace.took(pace, static_cast<double>(width) * height * report.samples, report.ms);
    } catch (const Error& error) {
        report.error = error.what();
    } catch (const std::bad_alloc&) {
        report.error = "out of memory";
    }
    if (!report.error.empty()) fill_columns(columns, picture.frame);
}

Picture PictureMaker::make(const Wish& wish, Fineness fineness) {
    const Clock::time_point start = Clock::now();
    Picture picture{wish.id,
                    fineness,
                    Framebuffer(wish.scene->width, wish.scene->height),
                    std::vector<PaneReport>(wish.panes.size()),
                    {},
                    0.0,
                    nullptr,
                    {}};
    for (std::size_t i = wish.panes.size(); i-- > 0;) draw_pane(wish, fineness, i, picture);
    picture.ms = ms_since(start);
    if (!wish.pixel || fineness == Fineness::within_budget) return picture;
    try {
        Scene scene = *wish.scene;
        for (const Pane& pane : wish.panes) {
            const Columns columns = columns_of(pane, scene.width);
            if (wish.pixel->x >= columns.from && wish.pixel->x < columns.to)
                scene.machine = pane.machine;
        }
        picture.trace =
            std::make_shared<const PixelTrace>(trace_pixel(scene, wish.pixel->x, wish.pixel->y));
    } catch (const Error& error) {
        picture.trace_error = error.what();
    }
    return picture;
}

std::optional<Fineness> finer(const Wish& wish, const Picture& picture) {
    if (wish.moving || picture.fineness == Fineness::smoothest) return std::nullopt;
    if (picture.fineness == Fineness::within_budget) return Fineness::full;
    const bool is_double = std::any_of(wish.panes.begin(), wish.panes.end(), [](const Pane& pane) {
        return pane.machine.double_precision;
    });
    if (wish.heat_map || is_double) return std::nullopt;
    return picture.fineness == Fineness::full ? Fineness::smooth : Fineness::smoothest;
}

}  // namespace burnish::view
