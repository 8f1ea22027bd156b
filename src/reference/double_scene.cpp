#include "reference/double_scene.hpp"

#include <fmt/format.h>

#include <burnish/error.hpp>
#include <cmath>

namespace burnish::reference {

namespace {

[[noreturn]] void refuse(const Material& material, const char* what) {
    throw Error(ErrorCode::bad_program,
                fmt::format("material '{}': {}, the double renderer has reflectance models of "
                            "opaque meshes only",
                            material.name, what));
}

std::vector<DoubleVertex> double_vertices(const Mesh& mesh) {
    std::vector<DoubleVertex> vertices;
    vertices.reserve(mesh.vertex_count());
    for (const VertexFrame& v : mesh.frames()) {
        const glm::dvec3 tangent{glm::vec3(v.tangent)}, normal(v.normal);
        vertices.push_back({glm::dvec3(v.position), tangent,
                            glm::cross(normal, tangent) * static_cast<double>(v.tangent.w), normal,
                            glm::dvec2(v.uv.x, 1.0 - static_cast<double>(v.uv.y))});
    }
    return vertices;
}

ExactMaterial layer_material(const Material& material, const Machine& machine, bool machine_grid) {
    const std::vector<LayerQuantity> layer = material_layer(material, machine);
    if (material.model == Model::text)
        return {nullptr, std::make_shared<TextModel>(material, layer)};
    return {layer_surface(material, layer, machine_grid ? TexelSteps::machine : TexelSteps::exact),
            nullptr};
}

std::optional<TexelGrid> shaded_texels(const Material& material, FilterOrder order,
                                       TexelSteps steps) {
    if (order == FilterOrder::before) return std::nullopt;
    const TexelSource source(material);
    const bool is_filtered =
        is_linear_within(source.sampler().filter) || source.sampler().mag_is_linear();
    if (!source.varies() || !is_filtered) return std::nullopt;
    TexelGrid grid{{}, source.sampler(), steps};
    for (int level = 0; level < source.levels(); ++level)
        grid.sizes.emplace_back(source.width(level), source.height(level));
    return grid;
}

DoubleObject double_object(const Object& object, FilterOrder order,
                           const std::optional<Machine>& layer_machine, bool machine_grid,
                           SurfaceCache* surfaces) {
    static const Material kDefault;
    const Material& material = object.material ? *object.material : kDefault;
    const auto* mesh = std::get_if<Mesh>(&object.geometry);
    if (mesh == nullptr) refuse(material, "vertices instead of a mesh");
    if (material.program) refuse(material, "a program");
    if (material.alpha_test.pass != Comparison::always) refuse(material, "an alpha test");
    if (object.raster.blend) refuse(material, "blending");
    ExactMaterial drawn;
    if (layer_machine)
        drawn = layer_material(material, *layer_machine, machine_grid);
    else if (surfaces != nullptr && object.material)
        drawn = surfaces->of(object.material);
    else
        drawn = exact_material(material);
    return {double_vertices(*mesh),
            {mesh->indices().begin(), mesh->indices().end()},
            glm::dmat4(object.world_from_object),
            material.model,
            std::move(drawn.surface),
            std::move(drawn.text),
            shaded_texels(material, order, machine_grid ? TexelSteps::machine : TexelSteps::exact),
            object.raster.depth_test,
            object.raster.depth_write,
            object.raster.cull};
}

}  // namespace

DoubleScene double_scene(const Scene& scene, int width, int height,
                         const std::optional<Machine>& layer_machine, bool machine_grid,
                         SurfaceCache* surfaces) {
    DoubleScene out;
    if (layer_machine && machine_grid)
        out.grid = {std::ldexp(1.0, layer_machine->subpixel_bits), layer_machine->snap_floor};
    out.view = make_view(scene.camera, width, height);
    out.viewer = scene.machine.viewer;
    out.tangent_frames = scene.machine.tangent_frames;
    out.table_filter = scene.machine.table_filter;
    out.table_bias = static_cast<double>(scene.machine.table_bias);
    out.normalise_half_vector = scene.machine.normalise_half_vector;
    out.ambient = glm::dvec3(scene.ambient);
    out.background = glm::dvec4(scene.background);
    for (const Light& light : scene.lights) {
        out.lights.push_back({glm::dvec3(light.position), light.position_w == 0.0F ? 0.0 : 1.0,
                              glm::dvec3(light.color) * static_cast<double>(light.intensity)});
    }
    try {
        for (const Object& object : scene.objects)
            out.objects.push_back(double_object(object, scene.machine.filter_order, layer_machine,
                                                machine_grid, surfaces));
    } catch (...) {
        // What comes after the refused object was not asked for: a frame's patience.
        if (surfaces != nullptr) surfaces->drop_unused(2);
        throw;
    }
    if (surfaces != nullptr) surfaces->drop_unused();
    return out;
}

}  // namespace burnish::reference
