#include "lab/stage_bits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <burnish/error.hpp>
#include <burnish/multipass.hpp>
#include <cmath>
#include <cstring>
#include <memory>
#include <string_view>
#include <utility>

#include "core/cpu.hpp"
#include "draw.hpp"
#include "models/abp_modified.hpp"
#include "models/compile_model.hpp"
#include "models/edited_program.hpp"
#include "raster/bin.hpp"
#include "raster/tile.hpp"
#include "shade/normalisation_cube.hpp"
#include "trace/coded_planes.hpp"
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
    check_bits("table_index", bits.table_index, 1);
    check_bits("table_values", bits.table_values, 1);
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

/// Whether x/2 + 1/2 of 0 is to be a code, as it is of wide machines.
bool half_is_a_code(const Machine& machine) {
    return machine.numbers == NumberModel::wide;
}

/// Whether models' tables are to be looked up on a TableGrid.
bool has_grid(const StageBits& bits) {
    return bits.table_index != kExactBits || bits.table_values != kExactBits ||
           bits.table_axis != TableSpacing::lobe || bits.table_linear;
}

/// What is drawn, and the tables of a model.
struct FineProgram {
    ProgramMaterial program;
    std::vector<TableReport> tables;
};

/// An object in one light.
struct LitDraw {
    Draw draw;
    CombinerProgram program;
    std::vector<bool> coded;
    std::vector<TableGrid::Table> tables;
    std::optional<TableGrid> grid;  ///< of the bits that are drawn with
};

std::vector<TableGrid::Table> tables_of(const Shading& shading,
                                        const std::vector<TableReport>& reports) {
    std::vector<TableGrid::Table> tables;
    for (const TableReport& report : reports) {
        TableGrid::Table& table = tables.emplace_back();
        table.texels = shading.textures.at(static_cast<std::size_t>(report.unit))->texels();
        for (std::size_t axis = 0; axis < report.axes.size(); ++axis) {
            table.first.at(axis) = report.axes[axis].first;
            table.last.at(axis) = report.axes[axis].last;
        }
    }
    return tables;
}

/// Models with fine texels; programs and maps of the talk's model as they are.
FineProgram fine_program(const Object& object, const Scene& scene, std::size_t light,
                         DerivedMaps& maps) {
    const Material& material = object.material ? *object.material : Material{};
    if (material.program || has_own_maps(material) ||
        !std::holds_alternative<Mesh>(object.geometry))
        return {program_of(object, scene, light, maps), {}};
    const Machine machine = scene.machine.for_programs();
    const auto [color, ambient] = light_of_model(scene, light);
    CompiledModel model = ModelCompiler(material, maps.models.stop)
                              .compile(machine, color, ambient, TexelPrecision::fine);
    apply_edit(object, machine, light, model.program);
    return {std::move(model.program), std::move(model.tables)};
}

/// The bits of each general stage.
std::vector<int> stage_bits(const StageBits& bits, std::size_t count) {
    std::vector<int> stages(count, bits.combiners);
    std::copy_n(bits.combiner_stages.begin(), std::min(bits.combiner_stages.size(), count),
                stages.begin());
    return stages;
}

void fill(Framebuffer& target, const glm::vec4& color) {
    for (int y = 0; y < target.height(); ++y) {
        for (int x = 0; x < target.width(); ++x)
            std::memcpy(target.row(y) + static_cast<std::size_t>(x) * sizeof color, &color,
                        sizeof color);
    }
}

}  // namespace

/// A scene on its way to pixels in double precision.
struct BitRenderer::State {
    State(const Scene& of, int threads, std::function<bool()> stop)
        : scene(of),
          pool(threads),
          size{scene.width, scene.height},
          viewport(make_viewport(scene.machine, scene.width, scene.height)),
          chunks(scene.objects.size()),
          visibility(static_cast<std::size_t>(pool.size())) {
        maps.models.stop = std::move(stop);
        for (const Object& object : scene.objects) prepare(object);
        for (std::size_t i = 0; i < draws.size(); ++i) {
            const Draw& draw = draws[i].front()->draw;
            chunks[i].fill(
                {draw.mesh(), static_cast<std::uint32_t>(i), draw.facing, viewport, size}, 0,
                draw.triangle_count(), table_reference());
        }
    }

