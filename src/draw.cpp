#include "draw.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <burnish/error.hpp>

#include "geometry/clip.hpp"
#include "machine/show_register.hpp"
#include "models/compile_model.hpp"
#include "models/edited_program.hpp"

namespace burnish {

namespace {

/// Corners of the triangles of a primitive with `count` vertices.
std::vector<std::uint32_t> triangle_indices(Topology topology, std::uint32_t count) {
    std::vector<std::uint32_t> out;
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        out.insert(out.end(), {a, b, c});
    };
    switch (topology) {
        case Topology::triangles:
            for (std::uint32_t i = 2; i < count; i += 3) add(i - 2, i - 1, i);
            break;
        case Topology::triangle_strip:  // every other one the other way round
            for (std::uint32_t i = 2; i < count; ++i) {
                i % 2 == 0 ? add(i - 2, i - 1, i) : add(i - 1, i - 2, i);
            }
            break;
        case Topology::triangle_fan:
            for (std::uint32_t i = 2; i < count; ++i) add(0, i - 1, i);
            break;
        case Topology::quads:  // split from the first to the third corner
            for (std::uint32_t i = 3; i < count; i += 4) {
                add(i - 3, i - 2, i - 1);
                add(i - 3, i - 1, i);
            }
            break;
        case Topology::quad_strip:  // corners 0 1 3 2 of each pair of pairs
            for (std::uint32_t i = 3; i < count; i += 2) {
                add(i - 3, i - 2, i);
                add(i - 3, i, i - 1);
            }
            break;
    }
    return out;
}

Facing facing_of(Cull cull) {
    switch (cull) {
        case Cull::none:
            return Facing::any;
        case Cull::back:
            return Facing::front_only;
        case Cull::front:
            return Facing::back_only;
    }
    return Facing::any;
}

std::size_t light_count(const Scene& scene) {
    if (scene.lights.size() > kMaxLights) {
        throw Error(ErrorCode::bad_option,
                    fmt::format("{} lights, expected at most {}", scene.lights.size(), kMaxLights));
    }
    return std::max(scene.lights.size(), std::size_t{1});
}

void transform_mesh(Draw& draw, const FrameView& frame, const Object& object, const Mesh& mesh,
                    const KernelTable& kernels, WorkerPool& pool) {
    const glm::mat4 clip_from_object(frame.view.clip_from_world *
                                     glm::dmat4(object.world_from_object));
    TransformCtx whole{};
    for (int i = 0; i < 16; ++i) whole.m[i] = clip_from_object[i / 4][i % 4];
    whole.viewport = frame.viewport;
    const std::array<const float*, 3> positions = mesh.positions();
    const std::size_t count = mesh.vertex_count();
    constexpr std::size_t kBatch = 1024;  // a multiple of every vector's lanes
    for_each_index(pool, (count + kBatch - 1) / kBatch, 1, [&](std::size_t batch, int) {
        const std::size_t first = batch * kBatch;
        TransformCtx ctx = whole;
        ctx.x = positions[0] + first;
        ctx.y = positions[1] + first;
        ctx.z = positions[2] + first;
        ctx.count = static_cast<int>(std::min(kBatch, count - first));
        ctx.screen = draw.screen.data() + first;
        ctx.homogeneous = draw.homogeneous.data() + first;
        kernels.transform(ctx);
    });
}

void transform_raw(Draw& draw, const FrameView& frame, const Object& object,
                   const RawVertices& raw) {
    glm::mat4 clip_from_vertex(1.0F);
    if (raw.space == Space::object) {
        clip_from_vertex =
            glm::mat4(frame.view.clip_from_world * glm::dmat4(object.world_from_object));
    }
    for (std::size_t i = 0; i < raw.vertices.size(); ++i) {
        const glm::vec4& p = raw.vertices[i].position;
        if (raw.space == Space::window) {
            place_window_vertex({p.x, p.y, p.z, p.w}, frame.viewport, draw.screen[i],
                                draw.homogeneous[i]);
        } else {
            const glm::vec4 clip = clip_from_vertex * p;
            place_clip_vertex({clip.x, clip.y, clip.z, clip.w}, frame.viewport, draw.screen[i],
                              draw.homogeneous[i]);
        }
    }
}

void prepare_shading(Shading& shading, const FrameView& frame, const Object& object,
                     std::span<const ProgramMaterial> programs, std::size_t first_light,
                     const Wanted& wanted) {
    const auto* mesh = std::get_if<Mesh>(&object.geometry);
    const Machine& machine = frame.scene->machine;
    shading.lights.clear();
    for (std::size_t i = 0; i < programs.size(); ++i) {
        const Light light = light_of(*frame.scene, first_light + i);
        shading.lights.push_back(
            {light_space(light, frame.view, machine.viewer, object.world_from_object),
             {programs[i].lit_tint, programs[i].lit_base},
             {machine.normalise_half_vector,
              machine.tangent_frames == TangentFrames::orthonormal}});
    }
    shading.half_cube = frame.half_cube;
    plan_shading(shading, programs, machine, mesh != nullptr, wanted);
    shading.frames = mesh != nullptr ? mesh->frames() : std::span<const VertexFrame>{};
}

void fill_rows(Shading& shading, const Object& object, const KernelTable& kernels,
               WorkerPool& pool) {
    if (const auto* mesh = std::get_if<Mesh>(&object.geometry)) {
        mesh_rows(mesh->frames(), shading.frame_attributes, shading.varying_list, shading.lights,
                  kernels, pool, shading.rows);
    } else {
        raw_rows(std::get<RawVertices>(object.geometry).vertices, shading.varying_list,
                 shading.program.numbers, shading.rows);
    }
}

/// Whether it brings a program instead of a model.
bool is_program(const Object& object) {
    return object.material && object.material->program;
}

/// One for each light.
std::vector<ProgramMaterial> programs_of(const Object& object, const Scene& scene,
                                         DerivedMaps& maps) {
    std::vector<ProgramMaterial> programs;
    for (std::size_t light = 0; light < light_count(scene); ++light)
        programs.push_back(program_of(object, scene, light, maps));
    return programs;
}

}  // namespace

