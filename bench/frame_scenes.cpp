#include "bench/frame_scenes.hpp"

#include <burnish/materials.hpp>
#include <burnish/shapes.hpp>
#include <cmath>
#include <utility>

namespace burnish {
namespace {

Image8 mixed_texels(int side) {
    Image8 image(side, side);
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x)
            for (int c = 0; c < 4; ++c)
                image.at(x, y)[c] = static_cast<std::uint8_t>(x * (c + 3) + y * 7 + x * y / 16);
    return image;
}

}  // namespace

Scene ellipsoid_scene(int columns, int rows, int width, int height) {
    MeshData data = shapes::sphere(columns, rows, {1.65F, 1.10F, 1.10F});
    for (glm::vec2& uv : data.uvs) uv *= glm::vec2(4.0F, 2.0F);
    Scene scene;
    scene.width = width;
    scene.height = height;
    scene.machine = machine_profile("geforce256");
    scene.machine.texture_units = 3;
    scene.lights.push_back({.position = {0.3F, 0.8F, 0.5F}});
    Material material = brushed_steel();
    material.ks = glm::vec3(1.0F);
    material.kd = glm::vec3(0.0F);
    scene.objects.push_back(
        {Mesh(data), std::make_shared<Material>(material), glm::mat4(1.0F), {.cull = Cull::back}});
    return scene;
}

Scene lobe_scene(int columns, int rows, int width, int height) {
    Scene scene = ellipsoid_scene(columns, rows, width, height);
    scene.machine = machine_profile("ideal");
    Material material = *scene.objects.front().material;
    material.model = Model::abp;
    material.exponent_map = {material.specular_map, 3, 8.0F, 16.0F};
    scene.objects.front().material = std::make_shared<Material>(material);
    return scene;
}

Scene layers_scene(const Layers& layers, int width, int height) {
    Scene scene;
    scene.width = width;
    scene.height = height;
    scene.machine = machine_profile("nv2a");
    using namespace combine;
    ProgramBuilder p;
    p.lerp(raw(Register::zero), raw(Register::zero), raw(Register::zero), raw(tex(0)));
    p.out_alpha(alpha(raw(tex(0))));
    auto material = std::make_shared<Material>();
    material->program.emplace();
    material->program->combiners = p.build();
    material->program->units = {std::make_shared<Texture>(mixed_texels(layers.texture), Sampler{})};
    const auto texels = static_cast<float>(layers.texture);
    const float angle = layers.degrees * 0.0174532925F;
    for (int layer = 0; layer < layers.count; ++layer) {
        RawVertices raw{Space::window, Topology::quads, {}};
        const auto step = static_cast<float>(layer);
        for (const auto& [corner_x, corner_y] :
             {std::pair{0, 0}, {width, 0}, {width, height}, {0, height}}) {
            const auto x = static_cast<float>(corner_x), y = static_cast<float>(corner_y);
            RawVertex v;
            v.position = {x, y, 0.9F - 0.8F * step / static_cast<float>(layers.count), 1.0F};
            v.uv[0] = {(x * std::cos(angle) - y * std::sin(angle)) / texels,
                       (x * std::sin(angle) + y * std::cos(angle)) / texels + 0.1F * step, 0.0F,
                       1.0F};
            raw.vertices.push_back(v);
        }
        scene.objects.push_back(
            {std::move(raw), material, glm::mat4(1.0F), {.blend = layers.blend}});
    }
    return scene;
}

}  // namespace burnish
