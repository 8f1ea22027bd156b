#include "lab/stage_bits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <burnish/error.hpp>
#include <burnish/multipass.hpp>
#include <cstring>
#include <memory>
#include <string_view>
#include <utility>

#include "core/cpu.hpp"
#include "draw.hpp"
#include "models/compile_model.hpp"
#include "raster/bin.hpp"
#include "raster/tile.hpp"
#include "shade/normalisation_cube.hpp"
#include "trace/exact_inputs.hpp"

namespace burnish::lab {

namespace {

void check_bits(std::string_view name, int bits, int fewest) {
    if (bits == kExactBits || (bits >= fewest && bits <= kMostBits)) return;
    throw Error(ErrorCode::bad_option, fmt::format("{} of {} bits, expected {} .. {} or exact",
                                                   name, bits, fewest, kMostBits));
}

void check(const StageBits& bits) {
    check_bits("half_vector", bits.half_vector, 1);
    check_bits("textures", bits.textures, 1);
    check_bits("filter", bits.filter, 1);
    check_bits("combiners", bits.combiners, 2);
    for (const int b : bits.combiner_stages) check_bits("a combiner stage", b, 2);
    check_bits("table", bits.table, 1);
    check_bits("frame", bits.frame, 1);
}

/// `machine` with room for a whole program and, for models, with texels of 16 bits: what plans the
/// inputs. Registers stop where those of `machine` do all the same.
Machine planning_machine(const Machine& machine, bool is_model) {
    Machine roomy = machine.multipass ? with_room(machine) : machine;
    roomy.multipass = false;
    if (is_model) roomy.numbers = NumberModel::wide;
    return roomy;
}

/// Whether x/2 + 1/2 of 0 is to be a code: not where `expand` takes the next one for it.
bool half_is_a_code(const Machine& machine) {
    return machine.numbers == NumberModel::wide || machine.expand == ExpandRule::ideal;
}

/// An object in one light.
struct LitDraw {
    Draw draw;
    CombinerProgram program;
    std::vector<bool> coded;
    std::vector<int> stages;  ///< bits of each
};

/// Models with fine texels; programs and maps of the talk's model as they are.
ProgramMaterial fine_program(const Object& object, const Scene& scene, std::size_t light,
                             DerivedMaps& maps) {
    const Material& material = object.material ? *object.material : Material{};
    const bool has_maps = material.model == Model::abp_modified && material.tangent_map;
    if (material.program || has_maps || !std::holds_alternative<Mesh>(object.geometry))
        return program_of(object, scene, light, maps);
    const Light source = scene.lights.empty() ? Light{.intensity = 0.0F} : scene.lights[light];
    return ModelCompiler(material)
        .compile(scene.machine.for_programs(), source.color * source.intensity,
                 light == 0 ? scene.ambient : glm::vec3(0.0F), TexelPrecision::fine)
        .program;
}

/// A scene on its way to pixels in double precision.
class BitFrame {
  public:
    BitFrame(const Scene& scene, const StageBits& bits, WorkerPool& pool)
        : m_scene(scene),
          m_bits(bits),
          m_pool(pool),
          m_size{scene.width, scene.height},
          m_viewport(make_viewport(scene.machine, scene.width, scene.height)),
          m_chunks(scene.objects.size()) {
        for (const Object& object : scene.objects) prepare(object);
        bin();
    }

    void draw(Framebuffer& target) {
        const std::int32_t columns = (m_size.width + kTileSize - 1) / kTileSize,
                           rows = (m_size.height + kTileSize - 1) / kTileSize;
        std::vector<TileVisibility> visibility(static_cast<std::size_t>(m_pool.size()));
        for_each_index(m_pool, static_cast<std::size_t>(columns * rows), 1,
                       [&](std::size_t tile, int worker) {
                           const auto i = static_cast<std::int32_t>(tile);
                           draw_tile(i % columns, i / columns,
                                     visibility[static_cast<std::size_t>(worker)], target);
                       });
    }

  private:
    void prepare(const Object& object) {
        const bool is_model = !(object.material && object.material->program);
        Scene scene = m_scene;
        scene.machine = planning_machine(m_scene.machine, is_model);
        FrameView view{&scene, make_view(scene.camera, scene.width, scene.height), m_viewport};
        view.half_cube = HalfVectorCube().of(scene.machine);
        std::vector<std::unique_ptr<LitDraw>>& lit = m_draws.emplace_back();
        for (std::size_t light = 0; light < std::max<std::size_t>(scene.lights.size(), 1);
             ++light) {
            const ProgramMaterial program = fine_program(object, m_scene, light, m_maps);
            lit.push_back(std::make_unique<LitDraw>());
            LitDraw& in = *lit.back();
            prepare_draw(in.draw, view, object, {&program, 1}, light, {.everything = true});
            transform_draw(in.draw, view, object, table_reference(), m_pool);
            in.program = program.combiners;
            in.coded = coded_planes(in.draw.shading, in.program);
            in.stages.assign(in.program.stages.size(), m_bits.combiners);
            std::copy_n(m_bits.combiner_stages.begin(),
                        std::min(m_bits.combiner_stages.size(), in.stages.size()),
                        in.stages.begin());
        }
        const Draw& first = lit.front()->draw;
        if (first.ordered || first.shading.quads)
            throw Error(ErrorCode::bad_program,
                        fmt::format("material '{}': {} cannot be drawn with chosen bits",
                                    object.material ? object.material->name : Material{}.name,
                                    first.ordered ? "what is blended or dropped after shading"
                                                  : "mip levels at computed coordinates"));
        m_rules.push_back(first.depth);
    }