ProgramMaterial program_of(const Object& object, const Scene& scene, std::size_t light,
                           DerivedMaps& maps) {
    static const auto kDefault = std::make_shared<const Material>();
    const std::shared_ptr<const Material>& material = object.material ? object.material : kDefault;
    if (material->program) return *material->program;
    if (!std::holds_alternative<Mesh>(object.geometry)) {
        throw Error(
            ErrorCode::bad_program,
            fmt::format(
                "material '{}': a reflectance model needs a mesh, raw vertices need a program",
                material->name));
    }
    const Machine machine = scene.machine.for_programs();
    const auto [color, ambient] = light_of_model(scene, light);
    ProgramMaterial program = has_own_maps(*material)
                                  ? compile_abp_modified(*material, machine, color, ambient, maps)
                                  : maps.models.get(material, machine, color, ambient).program;
    apply_edit(object, machine, light, program);
    return program;
}

void prepare_draw(Draw& draw, const FrameView& frame, const Object& object, DerivedMaps& maps) {
    std::vector<ProgramMaterial> programs = programs_of(object, *frame.scene, maps);
    prepare_draw(draw, frame, object, programs, 0, {});
    if (programs.size() > 1 && !draw.shading.reads_light && is_program(object)) {
        programs.resize(1);
        prepare_draw(draw, frame, object, programs, 0, {});
    }
    if (!frame.shown) return;
    // Tests that follow shading need the whole program first. A register is the first light's.
    const bool tested = draw.output.late_depth;
    programs.resize(1);
    const Wanted wanted = show_register(programs[0].combiners, *frame.shown, frame.format);
    if (tested) draw.shown.emplace();
    prepare_shading(tested ? draw.shown->values : draw.shading, frame, object, programs, 0, wanted);
}

void prepare_draw(Draw& draw, const FrameView& frame, const Object& object,
                  std::span<const ProgramMaterial> programs, std::size_t first_light,
                  const Wanted& wanted) {
    draw.facing = facing_of(object.raster.cull);
    prepare_shading(draw.shading, frame, object, programs, first_light, wanted);
    plan_fragments(draw, frame, object);
    if (const auto* mesh = std::get_if<Mesh>(&object.geometry)) {
        draw.indices = mesh->indices();
    } else {
        const auto& raw = std::get<RawVertices>(object.geometry);
        draw.own_indices =
            triangle_indices(raw.topology, static_cast<std::uint32_t>(raw.vertices.size()));
        draw.indices = draw.own_indices;
    }
}

void plan_fragments(Draw& draw, const FrameView& frame, const Object& object) {
    const DepthRule depth = comparison_rule(object.raster.depth_test, object.raster.depth_write);
    // What is shown instead of colours is that of the last fragment: nothing is blended.
    const bool shows_colors = !frame.shown && !frame.aov && frame.format != PixelFormat::depth32f;
    draw.output = plan_output(draw.shading, shows_colors ? object.raster.blend : std::nullopt,
                              object.material ? object.material->alpha_test : AlphaTest{}, depth);
    draw.depth = early_rule(draw.shading, draw.output);
    draw.ordered = needs_order(draw.output);
    if (draw.ordered && draw.shading.quads_of_pixels)
        throw Error(ErrorCode::bad_program,
                    "quads = pixels where fragments are blended or may be dropped, expected "
                    "quads = triangle");
    draw.shaded = true;
    draw.shown.reset();
    if (!frame.aov) return;
    const double aspect =
        static_cast<double>(frame.viewport.width) / static_cast<double>(frame.viewport.height);
    const glm::dmat4 square =
        glm::dmat4(glm::dmat3(aspect, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, 1.0));
    draw.shown = shown_values(*frame.aov, object, frame.scene->machine.tangent_frames,
                              square * frame.view.clip_from_world);
}

void transform_draw(Draw& draw, const FrameView& frame, const Object& object,
                    const KernelTable& kernels, WorkerPool& pool) {
    if (draw.shaded) fill_rows(draw.shading, object, kernels, pool);
    if (draw.shown && (!draw.shown->aov || draw.shown->values.frame_attributes > 0))
        fill_rows(draw.shown->values, object, kernels, pool);
    if (const auto* mesh = std::get_if<Mesh>(&object.geometry)) {
        draw.screen.resize(mesh->vertex_count());
        draw.homogeneous.resize(mesh->vertex_count());
        transform_mesh(draw, frame, object, *mesh, kernels, pool);
    } else {
        const auto& raw = std::get<RawVertices>(object.geometry);
        draw.screen.resize(raw.vertices.size());
        draw.homogeneous.resize(raw.vertices.size());
        transform_raw(draw, frame, object, raw);
    }
}

}  // namespace burnish