    void prepare(const Object& object) {
        const bool is_model = !(object.material && object.material->program);
        Scene planned = scene;
        planned.machine = planning_machine(scene.machine, is_model);
        FrameView view{&planned, make_view(scene.camera, scene.width, scene.height), viewport};
        view.half_cube = HalfVectorCube().of(planned.machine);
        std::vector<std::unique_ptr<LitDraw>>& lit = draws.emplace_back();
        const std::size_t lights = std::max<std::size_t>(scene.lights.size(), 1);
        for (std::size_t light = 0; light < lights; ++light) {
            const FineProgram fine = fine_program(object, scene, light, maps);
            const ProgramMaterial& program = fine.program;
            LitDraw& in = *lit.emplace_back(std::make_unique<LitDraw>());
            prepare_draw(in.draw, view, object, {&program, 1}, light, {.everything = true});
            transform_draw(in.draw, view, object, table_reference(), pool);
            in.program = program.combiners;
            in.coded = coded_planes(in.draw.shading, in.program);
            in.tables = tables_of(in.draw.shading, fine.tables);
        }
        const Draw& first = lit.front()->draw;
        if (first.ordered || first.shading.quads)
            throw Error(ErrorCode::bad_program,
                        fmt::format("material '{}': {} cannot be drawn with chosen bits",
                                    object.material ? object.material->name : Material{}.name,
                                    first.ordered ? "what is blended or dropped after shading"
                                                  : "a filter that looks at neighbours"));
        rules.push_back(first.depth);
    }

    /// Before shading with `bits`.
    void make_grids(const StageBits& bits) {
        for (const auto& lights : draws) {
            for (const auto& lit : lights) {
                lit->grid.reset();
                if (!has_grid(bits)) continue;
                if (lit->tables.empty() && !lit->draw.shading.stage_fetches.empty())
                    throw Error(ErrorCode::bad_option,
                                "table_index, table_values, table_axis or table_filter with a "
                                "material's own program, expected a model");
                lit->grid = TableGrid{.spacing = bits.table_axis,
                                      .linear = bits.table_linear,
                                      .index = bits.table_index,
                                      .values = bits.table_values,
                                      .tables = lit->tables};
            }
        }
    }

    /// Calls take(triangle, x, y) for every visible fragment of tile (x, y).
    template <class Take>
    void for_each_fragment(std::int32_t x, std::int32_t y, TileVisibility& tile, const Take& take) {
        tile.begin(x, y, size, nullptr);
        for (const Chunk& chunk : chunks) {
            if (!chunk.tile(x, y).empty()) tile.draw(chunk, rules, table_reference());
        }
        if (!tile.shows_anything()) return;
        const TileFragments fragments = tile.collect(table_reference());
        for (std::size_t t = 0; t < fragments.triangles.size(); ++t) {
            for (std::uint32_t k = fragments.first[t]; k < fragments.first[t + 1]; ++k) {
                constexpr int kBlocks = kTileSize / kBlockSize;
                const int block = fragments.pixels[k] / kBlockPixels,
                          inside = fragments.pixels[k] % kBlockPixels;
                take(*fragments.triangles[t],
                     tile.left() + block % kBlocks * kBlockSize + inside % kBlockSize,
                     tile.top() + block / kBlocks * kBlockSize + inside / kBlockSize);
            }
        }
    }

