#include "lab/attribution.hpp"

#include <fmt/format.h>

#include <burnish/error.hpp>
#include <burnish/program_text.hpp>
#include <burnish/renderer.hpp>
#include <cmath>
#include <cstring>
#include <utility>

#include "metrics/frame_errors.hpp"

namespace burnish::lab {

namespace {

/// One stage among StageBits.
struct Stage {
    std::string name;
    int StageBits::*field = nullptr;  ///< null: general stage `number`
    std::size_t number = 0;

    [[nodiscard]] int bits(const StageBits& of) const {
        if (field != nullptr) return of.*field;
        return number < of.combiner_stages.size() ? of.combiner_stages[number] : of.combiners;
    }
    /// To those of `from`.
    void set(StageBits& to, const StageBits& from) const {
        if (field != nullptr) {
            to.*field = from.*field;
            return;
        }
        while (to.combiner_stages.size() <= number) to.combiner_stages.push_back(to.combiners);
        to.combiner_stages[number] = bits(from);
    }
};

/// In the order in which a fragment meets them, but for tables, whose place depends on the program.
std::vector<Stage> stages_of(std::size_t general_stages) {
    std::vector<Stage> stages{{"half_vector", &StageBits::half_vector},
                              {"textures", &StageBits::textures},
                              {"filter", &StageBits::filter}};
    for (std::size_t i = 0; i < general_stages; ++i)
        stages.push_back({fmt::format("stage {}", i), nullptr, i});
    stages.push_back({"table", &StageBits::table});
    stages.push_back({"frame", &StageBits::frame});
    return stages;
}

StageBits exact_like(const StageBits& bits) {
    return {.rounding = bits.rounding};
}

Framebuffer drawn(const Scene& scene, int threads) {
    Framebuffer frame(scene.width, scene.height, PixelFormat::rgba32f);
    Renderer({.threads = threads}).render(scene, frame);
    return frame;
}

/// By the model's formula; nothing for what has none. Registers end at 1, so does the picture.
std::optional<Framebuffer> drawn_in_double(Scene scene, int threads) {
    for (const Object& object : scene.objects)
        if (object.material && object.material->program) return std::nullopt;
    Machine formulas = machine_profile("double");
    formulas.viewer = scene.machine.viewer;
    formulas.tangent_frames = scene.machine.tangent_frames;
    formulas.normalise_half_vector = scene.machine.normalise_half_vector;
    scene.machine = formulas;
    Framebuffer frame = drawn(scene, threads);
    for (int y = 0; y < frame.height(); ++y) {
        for (int x = 0; x < frame.width(); ++x) {
            std::byte* const at = frame.row(y) + static_cast<std::size_t>(x) * sizeof(glm::vec4);
            glm::vec4 color;
            std::memcpy(&color, at, sizeof color);
            color = glm::min(color, 1.0F);
            std::memcpy(at, &color, sizeof color);
        }
    }
    return frame;
}

/// Differences from one picture, where it shows a surface.
class Against {
  public:
    Against(const Framebuffer& reference, WorkerPool& pool)
        : m_reference(reference),
          m_pool(pool),
          m_covered(reference, reference, metrics::Region::covered, pool) {}

    [[nodiscard]] metrics::FrameErrors operator()(const Framebuffer& test) const {
        return metrics::frame_errors(test, m_reference, m_covered, m_pool);
    }

