#include "view/picture.hpp"

#include <algorithm>
#include <array>
#include <burnish/error.hpp>
#include <chrono>
#include <cmath>
#include <cstring>

#include "lab/stage_bits.hpp"
#include "lab/stage_bits_text.hpp"
#include "view/complaint.hpp"
#include "view/error_map.hpp"

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

/// Columns of `target` from a frame of that size or a smaller one, enlarged.
void put_columns(const Framebuffer& source, const Columns& columns, Framebuffer& target) {
    const auto count = static_cast<std::size_t>(std::max(columns.to - columns.from, 0));
    for (int y = 0; y < target.height(); ++y) {
        std::byte* out = target.row(y) + 4 * static_cast<std::size_t>(columns.from);
        if (source.width() == target.width()) {
            std::memcpy(out, source.row(y) + 4 * static_cast<std::size_t>(columns.from), 4 * count);
            continue;
        }
        const int row = y * source.height() / target.height();
        for (int x = columns.from; x < columns.to; ++x, out += 4) {
            const std::uint32_t value = pixel_at(source, x * source.width() / target.width(), row);
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

/// Numbers of 0 .. 1 as bytes, to nearest.
void put_bytes(const Framebuffer& floats, Framebuffer& bytes) {
    for (int y = 0; y < floats.height(); ++y) {
        const auto* from = reinterpret_cast<const float*>(floats.row(y));
        auto* to = reinterpret_cast<std::uint8_t*>(bytes.row(y));
        for (int i = 0; i < 4 * floats.width(); ++i)
            to[i] =
                static_cast<std::uint8_t>(std::lround(255.0F * std::clamp(from[i], 0.0F, 1.0F)));
    }
}

Machine double_precision(const Machine& machine) {
    Machine result = machine_profile("double");
    result.filter_order = machine.filter_order;
    return result;
}

lab::StageBits bits_of(const Wish& wish) {
    lab::StageBits bits;
    lab::set_stage_bits(bits, wish.bits);
    return bits;
}

bool has_bits(const Wish& wish, const Machine& machine) {
    return !wish.bits.empty() && !machine.double_precision;
}

int side_of(Fineness fineness) {
    return fineness == Fineness::smooth ? 2 : fineness == Fineness::smoothest ? 4 : 1;
}

}  // namespace

Renderer& PictureMaker::renderer_for(const Wish& wish, const Machine& machine) {
    const RendererOptions& options = wish.renderer;
    if (options.threads != m_options.threads || options.isa != m_options.isa ||
        options.accounting != m_options.accounting)
        m_renderers.clear();
    m_options = options;
    m_options.stop = m_stop;
    const bool is_split = wish.panes.size() > 1;
    if (!is_split) std::erase_if(m_renderers, [](const auto& each) { return !each.first.empty(); });
    std::unique_ptr<Renderer>& renderer = m_renderers[is_split ? machine.name : ""];
    if (!renderer) renderer = std::make_unique<Renderer>(m_options);
    return *renderer;
}

Framebuffer PictureMaker::draw_numbers(const Wish& wish, const Scene& scene, Picture& picture) {
    if (has_bits(wish, scene.machine))
        return lab::render_with_bits(scene, bits_of(wish), wish.renderer.threads, {.stop = m_stop});
    Framebuffer frame(scene.width, scene.height, PixelFormat::rgba32f);
    picture.stats = renderer_for(wish, scene.machine).render(scene, frame);
    return frame;
}

const Framebuffer& PictureMaker::truth_of(const Wish& wish, Scene scene) {
    // Equal widths may have other heights: sides are divided and rounded each on its own.
    if (m_truth && m_truth_id == wish.id && m_truth->width() == scene.width &&
        m_truth->height() == scene.height)
        return *m_truth;
    scene.machine = double_precision(scene.machine);
    m_truth_id = 0;  // nobody's, should it be stopped
    m_truth.emplace(scene.width, scene.height, PixelFormat::rgba32f);
    renderer_for(wish, scene.machine).render(scene, *m_truth);
    m_truth_id = wish.id;
    return *m_truth;
}

Framebuffer PictureMaker::draw_frame(const Wish& wish, const Scene& scene, int side,
                                     Picture& picture) {
    if (wish.heat_map)
        return error_map(draw_numbers(wish, scene, picture), truth_of(wish, scene),
                         static_cast<double>(wish.gain));
    Framebuffer frame(scene.width, scene.height);
    if (has_bits(wish, scene.machine))
        put_bytes(draw_numbers(wish, scene, picture), frame);
    else
        picture.stats = m_draw(renderer_for(wish, scene.machine), scene, side, frame);
    return frame;
}

Framebuffer PictureMaker::draw_with_edits(const Wish& wish, Scene& scene, int side,
                                          PaneReport& report, Picture& picture) {
    std::optional<Framebuffer> frame;
    try {
        frame = draw_frame(wish, scene, side, picture);
    } catch (const Error& error) {
        if (error.code() == ErrorCode::stopped) throw;
        report.misfits =
            m_fitting.replace_misfits(renderer_for(wish, scene.machine), wish.edits, scene);
        if (report.misfits.empty()) throw;
    }
    if (!frame) frame = draw_frame(wish, scene, side, picture);
    m_fitting.drawn(wish.edits, scene);
    return *std::move(frame);
}

Scene PictureMaker::draw_pane(const Wish& wish, Fineness fineness, std::size_t index,
                              Picture& picture) {
    const Pane& pane = wish.panes[index];
    PaneReport& report = picture.panes[index];
    report.machine = pane.machine.name;
    const Columns columns = columns_of(pane, wish.scene->width);
    Scene scene = *wish.scene;
    scene.machine = pane.machine;
    if (columns.from >= columns.to) return scene;
    const Clock::time_point start = Clock::now();
    try {
        const std::string pace = wish.heat_map                   ? "error"
                                 : has_bits(wish, scene.machine) ? "bits"
                                                                 : scene.machine.name;
        const bool in_double =
            wish.heat_map || !wish.bits.empty() || scene.machine.double_precision;
        if (fineness == Fineness::within_budget && can_shrink(scene))
            report.divisor = m_pace.divisor(pace, static_cast<double>(scene.width) * scene.height,
                                            static_cast<int>(wish.panes.size()),
                                            in_double ? Pace::kDoubleNs : Pace::kMachineNs);
        scene.width = static_cast<int>(std::ceil(scene.width / report.divisor));
        scene.height = static_cast<int>(std::ceil(scene.height / report.divisor));
        const int side = side_of(fineness);
        report.samples = side * side;
        put_columns(draw_with_edits(wish, scene, side, report, picture), columns, picture.frame);
        report.ms = ms_since(start);
        m_pace.took(pace, static_cast<double>(scene.width) * scene.height * report.samples,
                    report.ms, picture.stats.geometry_ms);
    } catch (const Error& error) {
        if (error.code() == ErrorCode::stopped) throw;
        report.error = error.what();
    } catch (const std::exception& error) {
        report.error = complaint(error);
    }
    if (!report.error.empty()) fill_columns(columns, picture.frame);
    return scene;
}

std::vector<MaterialProgram> PictureMaker::programs_of(const Wish& wish, Fineness fineness) {
    Scene scene = *wish.scene;
    // As its pane has it, which may draw programs in passes.
    for (const Pane& pane : wish.panes)
        if (pane.machine.name == scene.machine.name) scene.machine = pane.machine;
    return m_programs.of(renderer_for(wish, scene.machine), scene, fineness == Fineness::full);
}

Picture PictureMaker::make(const Wish& wish, Fineness fineness) {
    const Clock::time_point start = Clock::now();
    Picture picture(wish.scene->width, wish.scene->height);
    picture.id = wish.id;
    picture.fineness = fineness;
    picture.panes.resize(wish.panes.size());
    if (!wish.heat_map) m_truth.reset();
    std::optional<Scene> traced;
    for (std::size_t i = wish.panes.size(); i-- > 0;) {
        Scene drawn = draw_pane(wish, fineness, i, picture);
        const Columns columns = columns_of(wish.panes[i], wish.scene->width);
        if (wish.pixel && wish.pixel->x >= columns.from && wish.pixel->x < columns.to)
            traced = std::move(drawn);
    }
    picture.ms = ms_since(start);
    if (wish.programs)
        picture.programs = programs_of(wish, fineness);
    else
        m_programs = MaterialPrograms(m_stop);
    if (!traced || fineness != Fineness::full) return picture;
    try {
        picture.trace = std::make_shared<const PixelTrace>(
            trace_pixel(*traced, wish.pixel->x, wish.pixel->y, m_stop));
    } catch (const Error& error) {
        if (error.code() == ErrorCode::stopped) throw;
        picture.trace_error = error.what();
    } catch (const std::exception& error) {
        picture.trace_error = complaint(error);
    }
    return picture;
}

std::vector<ProgramError> misfits_of(const Picture& picture) {
    std::vector<ProgramError> all;
    for (const PaneReport& pane : picture.panes) {
        for (const ProgramError& misfit : pane.misfits)
            if (std::find(all.begin(), all.end(), misfit) == all.end()) all.push_back(misfit);
    }
    return all;
}

bool are_compiled_alike(const Wish& a, const Wish& b) {
    const auto has_material = [](const Object& x, const Object& y) {
        return x.material == y.material;
    };
    const auto has_machine = [](const Pane& x, const Pane& y) { return x.machine == y.machine; };
    return std::equal(a.scene->objects.begin(), a.scene->objects.end(), b.scene->objects.begin(),
                      b.scene->objects.end(), has_material) &&
           std::equal(a.panes.begin(), a.panes.end(), b.panes.begin(), b.panes.end(), has_machine);
}

std::optional<Fineness> finer(const Wish& wish, const Picture& picture) {
    if (wish.moving || picture.fineness == Fineness::smoothest) return std::nullopt;
    if (picture.fineness == Fineness::within_budget) return Fineness::full;
    const bool is_double = std::any_of(wish.panes.begin(), wish.panes.end(), [](const Pane& pane) {
        return pane.machine.double_precision;
    });
    if (wish.heat_map || is_double || !wish.bits.empty()) return std::nullopt;
    return picture.fineness == Fineness::full ? Fineness::smooth : Fineness::smoothest;
}

}  // namespace burnish::view