    [[nodiscard]] glm::dvec3 shade(const StageBits& bits, const SetupTriangle& triangle, int x,
                                   int y) const {
        const Shading& first = draws[triangle.draw].front()->draw.shading;
        if (!first.corners) return in_all_lights(bits, triangle, x, y, nullptr).color;
        TexelCornerCtx corner = first.corners->corner;
        const Filtered lower = at_corners(bits, triangle, x, y, corner);
        if (!first.corners->blends_levels() || lower.level_weight == 0.0) return lower.color;
        corner.choice = LevelChoice::ceiling;
        const Filtered upper = at_corners(bits, triangle, x, y, corner);
        Quantiser quantiser(bits.rounding);
        quantiser.begin(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y),
                        kFilterStream);
        return lerp(bits, lower.color, upper.color, lower.level_weight, quantiser);
    }

    /// A colour, and where the sample point lies between texels and levels.
    struct Filtered {
        glm::dvec3 color{0.0};
        std::array<double, 2> weights{};
        double level_weight = 0.0;
    };
    static constexpr std::uint32_t kFilterStream = kMaxLights;  ///< no light has it

    /// One lerp of the filter after combining.
    static glm::dvec3 lerp(const StageBits& bits, const glm::dvec3& a, const glm::dvec3& b,
                           double weight, Quantiser& quantiser) {
        const double one = std::ldexp(1.0, bits.filter);
        const double w = bits.filter == kExactBits ? weight : std::floor(weight * one) / one;
        glm::dvec3 result;
        for (int c = 0; c < 3; ++c)
            result[c] = quantiser.unsigned_number(a[c] + (b[c] - a[c]) * w, bits.filter);
        return result;
    }

    [[nodiscard]] Filtered at_corners(const StageBits& bits, const SetupTriangle& triangle, int x,
                                      int y, TexelCornerCtx corner) const {
        std::array<Filtered, FilterCtx::kCorners> at;
        for (std::size_t k = 0; k < at.size(); ++k) {
            corner.right = static_cast<std::uint8_t>(k & 1);
            corner.below = static_cast<std::uint8_t>(k >> 1);
            at[k] = in_all_lights(bits, triangle, x, y, &corner);
        }
        Quantiser quantiser(bits.rounding);
        quantiser.begin(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y),
                        kFilterStream + 1);
        const auto [right, below] = at[0].weights;
        const glm::dvec3 top = lerp(bits, at[0].color, at[1].color, right, quantiser);
        const glm::dvec3 bottom = lerp(bits, at[2].color, at[3].color, right, quantiser);
        return {lerp(bits, top, bottom, below, quantiser), at[0].weights, at[0].level_weight};
    }

    /// @param corner  null: at the pixel's own coordinates
    [[nodiscard]] Filtered in_all_lights(const StageBits& bits, const SetupTriangle& triangle,
                                         int x, int y, const TexelCornerCtx* corner) const {
        Filtered sum;
        for (std::size_t light = 0; light < draws[triangle.draw].size(); ++light) {
            Quantiser quantiser(bits.rounding);
            quantiser.begin(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y),
                            static_cast<std::uint32_t>(light));
            const Filtered one =
                shade(bits, *draws[triangle.draw][light], triangle, x, y, corner, quantiser);
            sum = {sum.color + one.color, one.weights, one.level_weight};
        }
        sum.color = glm::min(sum.color, 1.0);
        return sum;
    }

    /// In one light.
    [[nodiscard]] Filtered shade(const StageBits& bits, const LitDraw& lit,
                                 const SetupTriangle& triangle, int x, int y,
                                 const TexelCornerCtx* corner, Quantiser& quantiser) const {
        const Shading& shading = lit.draw.shading;
        const InputRounding rounding{.quantiser = &quantiser,
                                     .coded = half_is_a_code(scene.machine) ? &lit.coded : nullptr,
                                     .vectors = bits.half_vector,
                                     .texels = bits.textures,
                                     .filter = bits.filter,
                                     .table = bits.table,
                                     .grid = lit.grid ? &*lit.grid : nullptr};
        ExactInputs inputs(shading, lit.draw.mesh(), triangle, x, y, rounding);
        Filtered result;
        if (corner != nullptr) {
            // The plane of each light's program has its own place.
            TexelCornerCtx own = shading.corners->corner;
            own.right = corner->right;
            own.below = corner->below;
            own.choice = corner->choice;
            for (const InputOp& op : shading.corners->level) inputs.feed(op);
            inputs.stand_at(own);
            result.weights = inputs.corner_weights();
            const double lod = own.lambda < 0 ? 0.0 : inputs.plane(own.lambda);
            result.level_weight = lod - std::floor(lod);
        }
        inputs.feed_all(shading.inputs);
        std::size_t next = 0;
        const FetchReals fetch = [&](const StageFetch& f, const std::array<double, 3>& at) {
            const int unit = static_cast<int>(f.destination) - static_cast<int>(Register::tex0);
            if ((shading.unit_states.textured >> unit & 1) == 0) return Reals{0.0, 0.0, 0.0, 1.0};
            return inputs.fetch_between_stages(next++, at);
        };
        const std::vector<int> stages = stage_bits(bits, lit.program.stages.size());
        const Reals color = run_combiners_exactly(lit.program, scene.machine, inputs.registers(),
                                                  nullptr, fetch, {&quantiser, stages, bits.frame});
        result.color = {color[0], color[1], color[2]};
        return result;
    }

    const Scene& scene;
    WorkerPool pool;
    FrameSize size;
    Viewport viewport;
    DerivedMaps maps;
    std::vector<std::vector<std::unique_ptr<LitDraw>>> draws;  ///< object by object
    std::vector<DepthRule> rules;
    std::vector<Chunk> chunks;               ///< of each object
    std::vector<TileVisibility> visibility;  ///< of each worker
};