    void bin() {
        for (std::size_t i = 0; i < m_draws.size(); ++i) {
            const Draw& draw = m_draws[i].front()->draw;
            m_chunks[i].fill(
                {draw.mesh(), static_cast<std::uint32_t>(i), draw.facing, m_viewport, m_size}, 0,
                draw.triangle_count(), table_reference());
        }
    }

    void draw_tile(std::int32_t x, std::int32_t y, TileVisibility& visibility,
                   Framebuffer& target) const {
        visibility.begin(x, y, m_size, nullptr, table_reference());
        for (const Chunk& chunk : m_chunks) {
            if (!chunk.tile(x, y).empty()) visibility.draw(chunk, m_rules, table_reference());
        }
        if (!visibility.shows_anything()) return;
        const TileFragments fragments = visibility.collect(table_reference());
        for (std::size_t t = 0; t < fragments.triangles.size(); ++t) {
            const int first = static_cast<int>(fragments.first[t]);
            for (int k = 0; k < fragments.size(t); ++k) {
                const std::uint16_t pixel = fragments.pixels[first + k];
                const int block = pixel / kBlockPixels, in = pixel % kBlockPixels;
                const int blocks = kTileSize / kBlockSize;
                const int px = visibility.left() + block % blocks * kBlockSize + in % kBlockSize,
                          py = visibility.top() + block / blocks * kBlockSize + in / kBlockSize;
                const glm::vec4 color(shade(*fragments.triangles[t], px, py));
                std::memcpy(target.row(py) + static_cast<std::size_t>(px) * sizeof color, &color,
                            sizeof color);
            }
        }
    }

    [[nodiscard]] glm::dvec4 shade(const SetupTriangle& triangle, int x, int y) const {
        glm::dvec4 sum(0.0);
        const auto& lights = m_draws[triangle.draw];
        for (std::size_t i = 0; i < lights.size(); ++i) {
            const glm::dvec4 color = shade(*lights[i], triangle, x, y, i);
            sum = i == 0 ? color
                         : glm::dvec4(glm::min(glm::dvec3(sum) + glm::dvec3(color), 1.0), sum.a);
        }
        return sum;
    }

    [[nodiscard]] glm::dvec4 shade(const LitDraw& lit, const SetupTriangle& triangle, int x, int y,
                                   std::size_t light) const {
        Quantiser quantiser(m_bits.rounding);
        quantiser.begin(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y),
                        static_cast<std::uint32_t>(light));
        const InputRounding rounding{
            .quantiser = &quantiser,
            .coded = half_is_a_code(m_scene.machine) ? &lit.coded : nullptr,
            .vectors = m_bits.half_vector,
            .texels = m_bits.textures,
            .filter = m_bits.filter,
            .table = m_bits.table};
        ExactInputs inputs(lit.draw.shading, lit.draw.mesh(), triangle, x, y, rounding);
        for (const InputOp& op : lit.draw.shading.inputs) inputs.feed(op);
        std::size_t next = 0;
        const FetchReals fetch = [&](const StageFetch& f, const std::array<double, 3>& at) {
            const int unit = static_cast<int>(f.destination) - static_cast<int>(Register::tex0);
            if ((lit.draw.shading.unit_states.textured >> unit & 1) == 0)
                return Reals{0.0, 0.0, 0.0, 1.0};
            return inputs.fetch_between_stages(next++, at);
        };
        const Reals color =
            run_combiners_exactly(lit.program, m_scene.machine, inputs.registers(), nullptr, fetch,
                                  {&quantiser, lit.stages, m_bits.frame});
        return {color[0], color[1], color[2], color[3]};
    }

    const Scene& m_scene;
    const StageBits& m_bits;
    WorkerPool& m_pool;
    FrameSize m_size;
    Viewport m_viewport;
    DerivedMaps m_maps;
    std::vector<std::vector<std::unique_ptr<LitDraw>>> m_draws;  ///< object by object
    std::vector<DepthRule> m_rules;
    std::vector<Chunk> m_chunks;  ///< of each object
};

void fill(Framebuffer& target, const glm::vec4& color) {
    for (int y = 0; y < target.height(); ++y) {
        for (int x = 0; x < target.width(); ++x)
            std::memcpy(target.row(y) + static_cast<std::size_t>(x) * sizeof color, &color,
                        sizeof color);
    }
}

}  // namespace

Framebuffer render_with_bits(const Scene& scene, const StageBits& bits, int threads) {
    check(bits);
    scene.machine.validate();
    if (scene.machine.double_precision)
        throw Error(ErrorCode::bad_option,
                    "chosen bits with profile double, which has no stages; expected one of the "
                    "machines");
    Framebuffer target(scene.width, scene.height, PixelFormat::rgba32f);
    fill(target, scene.background);
    WorkerPool pool(threads);
    BitFrame(scene, bits, pool).draw(target);
    return target;
}

}  // namespace burnish::lab
