#include "app/picture.hpp"

#include <fmt/format.h>

#include <burnish/error.hpp>
#include <cstdio>
#include <map>
#include <memory>
#include <set>
#include <utility>

namespace burnish::app {
namespace {

bool is_scene(const std::filesystem::path& path) {
    return path.extension() == ".toml";
}

LoadedScene load(const PictureOptions& options) {
    if (!is_scene(options.input)) {
        if (!options.overrides.empty())
            throw Error(ErrorCode::bad_option,
                        fmt::format("-D {}: {} is a mesh, expected a scene",
                                    options.overrides.front(), options.input.string()));
        return scene_for_mesh(options.input);
    }
    // The profile goes through the scene, whose other [machine] keys override parts of it.
    std::vector<std::string> overrides = options.overrides;
    if (options.machine) overrides.push_back("machine.profile=" + *options.machine);
    return load_scene(options.input, overrides);
}

glm::vec3 rotated(const glm::vec3& v, const glm::vec3& axis, float degrees) {
    return glm::mat3(placement(glm::vec3(0.0F), axis, degrees, 1.0F)) * v;
}

Camera raised(Camera camera, float degrees) {
    const glm::vec3 arm = camera.position - camera.focal_point;
    const glm::vec3 side = glm::cross(camera.view_up, arm);
    camera.position = camera.focal_point + rotated(arm, side, -degrees);
    camera.view_up = rotated(camera.view_up, side, -degrees);
    return camera;
}

/// A bare mesh fills the picture, whatever its shape.
void reframe(Scene& scene) {
    const Mesh& mesh = std::get<Mesh>(scene.objects.front().geometry);
    const float aspect = static_cast<float>(scene.width) / static_cast<float>(scene.height);
    scene.camera = framing_camera(mesh.bounds(), aspect);
}

void apply_camera(const CameraOptions& options, Camera& camera) {
    const bool moves = options.position || options.focal_point || options.view_up ||
                       options.azimuth != 0.0F || options.elevation != 0.0F;
    if (moves && camera.view)
        throw Error(ErrorCode::bad_option,
                    "--camera-... moves a camera that the scene gives as a view matrix");
    if ((options.view_angle || options.zoom != 1.0F) && camera.projection)
        throw Error(
            ErrorCode::bad_option,
            "--camera-view-angle or --camera-zoom with a scene that gives a projection matrix");
    camera.position = options.position.value_or(camera.position);
    camera.focal_point = options.focal_point.value_or(camera.focal_point);
    camera.view_up = options.view_up.value_or(camera.view_up);
    camera.view_angle = options.view_angle.value_or(camera.view_angle) / options.zoom;
    if (options.azimuth != 0.0F) camera = turned(camera, options.azimuth);
    if (options.elevation != 0.0F) camera = raised(camera, options.elevation);
}

/// What --material, --model, --mipmaps and --max-anisotropy ask for, of every object that is a
/// mesh.
void replace_materials(const PictureOptions& options, Scene& scene) {
    std::shared_ptr<const Material> replacement;
    if (!options.material.empty())
        replacement = std::make_shared<const Material>(load_material(options.material));
    std::map<const Material*, std::shared_ptr<const Material>> changed;
    bool has_levels = false;
    for (Object& object : scene.objects) {
        if (!std::holds_alternative<Mesh>(object.geometry)) continue;
        if (replacement) object.material = replacement;
        const bool is_pipeline = object.material && object.material->program;
        if (options.model && is_pipeline)
            throw Error(ErrorCode::bad_option,
                        fmt::format("--model: material '{}' is a pipeline, expected one with a "
                                    "reflectance model",
                                    object.material->name));
        if (is_pipeline || !(options.model || options.mipmaps || options.max_anisotropy)) continue;
        std::shared_ptr<const Material>& copy = changed[object.material.get()];
        if (!copy) {
            Material material = object.material ? *object.material : Material{};
            material.model = options.model.value_or(material.model);
            if (options.mipmaps) {
                const int probes = material.mipmaps ? material.mipmaps->max_anisotropy : 1;
                material.mipmaps = options.mipmaps;
                material.mipmaps->max_anisotropy = probes;
            }
            if (options.max_anisotropy && material.mipmaps)
                material.mipmaps->max_anisotropy = *options.max_anisotropy;
            has_levels |= material.mipmaps.has_value();
            copy = std::make_shared<const Material>(std::move(material));
        }
        object.material = copy;
    }
    if (options.max_anisotropy && !has_levels)
        throw Error(ErrorCode::bad_option,
                    "--max-anisotropy without mip levels of a material, expected --mipmaps, too");
}

/// Texture units that are off, once per material.
void print_unit_problems(const Scene& scene) {
    std::set<const Material*> seen;
    for (const Object& object : scene.objects) {
        const Material* material = object.material.get();
        if (material == nullptr || !seen.insert(material).second) continue;
        if (!material->program || !material->program->texture_shader) continue;
        const ProgramMaterial& program = *material->program;
        for (const UnitProblem& problem :
             check_consistency(*program.texture_shader, program.units, scene.machine))
            fmt::print(stderr, "burnish: material '{}', texture unit {} is off: {}\n",
                       material->name, problem.unit, problem.reason);
    }
}

}  // namespace

Camera turned(const Camera& camera, float degrees) {
    if (camera.view)
        throw Error(ErrorCode::bad_option,
                    "a turn about the focal point of a camera that is given as a view matrix");
    Camera result = camera;
    const glm::vec3 arm = camera.position - camera.focal_point;
    result.position = camera.focal_point + rotated(arm, camera.view_up, degrees);
    return result;
}

Scene load_picture(const PictureOptions& options) {
    LoadedScene loaded = load(options);
    if (!options.quiet) {
        for (const std::string& note : loaded.notes) fmt::print(stderr, "burnish: {}\n", note);
    }
    Scene& scene = loaded.scene;
    if (options.machine && !is_scene(options.input))
        scene.machine = machine_profile(*options.machine);
    replace_materials(options, scene);
    if (options.multipass) scene.machine.multipass = true;
    if (options.half_vector) choose_half_vector(scene.machine, *options.half_vector);
    scene.machine.filter_order = options.filter_order.value_or(scene.machine.filter_order);
    if (options.size) {
        scene.width = options.size->x;
        scene.height = options.size->y;
        if (!is_scene(options.input)) reframe(scene);
    }
    if (!options.lights.empty()) scene.lights = options.lights;
    scene.background = options.background.value_or(scene.background);
    apply_camera(options.camera, scene.camera);
    if (!options.quiet) print_unit_problems(scene);
    return std::move(loaded.scene);
}

RendererOptions renderer_options(const PictureOptions& options) {
    RendererOptions renderer;
    renderer.threads = options.threads;
    renderer.isa = options.isa;
    return renderer;
}

FrameStats draw(Renderer& renderer, const Scene& scene, Framebuffer& target,
                const std::optional<Shown>& shown) {
    try {
        if (!shown) return renderer.render(scene, target);
        return std::visit([&](const auto& what) { return renderer.render(scene, target, what); },
                          *shown);
    } catch (const Error& error) {
        if (error.code() != ErrorCode::bad_option) throw;
        throw Error(ErrorCode::bad_input, error.what());
    }
}

}  // namespace burnish::app