  private:
    const Framebuffer& m_reference;
    WorkerPool& m_pool;
    metrics::Selection m_covered;
};

}  // namespace

StageBits machine_bits(const Machine& machine) {
    if (machine.numbers == NumberModel::wide)
        return {.half_vector = 14,
                .textures = 14,
                .filter = 14,
                .combiners = 15,
                .table = 14,
                .frame = 14};
    StageBits bits{
        .half_vector = 8, .textures = 8, .filter = 8, .combiners = 9, .table = 8, .frame = 8};
    if (machine.product_rounding == ProductRounding::truncate)
        bits.rounding = BitRounding::truncate;
    if (machine.product_rounding == ProductRounding::shift8) bits.rounding = BitRounding::shift8;
    return bits;
}

Attribution attribute_error(const Scene& whole_scene, const StageBits& bits, int threads,
                            const AttributionProgress& progress) {
    Scene scene = whole_scene;
    scene.background = glm::vec4(0.0F);
    BitRenderer renderer(scene, threads);
    WorkerPool pool(threads);
    const std::vector<Stage> stages = stages_of(renderer.stage_count());
    std::size_t done = 0;
    const std::size_t total = 3 * stages.size() + 3;
    const auto text_of = [&](std::size_t number) {
        const std::vector<GeneralStage>& stages_of_first = renderer.program(0).stages;
        return number < stages_of_first.size() ? print_stage(stages_of_first[number]) : "";
    };
    const auto count = [&] {
        if (progress) progress(++done, total);
    };
    const Framebuffer exact = renderer.render(exact_like(bits));
    const Against from_exact(exact, pool);
    const auto errors = [&](const StageBits& chosen) {
        const metrics::FrameErrors of = from_exact(renderer.render(chosen));
        count();
        return of;
    };
    Attribution result;
    result.pixels = from_exact(exact).pixels;
    StageBits so_far = exact_like(bits);
    for (const Stage& stage : stages) {
        StageBits only = exact_like(bits), all_but = bits;
        stage.set(only, bits);
        stage.set(all_but, exact_like(bits));
        stage.set(so_far, bits);
        const metrics::FrameErrors alone = errors(only);
        result.stages.push_back({.stage = stage.name,
                                 .text = stage.field == nullptr ? text_of(stage.number) : "",
                                 .bits = stage.bits(bits),
                                 .only = alone.rmse,
                                 .bias = alone.bias,
                                 .all_but = errors(all_but).rmse,
                                 .cumulative = errors(so_far).rmse});
    }
    const Framebuffer rounded = renderer.render(bits);
    count();
    const metrics::FrameErrors all = from_exact(rounded);
    result.all = all.rmse;
    result.all_bias = all.bias;
    const Framebuffer machine = drawn(scene, threads);
    result.machine = from_exact(machine).rmse;
    count();
    result.rest = Against(rounded, pool)(machine).rmse;
    if (const auto formula = drawn_in_double(scene, threads))
        result.plan = Against(*formula, pool)(exact).rmse;
    count();
    return result;
}

PixelAttribution attribute_pixel(const Scene& scene, const StageBits& bits, int x, int y,
                                 int threads) {
    if (x < 0 || y < 0 || x >= scene.width || y >= scene.height)
        throw Error(ErrorCode::bad_option,
                    fmt::format("pixel {},{}, expected one inside the frame of {}x{} pixels", x, y,
                                scene.width, scene.height));
    BitRenderer renderer(scene, threads);
    StageBits so_far = exact_like(bits);
    const auto exact = renderer.pixel(so_far, x, y);
    if (!exact)
        throw Error(ErrorCode::bad_option,
                    fmt::format("pixel {},{} shows the background, expected a surface", x, y));
    PixelAttribution result;
    result.steps.push_back({"exact", *exact, glm::dvec3(0.0)});
    for (const Stage& stage : stages_of(renderer.stage_count())) {
        stage.set(so_far, bits);
        const glm::dvec3 color = renderer.pixel(so_far, x, y).value();
        result.steps.push_back({stage.name, color, color - result.steps.back().color});
    }
    const Framebuffer frame = drawn(scene, threads);
    glm::vec4 color;
    std::memcpy(&color, frame.row(y) + static_cast<std::size_t>(x) * sizeof color, sizeof color);
    result.machine = glm::dvec3(glm::vec3(color));
    return result;
}

}  // namespace burnish::lab