BitRenderer::BitRenderer(const Scene& scene, int threads, std::function<bool()> stop) {
    scene.machine.validate();
    if (scene.machine.double_precision)
        throw Error(ErrorCode::bad_option,
                    "chosen bits with profile double, which has no stages; expected one of the "
                    "machines");
    m_state = std::make_unique<State>(scene, threads, std::move(stop));
}
BitRenderer::~BitRenderer() = default;

Framebuffer BitRenderer::render(const StageBits& bits, const FrameHooks& hooks) {
    check(bits);
    State& s = *m_state;
    s.make_grids(bits);
    Framebuffer target(s.size.width, s.size.height, PixelFormat::rgba32f);
    fill(target, s.scene.background);
    const std::int32_t columns = (s.size.width + kTileSize - 1) / kTileSize,
                       rows = (s.size.height + kTileSize - 1) / kTileSize;
    const auto tiles = static_cast<std::size_t>(columns * rows);
    TileWatch watch(hooks, tiles);
    for_each_index(s.pool, tiles, 1, [&](std::size_t tile, int worker) {
        if (!watch.go_on()) return;
        const auto i = static_cast<std::int32_t>(tile);
        s.for_each_fragment(
            i % columns, i / columns, s.visibility[static_cast<std::size_t>(worker)],
            [&](const SetupTriangle& triangle, int x, int y) {
                const glm::vec4 color(glm::vec3(s.shade(bits, triangle, x, y)), 1.0F);
                std::memcpy(target.row(y) + static_cast<std::size_t>(x) * sizeof color, &color,
                            sizeof color);
            });
        watch.tile_done();
    });
    watch.require_wanted();
    return target;
}

std::optional<glm::dvec3> BitRenderer::pixel(const StageBits& bits, int x, int y) {
    check(bits);
    State& s = *m_state;
    s.make_grids(bits);
    std::optional<glm::dvec3> color;
    s.for_each_fragment(x / kTileSize, y / kTileSize, s.visibility.front(),
                        [&](const SetupTriangle& triangle, int at_x, int at_y) {
                            if (at_x == x && at_y == y) color = s.shade(bits, triangle, x, y);
                        });
    return color;
}

std::size_t BitRenderer::stage_count() const {
    std::size_t most = 0;
    for (const auto& object : m_state->draws) {
        for (const auto& lit : object) most = std::max(most, lit->program.stages.size());
    }
    return most;
}

const CombinerProgram& BitRenderer::program(std::size_t object) const {
    return m_state->draws.at(object).front()->program;
}

Framebuffer render_with_bits(const Scene& scene, const StageBits& bits, int threads,
                             const FrameHooks& hooks) {
    check(bits);
    return BitRenderer(scene, threads, hooks.stop).render(bits, hooks);
}

}  // namespace burnish::lab
