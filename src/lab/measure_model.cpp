#include "lab/measure_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <burnish/error.hpp>
#include <burnish/materials.hpp>
#include <burnish/renderer.hpp>
#include <burnish/shapes.hpp>

#include "draw.hpp"
#include "geometry/camera.hpp"
#include "reference/render_double.hpp"

namespace burnish::lab {

namespace {

constexpr int kFrameSize = 256;
constexpr double kPeak = 0.9;

Framebuffer in_double(const Scene& scene, bool machine_grid = false) {
    Framebuffer frame(scene.width, scene.height, PixelFormat::rgba32f);
    WorkerPool pool(1);
    DoubleOptions options;
    if (!scene.machine.double_precision) options.layer_machine = scene.machine;
    options.machine_grid = machine_grid;
    render_double(scene, frame, pool, options);
    return frame;
}

/// Sets the light so that the double picture has its peak, and returns that picture: without
/// ambient light it is proportional to the light.
Framebuffer expose_picture(Scene& scene) {
    Light& light = scene.lights.front();
    light.intensity = 1.0F;
    Framebuffer frame = in_double(scene);
    const double peak = metrics::interior_peak(frame);
    if (peak <= 0.0) return frame;
    light.intensity = static_cast<float>(kPeak / peak);
    for (int y = 0; y < frame.height(); ++y) {
        auto* row = reinterpret_cast<glm::vec4*>(frame.row(y));
        for (int x = 0; x < frame.width(); ++x)
            row[x] = glm::vec4(glm::vec3(row[x]) * light.intensity, row[x].a);
    }
    return frame;
}

/// Of the only object under the only light.
void count_resources(const Scene& scene, ModelMeasurement& measured) {
    DerivedMaps maps;
    const ProgramMaterial program = program_of(scene.objects.front(), scene, 0, maps);
    measured.stages = static_cast<int>(program.combiners.stages.size());
    measured.units = static_cast<int>(
        std::count_if(program.units.begin(), program.units.end(),
                      [](const TexturePtr& texture) { return texture != nullptr; }));
    const FrameView frame{&scene, make_view(scene.camera, scene.width, scene.height),
                          make_viewport(scene.machine, scene.width, scene.height)};
    Draw draw;
    prepare_draw(draw, frame, scene.objects.front(), std::span(&program, 1), 0, {});
    measured.passes = static_cast<int>(draw.shading.earlier_passes.size()) + 1;
}

}  // namespace

ModelParameters constant_parameters(float alpha_x, float alpha_y, float exponent) {
    ModelParameters parameters;
    parameters.name = fmt::format("{}, {}, N {}", alpha_x, alpha_y, exponent);
    Material& material = parameters.material;
    material.name = parameters.name;
    material.alpha_x = alpha_x;
    material.alpha_y = alpha_y;
    material.exponent = exponent;
    material.kd = {0.1F, 0.12F, 0.2F};
    material.ks = {0.8F, 0.7F, 0.6F};
    return parameters;
}

ModelParameters shift_variant_parameters(std::string_view set) {
    return {std::string(set), generated_material(set, 1, 256), true};
}

std::vector<ModelParameters> measured_parameters() {
    std::vector<ModelParameters> all{constant_parameters(0.15F, 0.5F, 16.0F)};
    for (const float alpha_y : {0.05F, 0.2F})
        for (const float exponent : {2.0F, 16.0F, 128.0F})
            all.push_back(constant_parameters(0.05F, alpha_y, exponent));
    for (const std::string_view set : generated_set_names())
        all.push_back(shift_variant_parameters(set));
    return all;
}

bool has_widths(Model model) {
    return model != Model::blinn_phong && model != Model::banks && model != Model::kajiya_kay;
}

bool has_exponent(Model model) {
    return model == Model::blinn_phong || model == Model::abp || model == Model::banks ||
           model == Model::kajiya_kay;
}

Scene measured_scene(const Material& material, std::string_view machine) {
    Scene scene;
    scene.width = kFrameSize;
    scene.height = kFrameSize;
    scene.background = glm::vec4(0.0F);
    scene.machine = machine_profile(machine);
    scene.machine.multipass = !scene.machine.double_precision;
    scene.camera.position = {0.0F, 0.0F, 3.0F};
    scene.lights.push_back({.position = {0.4F, 0.5F, 0.8F}});
    scene.objects.push_back(
        {Mesh(shapes::sphere(96, 48)), std::make_shared<Material>(material), glm::mat4(1.0F), {}});
    return scene;
}

void expose(Scene& scene) {
    expose_picture(scene);
}

ModelMeasurement measure_model(Model model, std::string_view machine,
                               const ModelParameters& parameters) {
    ModelMeasurement measured;
    measured.model = model;
    measured.machine = machine;
    measured.parameters = parameters.name;
    Material material = parameters.material;
    material.model = model;
    Scene scene = measured_scene(material, machine);
    try {
        const Framebuffer want = expose_picture(scene);
        count_resources(scene, measured);
        Framebuffer got(scene.width, scene.height, PixelFormat::rgba32f);
        Renderer({.threads = 1}).render(scene, got);
        measured.errors = metrics::interior_errors(got, want);
        if (parameters.shift_variant && scene.machine.numbers == NumberModel::wide)
            measured.on_its_grid = metrics::interior_errors(got, in_double(scene, true));
        measured.estimate = estimate_error(material, scene.machine);
    } catch (const Error& error) {
        measured.refusal = error.what();
    }
    return measured;
}

}  // namespace burnish::lab
