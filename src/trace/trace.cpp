#include <fmt/format.h>

#include <algorithm>
#include <burnish/error.hpp>
#include <burnish/trace.hpp>
#include <map>
#include <utility>

#include "core/parallel.hpp"
#include "core/within_memory.hpp"
#include "shade/normalisation_cube.hpp"
#include "trace/filter_corners.hpp"
#include "trace/fragment.hpp"
#include "trace/pixel.hpp"
#include "trace/program.hpp"
#include "trace/unit_numbers.hpp"
#include "trace/visible.hpp"

namespace burnish {

namespace {

/// The renderer's road up to the screen, for one look.
class TracedFrame {
  public:
    TracedFrame(const Scene& scene, const std::function<bool()>& stop)
        : m_scene(scene),
          m_view{&scene, make_view(scene.camera, scene.width, scene.height),
                 make_viewport(scene.machine, scene.width, scene.height)} {
        m_maps.models.stop = stop;
        m_view.half_cube = HalfVectorCube().of(scene.machine);
        for (const Object& object : scene.objects) {
            m_draws.push_back(std::make_unique<Draw>());
            prepare_draw(*m_draws.back(), m_view, object, m_maps);
            transform_draw(*m_draws.back(), m_view, object, table_reference(), m_pool);
        }
    }

    [[nodiscard]] std::vector<VisibleTriangle> visible(int x, int y) const {
        return visible_triangles({m_draws, m_view.viewport, {m_scene.width, m_scene.height}}, x, y);
    }

    TracedFragment fragment(const VisibleTriangle& seen, int x, int y) {
        if (!m_draws[seen.setup.draw]->shading.corners) return in_all_lights(seen, x, y, nullptr);
        std::vector<TracedFragment> corners;
        const auto add_level = [&](bool above) {
            for (const bool below : {false, true}) {
                for (const bool right : {false, true}) {
                    const CornerChoice at{.above = above, .right = right, .below = below};
                    corners.push_back(in_all_lights(seen, x, y, &at));
                }
            }
        };
        add_level(false);
        const auto& blended = corners.front().corner->level_weight;
        if (blended && blended->value > 0.0) add_level(true);
        TracedFragment out = corners.front();
        out.corner.reset();
        out.further_lights.clear();
        out.units.clear();
        out.fetches.clear();
        out.stages.clear();
        filter_corners(m_scene.machine.numbers, corners, out);
        out.corners = std::move(corners);
        return out;
    }

  private:
    /// @param at  null: at the pixel's own coordinates
    TracedFragment in_all_lights(const VisibleTriangle& seen, int x, int y,
                                 const CornerChoice* at) {
        TracedFragment out = in_light(0, seen, x, y, at);
        const std::size_t further = m_draws[seen.setup.draw]->shading.further_lights.size();
        for (std::size_t light = 1; light <= further; ++light) {
            out.further_lights.push_back(in_light(light, seen, x, y, at));
            add_light(out.further_lights.back(), out);
        }
        return out;
    }

    TracedFragment in_light(std::size_t light, const VisibleTriangle& seen, int x, int y,
                            const CornerChoice* at) {
        const std::size_t number = seen.setup.draw;
        const Object& object = m_scene.objects[number];
        const auto& [program, draw] = lit_draw(number, light);
        TracedFragment out;
        out.object = number;
        out.material = object.material ? object.material->name : Material{}.name;
        out.triangle = seen.setup.number;
        out.clipped = seen.setup.clipped != 0;
        out.depth = static_cast<double>(seen.depth);
        out.units = traced_units(program, m_scene.machine);
        const FragmentInputs inputs = trace_inputs(draw, seen.setup, x, y, at, out);
        name_corners(draw, seen.setup, out);
        trace_program(program, m_scene.machine, inputs, out);
        out.light_codes = out.codes;
        out.light_color = out.color;
        return out;
    }

    /// An object in one light alone.
    struct LitDraw {
        ProgramMaterial program;
        Draw draw;
    };
    const LitDraw& lit_draw(std::size_t number, std::size_t light) {
        std::unique_ptr<LitDraw>& lit = m_lit[{number, light}];
        if (lit) return *lit;
        lit = std::make_unique<LitDraw>();
        const Object& object = m_scene.objects[number];
        lit->program = program_of(object, m_scene, light, m_maps);
        prepare_draw(lit->draw, m_view, object, {&lit->program, 1}, light, {.everything = true});
        transform_draw(lit->draw, m_view, object, table_reference(), m_pool);
        return *lit;
    }

    /// Colours add up to 1; alpha is the first light's.
    void add_light(const TracedFragment& light, TracedFragment& sum) const {
        const int one = code_of_one(m_scene.machine.numbers);
        for (std::size_t c = 0; c < 3; ++c) {
            sum.codes[c] = std::min(sum.codes[c] + light.codes[c], one);
            sum.color[c] = {static_cast<double>(sum.codes[c]) / one,
                            std::min(sum.color[c].exact + light.color[c].exact, 1.0)};
        }
    }

    /// Setup exchanges two corners of triangles that wind the other way round; here they stand as
    /// they were submitted.
    static void name_corners(const Draw& draw, const SetupTriangle& setup, TracedFragment& out) {
        for (std::size_t i = 0; i < 3; ++i) out.vertices[i] = draw.indices[3 * out.triangle + i];
        if (setup.swapped != 0) std::swap(out.barycentrics[1], out.barycentrics[2]);
    }

    const Scene& m_scene;
    FrameView m_view;
    WorkerPool m_pool{1};
    DerivedMaps m_maps;
    std::vector<std::unique_ptr<Draw>> m_draws;
    std::map<std::pair<std::size_t, std::size_t>, std::unique_ptr<LitDraw>> m_lit;
};

}  // namespace

PixelTrace trace_pixel(const Scene& scene, int x, int y, const std::function<bool()>& stop) {
    if (x < 0 || y < 0 || x >= scene.width || y >= scene.height) {
        throw Error(ErrorCode::bad_option,
                    fmt::format("pixel {},{}, expected one inside the frame of {}x{} pixels", x, y,
                                scene.width, scene.height));
    }
    scene.machine.validate();
    if (scene.machine.double_precision) {
        throw Error(ErrorCode::bad_option,
                    "a trace with profile double, which has no registers; expected one of the "
                    "machines");
    }
    if (scene.machine.quads == Quads::of_pixels) {
        throw Error(ErrorCode::bad_option,
                    "a trace with quads = pixels, which looks at other triangles than the pixel's; "
                    "expected quads = triangle");
    }
    if (scene.format == PixelFormat::depth32f) {
        throw Error(ErrorCode::bad_option,
                    "a trace of a scene with format depth32f, expected a format of colours");
    }
    PixelTrace trace;
    trace.x = x;
    trace.y = y;
    trace.machine = scene.machine;
    trace.one = code_of_one(scene.machine.numbers);
    trace.format = scene.format;
    const auto follow = [&](int) {
        TracedFrame frame(scene, stop);
        TracedPixel pixel(scene);
        for (const VisibleTriangle& seen : frame.visible(x, y)) {
            if (trace.fragment) trace.below.push_back(std::move(*trace.fragment));
            trace.fragment = frame.fragment(seen, x, y);
            pixel.take(*trace.fragment, scene.objects[seen.setup.draw].raster.blend);
        }
        trace.stored = pixel.channels();
    };
    // In the floating-point environment of the renderer's workers, whatever the caller's is.
    within_memory([] { return "out of memory for a trace"; }, [&] { WorkerPool(1).run(follow); });
    return trace;
}

}  // namespace burnish
